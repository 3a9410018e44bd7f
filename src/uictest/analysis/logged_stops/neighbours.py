"""Wheelsets beside their neighbours in the same stops, and what stands out.

In every stop a wheelset is compared with the middle one of the others: speed, rail and noise are the same for
all. Over stops the median of these differences has an interval by order statistics, whatever their
distribution, at 95 % for the four wheelsets together. A wheelset stands out where the whole interval lies
beyond a limit, which is chosen: no interval makes a difference matter that a train may have.
"""

from __future__ import annotations

import math
from collections.abc import Iterator, Sequence
from statistics import median
from typing import Final, NamedTuple

from uictest import report
from uictest.core import statistics
from uictest.core.document import Cell
from uictest.core.series_measures import Estimate, median_of
from uictest.recorded import service_log

_WHEELSETS: Final = (1, 2, 3, 4)
_CONFIDENCE: Final = 1.0 - 0.05 / len(_WHEELSETS)
"""Of the interval of one wheelset: 95 % for all four (Bonferroni)."""
FEWEST: Final = statistics.draws_needed(0.5, _CONFIDENCE, "both")
"""Stops below which no median has an interval."""
_FEWEST_OTHERS: Final = 2
_FEWEST_VENTS: Final = 3
"""Long vents of a stop that say whether a valve answers; chosen."""
_UNANSWERED: Final = 0.5
"""Share of these without an answer from which the valve does not vent; chosen."""
_NAMED: Final = 8
"""Stops that a finding names; chosen."""
Signs = Sequence[service_log.WheelsetSigns]


class NeighbourDifference(NamedTuple):
    """By how much one number of a wheelset differs from that of the middle one of the others.

    Args:
        sign: its kind, a key of `service_log.SIGNS`.
        wheelset: its number.
        own, others: medians over the stops, in the unit of the sign.
        difference: median over stops, in the unit of the sign or in %.
        stops: differences by the name of the stop.
    """

    sign: str
    wheelset: int
    own: float
    others: float
    difference: Estimate
    stops: dict[str, float]

    @property
    def kind(self) -> service_log.SignKind:
        """What is compared."""
        return service_log.SIGNS[self.sign]

    @property
    def limit(self) -> float:
        """The limit of the difference, in its unit."""
        if self.kind.relative:
            return 100.0 * self.kind.limit
        return max(self.kind.limit, self.kind.share * abs(self.others))

    @property
    def unit(self) -> str:
        """The unit of the difference."""
        return "%" if self.kind.relative else self.kind.unit

    @property
    def finding(self) -> str:
        """What the wheelset does that its neighbours do not; empty where nothing stands out."""
        if self.difference.low > self.limit:
            return self.kind.more
        return self.kind.less if self.difference.high < -self.limit else ""

    @property
    def showing(self) -> list[str]:
        """The stops in which the difference lies beyond the limit, the farthest first."""
        sign = math.copysign(1.0, self.difference.value)
        beyond = {name: sign * value for name, value in self.stops.items() if sign * value > self.limit}
        return sorted(beyond, key=lambda name: -beyond[name])


def sliding_sentence(differences: Sequence[NeighbourDifference]) -> str:
    """Return which wheelsets slide more or less than their neighbours; empty where none does.

    No finding: the trailing wheelsets of bogies carry less load, and later ones run on what others cleaned.
    """
    slides = [each for each in differences if each.sign == "slid_distance"]
    more = [each for each in slides if each.difference.low > each.limit]
    less = [each for each in slides if each.difference.high < -each.limit]
    parts = [
        f"{word} than its neighbours: wheelset {', '.join(_with_difference(each) for each in some)}"
        for word, some in (("slides more", more), ("slides less", less))
        if some
    ]
    return f"{'; '.join(parts)}; load and cleaned rail do that to sound trains, too" if parts else ""


def _with_difference(each: NeighbourDifference) -> str:
    return f"{each.wheelset} ({each.difference.value:+.0f} % of the distance)"


def neighbour_differences(signs: Signs) -> list[NeighbourDifference]:
    """Return the differences of every sign and wheelset that some stop shows."""
    return [each for sign in service_log.SIGNS for n in _WHEELSETS for each in _differences(signs, sign, n)]


def _differences(signs: Signs, sign: str, wheelset: int) -> Iterator[NeighbourDifference]:
    relative, limit = service_log.SIGNS[sign].relative, service_log.SIGNS[sign].limit
    known: dict[str, tuple[float, float]] = {}
    for stop in signs:
        numbers = stop.numbers[sign]
        others = [numbers[n - 1] for n in _WHEELSETS if n != wheelset and math.isfinite(numbers[n - 1])]
        if len(others) < _FEWEST_OTHERS or not math.isfinite(numbers[wheelset - 1]):
            continue
        middle = median(others)
        # Two that lie apart do not say which of them is sound.
        if len(others) > 2 or max(others) - min(others) <= limit * (abs(middle) if relative else 1.0):
            known[stop.stop] = numbers[wheelset - 1], middle
    known = {name: pair for name, pair in known.items() if pair[1] or not relative}
    if known:
        values = {
            name: 100.0 * (own / other - 1.0) if relative else own - other
            for name, (own, other) in known.items()
        }
        own, others_ = (median(side) for side in zip(*known.values(), strict=True))
        estimate = median_of(list(values.values()), _CONFIDENCE)
        yield NeighbourDifference(sign, wheelset, own, others_, estimate, values)


_FINDINGS: Final = (
    report.CampaignColumn("wheelset", "wheelset", 0, rank=0),
    report.CampaignColumn("finding", "finding", rank=0),
    report.CampaignColumn("measure", "by", wraps=True, rank=5),
    report.CampaignColumn("own", "it", rank=3),
    report.CampaignColumn("neighbours", "neighbours", rank=2),
    report.CampaignColumn("difference", "difference\n95 % interval", rank=1),
    report.CampaignColumn("shown_in", "shown in", rank=0),
    report.CampaignColumn(report.STOPS, "stops", wraps=True, rank=4),
)


def findings_table(signs: Signs, differences: Sequence[NeighbourDifference]) -> report.CampaignTable:
    """Return what stands out: components of a wheelset that answer late, weakly, wrongly or never."""
    rows = [*_from_differences(differences), *_from_valves(signs), *_from_defects(signs)]
    return report.CampaignTable(
        "findings",
        "Wheelsets that stand out",
        "Against the middle one of the others in the same stops: the whole interval of the median lies"
        " beyond a chosen limit. Valves that never vent and defects of the record: stop by stop.",
        "first",
        _FINDINGS,
        tuple(sorted(rows, key=lambda row: int(row[0] or 0))),
    )


def _from_differences(differences: Sequence[NeighbourDifference]) -> Iterator[tuple[Cell, ...]]:
    for each in differences:
        if not each.finding:
            continue
        alike = [other for other in differences if other.sign == each.sign and other.finding]
        pair = [other for other in alike if other.finding == each.finding]
        contrary = [other for other in alike if other.finding != each.finding]
        wheelset: Cell = each.wheelset
        finding = each.finding
        if len(pair) == len(contrary) == 2:
            if each is not alike[0]:
                continue
            # Two against two do not say which of them are sound: one finding on all four.
            wheelset, finding = None, ", or ".join(_of_pair(two) for two in (pair, contrary))
        kind, digits = each.kind, each.kind.digits
        unit = "" if kind.unit == "1" else f" {kind.unit}"
        shown = each.difference
        places = 1 if kind.relative else digits
        interval = f"{shown.low:+.{places}f} to {shown.high:+.{places}f}"
        yield (
            wheelset,
            finding,
            kind.meaning,
            f"{each.own:.{digits}f}{unit}",
            f"{each.others:.{digits}f}{unit}",
            f"{shown.value:+.{places}f} {each.unit} ({interval})",
            f"{len(each.showing)} of {shown.stops} stops",
            named(each.showing),
        )


def _of_pair(pair: Sequence[NeighbourDifference]) -> str:
    first, second = pair
    return f"{first.wheelset} and {second.wheelset}: {first.finding}"


def _from_valves(signs: Signs) -> Iterator[tuple[Cell, ...]]:
    for n in _WHEELSETS:
        asked = {stop.stop: (stop.unanswered[n - 1], stop.vents[n - 1]) for stop in signs}
        asked = {name: pair for name, pair in asked.items() if pair[1] >= _FEWEST_VENTS}
        silent = [name for name, (without, vents) in asked.items() if without >= _UNANSWERED * vents]
        if silent:
            without, vents = (sum(asked[name][k] for name in silent) for k in (0, 1))
            own = f"{without} of {vents} vents without an answer"
            shown = f"{len(silent)} of {len(asked)} stops"
            yield n, "does not vent", "fall of the pressure in a vent", own, "", "", shown, named(silent)


def _from_defects(signs: Signs) -> Iterator[tuple[Cell, ...]]:
    for n in _WHEELSETS:
        by_kind: dict[str, list[str]] = {}
        first: dict[str, str] = {}
        for stop in signs:
            for defect in stop.defects[n - 1]:
                kind, _, text = defect.partition(" ")
                channel, _, what = text.partition(" ")
                by_kind.setdefault(f"{kind} {channel}", []).append(stop.stop)
                first.setdefault(f"{kind} {channel}", what)
        for kind, stops in by_kind.items():
            shown = f"{len(stops)} of {len(signs)} stops"
            yield n, kind, "defect of the record", f"{first[kind]} ({stops[0]})", "", "", shown, named(stops)


def named(stops: Sequence[str]) -> str:
    """Return the names of stops for a cell; of many the first."""
    more = len(stops) - _NAMED
    return ", ".join(stops[:_NAMED]) + (f" and {more} more" if more > 0 else "")


_COMPARED: Final = (
    report.CampaignColumn("measure", "number"),
    report.CampaignColumn("wheelset", "wheelset", 0),
    report.CampaignColumn("own", "it", "significant"),
    report.CampaignColumn("neighbours", "neighbours", "significant"),
    report.CampaignColumn("unit", "unit"),
    report.CampaignColumn("difference", "difference", "significant"),
    report.CampaignColumn("low", "from", "significant"),
    report.CampaignColumn("high", "to", "significant"),
    report.CampaignColumn("difference_unit", "of it"),
    report.CampaignColumn("limit", "limit", "significant"),
    report.CampaignColumn("stops_compared", "stops", 0),
)


def compared_table(differences: Sequence[NeighbourDifference]) -> report.CampaignTable:
    """Return every difference between a wheelset and its neighbours, with its interval."""
    return report.CampaignTable(
        "wheelsets",
        "Wheelsets beside their neighbours",
        "Median over stops of the difference from the middle one of the others; interval by order statistics,"
        f" 95 % for the four wheelsets of a number together, from {FEWEST} stops on. Limits are chosen.",
        "detail",
        _COMPARED,
        tuple(
            (
                *(each.kind.meaning, each.wheelset, each.own, each.others, each.kind.unit),
                *(each.difference.value, each.difference.low, each.difference.high),
                *(each.unit, each.limit, each.difference.stops),
            )
            for each in differences
        ),
    )
