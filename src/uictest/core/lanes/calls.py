"""How compiled functions call each other: values go in, a value comes out.

Numba's own functions return a status, which each caller tests, and leave their result in memory. Here no
function has an error to return: what would raise one in Python ends the process.
"""

from copy import copy
from functools import cache
from types import SimpleNamespace
from typing import Any

from llvmlite import ir

from uictest.core.lanes.compiler import CallConvention, Target, none

_OWN = "direct."
"""How names of functions begin that are called so."""
_SUCCESS = SimpleNamespace(is_error=ir.Constant(ir.IntType(1), False))


class _DirectCalls(CallConvention):  # type: ignore[misc]
    """The convention within a function; numba's own functions are called as ever."""

    def get_function_type(self, result: Any, arguments: Any) -> Any:
        """Return the type of a function, which returns nothing for None."""
        returned = self.context.data_model_manager[result].get_return_type()
        taken = [self.context.get_value_type(each) for each in arguments]
        return ir.FunctionType(ir.VoidType() if result == none else returned, taken)

    def decorate_function(self, *arguments: Any, **options: Any) -> None:
        """Leave a function as it is declared."""

    def decode_arguments(self, builder: Any, kinds: Any, function: Any) -> Any:
        """Return the arguments of a function."""
        return function.args

    def return_value(self, builder: Any, value: Any) -> None:
        """Emit a return."""
        if isinstance(builder.function.function_type.return_type, ir.VoidType):
            builder.ret_void()
        else:
            builder.ret(value)

    def call_function(self, builder: Any, callee: Any, result: Any, *arguments: Any) -> Any:
        """Emit a call and return its status and its value."""
        if not callee.name.startswith(_OWN):
            return super().call_function(builder, callee, result, *arguments)
        return _SUCCESS, self.call(builder, callee, result, arguments[1])

    def call(self, builder: Any, function: Any, result: Any, arguments: Any) -> Any:
        """Emit a direct call and return its value."""
        value = builder.call(function, arguments)
        if result == none:
            return self.context.get_dummy_value()
        return self.context.get_returned_value(builder, result, value)

    def _end_process(self, builder: Any, *arguments: Any, **options: Any) -> None:
        """Emit what takes the place of an error."""
        builder.call(builder.module.declare_intrinsic("llvm.trap", (), _TRAP), ())
        builder.unreachable()

    return_user_exc = return_dynamic_user_exc = return_exc = return_status_propagate = _end_process

    def _refuse(self, *arguments: Any, **options: Any) -> None:
        raise NotImplementedError("linked code has no try, no generators, no results that may be None")

    return_optional_value = return_stop_iteration = set_try_status = _refuse


_TRAP = ir.FunctionType(ir.VoidType(), ())


class DirectTarget(Target):  # type: ignore[misc]
    """What numba emits code for, where functions call each other directly."""

    @classmethod
    @cache
    def of(cls, numbas: Any) -> Any:
        """Return the one that has all definitions of numba's."""
        target = copy(numbas)
        target.__class__ = cls
        target.cached_internal_func = {}  # those of numba's are called otherwise
        target.numbas = numbas
        return target

    call_conv = property(_DirectCalls)

    def refresh(self) -> None:
        """Take up what was added to registries since; the types have looked for new registries."""
        for each in tuple(self._registries):
            self.install_registry(each)

    def mangler(self, name: str, kinds: Any, *, abi_tags: Any = (), uid: Any = None) -> str:
        """Return the name of a function, which its number makes unique."""
        return f"{_OWN}{uid}.{name}"

    def declare_function(self, module: Any, described: Any) -> Any:
        """Declare a function that is called in its own way."""
        if described.mangled_name.startswith(_OWN):
            return super().declare_function(module, described)
        return self.numbas.declare_function(module, described)

    def insert_user_function(self, key: Any, described: Any, libraries: Any = ()) -> None:
        """Let all code, that of numba's own functions, too, call a function directly."""

        def call(context: Any, builder: Any, signature: Any, arguments: Any) -> Any:
            function = self.declare_function(builder.module, described)
            return self.call_conv.call(builder, function, described.restype, arguments)

        definition: Any = call
        definition.signature, definition.libs = described.argtypes, tuple(libraries)
        self._defns[key].append(definition, described.argtypes)

    def get_executable(self, library: Any, described: Any, environment: Any) -> Any:
        """Return what stands for a function where Python would call it: any built-in one, uncalled."""
        return [].index

    def post_lowering(self, module: Any, library: Any) -> None:
        """Link nothing else."""
