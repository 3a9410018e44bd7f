"""Compiled functions as object files: a warm start needs what the compiler made, not the compiler.

To import numba, and have it find code in its own cache, takes longer than a dozen stops. Its code
generator alone loads a file in a tenth of that.
"""

import hashlib
from typing import Any


def processor() -> str:
    """Return a short name of this processor's kind; object files are made for one of them."""
    from llvmlite import binding

    kind = f"{binding.get_host_cpu_name()} {binding.get_host_cpu_features().flatten()}"
    return hashlib.sha256(kind.encode()).hexdigest()[:12]


def object_file(callback: Any, name: str) -> bytes:
    """Return a callback of numba as an object file that defines ``name`` and needs nothing from outside."""
    from llvmlite import binding

    module = binding.parse_assembly(callback.inspect_llvm())
    module.get_function(callback.native_name).name = name
    for function in module.functions:
        if not function.is_declaration and function.name != name:
            function.linkage = "internal"
    machine = _machine()
    # What only calls from Python need would not be found where numba is not loaded.
    unused = binding.create_new_module_pass_manager()
    unused.add_global_dead_code_eliminate_pass()
    unused.run(module, binding.create_pass_builder(machine, binding.create_pipeline_tuning_options()))
    return bytes(machine.emit_object(module))


def load(code: bytes) -> Any:
    """Load an object file into this process; what is returned knows its addresses and keeps it there."""
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
