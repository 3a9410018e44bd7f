"""The slip-brake test over friction, cleaning of the rail and controller, judged by Appendix B."""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from dataclasses import dataclass
from statistics import median

from studies.stop_runner import StopRunner, Stops, seeded
from uictest import rig
from uictest.core.units import NORMAL_DENSITY, PERCENT, SIZES
from uictest.judging import evaluation
from uictest.plans import scenario

FRICTIONS = (0.03, 0.04, 0.05, 0.06, 0.08, 0.10)
CLEANED = "5.3 kJ/m"
"""The energy of the library's rail `wet-cleaning`."""
ENERGIES = ("none", "20 kJ/m", "10 kJ/m", CLEANED)
"""Energy per metre that cleans 63 % of the rail; none: sliding does not clean it."""
CONTROLLERS = {
    "small slides": "threshold",
    "deep slides": "{extends: threshold, slip_threshold: 6 m/s}",
}
"""The default controller, and the same one with a higher threshold of slip; chosen."""
SEEDS = range(3)


@dataclass(frozen=True, slots=True)
class SlipTest:
    """The slip-brake test at one point of the map: medians over the seeds.

    Attributes:
        controller, energy: as in `CONTROLLERS` and `ENERGIES`.
        friction: initial friction coefficient of the rail as it is found.
        initial_adhesion: g.
        sliding: minimum slide as the profile of Appendix B reads it, % of the time down to 60 km/h.
        depth: its reading as a depth, the largest slide that half of the wheelsets reach, %.
        distance: m.
        extension: of the distance over that of the dry stop, %.
        air: taken from the reservoir, NL.
        actuations: of all WSP valves.
        lock: longest uninterrupted lock of any wheelset, s.
        counts: whether most stops count as a slip-brake test: slippery enough, sliding for long enough.
    """

    controller: str
    energy: str
    friction: float
    initial_adhesion: float
    sliding: float
    depth: float
    distance: float
    extension: float
    air: float
    actuations: float
    lock: float
    counts: bool


Map = Mapping[tuple[str, str, float], SlipTest]
"""By controller, energy and friction."""


def slip_tests(stop_runner: StopRunner) -> Map:
    """Return the test at every point of the map, in order of controller, energy and friction."""
    dry = stop_runner.repeated(stop_runner.cases("dry-120"), [0])[0].stops[0].measures.braking_distance
    points = [(name, energy) for name in CONTROLLERS for energy in ENERGIES]
    cases = [case for point in points for case in slip_cases(stop_runner, *point, FRICTIONS)]
    repeats = iter(stop_runner.repeated(cases, SEEDS))
    return {
        (*point, friction): _test(*point, friction, next(repeats), float(dry))
        for point in points
        for friction in FRICTIONS
    }


def slip_cases(
    stop_runner: StopRunner, controller: str, energy: str, frictions: Sequence[float]
) -> list[scenario.Case]:
    """Return the slip-brake test at several frictions, with a controller and a rail of the map."""
    condition = "wet" if energy == "none" else f"{{extends: wet-cleaning, cleaning: {{energy: {energy}}}}}"
    return stop_runner.cases(
        "slip-120",
        f"rail.friction={','.join(f'{friction:g}' for friction in frictions)}",
        f"rail.condition={condition}",
        f"controller={CONTROLLERS[controller]}",
    )


def _test(controller: str, energy: str, friction: float, repeats: Stops, dry: float) -> SlipTest:
    verdicts = [_verdicts(repeats.case, seed, stop) for seed, stop in zip(SEEDS, repeats.stops, strict=True)]
    distance = median(float(stop.measures.braking_distance) for stop in repeats.stops)
    return SlipTest(
        controller,
        energy,
        friction,
        median(_value(each["initial-adhesion"]) for each in verdicts),
        median(_value(each["minimum-slide"]) for each in verdicts),
        median(_read_as("depth", each["minimum-slide"]) for each in verdicts),
        distance,
        (distance / dry - 1.0) / PERCENT,
        median(float(stop.measures.air_consumed) for stop in repeats.stops) / NORMAL_DENSITY / SIZES["NL"],
        median(float(stop.wheelset_measures.valve_actuations.sum()) for stop in repeats.stops),
        median(float(stop.wheelset_measures.longest_lock.max()) for stop in repeats.stops),
        median(all(verdict.status == "pass" for verdict in each.values()) for each in verdicts) > 0.5,
    )


def _verdicts(case: scenario.Case, seed: int, stop: rig.SimulatedStop) -> dict[str, evaluation.Verdict]:
    """Return the verdicts of the two limits of Appendix B for a wet rail."""
    judged = evaluation.judge(seeded(case, seed).scenario, stop.measures, stop.wheelset_measures)
    return {each.id: each for each in judged if each.id in ("initial-adhesion", "minimum-slide")}


def _value(verdict: evaluation.Verdict) -> float:
    return float("nan") if verdict.value is None else verdict.value


def _read_as(reading: str, verdict: evaluation.Verdict) -> float:
    """Return the value that a verdict has by another reading, NaN where it has none."""
    value = next((each.value for each in verdict.readings if each.id == reading), None)
    return float("nan") if value is None else value
