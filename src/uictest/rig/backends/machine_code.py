"""Compiled functions as object files: a warm start loads them without the compiler.

Importing numba and finding code in its own cache takes longer than a dozen stops. Its code generator alone
loads an object file in a tenth of that time.

Code is kept in two forms: the bitcode of a unit, which numba takes some six seconds to make and which is
the same for every processor of a kind, and an object file for one processor and one entry of the unit, which
is made from that in three or more.
"""

import ctypes
import logging
from collections.abc import Callable, Collection, Iterator, Sequence
from contextlib import contextmanager
from functools import cache
from threading import Lock
from typing import Any, Final, NamedTuple

from uictest.core import lanes, user_cache
from uictest.core.lanes import Arguments, leaves, lengths, passed
from uictest.rig.backends.compiled import compiler_inputs


class Entry(NamedTuple):
    """A function in machine code.

    Attributes:
        name: of the function.
        title: what people are told is compiled.
        arguments: what it takes.
        beside: small functions that are in its object file, too, for this process.
    """

    name: str
    title: str
    arguments: Arguments
    beside: tuple[str, ...] = ()


class Unit(NamedTuple):
    """Functions that are compiled together, since they call the same functions.

    Attributes:
        name: of its file in the cache.
        entries: those that are called from outside.
        functions: returns them in that order, of :func:`~uictest.core.lanes.compile_inner`; loads the
            compiler.
    """

    name: str
    entries: tuple[Entry, ...]
    functions: Callable[[], Sequence[Any]]


class Target(NamedTuple):
    """What code is generated for.

    Attributes:
        processor: its name for LLVM.
        features: instructions beyond those of that name, as LLVM writes them.
        in_library: whether the code is linked into a shared library, not loaded into this process.
    """

    processor: str
    features: str = ""
    in_library: bool = False


Watcher = Callable[[str, float], None]
"""Is told what is compiled and the share of the work that is done: 0 when it begins, 1 when it has ended."""

_BITCODE_SHARE: Final = 0.65
"""Share of the work that ends with the bitcode: measured, 8 of 11 s of single stops, 9 of 15 s of lanes."""
_INSTRUCTIONS: Final = ("sqrt",)
"""Functions of C that are one instruction: they are declared, but not called."""
_compiling = Lock()
_loaded: dict[str, tuple[Any, Callable[..., int]]] = {}
"""Functions by their name, and what keeps their code in this process."""


def _log(title: str, done: float) -> None:
    if done == 0.0:
        logging.getLogger(__name__).warning("uictest: compiling %s, once per installation", title)


_watcher: Watcher = _log


@contextmanager
def compilation_watched(watcher: Watcher) -> Iterator[None]:
    """Let a function be told how compilations go on meanwhile, instead of a line in the log for each."""
    global _watcher
    before, _watcher = _watcher, watcher
    try:
        yield
    finally:
        _watcher = before


def native_function(unit: Unit, entry: Entry) -> Callable[..., int]:
    """Return a function in machine code, from the cache, or compiled and kept there.

    It is called with what its arguments describe: arrays, records, named tuples of them, whole numbers. It
    releases the interpreter's lock while it runs, and raises TypeError where an array or a record does not
    have the compiled layout or shape.
    """
    return _of_values(entry, function_of_addresses(unit, entry))


def function_of_addresses(unit: Unit, entry: Entry) -> Callable[..., int]:
    """Return the same function, to be called with what :func:`~uictest.core.lanes.passed` returns."""
    with _compiling:
        if entry.name not in _loaded:
            engine = load_object_file(_object_code(unit, entry, host()))
            _loaded[entry.name] = engine, _function(engine, entry)
    return _loaded[entry.name][1]


def loaded_beside(entry: Entry, other: Entry) -> Callable[..., int] | None:
    """Return a function that is in the object file of another; None unless that was loaded."""
    if entry.name not in _loaded:
        return None
    return _of_values(other, _function(_loaded[entry.name][0], other))


def _of_values(entry: Entry, function: Callable[..., int]) -> Callable[..., int]:
    return lambda *values: function(*passed(entry.arguments, values))


def _function(engine: Any, entry: Entry) -> Callable[..., int]:
    count = len(lengths(entry.arguments)) + len(list(leaves(entry.arguments)))
    prototype = ctypes.CFUNCTYPE(ctypes.c_int64, *[ctypes.c_int64] * count)
    return prototype(engine.get_function_address(entry.name))


def object_code(unit: Unit, entry: Entry, target: Target) -> bytes:
    """Return a function as an object file for a target, from the cache, or compiled and kept there."""
    with _compiling:
        return _object_code(unit, entry, target)


def is_kept(entry: Entry) -> bool:
    """Return whether the cache holds a function for this process, so that it can be called at once."""
    return user_cache.read(entry.name, _inputs(host())) is not None


@cache
def host() -> Target:
    """Return the processor of this process."""
    from llvmlite import binding

    return Target(binding.get_host_cpu_name(), binding.get_host_cpu_features().flatten())


def _object_code(unit: Unit, entry: Entry, target: Target) -> bytes:
    def make() -> bytes:
        watcher, title = _watcher, entry.title
        watcher(title, 0.0)
        bitcode = _bitcode_of(unit, lambda done: watcher(title, _BITCODE_SHARE * done))
        code = object_file(bitcode, entry.name, target, () if target.in_library else entry.beside)
        watcher(title, 1.0)
        return code

    return _from_cache(entry.name, _inputs(target), make)


def _bitcode_of(unit: Unit, advance: Callable[[float], None] = lambda done: None) -> bytes:
    """Return the bitcode of a unit, from the cache, or compiled and kept there.

    Args:
        unit: the functions.
        advance: is told the share of the work that is done.
    """

    def make() -> bytes:
        pairs = zip(unit.entries, unit.functions(), strict=True)
        return lanes.bitcode({each.name: (function, each.arguments) for each, function in pairs}, advance)

    return _from_cache(unit.name, compiler_inputs(), make)


def _from_cache(kind: str, inputs: bytes, make: Callable[[], bytes]) -> bytes:
    kept = user_cache.read(kind, inputs)
    if kept is not None:
        return kept
    with user_cache.turn(kind, inputs):  # another process may have made it meanwhile
        kept = user_cache.read(kind, inputs)
        if kept is None:
            kept = make()
            user_cache.write(kind, inputs, kept)
    return kept


@cache
def _inputs(target: Target) -> bytes:
    return repr(tuple(target)).encode() + compiler_inputs()


def object_file(bitcode: bytes, entry: str, target: Target, beside: Collection[str] = ()) -> bytes:
    """Return one entry of a unit as an object file that needs nothing from outside.

    It defines its name and those of other entries that stand `beside` it.
    """
    from llvmlite import binding

    machine = _machine(target)
    module = binding.parse_bitcode(bitcode)
    for function in module.functions:
        if not function.is_declaration and function.name not in (entry, *beside):
            function.linkage = "internal"
    if target.in_library:
        module.get_function(entry).visibility = "hidden"
    tuning = binding.create_pipeline_tuning_options(speed_level=3)
    # Loops are over four wheelsets: unrolled they take a quarter longer to compile, and run no faster; nor do
    # they in vectors, and lanes are vectors already.
    tuning.loop_unrolling = tuning.loop_vectorization = tuning.slp_vectorization = False
    passes = binding.create_pass_builder(machine, tuning)
    # The unit's other entries are called by nothing now.
    others = binding.create_new_module_pass_manager()
    others.add_global_dead_code_eliminate_pass()
    others.run(module, passes)
    passes.getModulePassManager().run(module, passes)
    # What calls of functions that are inline now needed is left over.
    unused = binding.create_new_module_pass_manager()
    unused.add_ipsccp_pass()
    unused.add_simplify_cfg_pass()
    unused.add_global_dead_code_eliminate_pass()
    unused.run(module, passes)
    _reject_what_is_undefined(module, entry)
    return bytes(machine.emit_object(module))


def _reject_what_is_undefined(module: Any, entry: str) -> None:
    """Raise RuntimeError if code needs what stands nowhere: a process that loads it later would crash."""
    names = [each.name for each in (*module.functions, *module.global_variables) if each.is_declaration]
    undefined = sorted(name for name in names if name not in _INSTRUCTIONS and not name.startswith("llvm."))
    if undefined:
        raise RuntimeError(f"the code of {entry} needs what is not in it: {', '.join(undefined)}")


def load_object_file(code: bytes) -> Any:
    """Load an object file into this process and return what gives its addresses and keeps it loaded."""
    from llvmlite import binding

    engine = binding.create_mcjit_compiler(binding.parse_assembly(""), _machine(host()))
    engine.add_object_file(binding.ObjectFileRef.from_data(code))
    engine.finalize_object()
    return engine


def _machine(target: Target) -> Any:
    from llvmlite import binding

    binding.initialize_native_target()
    binding.initialize_native_asmprinter()
    return binding.Target.from_default_triple().create_target_machine(
        cpu=target.processor,
        features=target.features,
        opt=3,
        reloc="pic" if target.in_library else "default",
        codemodel="small" if target.in_library else "jitdefault",
        jit=not target.in_library,
    )
