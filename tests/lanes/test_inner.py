"""Functions that only compiled code calls are part of its code, and nothing is made for other callers."""

import numba

from uictest.core.lanes import compile_inner


def has_machine_code(function):
    """Whether a function that has been compiled once can be called by its address."""
    (compiled,) = function.overloads.values()
    name = compiled.fndesc.llvm_func_name
    return bool(compiled.library._codegen._engine.is_symbol_defined(name))


def test_a_function_inside_has_no_machine_code_of_its_own():
    def double(x):
        return 2.0 * x

    inner = compile_inner(double, forceinline=True)

    def quadruple(x):
        return inner(inner(x))

    outer = numba.njit(quadruple)
    assert outer(0.75) == 3.0
    assert has_machine_code(outer)
    assert not has_machine_code(inner)


def test_functions_inside_may_call_each_other():
    def larger(x, y):
        return x if x > y else y

    first = compile_inner(larger)

    def largest(x, y, z):
        return first(first(x, y), z)

    second = compile_inner(largest)

    def spread(x, y, z):
        return second(x, y, z) + second(-x, -y, -z)

    assert numba.njit(spread)(1.0, 4.5, -2.0) == 6.5
