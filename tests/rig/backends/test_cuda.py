"""The rig for GPUs without a GPU: the same stop in the simulator, and compiled to PTX without contraction."""

import importlib.util
import json
import subprocess
import sys
from pathlib import Path
from typing import Any

import pytest

pytestmark = pytest.mark.skipif(
    importlib.util.find_spec("numba_cuda") is None,
    reason='numba-cuda is not installed; pip install "uictest[cuda]"',
)
SLIDE = Path(__file__).parents[3] / "scenarios" / "slide-80.yaml"

SIMULATED = """
import json, os, sys
os.environ["NUMBA_ENABLE_CUDASIM"] = "1"
from pathlib import Path
import numpy as np
from uictest.measures import STOP_MEASURES, WHEELSET_MEASURES
from uictest.rig.assembly import assemble
from uictest.rig.backends import cuda
from uictest.rig.backends.finished_stop import run_to_end
from uictest.rig.backends.plain import plain_stop
from uictest.rig.model.rail_memory import RAIL_MEMORY
from uictest.rig.model.trace import TRAIN_SAMPLE, WHEELSET_SAMPLE
from uictest.scenario import load

case = load([Path(sys.argv[1])], sys.argv[2:])[0]
inputs = assemble(case)
parameters, wheelset_parameters, rail, controller, *_ = inputs
parameters["cycles"] = 2
measures, wheelsets = np.zeros(1, STOP_MEASURES), np.zeros((1, 4), WHEELSET_MEASURES)
batch = np.array([parameters], dtype=parameters.dtype)
with np.errstate(invalid="ignore"):
    memory = np.full(1, 9, RAIL_MEMORY)
    arguments = batch, wheelset_parameters[None], rail[None], memory, measures, wheelsets
    cuda.kernel(controller)[1, 1](*arguments, *cuda.constant_arguments())
    plain = run_to_end(plain_stop(controller), inputs)
same = measures[0].tobytes() == plain.measures.tobytes()
same_wheelsets = wheelsets[0].tobytes() == plain.wheelset_measures.tobytes()
print(json.dumps([same, same_wheelsets, float(measures["end_distance"][0])]))
"""

COMPILED = """
import json
from types import SimpleNamespace
import numba
from numba.cuda import compile_ptx, dispatcher
from uictest.measures import STOP_MEASURES, WHEELSET_MEASURES
from uictest.controllers import CONTROLLERS
from uictest.rig.backends import cuda
from uictest.rig.model.trace import TRAIN_SAMPLE, WHEELSET_SAMPLE
from uictest.rig.model.parameters import PARAMETERS
from uictest.rig.model.rail_memory import RAIL_MEMORY
from uictest.rig.model.state import BOGIE, CAR, WHEELSET
from uictest.rig.model.wheelset_parameters import WHEELSET_PARAMETERS

kernel = cuda.kernel(CONTROLLERS["threshold"])
# What a machine without a GPU cannot say of itself: the capability to compile for.
dispatcher.get_current_device = lambda: SimpleNamespace(compute_capability=(9, 0))
record = numba.from_dtype
signature = numba.void(
    record(PARAMETERS)[::1], record(WHEELSET_PARAMETERS)[:, ::1], numba.float64[:, :, ::1],
    record(RAIL_MEMORY)[::1], record(STOP_MEASURES)[::1],
    record(WHEELSET_MEASURES)[:, ::1],
    record(CAR)[::1], record(BOGIE)[::1], record(WHEELSET)[::1],
    record(TRAIN_SAMPLE)[::1], record(WHEELSET_SAMPLE)[:, ::1],
)

def twice(x):
    x[0] = x[1] * x[2] + x[3]
    x[4] = cuda.fused(x[1], x[2], x[3])

counts = []
with cuda.without_contraction():
    for function, kind in ((kernel.py_func, signature), (twice, numba.void(numba.float64[::1]))):
        ptx, _ = compile_ptx(function, kind, cc=(9, 0))
        counts.append([ptx.count(name) for name in (".entry", "fma.rn.f64", "mul.rn.f64", "mul.f64")])
print(json.dumps(counts))
"""


def printed(program: str, *arguments: str) -> list[Any]:
    """What a program prints, run in an interpreter of its own: the simulator is chosen at import."""
    done = subprocess.run(
        [sys.executable, "-c", program, *arguments], capture_output=True, text=True, check=False, timeout=300
    )
    assert done.returncode == 0, done.stderr
    values: list[Any] = json.loads(done.stdout.splitlines()[-1])
    return values


CLEANED = "rail.cleaning={energy: 1 J/m, recovered_friction: 0.28, reach: 1 mm, carry_over: 1}"
FAULTS = (
    "faults=[{at: 0 s, wheelset: 1, part: speed-sensor, kind: jumps, value: 20 km/h},"
    " {at: 0 s, part: brake-line, kind: leak, value: 2e-8 m3/(s Pa)},"
    " {at: 0 s, part: controller, kind: silent}, {at: 0 s, wheelset: 3, part: vent-magnet, kind: shorted}]"
)


@pytest.mark.parametrize(
    "overrides",
    [
        ["rig.compensation=full"],
        ["rig.compensation=thermal"],
        ["rig.compensation=full", "rig.sensors=pole-wheel", "vehicle.wheelsets.2.wheel_radius=0.42 m"],
        ["rig.compensation=none", CLEANED],
        ["brake.pad=disc-pad"],
        [FAULTS],
    ],
)
def test_the_kernel_gives_the_bits_of_plain_python(overrides: list[str]) -> None:
    """Whatever the memory of the rail held before, it is cleared where a rail is cleaned."""
    same, same_wheelsets, distance = printed(SIMULATED, str(SLIDE), *overrides)
    assert same
    assert same_wheelsets
    assert distance > 0.3


def test_the_kernel_fuses_what_is_written_as_fused_and_nothing_else() -> None:
    """The assembler of a GPU may fuse a plain ``mul``, but no ``mul.rn``."""
    rig, written_twice = printed(COMPILED)
    entries, fused, multiplications, contractible = rig
    assert entries == 1
    assert fused > 100
    assert multiplications > 100
    assert contractible == 0
    assert written_twice == [1, 1, 1, 0]
