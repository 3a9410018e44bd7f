"""Map the slip-brake test over the energy that cleans the rail, with small and with deep slides."""

from __future__ import annotations

import math
from collections.abc import Iterator, Mapping, Sequence
from functools import partial
from typing import TYPE_CHECKING, Any

import numpy as np
from numpy.typing import NDArray

from studies.drawing import MUTED, ORANGE, WHEELSET_COLOURS, WIDTH, from_zero, heading, heat_map
from studies.quantity import NOT_ASKED, OwnBand, StudyQuantity, StudyValue, spread
from studies.slip_brake_tests import (
    CLEANED,
    CONTROLLERS,
    FRICTIONS,
    SEEDS,
    Map,
    SlipTest,
    slip_cases,
    slip_tests,
)
from studies.stop_runner import StopRunner
from studies.study import Study, StudyFindings, Table
from uictest import Recording
from uictest.units import PERCENT

if TYPE_CHECKING:
    from matplotlib.axes import Axes
    from matplotlib.figure import Figure

_RAILS = {"found": "none", "cleaned": CLEANED}
SHOWN_FRICTION = 0.05
"""Of the two stops that are drawn over time."""


def _counts_key(controller: str, rail: str) -> str:
    return f"counts_{controller.partition(' ')[0]}_{rail}"


QUANTITIES = (
    StudyQuantity(
        "distance_ratio",
        f"braking distance cleaned at {CLEANED} over not cleaned, largest",
        "",
        NOT_ASKED,
        status="by construction",
        band=OwnBand(upper=1.0, below=True, reason="published direction"),
        digits=2,
    ),
    StudyQuantity(
        "air_ratio",
        "the same for the air consumed",
        "",
        NOT_ASKED,
        status="predicted",
        band=OwnBand(upper=1.0, below=True, reason="follows from the published direction"),
        digits=2,
    ),
    StudyQuantity(
        "actuation_ratio",
        "the same for the actuations of the WSP valves",
        "",
        NOT_ASKED,
        status="predicted",
        band=OwnBand(upper=1.0, below=True, reason="follows from the published direction"),
        digits=2,
    ),
    StudyQuantity(
        "trailing_share",
        "cleaned share under wheelsets 2 to 4 over that under wheelset 1, smallest",
        "",
        NOT_ASKED,
        status="by construction",
        band=OwnBand(lower=1.0, reason="published direction"),
        digits=2,
    ),
    *(
        StudyQuantity(
            _counts_key(controller, name),
            f"frictions at which the test counts, {controller}, {title}",
            f"of {len(FRICTIONS)}",
            NOT_ASKED,
            status="predicted",
            digits=0,
        )
        for controller in CONTROLLERS
        for name, title in (("found", "rail not cleaned"), ("cleaned", f"cleaned at {CLEANED}"))
    ),
    StudyQuantity(
        "deep_over_small_found",
        "distance with deep over small slides, rail not cleaned, median",
        "",
        NOT_ASKED,
        status="predicted",
        digits=2,
    ),
    StudyQuantity(
        "deep_over_small_cleaned",
        f"distance with deep over small slides, cleaned at {CLEANED}, median",
        "",
        NOT_ASKED,
        status="predicted",
        digits=2,
    ),
)


def run(stop_runner: StopRunner) -> StudyFindings:
    """Map the slip-brake test over friction and cleaning, with two controllers."""
    tests = slip_tests(stop_runner)
    stops = _recorded(stop_runner)
    return StudyFindings(
        _values(tests) | {"trailing_share": StudyValue(min(map(_trailing_share, stops.values())))},
        tables={"slip-brake-tests": _table(tests)},
        drawings={
            "rail-cleaning": partial(draw_maps, list(tests.values())),
            "rail-cleaning-stops": partial(draw_stops, stops),
        },
        notes=tuple(_notes(tests)),
    )


def _recorded(stop_runner: StopRunner) -> dict[str, Recording]:
    """Return a stop on the cleaned rail with each controller."""
    cases = [slip_cases(stop_runner, name, CLEANED, [SHOWN_FRICTION])[0] for name in CONTROLLERS]
    return dict(zip(CONTROLLERS, stop_runner.recordings(cases), strict=True))


def _trailing_share(stop: Recording) -> float:
    """Return the mean cleaned share over the distance under wheelsets 2 to 4, over that under the first."""
    first, *others = (float(np.trapezoid(stop[f"cleaned_share_{n}"], stop["distance"])) for n in (1, 2, 3, 4))
    return math.fsum(others) / len(others) / first


def _values(tests: Map) -> dict[str, StudyValue]:
    pairs = [
        (tests[name, "none", friction], tests[name, CLEANED, friction])
        for name in CONTROLLERS
        for friction in FRICTIONS
    ]
    counts = {
        _counts_key(name, rail): sum(tests[name, energy, friction].counts for friction in FRICTIONS)
        for name in CONTROLLERS
        for rail, energy in _RAILS.items()
    }
    return {
        "distance_ratio": StudyValue(max(cleaned.distance / found.distance for found, cleaned in pairs)),
        "air_ratio": StudyValue(max(cleaned.air / found.air for found, cleaned in pairs)),
        "actuation_ratio": StudyValue(max(cleaned.actuations / found.actuations for found, cleaned in pairs)),
        **{key: StudyValue(float(count)) for key, count in counts.items()},
        **{f"deep_over_small_{rail}": _deep_over_small(tests, energy) for rail, energy in _RAILS.items()},
    }


def _deep_over_small(tests: Map, energy: str) -> StudyValue:
    """Return the ratio of the distances with both controllers: median and range over the frictions."""
    small, deep = CONTROLLERS
    return spread(
        [
            tests[deep, energy, friction].distance / tests[small, energy, friction].distance
            for friction in FRICTIONS
        ]
    )


def _notes(tests: Map) -> Iterator[str]:
    yield (
        f"Each point: median of {len(SEEDS)} stops that differ in the noise of the sensors. The energy that "
        f"cleans the rail is varied; {CLEANED}, the friction of a clean rail, the reach and the carry-over "
        "are those of the library's rail wet-cleaning, all of them chosen."
    )
    yield (
        "The test counts where the deceleration in the first phase stays below 0.08 g and half of the "
        "wheelsets slide at once for more than 35 % of the time down to 60 km/h. Small slides: the default "
        "controller. Deep slides: the same one with a slip threshold of 6 m/s."
    )
    for name in CONTROLLERS:
        cleaned = [tests[name, CLEANED, friction] for friction in FRICTIONS]
        counting = ", ".join(f"{test.friction:g}" for test in cleaned if test.counts)
        where = f"at friction {counting}" if counting else "at none of these frictions"
        lock = max(test.lock for test in cleaned)
        yield (
            f"With {name}, cleaned at {CLEANED}, the test counts {where}; "
            f"the longest lock of a wheelset at any friction is {lock:.1f} s."
        )


def _table(tests: Map) -> Table:
    rows = list(tests.values())
    return {
        "controller": [row.controller for row in rows],
        "energy": [row.energy for row in rows],
        "friction": [row.friction for row in rows],
        "initial_adhesion_g": [round(row.initial_adhesion, 4) for row in rows],
        "sliding_share_percent": [round(row.sliding, 2) for row in rows],
        "slide_of_half_percent": [round(row.depth, 2) for row in rows],
        "counts": [row.counts for row in rows],
        "distance_m": [round(row.distance, 2) for row in rows],
        "extension_percent": [round(row.extension, 2) for row in rows],
        "air_nl": [round(row.air, 2) for row in rows],
        "actuations": [row.actuations for row in rows],
        "longest_lock_s": [round(row.lock, 3) for row in rows],
    }


_MAPS = {
    "sliding": "Time in which half of the wheelsets slide, % (framed: the slip-brake test counts)",
    "extension": "Extension over the dry stop, %",
}


def draw_maps(tests: Sequence[SlipTest], figure: Figure) -> None:
    """Draw a column of maps for each controller; a frame marks where the test counts."""
    figure.set_size_inches(WIDTH, 5.0)
    controllers = list(dict.fromkeys(test.controller for test in tests))
    rows: Any = figure.subfigures(len(_MAPS), 1)
    for row, (quantity, title) in zip(rows, _MAPS.items(), strict=True):
        panels = row.subplots(1, len(controllers), sharex=True, sharey=True)
        most = max(getattr(test, quantity) for test in tests)
        for axes, controller in zip(panels, controllers, strict=True):
            own = [test for test in tests if test.controller == controller]
            image = _draw_map(axes, own, quantity, most)
            axes.set_title(controller)
        panels[0].set_ylabel("energy that cleans")
        row.colorbar(image, ax=panels, pad=0.01)
        heading(row, title)
    for axes in panels:
        axes.set_xlabel("friction coefficient of the rail as found")


def _draw_map(axes: Axes, tests: Sequence[SlipTest], quantity: str, most: float) -> Any:
    frictions = list(dict.fromkeys(test.friction for test in tests))
    energies = list(dict.fromkeys(test.energy for test in tests))
    values: NDArray[np.float64] = np.full((len(energies), len(frictions)), np.nan)
    for test in tests:
        row, column = energies.index(test.energy), frictions.index(test.friction)
        values[row, column] = getattr(test, quantity)
        if test.counts:
            left, right, top, bottom = column - 0.42, column + 0.42, row - 0.4, row + 0.4
            frame = [left, right, right, left, left], [top, top, bottom, bottom, top]
            axes.plot(*frame, color=ORANGE, linewidth=1.3, solid_joinstyle="miter")
    axes.set_xticks(range(len(frictions)), [f"{friction:.2f}" for friction in frictions])
    axes.set_yticks(range(len(energies)), energies)
    return heat_map(axes, values, 0, most)


def draw_stops(stops: Mapping[str, Recording], figure: Figure) -> None:
    """Draw cleaned share and friction under each wheelset over its distance, a column for each stop."""
    figure.set_size_inches(WIDTH, 3.6)
    panels = figure.subplots(2, len(stops), sharex=True, sharey="row", squeeze=False)
    for column, (name, stop) in enumerate(stops.items()):
        shares, frictions = panels[0][column], panels[1][column]
        for n, colour in WHEELSET_COLOURS.items():
            share = stop[f"cleaned_share_{n}"] / PERCENT
            shares.plot(stop["distance"], share, color=colour, linewidth=0.7, label=f"wheelset {n}")
            frictions.plot(stop["distance"], stop[f"friction_{n}"], color=colour, linewidth=0.7)
        frictions.axhline(float(stop["friction_1"][0]), color=MUTED, linewidth=0.9, linestyle=(0, (4, 2)))
        frictions.set_xlabel("distance of the train, m")
        shares.set_title(name)
    for axes in panels.flat:
        from_zero(axes)
    handles, labels = panels[0][0].get_legend_handles_labels()
    figure.legend(handles, labels, loc="outside lower center", ncols=len(WHEELSET_COLOURS))
    panels[0][0].set_ylabel("cleaned share, %")
    panels[1][0].set_ylabel("friction met")


STUDY = Study(
    "rail-cleaning",
    "The slip-brake test from 120 km/h on a rail that sliding cleans",
    "",
    QUANTITIES,
    run,
    position=113,
)
