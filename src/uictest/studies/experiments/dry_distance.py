"""Braking distance of dry stops under every setting of the compensation, against that with four calipers."""

from __future__ import annotations

from collections.abc import Iterator, Sequence
from dataclasses import dataclass

from uictest.scenario import COMPENSATION_SETTINGS, Case
from uictest.studies.neighbourhood import FOUR_CALIPER, SETTINGS
from uictest.studies.quantity import NOT_ASKED, StudyQuantity, StudyValue
from uictest.studies.stop_runner import StopRunner, seeded
from uictest.studies.study import Study, StudyFindings, Table
from uictest.units import KILOMETRE_PER_HOUR, PERCENT

SPEEDS = ("100 km/h", "120 km/h", "145 km/h")
COMMANDS = ("70 %", "100 %")
SEEDS = range(2)
RIGS = {
    FOUR_CALIPER: f"rig.topology={FOUR_CALIPER}",
    **{setting: f"rig.compensation={setting}" for setting in SETTINGS},
}
"""Change of the scenario for each rig."""

WITHIN = 0.2
"""Difference from the distance with four calipers that a setting with hysteresis may have, %."""


@dataclass(frozen=True, slots=True)
class DryStop:
    """A dry stop on one rig: its distance, and that of the same stop with four calipers, m."""

    case: Case
    rig: str
    distance: float
    reference: float

    @property
    def difference(self) -> float:
        """Difference from four calipers, % of their distance."""
        return (self.distance / self.reference - 1.0) / PERCENT


def _quantities() -> Iterator[StudyQuantity]:
    for name, setting in COMPENSATION_SETTINGS.items():
        bound = WITHIN if setting.hysteresis else None
        yield StudyQuantity(
            name,
            f"difference of the distance, {name}, worst stop",
            "%",
            NOT_ASKED,
            lower=-bound if bound else None,
            upper=bound,
            digits=2,
            reason="ours" if bound else "",
        )


def run(stop_runner: StopRunner) -> StudyFindings:
    """Stop from every speed with every command on all rigs, in brake position R."""
    stops = dry_stops(stop_runner)
    return StudyFindings(
        {setting: StudyValue(largest_difference(stops, setting)) for setting in SETTINGS},
        tables={"distances": _table(stops)},
        notes=(
            (
                f"Stops from {', '.join(SPEEDS)} at {' and '.join(COMMANDS)} command, {len(SEEDS)} seeds, "
                "each against the same stop with four calipers. The stop that differs most is shown."
            ),
        ),
    )


def dry_stops(stop_runner: StopRunner) -> list[DryStop]:
    """Return the stops from every speed with every command under every seed, on all rigs."""
    distances = {rig: list(_distances(stop_runner, change)) for rig, change in RIGS.items()}
    return [
        DryStop(case, rig, distance, reference)
        for rig, of_rig in distances.items()
        for (case, distance), (_, reference) in zip(of_rig, distances[FOUR_CALIPER], strict=True)
    ]


def _distances(stop_runner: StopRunner, change: str) -> Iterator[tuple[Case, float]]:
    """Yield every stop on the rig of a change, and its distance in m."""
    speeds, commands = f"initial_speed={','.join(SPEEDS)}", f"brake.command={','.join(COMMANDS)}"
    cases = stop_runner.cases("dry-120", speeds, commands, change)
    for repeats in stop_runner.repeated(cases, SEEDS):
        for seed, stop in zip(SEEDS, repeats.stops, strict=True):
            yield seeded(repeats.case, seed), float(stop.measures.braking_distance)


def largest_difference(stops: Sequence[DryStop], rig: str) -> float:
    """Return the difference of the stop on a rig that differs most from four calipers, %, with its sign."""
    return max((stop.difference for stop in stops if stop.rig == rig), key=abs)


def _table(stops: Sequence[DryStop]) -> Table:
    scenarios = [stop.case.scenario for stop in stops]
    return {
        "speed_kmh": [round(each.initial_speed / KILOMETRE_PER_HOUR, 1) for each in scenarios],
        "command_percent": [round(each.brake.command / PERCENT, 1) for each in scenarios],
        "seed": [each.seed for each in scenarios],
        "rig": [stop.rig for stop in stops],
        "distance_m": [round(stop.distance, 3) for stop in stops],
        "difference_percent": [round(stop.difference, 4) for stop in stops],
    }


STUDY = Study(
    "dry-distance",
    "Braking distance of dry stops under every compensation, against four calipers",
    "",
    tuple(_quantities()),
    run,
    position=106,
)
