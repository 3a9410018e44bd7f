"""Stops in lanes give the bits of stops one by one."""

import subprocess
import sys
from collections.abc import Sequence
from concurrent.futures import ThreadPoolExecutor
from pathlib import Path
from typing import Any

import numpy as np
import pytest
from hypothesis import HealthCheck, given, settings, strategies as st
from numpy.typing import NDArray

from uictest.rig.backends.batch import BatchMeasures
from uictest.rig.backends.finished_stop import run_to_end
from uictest.rig.backends.lanes import run_in_lanes
from uictest.rig.backends.native import compiled_stop
from uictest.rig.model.parameters import PARAMETERS

WET = ("rail.condition=wet", "rail.friction=0.09")
PLACES = "{position: 0 m, friction: 0.2}, {position: 9 m, friction: 0.04}"
TIMES = "{time: 0 s, factor: 1}, {time: 2 s, factor: 0.5}, {time: 3 s, factor: 1.5}"
STEPPED = f"rail.friction={{interpolation: steps, points: [{PLACES}]}}"
FADING = f"rail.friction_over_time={{points: [{TIMES}]}}"
VARIANTS: tuple[tuple[str, ...], ...] = (
    (),
    ("rig.compensation=none", *WET),
    ("rig.compensation=cylinder", *WET),
    ("rig.compensation=hysteresis", *WET),
    ("rig.compensation=thermal", *WET),
    ("rig.topology=four-caliper", *WET),
    ("rig.wsp=bypassed", *WET),
    ("controller=slip-band", *WET),
    ("rail.condition=wet", STEPPED),
    ("rail.condition=wet", FADING),
    ("simulation.time_step=0.25 ms", *WET),
    ("vehicle=crh380a", "rail.gradient=10 permille"),
    ("brake.position=G", "brake.command=70 %"),
)

WITHOUT_COMPILER = """
import sys
sys.modules["numba"] = None
from pathlib import Path
import numpy as np
from uictest.controllers import CONTROLLERS
from uictest.rig.backends.lanes import lanes_are_compiled, run_in_lanes
controllers = [CONTROLLERS["threshold"]] * 2
assert lanes_are_compiled(controllers)
parameters, rail = (np.load(Path(sys.argv[1], f"{name}.npy")) for name in ("parameters", "rail"))
print(run_in_lanes(parameters, rail, controllers).measures.tobytes().hex())
"""


class Batch:
    """Cases of all kinds and what each of them gives alone."""

    def __init__(self, rig: Any) -> None:
        cases = [
            rig.inputs(*variant, f"initial_speed={speed} km/h", case_key=number)
            for number, variant in enumerate(VARIANTS)
            for speed in (9, 24 + number)
        ]
        cases.append(rig.inputs(cycles=120))
        self.parameters: NDArray[Any] = np.zeros(len(cases), PARAMETERS)
        self.rail = np.zeros((len(cases), 4, max(case.rail.shape[1] for case in cases)))
        self.controllers = [case.controller for case in cases]
        for number, (parameters, rail, _) in enumerate(cases):
            self.parameters[number] = parameters
            self.rail[number, :, : rail.shape[1]] = rail
        self.alone = [run_to_end(compiled_stop(case.controller), case) for case in cases]

    def in_lanes(self, numbers: Sequence[int], width: int | None = None) -> BatchMeasures:
        chosen = list(numbers)
        controllers = [self.controllers[number] for number in chosen]
        return run_in_lanes(self.parameters[chosen], self.rail[chosen], controllers, width)

    def is_as_alone(self, numbers: Sequence[int], batch: BatchMeasures) -> bool:
        return all(
            batch.measures[place].tobytes() == self.alone[number].measures.tobytes()
            and batch.wheelset_measures[place].tobytes() == self.alone[number].wheelset_measures.tobytes()
            for place, number in enumerate(numbers)
        )


@pytest.fixture(name="batch", scope="module")
def _batch(rig: Any) -> Batch:
    return Batch(rig)


ALL = range(2 * len(VARIANTS) + 1)


def test_the_cases_differ_in_what_they_do(batch: Batch) -> None:
    stopped = {float(outcome.measures.stopped) for outcome in batch.alone}
    slides = [outcome.wheelset_measures.maximum_slide.max() for outcome in batch.alone]
    assert stopped == {0.0, 1.0}
    assert min(slides) < 0.05
    assert max(slides) > 0.3
    assert sum(outcome.wheelset_measures.valve_actuations.sum() for outcome in batch.alone) > 20
    assert len(set(batch.parameters["steps_per_cycle"])) == 2


@pytest.mark.parametrize("width", [2, 4, 8, 16])
def test_a_lane_gives_the_bits_of_a_stop_alone(batch: Batch, width: int) -> None:
    assert batch.is_as_alone(ALL, batch.in_lanes(ALL, width))


@given(numbers=st.lists(st.sampled_from(ALL), max_size=20))
@settings(max_examples=15, suppress_health_check=[HealthCheck.function_scoped_fixture])
def test_neighbours_order_and_number_do_not_matter(batch: Batch, numbers: list[int]) -> None:
    assert batch.is_as_alone(numbers, batch.in_lanes(numbers))


def test_threads_run_batches_of_their_own(batch: Batch) -> None:
    shares = [ALL[first::3] for first in range(3)]
    with ThreadPoolExecutor(3) as pool:
        batches = list(pool.map(batch.in_lanes, shares))
    assert all(batch.is_as_alone(share, result) for share, result in zip(shares, batches, strict=True))


def test_parameters_and_friction_laws_are_only_read(batch: Batch) -> None:
    before = batch.parameters.tobytes(), batch.rail.tobytes()
    batch.in_lanes(ALL)
    assert (batch.parameters.tobytes(), batch.rail.tobytes()) == before


def test_a_warm_start_needs_no_compiler(batch: Batch, tmp_path: Path) -> None:
    warm = batch.in_lanes([0, 1])
    for name, array in (("parameters", batch.parameters[:2]), ("rail", batch.rail[:2])):
        np.save(tmp_path / f"{name}.npy", array, allow_pickle=False)
    done = subprocess.run(
        [sys.executable, "-c", WITHOUT_COMPILER, tmp_path], capture_output=True, text=True, check=False
    )
    assert done.stdout.strip() == warm.measures.tobytes().hex(), done.stderr


def test_the_compiler_is_loaded_only_for_a_batch() -> None:
    code = (
        "import sys, uictest.rig.backends.lanes; "
        "sys.exit('numba' in sys.modules or 'llvmlite' in sys.modules)"
    )
    assert subprocess.run([sys.executable, "-c", code], check=False).returncode == 0
