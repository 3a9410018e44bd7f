"""What the rail gave in the stops of a log: adhesion over speed and place, friction stop by stop."""

from __future__ import annotations

import math
from collections.abc import Iterator, Mapping, Sequence
from typing import Final

import numpy as np
from numpy.typing import NDArray

from uictest import report
from uictest.core.document import Cell
from uictest.core.series_measures import median_of
from uictest.core.units import KILOMETRE_PER_HOUR
from uictest.judging.evaluation import CaseResult
from uictest.recorded import service_log

Array = NDArray[np.float64]
_SPEED_BIN: Final = 20.0
"""km/h; chosen."""
_SPEED_STEP: Final = 10.0
"""km/h to which the initial speeds of stops are rounded; chosen."""
_PLACE_BINS: Final = (10.0, 20.0, 50.0, 100.0, 200.0, 500.0, 1000.0)
_MOST_BINS: Final = 12
"""Bins of places at most: the narrowest of the widths above that needs no more; chosen."""
_FRICTION_BIN: Final = 0.02
"""Chosen."""
_NOT_SEEN: Final = "not seen"
_CONFIDENCE: Final = 0.95
Uses = Sequence[service_log.RailUse]
Bins = Mapping[str, Sequence[Sequence[Array]]]
"""Adhesion by the range of a bin, wheelset and stop; stops without any are left out."""


def rail_tables(
    uses: Uses, results: Sequence[CaseResult], speeds: dict[str, float]
) -> Iterator[report.CampaignTable]:
    """Yield the tables of the rail; `speeds` are the initial ones by the name of the stop, km/h."""
    if not uses:
        return
    yield _outcome_map(uses, results, speeds)
    highest = max(speeds.values())
    farthest = max((float(use.windows.place.max()) for use in uses if len(use.windows.place)), default=0.0)
    width = next((each for each in _PLACE_BINS if farthest <= each * _MOST_BINS), _PLACE_BINS[-1])
    by_speed = [use.windows.speed / KILOMETRE_PER_HOUR for use in uses]
    yield from _adhesion("speed", "km/h", by_speed, np.arange(0.0, highest + _SPEED_BIN, _SPEED_BIN), uses)
    by_place = [use.windows.place for use in uses]
    yield from _adhesion("place", "m", by_place, np.arange(0.0, farthest + width, width), uses)
    yield _friction_table(uses, speeds)


def _adhesion(
    name: str, unit: str, values: Sequence[Array], edges: Array, uses: Uses
) -> Iterator[report.CampaignTable]:
    """Yield the adhesion by one quantity: medians as a map, and the distribution in every bin.

    `values` are those of the windows of sliding, stop by stop; `edges` bound the bins.
    """
    wheelsets = _wheelsets(uses)
    numbers = [np.clip(np.digitize(each, edges) - 1, 0, len(edges) - 2) for each in values]
    bins: dict[str, list[list[Array]]] = {}
    for number in range(len(edges) - 1):
        inside = [(use.windows, own == number) for use, own in zip(uses, numbers, strict=True)]
        parts = ([each.adhesion[own & (each.wheelset == n)] for each, own in inside] for n in wheelsets)
        known = [[part for part in of_stops if len(part)] for of_stops in parts]
        bins[f"{edges[number]:g} to {edges[number + 1]:g}"] = known
    if bins:
        first = report.CampaignColumn(name, f"{name}, {unit}")
        yield _adhesion_map(first, bins, wheelsets, uses)
        yield _adhesion_table(first, bins, wheelsets)


def _adhesion_map(
    first: report.CampaignColumn, bins: Bins, wheelsets: Sequence[int], uses: Uses
) -> report.CampaignTable:
    """Return the medians, a row for each bin and a column for each wheelset."""
    columns = (report.CampaignColumn(f"wheelset_{n}", _heading(n), 3) for n in wheelsets)
    rows = [
        (text, *(float(np.median(np.concatenate(part))) if part else _NOT_SEEN for part in parts))
        for text, parts in bins.items()
    ]
    basis = "Place: from the brake command. " if first.key == "place" else ""
    return report.CampaignTable(
        f"adhesion_over_{first.key}",
        f"Adhesion given, over {first.key}",
        f"Median where the wheelset slides; {_NOT_SEEN}: the brake never reached the limit of the rail."
        f" {basis}By {'; '.join(dict.fromkeys(use.known_by for use in uses if use.known_by))}.",
        "map",
        (first, *columns),
        tuple(rows if first.key == "place" else rows[::-1]),
    )


def _adhesion_table(
    first: report.CampaignColumn, bins: Bins, wheelsets: Sequence[int]
) -> report.CampaignTable:
    """Return the distribution in every bin of each wheelset."""
    return report.CampaignTable(
        f"adhesion_by_{first.key}",
        f"Adhesion by {first.key} and wheelset",
        "Over windows of 0.25 s in which the wheelset slides without being locked; the interval (95 %) is"
        " that of the median over stops, since windows of one stop are alike.",
        "detail",
        (first, *_DISTRIBUTION),
        tuple(
            (text, wheelset, *_spread(part))
            for text, parts in bins.items()
            for wheelset, part in zip(wheelsets, parts, strict=True)
        ),
    )


_DISTRIBUTION: Final = (
    report.CampaignColumn("wheelset", "wheelset", 0),
    report.CampaignColumn("windows", "windows", 0),
    report.CampaignColumn("stops_seen", "stops", 0),
    report.CampaignColumn("p10", "10 %", 3),
    report.CampaignColumn("median", "median", 3),
    report.CampaignColumn("p90", "90 %", 3),
    report.CampaignColumn("low", "median of stops\nfrom", 3),
    report.CampaignColumn("high", "to", 3),
)


def _spread(parts: Sequence[Array]) -> tuple[Cell, ...]:
    if not parts:
        return 0, 0, _NOT_SEEN, _NOT_SEEN, _NOT_SEEN, None, None
    own = np.concatenate(parts)
    of_stops = median_of([float(np.median(part)) for part in parts], _CONFIDENCE)
    return len(own), len(parts), *map(float, np.quantile(own, (0.1, 0.5, 0.9))), of_stops.low, of_stops.high


def _wheelsets(uses: Uses) -> list[int]:
    """Return the numbers of the wheelsets whose adhesion is known; 0 stands for all together."""
    known = sorted({int(n) for use in uses for n in use.windows.wheelset})
    return known if known == [0] else [*(n for n in known if n == 0), 1, 2, 3, 4]


def _heading(wheelset: int) -> str:
    return f"wheelset {wheelset}" if wheelset else "all wheelsets"


def _outcome_map(uses: Uses, results: Sequence[CaseResult], speeds: dict[str, float]) -> report.CampaignTable:
    """Return the outcomes of the stops by initial speed and friction of the rail."""
    outcomes = {result.id: result.outcome for result in results}
    known = [use for use in uses if use.standing == "found"]
    frictions = {use.stop: int(use.friction / _FRICTION_BIN) for use in known}
    rows_of = {name: _SPEED_STEP * round(speed / _SPEED_STEP) for name, speed in speeds.items()}
    bins = sorted(set(frictions.values()))
    columns = [report.CampaignColumn("initial_speed", "from about\nkm/h")]
    columns += [
        report.CampaignColumn(
            f"friction_{k * _FRICTION_BIN:.2f}", f"{k * _FRICTION_BIN:.2f} to {(k + 1) * _FRICTION_BIN:.2f}"
        )
        for k in bins
    ]
    columns.append(report.CampaignColumn("friction_not_seen", _NOT_SEEN))
    rows: list[tuple[Cell, ...]] = []
    for row in sorted(set(rows_of.values()), reverse=True):
        stops = [use.stop for use in uses if rows_of[use.stop] == row]
        cells = [_outcomes_text([outcomes[s] for s in stops if frictions.get(s) == k]) for k in bins]
        unseen = _outcomes_text([outcomes[s] for s in stops if s not in frictions])
        rows.append((f"{row:g}", *cells, unseen))
    return report.CampaignTable(
        "outcomes_over_speed_and_friction",
        "Stops by speed and friction",
        "Friction as fitted to each stop (initial coefficient of the creep law); not seen: no wheelset slid"
        " long enough, or no single coefficient describes the stop.",
        "map",
        tuple(columns),
        tuple(rows),
    )


def _outcomes_text(outcomes: Sequence[str]) -> str:
    return ", ".join(f"{outcomes.count(each)} {each}" for each in dict.fromkeys(sorted(outcomes)))


def _friction_table(uses: Uses, speeds: dict[str, float]) -> report.CampaignTable:
    on_line = any(math.isfinite(use.place) for use in uses)
    columns = (
        report.CampaignColumn(report.STOPS, "stop"),
        report.CampaignColumn("speed_kmh", "from, km/h", 1),
        *((report.CampaignColumn("place_m", "at, m", 0),) if on_line else ()),
        report.CampaignColumn("standing", "friction"),
        report.CampaignColumn("friction", "coefficient", 4),
        report.CampaignColumn("half_width", "+-", 4),
        report.CampaignColumn("remark", "remark", wraps=True),
    )
    rows = (
        (
            *(use.stop, speeds[use.stop], *((use.place,) if on_line else ()), use.standing),
            *(use.friction, use.half_width, use.remark),
        )
        for use in uses
    )
    return report.CampaignTable(
        "friction",
        "Friction of the rail, stop by stop",
        "As `uictest fit` finds it, one coefficient for the whole stop; 95 % confidence for the noise alone."
        " Not one: no single coefficient describes the stop.",
        "detail",
        columns,
        tuple(rows),
    )
