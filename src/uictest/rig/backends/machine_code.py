"""Compiled functions as object files: a warm start loads them without the compiler.

Importing numba and finding code in its own cache takes longer than a dozen stops. Its code generator alone
loads an object file in a tenth of that time.
"""

import ctypes
from collections.abc import Callable
from functools import cache
from threading import Lock
from typing import Any, NamedTuple

import numpy as np

from uictest import user_cache
from uictest.rig.backends.compiled import compiler_inputs


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


_compiling = Lock()
_loaded: dict[str, tuple[Any, Callable[..., int]]] = {}
"""Functions by their name, and what keeps their code in this process."""


def native_function(name: str, callback: Callable[[], Any], arguments: int) -> Callable[..., int]:
    """Return a function in machine code, from the cache, or compiled and kept there.

    Args:
        name: of the function and of its file.
        callback: returns the function compiled (see `compiled.callback`) within seconds.
        arguments: how many it has, addresses and whole numbers.
    """
    with _compiling:
        if name not in _loaded:
            engine = load_object_file(_object_code(name, callback, host()))
            prototype = ctypes.CFUNCTYPE(ctypes.c_int64, *[ctypes.c_int64] * arguments)
            _loaded[name] = engine, prototype(engine.get_function_address(name))
    return _loaded[name][1]


def object_code(name: str, callback: Callable[[], Any], target: Target) -> bytes:
    """Return a function as an object file for a target, from the cache, or compiled and kept there."""
    with _compiling:
        return _object_code(name, callback, target)


def is_kept(name: str, target: Target | None = None) -> bool:
    """Return whether a function is in the cache, so that it can be called or linked without compiling.

    Args:
        name: of the function.
        target: what it is generated for [default: this process].
    """
    return _kept(name, target or host()) is not None


@cache
def host() -> Target:
    """Return the processor of this process."""
    from llvmlite import binding

    return Target(binding.get_host_cpu_name(), binding.get_host_cpu_features().flatten())


def address(values: Any, layout: Any, shape: tuple[int, ...] = ()) -> int:
    """Return the address of a record or an array. Machine code does not check the layout behind it.

    Raises TypeError for another layout or shape.
    """
    if values.dtype != layout or values.shape != shape or not values.flags.c_contiguous:
        raise TypeError(
            f"expected {shape} contiguous {np.dtype(layout)}, found {values.shape} {values.dtype}"
        )
    if isinstance(values, np.ndarray):
        return int(values.ctypes.data)
    # A single record has no other way to tell; it lists all its fields first, some tenths of a millisecond.
    return int(values.__array_interface__["data"][0])


def _object_code(name: str, callback: Callable[[], Any], target: Target) -> bytes:
    kept = _kept(name, target)
    if kept is not None:
        return kept
    with user_cache.turn(name, _inputs(target)):  # another process may have compiled it meanwhile
        return _kept(name, target) or _compiled(name, callback, target)


def _compiled(name: str, callback: Callable[[], Any], target: Target) -> bytes:
    code = object_file(callback(), name, target)
    user_cache.write(name, _inputs(target), code)
    return code


def _kept(name: str, target: Target) -> bytes | None:
    return user_cache.read(name, _inputs(target))


@cache
def _inputs(target: Target) -> bytes:
    return repr(tuple(target)).encode() + compiler_inputs()


def object_file(callback: Any, name: str, target: Target) -> bytes:
    """Return a callback of numba as an object file that defines ``name`` and needs nothing from outside."""
    from llvmlite import binding

    module = binding.parse_assembly(callback.inspect_llvm())
    entry = module.get_function(callback.native_name)
    entry.name = name
    if target.in_library:
        entry.visibility = "hidden"
    for function in module.functions:
        if not function.is_declaration and function.name != name:
            function.linkage = "internal"
    for variable in module.global_variables:
        if not variable.is_declaration:
            variable.linkage = "internal"
    machine = _machine(target)
    # Code for calls from Python refers to symbols that are there only where numba is loaded.
    unused = binding.create_new_module_pass_manager()
    unused.add_global_dead_code_eliminate_pass()
    unused.run(module, binding.create_pass_builder(machine, binding.create_pipeline_tuning_options()))
    return bytes(machine.emit_object(module))


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
