"""The slip-brake test over friction, cleaning of the rail and controller, judged by Appendix B."""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from dataclasses import dataclass
from statistics import median

from studies.stop_runner import StopRunner, measured, verdict_value
from uictest import Case, CaseResult
from uictest.units import PERCENT

FRICTIONS = (0.03, 0.04, 0.05, 0.06, 0.08, 0.10)
CLEANED = "5.3 kJ/m"
"""The energy of the library's rail `wet-cleaning`."""
ENERGIES = ("none", "20 kJ/m", "10 kJ/m", CLEANED)
"""Energy per metre that cleans 63 % of the rail; none: sliding does not clean it."""
CONTROLLERS = {"small slides": "threshold", "deep slides": "{extends: threshold, slip_threshold: 6 m/s}"}
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
    (dry,) = stop_runner.repeated(stop_runner.cases("dry-120"), [0])
    dry_distance = measured(dry.stops[0], "braking_distance_m")
    points = [(name, energy) for name in CONTROLLERS for energy in ENERGIES]
    cases = [case for point in points for case in slip_cases(stop_runner, *point, FRICTIONS)]
    repeats = iter(stop_runner.repeated(cases, SEEDS))
    return {
        (*point, friction): _test(*point, friction, next(repeats).stops, dry_distance)
        for point in points
        for friction in FRICTIONS
    }


def slip_cases(
    stop_runner: StopRunner, controller: str, energy: str, frictions: Sequence[float]
) -> Sequence[Case]:
    """Return the slip-brake test at several frictions, with a controller and a rail of the map."""
    condition = "wet" if energy == "none" else f"{{extends: wet-cleaning, cleaning: {{energy: {energy}}}}}"
    changes = {"rail.condition": condition, "controller": CONTROLLERS[controller]}
    return stop_runner.cases("slip-120", {"rail.friction": frictions, **changes})


def _test(controller: str, energy: str, friction: float, stops: Sequence[CaseResult], dry: float) -> SlipTest:
    distance = median(measured(stop, "braking_distance_m") for stop in stops)
    return SlipTest(
        controller,
        energy,
        friction,
        median(verdict_value(stop, "initial-adhesion") for stop in stops),
        median(verdict_value(stop, "minimum-slide") for stop in stops),
        median(_depth(stop) for stop in stops),
        distance,
        (distance / dry - 1.0) / PERCENT,
        median(measured(stop, "air_consumed_nl") for stop in stops),
        median(float(sum(each["valve_actuations"] for each in stop.wheelsets)) for stop in stops),
        median(verdict_value(stop, "locked-wheels") for stop in stops),
        median(all(_passes(stop, name) for name in ("initial-adhesion", "minimum-slide")) for stop in stops)
        > 0.5,
    )


def _depth(stop: CaseResult) -> float:
    """Return the minimum slide read as a depth; NaN where it has none."""
    readings = [
        each for verdict in stop.criteria if verdict.id == "minimum-slide" for each in verdict.readings
    ]
    value = next((each.value for each in readings if each.id == "depth"), None)
    return float("nan") if value is None else value


def _passes(stop: CaseResult, criterion: str) -> bool:
    return any(verdict.id == criterion and verdict.status == "pass" for verdict in stop.criteria)
