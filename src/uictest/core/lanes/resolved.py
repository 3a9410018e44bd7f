"""What operators and functions are for the types of their arguments, found once in a process.

Numba asks each of its definitions of an operator in turn, among them numpy's for arrays, wherever the
operator is used.
"""

import operator
from collections.abc import Callable
from functools import cache
from typing import Any

from uictest.core.lanes.compiler import Emission, EmittedFunction, local_variable


class Resolved:
    """The types that a compiler knows, and what it has found for them."""

    def __init__(self, context: Any) -> None:
        self._context = context
        self._found: dict[Any, Any] = {}

    @classmethod
    @cache
    def of(cls, context: Any) -> "Resolved":
        """Return the one for a compiler."""
        return cls(context)

    def __getattr__(self, name: str) -> Any:
        return getattr(self._context, name)

    def refresh(self) -> None:
        """Look for no new definitions: there are none while functions are compiled."""

    def resolve_function_type(self, function: Any, args: Any, kws: Any) -> Any:
        """Return the signature of a function or operator for arguments; None where it has none."""
        asked = function, tuple(args), tuple(sorted(kws.items()))
        return self._once(asked, lambda: self._context.resolve_function_type(function, args, kws))

    def resolve_getattr(self, kind: Any, name: str) -> Any:
        """Return the type of an attribute; None where there is none."""
        return self._once((kind, name), lambda: self._context.resolve_getattr(kind, name))

    def _once(self, asked: Any, find: Callable[[], Any]) -> Any:
        """Return what was found; nothing that was not is remembered, since more may be defined meanwhile."""
        if self._found.get(asked) is None:
            self._found[asked] = find()
        return self._found[asked]


class _Function(EmittedFunction):  # type: ignore[misc]
    """Code of a function, whose operators are those that were found for its types.

    It counts no references and describes nothing to a debugger.
    """

    def emit_environment_object(self) -> None:
        """Make no place for objects that errors would be raised with."""

    def pre_block(self, block: Any) -> None:
        """Begin a block; none is part of a try."""

    def storevar(self, value: Any, name: str, argidx: Any = None) -> None:
        """Keep the value of a variable, on the stack where other blocks use it."""
        if name in self._singly_assigned_vars:
            self._blk_local_varmap[name] = value
        else:
            self.builder.store(value, self.getvar(name))

    def alloca_lltype(self, name: str, kind: Any, datamodel: Any = None) -> Any:
        """Make a place for a variable."""
        return local_variable(self.builder, kind, name=name)

    def lower_binop(self, resty: Any, expr: Any, op: Any) -> Any:
        """Emit an operator; numba looks for code for constants first, and has some for powers only."""
        if op in (operator.pow, operator.ipow):
            return super().lower_binop(resty, expr, op)
        found = self.fndesc.calltypes[expr]
        operands = [
            self.context.cast(self.builder, self.loadvar(each.name), self.typeof(each.name), kind)
            for each, kind in zip((expr.lhs, expr.rhs), found.args, strict=True)
        ]
        typing = self.context.typing_context
        function = typing.resolve_value_type(op)
        signature = Resolved.of(typing).resolve_function_type(function, found.args, {})
        value = self.context.get_function(function, signature)(self.builder, operands)
        return self.context.cast(self.builder, value, found.return_type, resty)


class ResolvedEmission(Emission):  # type: ignore[misc]
    """The step that emits code of operators and functions that were found before."""

    lowering_class = _Function
