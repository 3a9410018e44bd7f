"""A validation as lines, as CSV and as Markdown."""

from __future__ import annotations

from collections.abc import Iterable, Iterator
from typing import Final

from uictest.analysis.validation.document import Validation
from uictest.analysis.validation.domain import Conditions, Domain
from uictest.analysis.validation.stops import Agreement, ComparedStop, Differences
from uictest.core.measures import STOP_COLUMNS, WHEELSET_COLUMNS
from uictest.core.units import KILOMETRE_PER_HOUR
from uictest.report import (
    Cell,
    Table,
    TableColumn,
    aligned,
    columns_not_shown,
    counted,
    csv_text,
    fitted,
    interval_text,
    printable,
    prose,
)

_ALWAYS: Final = ("initial_speed", "brake.command", "rail.friction", "rail.gradient", "vehicle.body.mass")
"""Numbers of a domain that are shown even where they are the same in all stops."""
_DISTANCE: Final = "braking_distance_m"
_SETTINGS: Final = ("brake.position", "rig.wsp", "rig.topology", "rig.compensation")
_OF_DIFFERENCES: Final = ("bias", "deviation", "bias_low", "bias_high", "limits_low", "limits_high")
_DRAWS: Final = "one seed per stop"
"""How the simulations behind the intervals of a validation were drawn, as figures.csv says it."""
_TABLE: Final = ("stops", "recorded", "bias", "interval of bias", "spread", "limits of agreement", "bias, %")


def validation_lines(validation: Validation, width: int | None, *, every_figure: bool) -> Iterator[str]:
    """Yield stops, figures, domain and remarks, in so many characters.

    Args:
        validation: what is shown.
        width: of the terminal; None for a stream that is none.
        every_figure: whether the figures of single wheelsets are shown as well.
    """
    yield from _stop_lines(validation)
    shown = [each for each in validation.figures if every_figure or each.figure in STOP_COLUMNS]
    if shown:
        columns, hidden = fitted(_columns(shown), width)
        yield from aligned(columns)
        if hidden:
            yield columns_not_shown(hidden, "figures.csv has them")
    yield from _domain_lines(validation)
    yield from remarks(validation)
    further = len(validation.figures) - len(shown)
    if further:
        yield f"{further} figures of single wheelsets: -v, figures.csv"


def tally(validation: Validation) -> str:
    """Return how many of the recorded stops count."""
    return f"{len(validation.counted)} of {counted(len(validation.stops), 'recorded stop')} counted"


def _stop_lines(validation: Validation) -> Iterator[str]:
    for stop in validation.stops:
        one, other = (each.get(_DISTANCE, float("nan")) for each in (stop.recorded, stop.simulated))
        figures = f"recorded {_number(one)} m, simulated {_number(other)} m ({_percent(one, other)})"
        speed = f"from {stop.initial_speed / KILOMETRE_PER_HOUR:.4g} km/h"
        if stop.tuned:
            figures += "; not counted: numbers of its scenario were found with it"
        shown = f"not counted: {stop.not_counted}" if stop.not_counted else figures
        yield printable(f"stop {stop.id} {speed}: {shown}")


def _percent(recorded: float, simulated: float) -> str:
    share = (simulated - recorded) / recorded if recorded else float("nan")
    return "-" if share != share else f"{100.0 * share:+.2f} %"


def _columns(figures: Iterable[Agreement]) -> list[TableColumn]:
    listed = list(figures)
    cells = [_cells(each) for each in listed]
    ranks = dict(zip(_TABLE, (0, 4, 0, 1, 2, 3, 5), strict=True))
    return [
        TableColumn("figure", [each.figure for each in listed]),
        *(
            TableColumn(title, [row[place] for row in cells], ranks[title], right=True)
            for place, title in enumerate(_TABLE)
        ),
    ]


def _cells(agreement: Agreement) -> tuple[str, ...]:
    one = agreement.absolute
    relative = "-" if agreement.relative is None else f"{100.0 * agreement.relative.bias:+.2f}"
    return (
        str(agreement.stops),
        _number(agreement.recorded_mean),
        f"{one.bias:+.4g}",
        _interval(one.bias_low, one.bias_high),
        _number(one.deviation),
        _interval(one.limits_low, one.limits_high),
        relative,
    )


def _interval(low: float, high: float) -> str:
    return "-" if low != low else f"{low:+.4g} .. {high:+.4g}"


def _number(value: float) -> str:
    return "-" if value != value else f"{value:.5g}"


def _domain_lines(validation: Validation) -> Iterator[str]:
    for number, domain in enumerate(validation.domains, start=1):
        yield f"domain {number}: {domain_text(domain)}"


def domain_text(domain: Domain) -> str:
    """Return a domain in one sentence; what is the same in all of its stops is counted, but for the usual."""
    conditions = domain.conditions
    names = [f"{key} {name}" for key, name in conditions.names.items()]
    settings = [f"{key} {conditions.settings[key]}" for key in _SETTINGS if key in conditions.settings]
    shown = [key for key in conditions.ranges if key in _ALWAYS or _varies(conditions, key)]
    ranges = [f"{key} {_range_text(conditions, key)}" for key in shown]
    further = len(conditions.ranges) + len(conditions.settings) - len(shown) - len(settings)
    stops = f"{domain.stops} stop" + ("s" if domain.stops > 1 else "")
    listed = "; ".join((*names, *settings, *ranges))
    return printable(f"{stops}: {listed}; {further} further numbers and settings as in these stops")


def _varies(conditions: Conditions, key: str) -> bool:
    interval = conditions.ranges[key]
    return interval.lowest < interval.highest


def _range_text(conditions: Conditions, key: str) -> str:
    interval = conditions.ranges[key]
    return interval_text(interval.lowest, interval.highest, interval.unit)


def remarks(validation: Validation) -> Iterator[str]:
    """Yield what a reader must know besides the figures."""
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
        yield f"simulated draws: {_draws(validation)}"
    if any(stop.repeats == 1 for stop in validation.counted):
        yield "a simulation under one seed is one draw where wheelsets slide; `repeat` compares medians"
    if stops and validation.not_compared:
        # What only one side has says nothing; a reader must know that it was not forgotten.
        columns = dict.fromkeys(map(_column_of, validation.not_compared))
        yield f"not compared, as no counted stop has both: {', '.join(columns)}"


def _draws(validation: Validation) -> str:
    """Return how the simulations were drawn, and so what the intervals are worth."""
    if any(stop.seed is None for stop in validation.counted):
        return "not known: stops that share a seed and a speed share a draw, and the intervals are too narrow"
    return (
        f"{_DRAWS}, from the seed of its scenario and the SHA-256 of its recording, whatever the other stops"
        " are; stops.csv has it"
    )


def _column_of(figure: str) -> str:
    """Return the column of results that a figure is from: of a wheelset without its number."""
    stem, _, number = figure.rpartition("_")
    return stem if stem in WHEELSET_COLUMNS and number.isdigit() else figure


def figures_csv(validation: Validation) -> str:
    """Return the table of the figures as CSV."""
    return csv_text(*figures_table(validation))


def figures_table(validation: Validation) -> Table:
    """Return every figure with its agreement, absolute and as a share of the recorded figure."""
    columns = ("figure", "unit", "stops", "draws", "recorded_mean")
    known = all(stop.seed is not None for stop in validation.counted)
    relative = [f"relative_{name}" for name in _OF_DIFFERENCES]
    rows: list[dict[str, Cell]] = [
        {
            "figure": each.figure,
            "unit": each.unit,
            "stops": each.stops,
            "draws": _DRAWS if known else "not known",
            "recorded_mean": each.recorded_mean,
            **_values(each.absolute, ""),
            **({} if each.relative is None else _values(each.relative, "relative_")),
        }
        for each in validation.figures
    ]
    return Table([*columns, *_OF_DIFFERENCES, *relative], rows)


def _values(differences: Differences, prefix: str) -> dict[str, float]:
    return {f"{prefix}{name}": getattr(differences, name) for name in _OF_DIFFERENCES}


def stops_csv(validation: Validation) -> str:
    """Return the table of the stops as CSV."""
    return csv_text(*stops_table(validation))


def stops_table(validation: Validation) -> Table:
    """Return one row for each figure of each stop: recorded, simulated and their difference."""
    columns = (
        *("stop", "recording", "counted", "tuned", "not_counted", "seed", "repeats"),
        *("figure", "recorded", "simulated", "difference"),
    )
    return Table(columns, [row for stop in validation.stops for row in _rows(stop)])


def _rows(stop: ComparedStop) -> Iterator[dict[str, Cell]]:
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


def markdown(validation: Validation) -> str:
    """Return the validation as a page in Markdown."""
    lines = [f"# Validation {prose(validation.name)}", ""]
    if validation.title:
        lines += [prose(validation.title), ""]
    lines += [f"uictest {validation.version}, {tally(validation)}.", "", "## Stops", ""]
    lines += [f"- {prose(line)}" for line in _stop_lines(validation)]
    lines += ["", "## Figures", "", *_markdown_table(validation.figures), "", "## Domain", ""]
    lines += [f"- {prose(line)}" for line in _domain_lines(validation)]
    lines += ["", "## Remarks", "", *(f"- {prose(line)}" for line in remarks(validation))]
    return "\n".join(lines) + "\n"


def _markdown_table(figures: Iterable[Agreement]) -> Iterator[str]:
    yield f"| figure | {' | '.join(_TABLE)} |"
    yield f"|---|{'---:|' * len(_TABLE)}"
    for each in figures:
        yield f"| {each.figure} | {' | '.join(_cells(each))} |"
