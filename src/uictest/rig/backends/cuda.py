"""The rig on a GPU: the same stop, one thread per case.

The functions that step the rig in plain Python and on the processor are translated once more, for CUDA
(extra ``cuda``). Importing this module needs numba-cuda, calling :func:`run_on_gpu` a GPU.
"""

from collections.abc import Iterator
from contextlib import contextmanager
from functools import partial
from typing import Any

import numba.cuda
import numpy as np
from numpy.typing import NDArray

from uictest.measures import STOP_MEASURES, WHEELSET_MEASURES
from uictest.physics import arithmetic
from uictest.rig.backends.compiled import Function, translate
from uictest.rig.model.records import BOGIE, CAR, WHEELSET
from uictest.rig.model.stop import run_stop

THREADS_PER_BLOCK = 128
"""Threads of a block: few, since each stop fills the registers of a thread."""
NO_TRACE = 0

cuda: Any = numba.cuda


@cuda.jit(device=True)  # type: ignore[untyped-decorator]
def fused(a: float, b: float, c: float) -> Any:
    """Return :func:`uictest.physics.arithmetic.fma` in one instruction."""
    return cuda.fma(a, b, c)


def _operations() -> dict[Function, Any]:
    """Return what takes the place of plain functions; numba's simulator rounds its own ``fma`` twice."""
    return {} if cuda.config.ENABLE_CUDASIM else {arithmetic.fma: fused}


device_stop = translate(run_stop, cuda.jit(device=True), _operations())


@cuda.jit  # type: ignore[untyped-decorator]
def kernel(parameters: Any, rail: Any, measures: Any, wheelset_measures: Any, trace: Any) -> None:
    """Run the stop of one case in each thread; states live in the thread's own memory."""
    i = cuda.grid(1)
    if i < parameters.shape[0]:
        car = cuda.local.array(1, CAR)
        bogies = cuda.local.array(2, BOGIE)
        wheelsets = cuda.local.array(4, WHEELSET)
        device_stop(
            car[0],
            bogies,
            wheelsets,
            parameters[i],
            rail[i],
            measures[i],
            wheelset_measures[i],
            trace,
            NO_TRACE,
        )


def run_on_gpu(parameters: Any, rail: NDArray[np.float64]) -> tuple[Any, Any]:
    """Simulate many stops on the GPU.

    Args:
        parameters: records of :data:`~uictest.rig.model.records.PARAMETERS`, shape (n,).
        rail: friction laws, shape (n, 4, points), as :func:`uictest.rig.assembly.assemble` gives them.

    Returns:
        Records of :data:`~uictest.measures.STOP_MEASURES`, shape (n,), and of
        :data:`~uictest.measures.WHEELSET_MEASURES`, shape (n, 4).

    Raises:
        numba.cuda.CudaSupportError: when there is no GPU or no driver for it.
    """
    count = len(parameters)
    measures = cuda.device_array(count, STOP_MEASURES)
    wheelset_measures = cuda.device_array((count, 4), WHEELSET_MEASURES)
    blocks = -(-count // THREADS_PER_BLOCK)
    with without_contraction():
        kernel[blocks, THREADS_PER_BLOCK](
            cuda.to_device(parameters),
            cuda.to_device(rail),
            measures,
            wheelset_measures,
            cuda.device_array((1, 1), np.float64),
        )
    return measures.copy_to_host(), wheelset_measures.copy_to_host()


@contextmanager
def without_contraction() -> Iterator[None]:
    """Compile without fusing what is written apart, so that a GPU rounds as a processor does.

    numba-cuda hands its options to the compiler in one place and has no option of its own for this one.
    """
    from numba.cuda.cudadrv import nvvm

    contracting = nvvm.compile_ir
    nvvm.compile_ir = partial(contracting, fma=False)
    try:
        yield
    finally:
        nvvm.compile_ir = contracting
