"""A validation as a document for people, as tables and as a page."""

from __future__ import annotations

import math
from collections.abc import Iterator, Sequence
from typing import Final

from uictest.analysis.comparison import OVERLAY_WORDS, Overlay
from uictest.analysis.validation.document import (
    Agreement,
    ComparedStop,
    Differences,
    Validation,
    relative_difference,
)
from uictest.analysis.validation.domain import Domain
from uictest.core.document import Cell, Column, Document, Lines, Table, table_of
from uictest.core.measures import STOP_COLUMNS, without_wheelset
from uictest.core.units import KILOMETRE_PER_HOUR
from uictest.report import counted, interval_text, percent
from uictest.report.page import Effect, case_anchor, forest, fragment, render

_ALWAYS: Final = ("initial_speed", "brake.command", "rail.friction", "rail.gradient", "vehicle.body.mass")
"""Numbers of a domain that are shown even where they are the same in all stops."""
_DISTANCE: Final = "braking_distance_m"
_SETTINGS: Final = ("brake.position", "rig.wsp", "rig.topology", "rig.compensation")
_OF_DIFFERENCES: Final = ("bias", "deviation", "bias_low", "bias_high", "limits_low", "limits_high")
_DRAWS: Final = "one seed per stop"
"""How the simulations behind the intervals of a validation were drawn, as figures.csv says it."""


def _interval_text(low: float, high: float) -> str:
    return "-" if low != low else f"{low:+.4g} .. {high:+.4g}"


def _number_text(value: float) -> str:
    return "-" if value != value else f"{value:.5g}"


def _relative_bias(agreement: Agreement) -> str:
    return "-" if agreement.relative is None else f"{100.0 * agreement.relative.bias:+.2f}"


_STOPS: Final[tuple[Column[ComparedStop], ...]] = (
    Column(heading="stop", text=lambda stop: stop.id, wraps=True, literal=True),
    Column(heading="from", unit="km/h", value=lambda stop: stop.initial_speed / KILOMETRE_PER_HOUR, digits=1),
    Column(heading="recorded", unit="m", value=lambda stop: stop.recorded[_DISTANCE], digits=1),
    Column(heading="simulated", unit="m", value=lambda stop: stop.simulated[_DISTANCE], digits=1),
    Column(
        heading="off",
        unit="%",
        text=lambda stop: f"{100.0 * relative_difference(stop.recorded, stop.simulated):+.2f}",
        right=True,
    ),
)
_FIGURES: Final[tuple[Column[Agreement], ...]] = (
    Column(heading="figure", text=lambda each: each.figure),
    Column(heading="stops", text=lambda each: str(each.stops), right=True),
    Column(heading="recorded", text=lambda each: _number_text(each.recorded_mean), rank=1, right=True),
    Column(heading="bias", text=lambda each: f"{each.absolute.bias:+.4g}", right=True),
    Column(
        heading="interval of bias",
        text=lambda each: _interval_text(each.absolute.bias_low, each.absolute.bias_high),
        right=True,
    ),
    Column(heading="spread", text=lambda each: _number_text(each.absolute.deviation), rank=2, right=True),
    Column(
        heading="limits of agreement",
        text=lambda each: _interval_text(each.absolute.limits_low, each.absolute.limits_high),
        rank=3,
        right=True,
    ),
    Column(heading="bias, %", text=_relative_bias, right=True),
)


def validation_document(validation: Validation, *, every_figure: bool = True) -> Document:
    """Return the answer, stops, figures, domain, remarks; `every_figure`: those of single wheelsets too."""
    furthest_off = sorted(
        validation.counted, key=lambda stop: -abs(relative_difference(stop.recorded, stop.simulated))
    )
    shown = [each for each in validation.figures if every_figure or each.figure in STOP_COLUMNS]
    further = len(validation.figures) - len(shown)
    more = [f"{further} figures of single wheelsets: -v, tables/figures.csv"] if further else []
    domains = [f"domain {n}: {domain_text(each)}" for n, each in enumerate(validation.domains, start=1)]
    about = [validation.title, f"uictest {validation.version}, {tally(validation)}."]
    return Document(
        f"Validation {validation.name}",
        [
            Lines([answer(validation), *_not_counted_lines(validation)]),
            Table(_STOPS, furthest_off, "Stops, the furthest off first", all_in="tables/stops.csv"),
            Table(_FIGURES, shown, "Figures", all_in="tables/figures.csv"),
            Lines(domains, "Domain"),
            Lines([*remarks(validation), *more], "Remarks"),
        ],
        list(filter(None, about)),
    )


def tally(validation: Validation) -> str:
    """Return the number of recorded stops that count, in words."""
    return f"{len(validation.counted)} of {counted(len(validation.stops), 'recorded stop')} counted"


def answer(validation: Validation) -> str:
    """Return how far off the simulated stops are: `simulated stops are 0.6 % longer (...), 4 stops`."""
    distance = next((each for each in validation.figures if each.figure == _DISTANCE), None)
    if distance is None or distance.relative is None:
        return f"no recorded stop counts: nothing is validated ({tally(validation)})"
    bias, low, high = distance.relative.bias, distance.relative.bias_low, distance.relative.bias_high
    stops = counted(distance.stops, "stop")
    if math.isnan(low):
        alike = "1 stop shows no interval" if distance.stops == 1 else f"{stops}, equally far off"
        return f"simulated stops are {_longer(bias)} than recorded: {alike}"
    if low <= 0.0 <= high:
        ends = f"{_longer(low)} to {_longer(high)}"
        return f"no difference is shown by {stops}: simulated ones are {ends} on average"
    near, far = sorted(map(abs, (low, high)))
    ends = f"{100.0 * near:.2g} to {percent(far, 2)}"
    return f"simulated stops are {_longer(bias)} than recorded ({ends}), {stops}"


def _longer(share: float) -> str:
    return f"{percent(abs(share), 2)} {'longer' if share >= 0.0 else 'shorter'}"


def _not_counted_lines(validation: Validation) -> Iterator[str]:
    for stop in validation.stops:
        if not stop.counted:
            why = stop.not_counted or "numbers of its scenario were found with it"
            yield (
                f"not counted: {stop.id} from {stop.initial_speed / KILOMETRE_PER_HOUR:.4g} km/h"
                f" ({stop.recording}): {why}"
            )


def domain_text(domain: Domain) -> str:
    """Return a domain in one sentence; what is the same in all of its stops is counted, but for the usual."""
    conditions = domain.conditions
    names = [f"{key} {name}" for key, name in conditions.names.items()]
    settings = [f"{key} {conditions.settings[key]}" for key in _SETTINGS if key in conditions.settings]
    range_texts = {
        key: interval_text(each.lowest, each.highest, each.unit)
        for key, each in conditions.ranges.items()
        if key in _ALWAYS or each.lowest < each.highest
    }
    ranges = [f"{key} {text}" for key, text in range_texts.items()]
    further = len(conditions.ranges) + len(conditions.settings) - len(range_texts) - len(settings)
    stops = f"{domain.stops} stop" + ("s" if domain.stops > 1 else "")
    listed = "; ".join((*names, *settings, *ranges))
    return f"{stops}: {listed}; {further} further numbers and settings as in these stops"


def remarks(validation: Validation) -> Iterator[str]:
    """Yield the remarks that a reader needs to understand the figures."""
    stops = len(validation.counted)
    if stops == 1:
        yield "one stop: it shows a difference, and nothing of bias or spread"
    elif stops > 1:
        percent = f"{100.0 * validation.confidence:.4g} %"
        yield (
            f"bias: mean of simulated minus recorded; intervals with {percent} by Student's t, for stops that"
            " are independent; limits of agreement: of one further stop"
        )
    if stops:
        yield f"simulated draws: {_draws_text(validation)}"
    if any(stop.repeats == 1 for stop in validation.counted):
        yield "a simulation under one seed is one draw where wheelsets slide; `repeat` compares medians"
    if stops and validation.not_compared:
        # What only one side has says nothing; a reader must know that it was not forgotten.
        columns = dict.fromkeys(without_wheelset(each)[0] for each in validation.not_compared)
        yield f"not compared, as no counted stop has both: {', '.join(columns)}"


def _draws_text(validation: Validation) -> str:
    """Return how the simulations were drawn, which says what the intervals are worth."""
    if any(stop.seed is None for stop in validation.counted):
        return "not known: stops that share a seed and a speed share a draw, and the intervals are too narrow"
    return (
        f"{_DRAWS}, from the seed of its scenario and the SHA-256 of its recording, whatever the other stops"
        " are; tables/stops.csv has it"
    )


def figures_table(validation: Validation) -> Table:
    """Return every figure with its agreement, absolute and as a share of the recorded figure."""
    columns = ("figure", "unit", "stops", "draws", "recorded_mean")
    seeds_known = all(stop.seed is not None for stop in validation.counted)
    relative = [f"relative_{name}" for name in _OF_DIFFERENCES]
    rows: list[dict[str, Cell]] = [
        {
            "figure": each.figure,
            "unit": each.unit,
            "stops": each.stops,
            "draws": _DRAWS if seeds_known else "not known",
            "recorded_mean": each.recorded_mean,
            **_difference_columns(each.absolute, ""),
            **({} if each.relative is None else _difference_columns(each.relative, "relative_")),
        }
        for each in validation.figures
    ]
    return table_of("figures", rows, [*columns, *_OF_DIFFERENCES, *relative])


def _difference_columns(differences: Differences, prefix: str) -> dict[str, float]:
    return {f"{prefix}{name}": getattr(differences, name) for name in _OF_DIFFERENCES}


def stops_table(validation: Validation) -> Table:
    """Return one row for each figure of each stop: recorded, simulated and their difference."""
    columns = (
        *("stop", "recording", "counted", "tuned", "not_counted", "seed", "repeats"),
        *("figure", "recorded", "simulated", "difference"),
    )
    return table_of("stops", [row for stop in validation.stops for row in _rows_of_stop(stop)], columns)


def _rows_of_stop(stop: ComparedStop) -> Iterator[dict[str, Cell]]:
    shared: dict[str, Cell] = {
        "stop": stop.id,
        "recording": stop.recording,
        "counted": stop.counted,
        "tuned": stop.tuned,
        "not_counted": stop.not_counted,
        "seed": stop.seed,
        "repeats": stop.repeats,
    }
    if not stop.recorded:
        yield {**shared}
    for name, recorded in stop.recorded.items():
        simulated = stop.simulated.get(name, float("nan"))
        values = {"recorded": recorded, "simulated": simulated, "difference": simulated - recorded}
        yield {**shared, "figure": name, **values}


def validation_html(validation: Validation, overlays: Sequence[Overlay] = ()) -> str:
    """Return one page of recorded stops against their simulation, some laid over it; it loads nothing."""
    effects = {
        each.figure: _relative_effect(each) for each in validation.figures if each.figure in STOP_COLUMNS
    }
    return render(
        "validation.html.j2",
        with_plots=bool(overlays),
        running_head=validation.name,
        validation=validation,
        document=validation_document(validation),
        answer=answer(validation),
        overlays=overlays,
        comparison={"first": "recorded", "second": "simulated"},
        fragments={overlay.title: fragment(case_anchor(overlay.title)) for overlay in overlays},
        **OVERLAY_WORDS,
        drawn=forest(
            (effect for effect in effects.values() if effect is not None),
            "Bias of each figure with its interval and the limits of agreement; the table has the numbers",
            "simulated - recorded, % of recorded; band: limits of agreement; filled: not 0 by the interval",
        ),
        not_drawn=[figure for figure, effect in effects.items() if effect is None],
    )


def _relative_effect(agreement: Agreement) -> Effect | None:
    """Return the differences in per cent of the recorded figure; None where they have no such share."""
    relative = agreement.relative
    if relative is None:
        return None
    bias, low, high, *outer = (
        100.0 * end
        for end in (
            *(relative.bias, relative.bias_low, relative.bias_high),
            *(relative.limits_low, relative.limits_high),
        )
    )
    if not math.isfinite(bias + low + high + sum(outer)):
        return None
    return Effect(agreement.figure, bias, low, high, (outer[0], outer[1]))
