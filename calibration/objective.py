"""How far a choice of parameters is from the paper (Lee and Kang 2015): a sum of squares beyond bands."""

from dataclasses import dataclass
from pathlib import Path

import numpy as np
import yaml
from numpy.typing import NDArray
from parameters import Fields, fields, values

from uictest.plans.scenario import load
from uictest.rig.assembly import assemble
from uictest.rig.model.rail import FRICTIONS
from uictest.rig.train_stop import FinishedStop, StopInputs, compiled_rig, run_to_end

SCENARIOS = Path(__file__).parent.parent / "scenarios"
SETTINGS: dict[str, Fields] = {
    "full": {},
    "none": {"uses_cylinder_dynamics": 0.0, "uses_hysteresis": 0.0},
    "calipers": {"calipers": 4},
}
SEEDS = tuple(yaml.safe_load((Path(__file__).parent / "conditions.yaml").read_text("utf-8"))["seeds"])
GIVEN_UP = 20.0
"""Added to the misfit where the slide test is too far off for the other stops to be worth running."""


@dataclass(frozen=True)
class Stop:
    """A stop to be run with other numbers: the slide test, the dry stop, the slip-brake test."""

    inputs: StopInputs

    def run(self, changed: Fields, friction: float | None = None) -> FinishedStop:
        """Run it with some record fields, and maybe the rail's friction, changed."""
        record, of_wheelsets = self.inputs.parameters.copy(), self.inputs.wheelset_parameters.copy()
        for name, value in changed.items():
            (record if name in record.dtype.names else of_wheelsets)[name] = value
        rail = self.inputs.rail.copy()
        if friction is not None:
            rail[FRICTIONS] = friction
        changed_inputs = self.inputs._replace(parameters=record, wheelset_parameters=of_wheelsets, rail=rail)
        return run_to_end(compiled_rig(), changed_inputs)


def stop(file: str) -> Stop:
    """The stop of a shipped scenario file with the paper's compensation, against whose numbers it is held."""
    [case] = load([SCENARIOS / file], ["rig.compensation=full"])
    return Stop(assemble(case))


SLIDE = stop("slide-80.yaml")
DRY = stop("dry-120.yaml")
SLIP = stop("slip-120.yaml")
SLIPPERIEST = stop("low-adhesion-80.yaml")


def misfit(shares: NDArray[np.float64]) -> float:
    """Misfit of free parameters given as shares between their bounds."""
    chosen = values(shares)
    changed = fields(chosen, SLIDE.inputs.parameters)
    slide = float(np.mean([_slide_test(changed, chosen["friction"], seed) for seed in SEEDS]))
    changed.pop("commanded_pressure")  # dry stop and slip-brake test are made in position R
    total = slide + _dry_stop(changed)
    if total > GIVEN_UP:
        return total + GIVEN_UP
    slip = float(np.mean([_slip_brake_test(changed | {"seed": seed}) for seed in SEEDS]))
    return total + slip + _slipperiest_rail(changed)


def beyond(value: float, low: float, high: float, scale: float) -> float:
    """Square of the distance to a band, in units of ``scale``."""
    return (max(low - value, 0.0, value - high) / scale) ** 2


def _slide_test(changed: Fields, friction: float, seed: int) -> float:
    """Actuations 11 / 21 / 11, 17.6 s and 197 m, slides that stay shallow."""
    stops = {
        name: SLIDE.run(changed | setting | {"seed": seed}, friction) for name, setting in SETTINGS.items()
    }
    acts = {name: outcome.wheelset_measures.valve_actuations for name, outcome in stops.items()}
    misfit = (
        beyond(acts["full"][0], 10.0, 12.0, 0.5)
        + beyond(acts["none"][1], 19.5, 22.5, 0.5)
        + 2.0 * beyond(acts["full"][1], 10.4, 11.6, 1.0)
        + 0.5 * beyond(acts["full"][0] - acts["full"][1], -2.0, 1.0, 1.0)
        + 0.4 * beyond(acts["full"][2:].mean(), 10.0, 12.0, 1.5)
        + 0.3 * beyond(acts["none"][2:].mean(), 19.0, 23.0, 2.0)
        + 0.5 * beyond(acts["calipers"][:2].mean(), 10.0, 12.0, 1.5)
        + 0.3 * beyond(acts["calipers"].mean(), 10.0, 12.0, 1.5)
    )
    return misfit + sum(_course(outcome, 1.0 if name == "full" else 0.3) for name, outcome in stops.items())


def _course(outcome: FinishedStop, weight: float) -> float:
    measures, wheelsets = outcome.measures, outcome.wheelset_measures
    if not measures.stopped:
        return GIVEN_UP
    course = beyond(measures.braking_time, 16.8, 18.2, 0.2) + beyond(
        measures.braking_distance, 189.0, 207.0, 2.0
    )
    locked = 2.0 * float(wheelsets.locked_time.sum())
    return weight * course + locked + beyond(float(wheelsets.maximum_slide.max()), 0.0, 0.5, 0.1)


def _dry_stop(changed: Fields) -> float:
    """440-490 m, well inside."""
    return beyond(DRY.run(changed).measures.braking_distance, 448.0, 478.0, 2.0)


def _slip_brake_test(changed: Fields) -> float:
    """Below 0.08 g in the first three seconds of sliding, slides above 35 % on half, no long lock."""
    outcome = SLIP.run(changed)
    measures, wheelsets = outcome.measures, outcome.wheelset_measures
    if not measures.stopped:
        return 5.0 * GIVEN_UP
    speeds = measures.speed_after_sliding
    adhesion = (speeds[0] - speeds[3]) / 3.0 / float(SLIP.inputs.parameters.gravity)
    slides = np.sort(wheelsets.maximum_slide_above[:, 3])
    return (
        beyond(adhesion, 0.0, 0.076, 0.002)
        + beyond(float(slides[2]), 0.42, 2.0, 0.03)
        + 2.0 * beyond(float(wheelsets.longest_lock.max()), 0.0, 0.6, 0.2)
    )


def _slipperiest_rail(changed: Fields) -> float:
    """No lock of a second on a rail of 0.03."""
    longest = float(SLIPPERIEST.run(changed).wheelset_measures.longest_lock.max())
    return 2.0 * beyond(longest, 0.0, 0.8, 0.2)
