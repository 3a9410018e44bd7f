"""Functions compiled to code that is linked once, with everything that it calls, and optimised only then.

Numba by itself optimises each function with all that it calls, and once more in each caller, and makes
machine code of it; and in each it looks for closures, and for loops over lists and arrays to rewrite. Plain
functions of numbers and records need none of that.
"""

import gc
from collections.abc import Callable, Iterator, Mapping
from contextlib import contextmanager
from types import SimpleNamespace
from typing import Any

from llvmlite import binding

from uictest.core.lanes.compiler import PASSES, Library, PassManager, Pipeline, compiled, compiled_entry
from uictest.core.lanes.types import type_of_argument

Function = Callable[..., Any]
_NOTHING_COUNTED = """
define void @NRT_incref(ptr %memory) alwaysinline { ret void }
define void @NRT_decref(ptr %memory) alwaysinline { ret void }
"""
"""In place of numba's counting of references: memory is handed in by the caller, who owns it."""
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
    entries: Mapping[str, tuple[Function, tuple[Any, ...]]],
    advance: Callable[[float], None] = lambda done: None,
    **options: Any,
) -> bytes:
    """Compile functions as C calls them, and return LLVM's code of them and of all that they call.

    The code is not optimised and the same on every processor of a kind. Each entry returns a whole number.

    Args:
        entries: name -> function and, for each of its arguments, the layout of what lies at the address, or
            `int` for a whole number.
        advance: is told the share of the work that is done, as far as it can be foreseen.
        options: those of `numba.cfunc`.
    """
    linked = binding.parse_assembly(_NOTHING_COUNTED)
    with _without_collection(), _watched(advance):
        for name, (function, arguments) in entries.items():
            module = _compiled_entry(name, function, arguments, options)
            linked.triple, linked.data_layout = module.triple, module.data_layout
            linked.link_in(module)
    for number, each in enumerate((*linked.functions, *linked.global_variables)):
        if not each.is_declaration and each.name not in entries:
            # Numba's own names also count what was compiled before.
            each.linkage, each.name = "internal", f"inner.{number}"
    return bytes(linked.as_bitcode())


def _compiled_entry(name: str, function: Function, arguments: tuple[Any, ...], options: Any) -> Any:
    kinds = [type_of_argument(each) for each in arguments]
    entry = compiled_entry(type_of_argument(int)(*kinds), pipeline_class=_LinkedOnly, **options)(function)
    module = entry._library._get_module_for_linking()
    wrapper = module.get_function(entry.native_name)
    wrapper.name, wrapper.linkage = name, "external"
    return module


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
    """Code as it was written; whoever calls it from outside links it."""

    def _optimize_functions(self, module: Any) -> None:
        module.data_layout = self._codegen._data_layout

    def finalize(self) -> None:
        """Link nothing and optimise nothing."""
        self._finalized = True

    def get_pointer_to_function(self, name: str) -> int:
        """Return that there is none."""
        return 0

    def _get_module_for_linking(self) -> Any:
        """Return the code with that of everything that it calls."""
        module = self._own_module().clone()
        for library in _called_by(self):
            inner = isinstance(library, _LinkedCode)
            called = library._own_module() if inner else library._get_module_for_linking()
            module.link_in(called, preserve=True)
        return module

    def _own_module(self) -> Any:
        return super()._get_module_for_linking()

    @property
    def codegen(self) -> Any:
        """What is told of the objects that errors are raised with: there is no place to keep them."""
        return SimpleNamespace(set_env=lambda name, environment: None)


def _called_by(library: Any) -> list[Any]:
    """Return the libraries of everything that code calls, each once."""
    called: dict[Any, None] = {}
    waiting = list(library._linking_libraries)
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
        super().__init__(typing_context, target_context, *others)
        self.state.library = _LinkedCode(target_context.codegen(), "inner")
        _progress.compiled += 1
        _progress.advance(min(_progress.compiled / max(_progress.awaited, 1), 1.0))

    def define_pipelines(self) -> list[Any]:
        """Return the only pipeline."""
        steps = PassManager("linked code")
        for each in PASSES:
            steps.add_pass(each, each.__name__)
        steps.finalize()
        return [steps]
