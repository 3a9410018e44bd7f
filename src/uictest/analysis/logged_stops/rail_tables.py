"""What the rail gave in the stops of a log: adhesion over speed and place, friction stop by stop."""

from __future__ import annotations

import math
from collections.abc import Iterator, Sequence
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


def rail_tables(
    uses: Uses, results: Sequence[CaseResult], speeds: dict[str, float]
) -> Iterator[report.CampaignTable]:
    """Yield the tables of the rail; `speeds` are the initial ones by the name of the stop, km/h."""
    if not uses:
        return
    yield _outcome_map(uses, results, speeds)
    highest = max(speeds.values())
    speed_edges = np.arange(0.0, highest + _SPEED_BIN, _SPEED_BIN)
    farthest = max((float(use.windows.place.max()) for use in uses if len(use.windows.place)), default=0.0)
    width = next((each for each in _PLACE_BINS if farthest <= each * _MOST_BINS), _PLACE_BINS[-1])
    place_edges = np.arange(0.0, farthest + width, width)
    by_speed = _Bins("speed", "km/h", speed_edges, [use.windows.speed / KILOMETRE_PER_HOUR for use in uses])
    by_place = _Bins("place", "m", place_edges, [use.windows.place for use in uses])
    for bins in (by_speed, by_place):
        if len(bins.edges) > 1:
            yield bins.map(uses)
            yield bins.table(uses)
    yield _friction_table(uses, speeds)


class _Bins:
    """Windows of sliding by one quantity, those of each stop apart."""

    def __init__(self, name: str, unit: str, edges: Array, values: Sequence[Array]) -> None:
        self.name, self.unit, self.edges = name, unit, edges
        self.numbers = [np.clip(np.digitize(each, edges) - 1, 0, len(edges) - 2) for each in values]

    def adhesion(self, uses: Uses, number: int, wheelset: int) -> list[Array]:
        """Return the adhesion of a wheelset in one bin, stop by stop; stops without any are left out."""
        parts = (
            use.windows.adhesion[(own == number) & (use.windows.wheelset == wheelset)]
            for use, own in zip(uses, self.numbers, strict=True)
        )
        return [part for part in parts if len(part)]

    @property
    def basis(self) -> str:
        return "" if self.name == "speed" else "Place: from the brake command. "

    def range_text(self, number: int) -> str:
        return f"{self.edges[number]:g} to {self.edges[number + 1]:g}"

    def map(self, uses: Uses) -> report.CampaignTable:
        """Return the medians, a row for each bin and a column for each wheelset."""
        wheelsets = _wheelsets(uses)
        columns = [report.CampaignColumn(self.name, f"{self.name}, {self.unit}")]
        columns += [report.CampaignColumn(f"wheelset_{n}", _heading(n), 3) for n in wheelsets]
        rows: list[tuple[Cell, ...]] = []
        for number in reversed(range(len(self.edges) - 1)):
            parts = [self.adhesion(uses, number, n) for n in wheelsets]
            middles = [float(np.median(np.concatenate(part))) if part else _NOT_SEEN for part in parts]
            rows.append((self.range_text(number), *middles))
        where = "over speed" if self.name == "speed" else "over place"
        return report.CampaignTable(
            f"adhesion_over_{self.name}",
            f"Adhesion given, {where}",
            f"Median where the wheelset slides; {_NOT_SEEN}: the brake never reached the limit of the rail."
            f" {self.basis}By {'; '.join(dict.fromkeys(use.known_by for use in uses if use.known_by))}.",
            "map",
            tuple(columns),
            tuple(rows if self.name == "speed" else rows[::-1]),
        )

    def table(self, uses: Uses) -> report.CampaignTable:
        """Return the distribution in every bin of each wheelset."""
        keys = ("windows", "stops_seen"), ("p10", "median", "p90", "low", "high")
        titles = "10 %", "median", "90 %", "median of stops\nfrom", "to"
        columns = [
            report.CampaignColumn(self.name, f"{self.name}, {self.unit}"),
            report.CampaignColumn("wheelset", "wheelset", 0),
            *(
                report.CampaignColumn(key, title, 0)
                for key, title in zip(keys[0], ("windows", "stops"), strict=True)
            ),
            *(report.CampaignColumn(key, title, 3) for key, title in zip(keys[1], titles, strict=True)),
        ]
        rows = tuple(
            (self.range_text(number), wheelset, *_spread(self.adhesion(uses, number, wheelset)))
            for number in range(len(self.edges) - 1)
            for wheelset in _wheelsets(uses)
        )
        return report.CampaignTable(
            f"adhesion_by_{self.name}",
            f"Adhesion by {self.name} and wheelset",
            "Over windows of 0.25 s in which the wheelset slides without being locked; the interval (95 %) is"
            " that of the median over stops, since windows of one stop are alike.",
            "detail",
            tuple(columns),
            tuple(rows),
        )


def _spread(parts: Sequence[Array]) -> tuple[Cell, ...]:
    if not parts:
        return 0, 0, _NOT_SEEN, _NOT_SEEN, _NOT_SEEN, None, None
    own = np.concatenate(parts)
    of_stops = median_of([float(np.median(part)) for part in parts], _CONFIDENCE)
    quantiles = (float(np.quantile(own, level)) for level in (0.1, 0.5, 0.9))
    ends = report.number_cell(of_stops.low), report.number_cell(of_stops.high)
    return len(own), len(parts), *quantiles, *ends


def _wheelsets(uses: Uses) -> list[int]:
    """Return the numbers of the wheelsets whose adhesion is known; 0 stands for all together."""
    known = sorted({int(n) for use in uses for n in use.windows.wheelset})
    return known if known == [0] else [1, 2, 3, 4]


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
        " long enough.",
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
    number = report.number_cell
    rows = (
        (
            *(use.stop, speeds[use.stop], *((number(use.place),) if on_line else ()), use.standing),
            *(number(use.friction), number(use.half_width), use.remark),
        )
        for use in uses
    )
    return report.CampaignTable(
        "friction",
        "Friction of the rail, stop by stop",
        "As `uictest fit` finds it, one coefficient for the whole stop; 95 % confidence for the noise alone.",
        "detail",
        columns,
        tuple(rows),
    )
