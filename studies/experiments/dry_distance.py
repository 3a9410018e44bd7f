"""Braking distance of dry stops under every setting of the compensation, against that with four calipers."""

from __future__ import annotations

from collections.abc import Iterator, Mapping, Sequence
from dataclasses import dataclass

from studies.neighbourhood import FOUR_CALIPER, SETTINGS
from studies.quantity import NOT_ASKED, OwnBand, StudyQuantity, StudyValue
from studies.stop_runner import StopRunner, measured, seeded
from studies.study import Study, StudyFindings, Table
from uictest import Case
from uictest.units import KILOMETRE_PER_HOUR, PERCENT

SPEEDS = ("30 km/h", "60 km/h", "100 km/h", "120 km/h", "145 km/h")
COMMANDS = ("30 %", "70 %", "100 %")
LEAST_SPEED = 100.0 * KILOMETRE_PER_HOUR
LEAST_COMMAND = 70.0 * PERCENT
"""Stops from at least this speed with at least this command have a band; slower and weaker ones are shown."""
SEEDS = range(2)
_ROUNDING = 1e-9
RIGS = {
    FOUR_CALIPER: {"rig.topology": FOUR_CALIPER},
    **{setting: {"rig.compensation": setting} for setting in SETTINGS},
}
"""Change of the scenario for each rig."""

WITH_HYSTERESIS = ("hysteresis", "full", "thermal")
WITHIN = 0.2
"""Difference from four calipers that a setting with hysteresis may have in the stops that have a band, %."""


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

    @property
    def has_band(self) -> bool:
        """Whether the stop is fast and strong enough for the band."""
        scenario = self.case.scenario
        # Speed and command come from texts with units: their last bit is no reason to leave a stop out.
        return bool(
            scenario.initial_speed > LEAST_SPEED * (1.0 - _ROUNDING)
            and scenario.brake.first_command > LEAST_COMMAND * (1.0 - _ROUNDING)
        )


def _quantities() -> Iterator[StudyQuantity]:
    for name in SETTINGS:
        band = OwnBand(lower=-WITHIN, upper=WITHIN, reason="ours") if name in WITH_HYSTERESIS else None
        yield StudyQuantity(
            name,
            f"difference, {name}, worst from 100 km/h at 70 %",
            "%",
            NOT_ASKED,
            status="predicted",
            band=band,
            digits=2,
        )
        yield StudyQuantity(
            f"{name}_all", f"difference, {name}, worst of all", "%", NOT_ASKED, status="predicted", digits=2
        )


def run(stop_runner: StopRunner) -> StudyFindings:
    """Stop from every speed with every command on all rigs, in brake position R."""
    stops = dry_stops(stop_runner)
    banded = [stop for stop in stops if stop.has_band]
    return StudyFindings(
        {setting: StudyValue(worst_stop(banded, setting).difference) for setting in SETTINGS}
        | {f"{setting}_all": StudyValue(worst_stop(stops, setting).difference) for setting in SETTINGS},
        tables={"distances": _table(stops)},
        notes=(
            (
                f"Stops from {', '.join(SPEEDS)} at {', '.join(COMMANDS)} command in brake position R, "
                f"{len(SEEDS)} seeds, each against the same stop with four calipers. The stop that differs "
                "most is shown: of those from 100 km/h at 70 % command and above, and of all."
            ),
            *(_where(setting, worst_stop(stops, setting)) for setting in ("full", "thermal")),
        ),
    )


def _where(setting: str, stop: DryStop) -> str:
    speed = stop.case.scenario.initial_speed / KILOMETRE_PER_HOUR
    command = stop.case.scenario.brake.first_command / PERCENT
    return (
        f"The stop of {setting} that differs most of all: from {speed:.0f} km/h at {command:.0f} % command."
    )


def dry_stops(stop_runner: StopRunner) -> list[DryStop]:
    """Return the stops from every speed with every command under every seed, on all rigs."""
    distances = {rig: list(_distances(stop_runner, change)) for rig, change in RIGS.items()}
    return [
        DryStop(case, rig, distance, reference)
        for rig, of_rig in distances.items()
        for (case, distance), (_, reference) in zip(of_rig, distances[FOUR_CALIPER], strict=True)
    ]


def _distances(stop_runner: StopRunner, rig: Mapping[str, str]) -> Iterator[tuple[Case, float]]:
    """Yield every stop on a rig, and its distance in m."""
    cases = stop_runner.cases("dry-120", {"initial_speed": SPEEDS, "brake.command": COMMANDS, **rig})
    for repeats in stop_runner.repeated(cases, SEEDS):
        for seed, stop in zip(SEEDS, repeats.stops, strict=True):
            yield seeded(repeats.case, seed), measured(stop, "braking_distance_m")


def worst_stop(stops: Sequence[DryStop], rig: str) -> DryStop:
    """Return the stop on a rig that differs most from four calipers."""
    return max((stop for stop in stops if stop.rig == rig), key=lambda stop: abs(stop.difference))


def _table(stops: Sequence[DryStop]) -> Table:
    scenarios = [stop.case.scenario for stop in stops]
    return {
        "speed_kmh": [round(each.initial_speed / KILOMETRE_PER_HOUR, 1) for each in scenarios],
        "command_percent": [round(each.brake.first_command / PERCENT, 1) for each in scenarios],
        "seed": [each.seed for each in scenarios],
        "rig": [stop.rig for stop in stops],
        "distance_m": [round(stop.distance, 3) for stop in stops],
        "difference_percent": [round(stop.difference, 4) for stop in stops],
        "has_band": [stop.has_band for stop in stops],
    }


STUDY = Study(
    "dry-distance",
    "Braking distance of dry stops under every compensation, against four calipers",
    "",
    tuple(_quantities()),
    run,
    position=106,
)
