"""Check the order of the valve actuations at points around the calibrated slide test."""

from __future__ import annotations

from collections.abc import Iterator, Mapping, Sequence
from dataclasses import dataclass
from functools import partial
from statistics import median
from typing import TYPE_CHECKING

import numpy as np
from numpy.typing import NDArray

from studies.drawing import BAND, INK, MUTED, SETTING_COLOURS, WIDTH, from_zero, title_and_legend
from studies.neighbourhood import (
    APART,
    BANDS,
    FOUR_CALIPER,
    PAPER,
    SEEDS,
    Counts,
    Point,
    counts,
    friction_sweep,
    in_bands,
    in_order,
    mean_counts,
    neighbourhood,
)
from studies.quantity import NOT_ASKED, OwnBand, StudyQuantity, StudyValue, spread
from studies.stop_runner import StopRunner
from studies.study import Study, StudyFindings, Table
from uictest.units import PERCENT

if TYPE_CHECKING:
    from matplotlib.figure import Figure

SHOWN = (FOUR_CALIPER, "full", "none")

QUANTITIES = (
    StudyQuantity(
        "in_order",
        "points at which full is near the caliper and none clearly apart",
        "of 9",
        "11 / 11 / 21 in one stop",
        status="predicted",
        band=OwnBand(lower=9.0, reason="ours"),
        digits=0,
    ),
    StudyQuantity(
        "full_over_caliper",
        "actuations with full compensation over those with a caliper",
        "",
        "1.0 in one stop",
        status="predicted",
        band=OwnBand(lower=0.75, upper=1.25, reason="ours"),
        digits=2,
    ),
    StudyQuantity(
        "none_over_caliper",
        "actuations without compensation over those with a caliper",
        "",
        "1.9 in one stop",
        status="predicted",
        band=OwnBand(lower=APART, reason="ours"),
        digits=2,
    ),
    StudyQuantity(
        "sweep_in_order",
        f"stops of the friction sweep with none above {APART} x full, and full nearer to the caliper",
        "%",
        "11 / 11 / 21 in one stop",
        status="predicted",
        band=OwnBand(lower=95.0, reason="ours"),
    ),
    StudyQuantity(
        "sweep_in_order_thermal", "the same with thermal in place of full", "%", NOT_ASKED, status="predicted"
    ),
    StudyQuantity(
        "sweep_in_bands",
        "stops of the friction sweep whose three counts lie in the bands of valve-actuations",
        "of 130",
        "11 / 11 / 21 in one stop",
        status="predicted",
        digits=0,
    ),
)


@dataclass(frozen=True, slots=True)
class SweptFriction:
    """The repeats at one friction, in the order of their seeds.

    Attributes:
        friction: as written.
        counts: by the names of :data:`~studies.neighbourhood.COUNTED`.
        in_order: whether the order holds with `full`, and with `thermal`, by setting.
        in_bands: whether the paper's three counts lie in their bands.
    """

    friction: str
    counts: Mapping[str, Counts]
    in_order: Mapping[str, NDArray[np.bool_]]
    in_bands: NDArray[np.bool_]


def run(stop_runner: StopRunner) -> StudyFindings:
    """Count actuations with calipers, with compensation and without: at nine points, and over friction."""
    points = neighbourhood(stop_runner)
    by_point = {
        point.title: {name: mean_counts(point.stops[name]).tolist() for name in SHOWN} for point in points
    }
    sweep = [swept_friction(point) for point in friction_sweep(stop_runner)]
    return StudyFindings(
        _values_of_points(by_point) | _values_of_sweep(sweep),
        tables={"actuations": _table(points), "friction-sweep": _sweep_table(sweep)},
        drawings={
            "robustness": partial(draw_points, by_point),
            "robustness-friction": partial(draw_sweep, sweep),
        },
        notes=tuple(_notes(sweep)),
    )


def swept_friction(point: Point) -> SweptFriction:
    """Return the counts at one friction, and where they are as the paper found them."""
    means = {name: mean_counts(stops) for name, stops in point.stops.items()}
    order = {name: in_order(means[FOUR_CALIPER], means[name], means["none"]) for name in ("full", "thermal")}
    counted = counts(point.stops)
    return SweptFriction(point.friction, counted, order, in_bands(counted))


def _values_of_points(by_point: Mapping[str, Mapping[str, Sequence[float]]]) -> dict[str, StudyValue]:
    medians = [{name: median(values) for name, values in by_rig.items()} for by_rig in by_point.values()]
    return {
        "in_order": StudyValue(float(sum(map(_in_order, medians)))),
        "full_over_caliper": spread([_ratio(by_rig["full"], by_rig[FOUR_CALIPER]) for by_rig in medians]),
        "none_over_caliper": spread([_ratio(by_rig["none"], by_rig[FOUR_CALIPER]) for by_rig in medians]),
    }


def _values_of_sweep(sweep: Sequence[SweptFriction]) -> dict[str, StudyValue]:
    shares = {
        name: StudyValue(float(np.mean([each.in_order[name] for each in sweep])) / PERCENT)
        for name in ("full", "thermal")
    }
    return {
        "sweep_in_order": shares["full"],
        "sweep_in_order_thermal": shares["thermal"],
        "sweep_in_bands": StudyValue(float(np.sum([each.in_bands for each in sweep]))),
    }


def _notes(sweep: Sequence[SweptFriction]) -> Iterator[str]:
    yield (
        "Actuations per wheelset, mean of modules 2 to 4. Each point of friction and command stands for the "
        f"median of {len(SEEDS)} stops that differ in the noise of the sensors; the ratios are the median "
        "and the range over the points."
    )
    yield (
        "A point is in order where full lies nearer to the caliper than none does, and none has at least "
        f"{APART} times the actuations of the caliper."
    )
    yield (
        f"Friction sweep: {len(sweep)} frictions from {sweep[0].friction} to {sweep[-1].friction}, "
        f"{len(SEEDS)} stops each, every stop judged for itself. The order is that of modules 2 to 4; the "
        "paper's counts are those of modules 1 and 2."
    )
    where = [f"{np.sum(each.in_bands)} at {each.friction}" for each in sweep if each.in_bands.any()]
    yield f"Stops with all three counts of the paper, by friction: {', '.join(where) or 'none'}."


def _in_order(medians: dict[str, float]) -> bool:
    caliper, full, none = (medians[name] for name in SHOWN)
    return caliper > 0.0 and abs(full - caliper) < abs(none - caliper) and none >= APART * caliper


def _ratio(value: float, reference: float) -> float:
    return value / reference if reference else float("nan")


def _table(points: list[Point]) -> Table:
    rows = [
        (point.friction, point.command, name, seed, stop)
        for point in points
        for name in SHOWN
        for seed, stop in zip(SEEDS, point.stops[name], strict=True)
    ]
    columns: dict[str, list[object]] = {
        "friction": [row[0] for row in rows],
        "command": [row[1] for row in rows],
        "rig": [row[2] for row in rows],
        "seed": [row[3] for row in rows],
    }
    for n in (1, 2, 3, 4):
        columns[f"actuations_{n}"] = [row[4].wheelsets[n - 1]["valve_actuations"] for row in rows]
    return columns


def _sweep_table(sweep: Sequence[SweptFriction]) -> Table:
    rows = [(each, k) for each in sweep for k in range(len(SEEDS))]
    return {
        "friction": [each.friction for each, _ in rows],
        "seed": [SEEDS[k] for _, k in rows],
        **{key: [int(each.counts[key][k]) for each, k in rows] for key in sweep[0].counts},
        "in_order": [bool(each.in_order["full"][k]) for each, k in rows],
        "in_order_thermal": [bool(each.in_order["thermal"][k]) for each, k in rows],
        "in_bands": [bool(each.in_bands[k]) for each, k in rows],
    }


_RIG_TITLES = {
    "four-caliper": "caliper in every module",
    "full": "full compensation",
    "none": "no compensation",
}
_APART = 0.24
"""Distance between the columns of a point, in steps of points."""
_SWEPT = {
    "caliper": ("module 1, caliper", INK, "o"),
    "none": ("module 2, no model", SETTING_COLOURS["none"], "s"),
    "full": ("module 2, both models", SETTING_COLOURS["full"], "^"),
}
"""Label, colour and mark of the counts that the paper gives."""
_ABREAST = 0.2
"""Distance between the marks of one friction, in steps of friction."""


def draw_points(counts: Mapping[str, Mapping[str, Sequence[float]]], figure: Figure) -> None:
    """Draw three columns of dots for each point, a stop a dot, the median a bar; counts by point and rig."""
    figure.set_size_inches(WIDTH, 3.3)
    axes = figure.subplots()
    for place, of in enumerate(counts.values()):
        for k, (name, values) in enumerate(of.items()):
            across, colour = place + (k - 1) * _APART, SETTING_COLOURS[name]
            axes.plot([across] * len(values), values, "o", color=colour, alpha=0.3, markersize=3.5, mew=0.0)
            label = _RIG_TITLES[name] if place == 0 else None
            axes.plot(
                [across - 0.09, across + 0.09], [median(values)] * 2, color=colour, linewidth=2.4, label=label
            )
    axes.set_xticks(range(len(counts)), [title.replace(", ", "\n") for title in counts])
    axes.grid(visible=False, axis="x")
    axes.set(xlabel="friction coefficient and command", ylabel="actuations, mean of modules 2-4")
    title_and_legend(axes, "Valve actuations per wheelset", 3)
    from_zero(axes, across=False)


def draw_sweep(sweep: Sequence[SweptFriction], figure: Figure) -> None:
    """Draw the median and the range of the paper's three counts over friction, and the paper's counts."""
    figure.set_size_inches(WIDTH, 3.3)
    axes = figure.subplots()
    for low, high in set(BANDS.values()):
        axes.axhspan(low, high, color=BAND, zorder=0)
    for count in set(PAPER.values()):
        axes.axhline(count, color=MUTED, linewidth=0.9, linestyle=(0, (4, 2)))
        axes.text(len(sweep) + 0.4, count + 0.2, f"paper: {count}", ha="right", color=MUTED, fontsize=7.0)
    for k, (key, (label, colour, mark)) in enumerate(_SWEPT.items()):
        values = np.array([each.counts[key] for each in sweep])
        middle, across = np.median(values, axis=1), np.arange(len(sweep)) + (k - 1) * _ABREAST
        axes.vlines(across, values.min(axis=1), values.max(axis=1), color=colour, alpha=0.5, linewidth=1.4)
        axes.plot(across, middle, mark, color=colour, markersize=3.5, label=label)
    titles = [f"{each.friction}\n{np.sum(each.in_bands)}/{len(each.in_bands)}" for each in sweep]
    axes.set_xticks(range(len(sweep)), titles)
    axes.set_xlim(-0.6, len(sweep) + 0.4)
    axes.grid(visible=False, axis="x")
    axes.set(xlabel="friction coefficient, and stops with all three counts in the bands", ylabel="actuations")
    title_and_legend(axes, "Valve actuations in one stop: median and range over seeds", 3)
    from_zero(axes, across=False)


STUDY = Study(
    "robustness",
    "Valve actuations over friction, command and sensor noise",
    "one stop: 11 actuations with the caliper, 21 without models, 11 with both",
    QUANTITIES,
    run,
    position=100,
)
