"""Compiled functions as object files: a warm start loads them without the compiler.

Importing numba and finding code in its own cache takes longer than a dozen stops. Its code generator alone
loads an object file in a tenth of that time.
"""

import ctypes
from collections.abc import Callable
from functools import cache
from threading import Lock
from typing import Any

import numpy as np

from uictest import user_cache
from uictest.rig.backends.compiled import compiler_inputs

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
            engine = load_object_file(_kept(name) or _compiled(name, callback))
            prototype = ctypes.CFUNCTYPE(ctypes.c_int64, *[ctypes.c_int64] * arguments)
            _loaded[name] = engine, prototype(engine.get_function_address(name))
    return _loaded[name][1]


def is_kept(name: str) -> bool:
    """Return whether a function is in the cache, so that it can be called without compiling."""
    return _kept(name) is not None


def address(values: Any, layout: Any, shape: tuple[int, ...] = ()) -> int:
    """Return the address of a record or an array. Machine code does not check the layout behind it.

    Raises TypeError for another layout or shape.
    """
    if values.dtype != layout or values.shape != shape or not values.flags.c_contiguous:
        raise TypeError(
            f"expected {shape} contiguous {np.dtype(layout)}, found {values.shape} {values.dtype}"
        )
    return int(values.__array_interface__["data"][0])


def _compiled(name: str, callback: Callable[[], Any]) -> bytes:
    code = object_file(callback(), name)
    user_cache.write(name, _inputs(), code)
    return code


def _kept(name: str) -> bytes | None:
    return user_cache.read(name, _inputs())


@cache
def _inputs() -> bytes:
    from llvmlite import binding

    processor = f"{binding.get_host_cpu_name()} {binding.get_host_cpu_features().flatten()}"
    return processor.encode() + compiler_inputs()


def object_file(callback: Any, name: str) -> bytes:
    """Return a callback of numba as an object file that defines ``name`` and needs nothing from outside."""
    from llvmlite import binding

    module = binding.parse_assembly(callback.inspect_llvm())
    module.get_function(callback.native_name).name = name
    for function in module.functions:
        if not function.is_declaration and function.name != name:
            function.linkage = "internal"
    machine = _machine()
    # Code for calls from Python refers to symbols that are there only where numba is loaded.
    unused = binding.create_new_module_pass_manager()
    unused.add_global_dead_code_eliminate_pass()
    unused.run(module, binding.create_pass_builder(machine, binding.create_pipeline_tuning_options()))
    return bytes(machine.emit_object(module))


def load_object_file(code: bytes) -> Any:
    """Load an object file into this process and return what gives its addresses and keeps it loaded."""
    from llvmlite import binding

    engine = binding.create_mcjit_compiler(binding.parse_assembly(""), _machine())
    engine.add_object_file(binding.ObjectFileRef.from_data(code))
    engine.finalize_object()
    return engine


def _machine() -> Any:
    from llvmlite import binding

    binding.initialize_native_target()
    binding.initialize_native_asmprinter()
    return binding.Target.from_default_triple().create_target_machine(
        cpu=binding.get_host_cpu_name(),
        features=binding.get_host_cpu_features().flatten(),
        opt=3,
        codemodel="jitdefault",
        jit=True,
    )
