"""Functions compiled to code that is linked once, with everything that it calls, and optimised only then.

Numba by itself optimises each function with all that it calls, and once more in each caller, and makes
machine code of it; and in each it looks for closures, and for loops over lists and arrays to rewrite. Plain
functions of numbers and records need none of that.
"""

import gc
from collections.abc import Callable, Iterator, Mapping
from contextlib import contextmanager
from itertools import count
from types import SimpleNamespace
from typing import Any

from llvmlite import binding, ir

from uictest.core.lanes.arguments import Arguments
from uictest.core.lanes.calls import DirectTarget
from uictest.core.lanes.compiler import (
    LAST_STEP,
    STEPS_BEFORE_CODE,
    Library,
    Pipeline,
    compiled,
    empty_library,
)
from uictest.core.lanes.given_values import given_values, kind_of, parameters_of_c
from uictest.core.lanes.resolved import Resolved, ResolvedEmission

Function = Callable[..., Any]
_METADATA: tuple[list[Any], dict[Any, Any]] = [], {}
"""Nodes of metadata of all code, which are numbered in it together."""
_OF_ONE_MODULE = '@".const.'
"""How names of constants begin that another module may have for other constants."""
_numbers = count()
"""Of the libraries of this process."""
_progress = SimpleNamespace(awaited=0, compiled=0, advance=lambda done: None)
"""How many functions wait to be compiled, how many are, and who is told."""


def compile_inner(function: Function, **options: Any) -> Any:
    """Compile a function that compiled code calls, and nothing else: it has no entries from Python and C.

    Args:
        function: plain Python.
        options: those of `numba.njit`.
    """
    _progress.awaited += 1
    without_entries = {"no_cpython_wrapper": True, "no_cfunc_wrapper": True}
    return compiled(**options, **without_entries, pipeline_class=_LinkedOnly)(function)


def bitcode(
    entries: Mapping[str, tuple[Any, Arguments]], advance: Callable[[float], None] = lambda done: None
) -> bytes:
    """Return LLVM's code of functions as C calls them, and of all that they call.

    The code is not optimised and the same on every processor of a kind. What C calls returns a whole number,
    0 where the function returns nothing.

    Args:
        entries: name -> function of :func:`compile_inner`, and what it takes.
        advance: is told the share of the work that is done, as far as it can be foreseen.
    """
    with _without_collection(), _watched(advance):
        linked = _module_of([_entry(name, *each) for name, each in entries.items()])
    for number, each in enumerate((*linked.functions, *linked.global_variables)):
        if each.name in entries:
            each.linkage = "external"
        elif not each.is_declaration:
            # Numba's own names also count what was compiled before.
            each.linkage, each.name = "internal", f"inner.{number}"
    return bytes(linked.as_bitcode())


def _entry(name: str, function: Any, arguments: Arguments) -> Any:
    """Return the code of a function of C that calls a compiled one."""
    for context in (function.typingctx, function.targetctx):
        context.refresh()
    kinds = tuple(map(kind_of, arguments))
    function.compile(kinds)
    result = function.overloads[kinds]
    context, returned = result.target_context, result.signature.return_type
    code = _LinkedCode(context.codegen(), name)
    code.add_linking_library(result.library)
    module, whole = code.create_ir_module(name), ir.IntType(64)
    entry = ir.Function(module, ir.FunctionType(whole, parameters_of_c(context, arguments)), name)
    builder = ir.IRBuilder(entry.append_basic_block())
    called = context.declare_function(module, result.fndesc)
    values = given_values(context, builder, arguments, entry.args)
    value = context.call_conv.call(builder, called, returned, values)
    builder.ret(value if value.type == whole else whole(0))
    code.add_ir_module(module)
    return code


@contextmanager
def _watched(advance: Callable[[float], None]) -> Iterator[None]:
    """Call a function for each function that is compiled; most are compiled for one kind of argument."""
    _progress.compiled, _progress.advance = 0, advance
    try:
        yield
    finally:
        _progress.awaited, _progress.advance = 0, lambda done: None


@contextmanager
def _without_collection() -> Iterator[None]:
    """Pause the search for unused cycles: the compiler makes millions of objects and needs nearly all."""
    enabled = gc.isenabled()
    gc.disable()
    try:
        yield
    finally:
        if enabled:
            gc.enable()


class _LinkedCode(Library):  # type: ignore[misc]
    """Code as text, as it was written; whoever calls it from outside links it."""

    def __init__(self, codegen: Any, name: str) -> None:
        empty_library(self, codegen, name)
        self._linking_libraries: list[Any] = []
        self._constants = f"{_OF_ONE_MODULE}{next(_numbers)}."
        self.declared: dict[str, str] = {}
        self.defined: dict[str, str] = {}

    def create_ir_module(self, name: str) -> Any:
        """Return a module to write code in."""
        return _empty_module(self._codegen, name)

    def add_ir_module(self, module: Any) -> None:
        """Add code as it was written."""
        for each in module.global_values:
            is_defined = each.blocks if isinstance(each, ir.Function) else each.initializer
            if is_defined:
                each.linkage = each.linkage or "linkonce_odr"
            name = each.get_reference().replace(_OF_ONE_MODULE, self._constants)
            texts = self.defined if is_defined else self.declared
            texts[name] = str(each).replace(_OF_ONE_MODULE, self._constants)

    def finalize(self) -> None:
        """Link nothing and optimise nothing."""
        self._finalized = True

    def _get_module_for_linking(self) -> Any:
        """Return the code with that of everything that it calls."""
        return _module_of([self])


def _empty_module(codegen: Any, name: str) -> Any:
    module = codegen._create_empty_module(name)
    module.metadata, module._metadatacache = _METADATA
    return module


def _module_of(libraries: list[Any]) -> Any:
    """Return libraries and everything that they call as one module of LLVM."""
    called = _called_by(libraries)
    written = [each for each in called if isinstance(each, _LinkedCode)]
    texts: dict[str, str] = {}
    for library in written:
        texts.update(library.declared)
    for library in written:
        texts.update(library.defined)
    frame = str(_empty_module(written[0]._codegen, "linked"))
    module = binding.parse_assembly("\n".join([frame, *texts.values()]))
    for library in called:
        if library not in written:
            module.link_in(library._get_module_for_linking(), preserve=True)
    module.verify()
    return module


def _called_by(libraries: list[Any]) -> list[Any]:
    """Return libraries and those of everything that their code calls, each once."""
    called: dict[Any, None] = {}
    waiting = list(libraries)
    while waiting:
        each = waiting.pop()
        if each not in called:
            called[each] = None
            if isinstance(each, _LinkedCode):  # any other is linked already
                waiting += each._linking_libraries
    return list(called)


class _LinkedOnly(Pipeline):  # type: ignore[misc]
    """The steps of numba's own pipeline that plain functions need, with another end."""

    def __init__(self, typing_context: Any, target_context: Any, *others: Any) -> None:
        super().__init__(Resolved.of(typing_context), DirectTarget.of(target_context), *others)
        # Memory is handed in by the caller, who owns it: references to it are not counted.
        self.state.targetctx.enable_nrt = False
        self.state.library = _LinkedCode(target_context.codegen(), "inner")
        _progress.compiled += 1
        _progress.advance(min(_progress.compiled / max(_progress.awaited, 1), 1.0))

    def define_pipelines(self) -> list[Any]:
        """Return the only pipeline."""
        return [SimpleNamespace(pipeline_name="linked code", exec_times={}, run=_take_steps)]


def _take_steps(state: Any) -> None:
    for step in (*STEPS_BEFORE_CODE, ResolvedEmission(), LAST_STEP):
        step.run_pass(state)
