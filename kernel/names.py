"""Names, numbers and brackets as C++ writes them."""

from typing import Any

import numpy as np

_CPP = (
    "alignas alignof asm auto bool case catch char class concept const constexpr const_cast decltype default"
    " delete do double dynamic_cast enum explicit export extern float friend goto inline int long mutable"
    " namespace new noexcept nullptr operator private protected public register requires short signed sizeof"
    " static static_assert struct switch template this throw typedef typeid typename union unsigned using"
    " virtual void volatile wchar_t xor"
)
_HEADER = (
    "at call_step copy_from_lane copy_to_lane exchange_at floor floor_divided fused get item lane larger len"
    " magnitude maximum minimum modulo nearest_even real select slice spread sqrt truth tuple_of vectors"
    " whole EXPORT INLINE JOINED LANES OF_VARIANT OUTLINE VARIANT"
)
_RESERVED = frozenset([*_CPP.split(), *_HEADER.split()])
"""Words of C++ and of the runtime header: a name of these gets an underscore."""


class UntranslatableError(Exception):
    """A construct that has no place in compiled code; the message has file, line and what to write."""


def namespace(module: str) -> str:
    """Return the namespace of a module: its name and that of its room."""
    return "_".join(module.split(".")[-2:])


def safe(name: str) -> str:
    """Return a name as C++ can have it."""
    # What ends with an underscore gets another one, so that no two names become the same.
    return f"{name}_" if name in _RESERVED or (name.endswith("_") and name != "_") else name


def literal(value: Any) -> str:
    """Return a number as C++ writes it."""
    if isinstance(value, bool | np.bool_):
        return "true" if value else "false"
    if isinstance(value, int | np.integer):
        return str(int(value)) if abs(int(value)) < 2**31 else f"INT64_C({int(value)})"
    if value != value:
        return '__builtin_nan("")'
    if value in (float("inf"), float("-inf")):
        return ("-" if value < 0 else "") + "__builtin_inf()"
    return repr(float(value))


def constant_text(name: str, value: Any, place: str) -> str:
    """Return the definition of a number or of a table of numbers. Raises UntranslatableError."""
    members = value if isinstance(value, tuple) else (value,)
    if not members or not all(map(is_number, members)):
        raise UntranslatableError(
            f"{place}: `{name}` cannot be compiled; write a number or a tuple of numbers of 64 bits"
        )
    whole = all(isinstance(each, int | np.integer) for each in members)
    kind = "bool" if isinstance(value, bool) else "int64_t" if whole else "double"
    if isinstance(value, tuple):
        return f"constexpr {kind} {name}[] = {{{', '.join(map(literal, value))}}};"
    return f"constexpr {kind} {name} = {literal(value)};"


def is_number(value: Any) -> bool:
    """Whether a value is a number of 64 bits, as all numbers of C++ are here."""
    if isinstance(value, int | np.int64):
        return abs(int(value)) < 2**63
    return isinstance(value, float | np.bool_)


def bracketed(text: str) -> str:
    """Return an operand of a sign: `- -x` would be `--x`."""
    return f"({text})" if text.startswith(("-", "+")) else text


def bare(text: str) -> str:
    """Return an expression without the brackets around all of it."""
    return text[1:-1] if _is_enclosed(text) else text


def _is_enclosed(text: str) -> bool:
    """Whether one pair of brackets encloses a text."""
    if not (text.startswith("(") and text.endswith(")")):
        return False
    depth = 0
    for n, sign in enumerate(text):
        depth += (sign == "(") - (sign == ")")
        if depth == 0:
            return n == len(text) - 1
    return False
