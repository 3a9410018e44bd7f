"""The internals of numba that this room uses, under names that say what they are for.

They are annotated here, since numba's own annotations are incomplete.
"""

from collections.abc import Callable
from typing import Any

from numba import njit
from numba.core import callconv, cgutils, cpu, imputils, lowering, typed_passes, types, untyped_passes
from numba.core.codegen import CodeLibrary, JITCodeLibrary
from numba.core.compiler import Compiler
from numba.core.typing import templates
from numba.extending import intrinsic
from numba.np import arrayobj

CompiledDefinition = Callable[..., Any]
Decorator = Callable[[CompiledDefinition], CompiledDefinition]

compiled: Callable[..., Any] = njit
"""Compile a function when it is first called, for the types of its arguments."""
in_compiled_code: Decorator = intrinsic
"""Make a definition a function of compiled code; from the types of arguments it gives signature and code."""
typing_of: Callable[[Any], Callable[[type], type]] = templates.infer_global
"""Let a template find the signatures of a function or operator."""
code_of: Callable[..., Decorator] = imputils.lower_builtin
"""Let a definition emit the code of a function or operator for arguments of given types."""
code_of_reading: Callable[[type], Decorator] = imputils.lower_getattr_generic
"""Let a definition emit the code that reads an attribute of a type."""
code_of_writing: Callable[[type], Decorator] = imputils.lower_setattr_generic
"""Let a definition emit the code that writes an attribute of a type."""
code_of_conversion: Callable[[Any, Any], Decorator] = imputils.lower_cast
"""Let a definition emit the code that turns one type into another."""
signature: Callable[..., Any] = templates.signature
"""Signature of a function: type of the result, types of the arguments."""
member_of_record: Callable[..., Any] = cgutils.get_record_member
"""Address of a field of an ordinary record."""
emit_array: Callable[..., Any] = arrayobj.np_cfarray
"""Emit the code that makes an array of a pointer and a shape."""
local_variable: Callable[..., Any] = cgutils.alloca_once
"""Address of a variable on the stack of the function being compiled."""
Library: Any = JITCodeLibrary
"""Code of one compiled function and of all that is linked into it."""
empty_library: Any = CodeLibrary.__init__
"""Begin a library without any code."""
Pipeline: Any = Compiler
"""Steps from a Python function to its code."""
CallConvention: Any = callconv.CPUCallConv
"""How functions call each other."""
Target: Any = cpu.CPUContext
"""What code is emitted for, and the definitions by which it is."""
none: Any = types.none
"""Type of None."""
EmittedFunction: Any = lowering.Lower
"""Emits the code of one function."""
Emission: Any = typed_passes.NativeLowering
"""The step that emits code."""
_BEFORE_CODE: Any = (
    untyped_passes.TranslateByteCode,
    untyped_passes.FixupArgs,
    untyped_passes.IRProcessing,
    untyped_passes.ReconstructSSA,
    typed_passes.NopythonTypeInference,
    typed_passes.PreLowerStripPhis,
)
STEPS_BEFORE_CODE: Any = tuple(step() for step in _BEFORE_CODE)
"""The steps without which no function is compiled, in their order, up to that which emits code."""
_RESULT: Any = typed_passes.NoPythonBackend
LAST_STEP: Any = _RESULT()
"""The step that returns the result."""
