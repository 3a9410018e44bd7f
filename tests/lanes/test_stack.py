"""Registers that are put aside lie on whole cache lines."""

import numba

from uictest.core.lanes import align_stack

njit = numba.njit


def test_an_aligned_variable_outlives_the_optimiser():
    """With it the compiler aligns the whole stack of the function, without it only as calls need it."""

    @njit
    def aligned(x):
        align_stack()
        return 2.0 * x

    assert aligned(2.0) == 4.0
    (optimised,) = aligned.inspect_llvm().values()
    assert "alloca <8 x double>, align 64" in optimised
