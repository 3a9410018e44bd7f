"""Frozen dataclasses, made in a quarter of the time that :func:`dataclasses.dataclass` takes.

That compiles six methods for each class. A command makes up to a hundred classes, most of whose methods it
never calls; here only ``__init__`` is compiled, and the other methods are closures over the names of fields.
"""

from __future__ import annotations

import dataclasses
import sys
from collections.abc import Callable
from dataclasses import MISSING, Field, FrozenInstanceError, fields
from operator import attrgetter
from typing import TYPE_CHECKING, Any, Literal, TypeVar

_Class = TypeVar("_Class", bound=type)

if TYPE_CHECKING:
    from dataclasses import dataclass as dataclass
else:

    def dataclass(
        *, frozen: Literal[True], slots: bool = False, eq: bool = True, kw_only: bool = False
    ) -> Callable[[_Class], _Class]:
        """Return the decorator that :func:`dataclasses.dataclass` returns for these options."""

        def decorate(declared: _Class) -> _Class:
            made = dataclasses.dataclass(init=False, repr=False, eq=False, slots=slots, kw_only=kw_only)(
                declared
            )
            names = tuple(each.name for each in fields(made))
            methods = {"__init__": _compiled_init(made), "__repr__": _repr_of(fields(made))}
            if eq:
                methods |= _comparison([each.name for each in fields(made) if each.compare])
            if slots:
                methods |= _state(names)
            own = vars(made)
            for name, method in (*methods.items(), *_protection(made, names).items()):
                if own.get(name) is None:
                    method.__name__ = name
                    method.__qualname__ = f"{made.__qualname__}.{name}"
                    setattr(made, name, method)
            return made

        return decorate


def _compiled_init(made: Any) -> Any:
    """Return ``__init__`` of a dataclass, with the signature that the standard library's has."""
    own = [each for each in fields(made) if each.init]
    given = {f"_default_{each.name}": _default(each) for each in own if _has_default(each)}
    plain = [_parameter(each) for each in own if not each.kw_only]
    named = [_parameter(each) for each in own if each.kw_only]
    signature = ", ".join(["self", *plain, *(["*", *named] if named else [])])
    lines = [f"_set(self, {each.name!r}, {_value(each)})" for each in own] or ["pass"]
    lines += ["self.__post_init__()"] if hasattr(made, "__post_init__") else []
    body = "\n  ".join(lines)
    source = f"def make(_set, {', '.join(given)}):\n def __init__({signature}):\n  {body}\n return __init__"
    namespace: dict[str, Any] = {}
    # In the namespace of the class's module, where what reads annotations looks for their names.
    exec(source, vars(sys.modules[made.__module__]), namespace)
    init = namespace["make"](object.__setattr__, **given)
    init.__annotations__ = {each.name: each.type for each in own} | {"return": None}
    return init


def _has_default(field: Field[Any]) -> bool:
    return field.default is not MISSING or field.default_factory is not MISSING


class _Made:
    """Stands for a value that a factory makes for each object."""

    def __init__(self, factory: Callable[[], Any]) -> None:
        self.factory = factory

    def __repr__(self) -> str:
        return "<factory>"


def _default(field: Field[Any]) -> Any:
    return field.default if field.default_factory is MISSING else _Made(field.default_factory)


def _parameter(field: Field[Any]) -> str:
    return f"{field.name}=_default_{field.name}" if _has_default(field) else field.name


def _value(field: Field[Any]) -> str:
    if field.default_factory is MISSING:
        return field.name
    default = f"_default_{field.name}"
    return f"{default}.factory() if {field.name} is {default} else {field.name}"


def _repr_of(own: tuple[Field[Any], ...]) -> Any:
    names = [each.name for each in own if each.repr]

    def shown_as(self: Any) -> str:
        return f"{type(self).__qualname__}({', '.join(f'{name}={getattr(self, name)!r}' for name in names)})"

    return shown_as


def _values_of(names: list[str]) -> Callable[[Any], tuple[Any, ...]]:
    """Return what gives the values of fields; always as a tuple, in which NaN is itself."""
    if len(names) > 1:
        return attrgetter(*names)
    return lambda of: tuple(getattr(of, name) for name in names)


def _comparison(names: list[str]) -> dict[str, Any]:
    values = _values_of(names)

    def equals(self: Any, other: object) -> Any:
        if type(other) is not type(self):
            return NotImplemented
        return values(self) == values(other)

    def hashed(self: Any) -> int:
        return hash(values(self))

    return {"__eq__": equals, "__hash__": hashed}


def _protection(made: Any, names: tuple[str, ...]) -> dict[str, Any]:
    def set_attribute(self: Any, name: str, value: object) -> None:
        if type(self) is made or name in names:
            raise FrozenInstanceError(f"cannot assign to field {name!r}")
        super(made, self).__setattr__(name, value)

    def delete_attribute(self: Any, name: str) -> None:
        if type(self) is made or name in names:
            raise FrozenInstanceError(f"cannot delete field {name!r}")
        super(made, self).__delattr__(name)

    return {"__setattr__": set_attribute, "__delattr__": delete_attribute}


def _state(names: tuple[str, ...]) -> dict[str, Any]:
    """Return how an object without a dictionary is pickled, past its protection."""

    def state_of(self: Any) -> list[Any]:
        return [getattr(self, name) for name in names]

    def take_state(self: Any, state: list[Any]) -> None:
        for name, value in zip(names, state, strict=True):
            object.__setattr__(self, name, value)

    return {"__getstate__": state_of, "__setstate__": take_state}
