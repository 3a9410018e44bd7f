"""The rig on a GPU: the same stop, one thread per case.

The functions that step the rig in plain Python and on the processor are translated once more, for CUDA
(extra ``cuda``). Importing this module needs numba-cuda, calling :func:`run_on_gpu` a GPU.
"""

from collections.abc import Iterator, Sequence
from contextlib import contextmanager
from functools import cache, partial
from typing import Any

import numba.cuda
import numpy as np
from numpy.typing import NDArray

from uictest.controllers import Controller
from uictest.measures import STOP_MEASURES, WHEELSET_MEASURES
from uictest.physics import fma
from uictest.rig.backends.batch import BatchMeasures, cases_by_controller
from uictest.rig.backends.compiled import Function, translate, with_controller
from uictest.rig.model.rail_memory import RAIL_MEMORY
from uictest.rig.model.state import BOGIE, CAR, WHEELSET
from uictest.rig.model.stop import run_stop
from uictest.rig.model.trace import TRAIN_SAMPLE, WHEELSET_SAMPLE, Trace

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
    return {} if cuda.config.ENABLE_CUDASIM else {fma: fused}


@cache
def kernel(controller: Controller) -> Any:
    """Return the kernel that runs the stop of one case in each thread, for cases with one controller."""
    device = cuda.jit(device=True)
    run_on_device = translate(run_stop, device, with_controller(controller, device, _operations()))

    def run_stops(
        parameters: Any,
        wheelset_parameters: Any,
        rail: Any,
        memories: Any,
        measures: Any,
        wheelset_measures: Any,
        zeroed_car: Any,
        zeroed_bogies: Any,
        zeroed_wheelsets: Any,
        no_train: Any,
        no_wheelsets: Any,
    ) -> None:
        i = cuda.grid(1)
        if i < parameters.shape[0]:
            # States live in the thread's own memory, which holds whatever was there before.
            car = cuda.local.array(1, CAR)
            bogies = cuda.local.array(2, BOGIE)
            wheelsets = cuda.local.array(4, WHEELSET)
            car[0] = zeroed_car[0]
            for j in range(2):
                bogies[j] = zeroed_bogies[j]
            for j in range(4):
                wheelsets[j] = zeroed_wheelsets[j]
            run_on_device(
                car[0],
                bogies,
                wheelsets,
                parameters[i],
                wheelset_parameters[i],
                rail[i],
                # A single memory where no case writes one: it is large beside the state of a stop.
                memories[min(i, memories.shape[0] - 1)],
                measures[i],
                wheelset_measures[i],
                Trace(no_train, no_wheelsets),
                NO_TRACE,
            )

    return cuda.jit(run_stops)


def constant_arguments() -> tuple[NDArray[Any], ...]:
    """Return the last arguments of a kernel: a rig of zeros, with which a stop begins, and an empty trace."""
    rig = np.zeros(1, CAR), np.zeros(2, BOGIE), np.zeros(4, WHEELSET)
    return *rig, np.zeros(1, TRAIN_SAMPLE), np.zeros((1, 1), WHEELSET_SAMPLE)


def run_on_gpu(
    parameters: Any, wheelset_parameters: Any, rail: NDArray[np.float64], controllers: Sequence[Controller]
) -> BatchMeasures:
    """Simulate many stops on the GPU.

    Args:
        parameters: records of :data:`~uictest.rig.model.parameters.PARAMETERS`, shape (n,).
        wheelset_parameters: records of
            :data:`~uictest.rig.model.wheelset_parameters.WHEELSET_PARAMETERS`, shape (n, 4).
        rail: friction of the cases' rails, the rows of :mod:`~uictest.rig.model.friction_law`, shape
            (n, 4, points).
        controllers: the controller of each case.

    Raises:
        numba.cuda.CudaSupportError: when there is no GPU or no driver for it.
    """
    count = len(parameters)
    batch = BatchMeasures(np.zeros(count, STOP_MEASURES), np.zeros((count, 4), WHEELSET_MEASURES))
    for controller, cases in cases_by_controller(controllers):
        measures, wheelset_measures = _run(
            controller, parameters[cases], wheelset_parameters[cases], rail[cases]
        )
        batch.measures[cases] = measures
        batch.wheelset_measures[cases] = wheelset_measures
    return batch


def _run(
    controller: Controller, parameters: Any, wheelset_parameters: Any, rail: NDArray[np.float64]
) -> tuple[Any, Any]:
    """Return the measures of cases with the same controller."""
    count = len(parameters)
    measures = cuda.device_array(count, STOP_MEASURES)
    wheelset_measures = cuda.device_array((count, 4), WHEELSET_MEASURES)
    memories = cuda.device_array(count if parameters["cleans_rail"].any() else 1, RAIL_MEMORY)
    blocks = -(-count // THREADS_PER_BLOCK)
    with without_contraction():
        kernel(controller)[blocks, THREADS_PER_BLOCK](
            cuda.to_device(parameters),
            cuda.to_device(wheelset_parameters),
            cuda.to_device(rail),
            memories,
            measures,
            wheelset_measures,
            *(cuda.to_device(array) for array in constant_arguments()),
        )
    return measures.copy_to_host(), wheelset_measures.copy_to_host()


@contextmanager
def without_contraction() -> Iterator[None]:
    """Compile without fusing separate operations, so that a GPU rounds as a processor does.

    numba-cuda has no option for it, but passes its options to the compiler in one function, replaced here.
    """
    from numba.cuda.cudadrv import nvvm

    contracting = nvvm.compile_ir
    nvvm.compile_ir = partial(contracting, fma=False)
    try:
        yield
    finally:
        nvvm.compile_ir = contracting
