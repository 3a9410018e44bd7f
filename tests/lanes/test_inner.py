"""Functions that only compiled code calls are part of its code, and nothing is made for other callers."""

from typing import Any

import numba

from uictest.core.lanes import compile_inner


def has_machine_code(function: Any) -> bool:
    """Whether a function that has been compiled once can be called by its address."""
    (compiled,) = function.overloads.values()
    name = compiled.fndesc.llvm_func_name
    return bool(compiled.library._codegen._engine.is_symbol_defined(name))


def test_a_function_inside_has_no_machine_code_of_its_own() -> None:
    def double(x: float) -> float:
        return 2.0 * x

    inner = compile_inner(double, forceinline=True)

    def quadruple(x: float) -> Any:
        return inner(inner(x))

    outer: Any = numba.njit(quadruple)
    assert outer(0.75) == 3.0
    assert has_machine_code(outer)
    assert not has_machine_code(inner)


def test_functions_inside_may_call_each_other() -> None:
    def larger(x: float, y: float) -> float:
        return x if x > y else y

    first = compile_inner(larger)

    def largest(x: float, y: float, z: float) -> Any:
        return first(first(x, y), z)

    second = compile_inner(largest)

    def spread(x: float, y: float, z: float) -> Any:
        return second(x, y, z) + second(-x, -y, -z)

    assert numba.njit(spread)(1.0, 4.5, -2.0) == 6.5
