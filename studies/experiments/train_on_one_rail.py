"""A train of four cars on one rail: what every car finds, and what the train makes of it."""

from __future__ import annotations

from collections.abc import Iterator, Mapping, Sequence
from dataclasses import dataclass
from functools import partial
from statistics import fmean
from typing import TYPE_CHECKING, Final

from studies.drawing import BLUE, MUTED, WIDTH
from studies.quantity import NOT_ASKED, OwnBand, StudyQuantity, StudyValue, spread
from studies.stop_runner import StopRunner, seeded
from studies.study import Study, StudyFindings, Table
from uictest.rig import Coupling, TrainStop, run_coupled
from uictest.units import PERCENT

if TYPE_CHECKING:
    from matplotlib.figure import Figure

SEEDS = range(12)
CARS = 4
_DISTANCE: Final = 26.4
"""Between the centres of neighbouring cars, m: the usual length of a coach over its buffers; chosen."""
COUPLED = Coupling(_DISTANCE)
ALONE = Coupling(_DISTANCE, stiffness=0.0, damping=0.0)
"""Every car at its place in the train, on the rail that those before it leave, held by its brakes only."""
NOT_CLEANED = "not cleaned"
_CLEANING = "{energy: 5300 J/m, recovered_friction: 0.28, reach: 0.5 m, carry_over: 0.5}"
RAILS: Final[Mapping[str, Mapping[str, str]]] = {
    NOT_CLEANED: {"rail.friction": "0.08"},
    "cleaned": {"rail.friction": "0.08", "rail.cleaning": _CLEANING},
    "wet-curves": {"rail.friction": "0.08", "rail.condition": "wet-curves"},
}
"""Changes of the slip test from 120 km/h."""
_SLUG: Final = {rail: rail.replace(" ", "_").replace("-", "_") for rail in RAILS}


@dataclass(frozen=True, slots=True)
class TrainStops:
    """The stops of a train on one rail, one per seed, and the dry distance of a car.

    Attributes:
        dry: distance of a dry stop of one car, m.
        alone: cars that only their brakes hold.
        coupled: the train.
    """

    dry: float
    alone: Sequence[TrainStop]
    coupled: Sequence[TrainStop]

    def extensions(self, car: int) -> list[float]:
        """Return by how much a car, numbered from 0, stops longer than on a dry rail, %, for every seed."""
        distances = [float(stop.cars[car].measures.end_distance) for stop in self.alone]
        return [(distance / self.dry - 1.0) / PERCENT for distance in distances]

    @property
    def of_train(self) -> list[float]:
        """The same of the coupled train."""
        distances = [float(stop.cars[0].measures.end_distance) for stop in self.coupled]
        return [(distance / self.dry - 1.0) / PERCENT for distance in distances]

    @property
    def first_share(self) -> list[float]:
        """Share of the first car in the contact loss of the coupled train, %, for every seed."""
        losses = [[car.wheelset_measures.contact_loss.sum() for car in stop.cars] for stop in self.coupled]
        return [float(each[0] / sum(each)) / PERCENT for each in losses]

    @property
    def largest_force(self) -> list[float]:
        """Largest force in a coupler, kN, for every seed."""
        couplers = [stop.couplers for stop in self.coupled]
        return [float(max(each["largest_pull"].max(), each["largest_push"].max())) / 1e3 for each in couplers]


def _quantities() -> Iterator[StudyQuantity]:
    for rail, slug in _SLUG.items():
        for car in range(CARS):
            title = f"extension of car {car + 1} by itself, {rail}"
            band = None
            if rail == NOT_CLEANED and car:
                title += ", over that of car 1"
                band = OwnBand(lower=0.95, upper=1.05, reason="ours: every car finds the same rail")
            unit, digits = ("", 3) if band else ("%", 1)
            key = f"{slug}_{car + 1}"
            yield StudyQuantity(key, title, unit, NOT_ASKED, status="predicted", band=band, digits=digits)
        for key, title, unit in (
            ("train", f"extension of the coupled train, {rail}", "%"),
            ("share", f"share of car 1 in the contact loss of the train, {rail}", "%"),
            ("force", f"largest coupler force, {rail}", "kN"),
        ):
            yield StudyQuantity(f"{slug}_{key}", title, unit, NOT_ASKED, status="predicted", digits=1)


def run(stop_runner: StopRunner) -> StudyFindings:
    """Stop a train on every rail under every seed, coupled and not."""
    rails = {rail: _stops(stop_runner, changes) for rail, changes in RAILS.items()}
    return StudyFindings(
        dict(_values(rails)),
        tables={"cars": _car_table(rails)},
        drawings={"train": partial(draw, rails)},
        notes=tuple(_notes()),
    )


def _notes() -> Iterator[str]:
    yield (
        f"{CARS} equal cars, {_DISTANCE} m apart, one rig and one controller each, under {len(SEEDS)} seeds; "
        "the command comes along a wire. Couplers of 5 MN/m and 0.8 MN s/m. The extension is that of the "
        "distance over the dry one of a car. By itself means at its place in the train and on the rail that "
        "the cars before it leave, with couplers that carry nothing."
    )
    yield "There is no public figure to judge a cleaned rail through a train by."


def _stops(stop_runner: StopRunner, changes: Mapping[str, str]) -> TrainStops:
    (dry,) = stop_runner.cases("dry-120", {"rig.compensation": "thermal"})
    (wet,) = stop_runner.cases("slip-120", {"rig.compensation": "thermal", **changes})
    trains = [[seeded(wet, seed)] * CARS for seed in SEEDS]
    return TrainStops(
        float(run_coupled([dry], COUPLED).cars[0].measures.end_distance),
        stop_runner.map(partial(run_coupled, coupling=ALONE), trains),
        stop_runner.map(partial(run_coupled, coupling=COUPLED), trains),
    )


def _values(rails: Mapping[str, TrainStops]) -> Iterator[tuple[str, StudyValue]]:
    for rail, stops in rails.items():
        slug = _SLUG[rail]
        for car in range(CARS):
            extensions = stops.extensions(car)
            if rail == NOT_CLEANED and car:
                yield f"{slug}_{car + 1}", StudyValue(fmean(extensions) / fmean(stops.extensions(0)))
            else:
                yield f"{slug}_{car + 1}", spread(extensions)
        yield f"{slug}_train", spread(stops.of_train)
        yield f"{slug}_share", spread(stops.first_share)
        yield f"{slug}_force", spread(stops.largest_force)


def _car_table(rails: Mapping[str, TrainStops]) -> Table:
    rows = [
        (rail, seed, car, stops.alone[k].cars[car], stops.coupled[k].cars[car])
        for rail, stops in rails.items()
        for k, seed in enumerate(SEEDS)
        for car in range(CARS)
    ]
    return {
        "rail": [rail for rail, *_ in rows],
        "seed": [seed for _, seed, *_ in rows],
        "car": [car + 1 for _, _, car, *_ in rows],
        "distance_by_itself_m": [round(float(alone.measures.end_distance), 2) for *_, alone, _ in rows],
        "distance_in_train_m": [round(float(coupled.measures.end_distance), 2) for *_, coupled in rows],
        "contact_loss_in_train_kj": [
            round(float(coupled.wheelset_measures.contact_loss.sum()) / 1e3, 1) for *_, coupled in rows
        ],
    }


def draw(rails: Mapping[str, TrainStops], figure: Figure) -> None:
    """Draw the extension of every car by itself, and that of the train as a line."""
    figure.set_size_inches(WIDTH, 2.6)
    panels = figure.subplots(1, len(rails), squeeze=False, sharey=True)[0]
    for axes, (rail, stops) in zip(panels, rails.items(), strict=True):
        for car in range(CARS):
            extensions = stops.extensions(car)
            axes.plot([car + 1] * len(extensions), extensions, ".", color=MUTED, markersize=3.0)
            axes.plot(car + 1, fmean(extensions), "o", color=BLUE)
        axes.axhline(fmean(stops.of_train), color=BLUE, linewidth=1.0)
        axes.set_xticks(range(1, CARS + 1))
        axes.set_xlabel("car")
        axes.set_title(rail)
    panels[0].set_ylabel("extension, %")


STUDY = Study(
    "train",
    "Extension of the cars of a train on one rail, from 120 km/h",
    "",
    tuple(_quantities()),
    run,
    position=119,
)
