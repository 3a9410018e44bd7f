"""A programme of tests as reports show it: the table of its tests, and where along friction each is met."""

from __future__ import annotations

import math
from collections import Counter
from collections.abc import Iterator, Mapping, Sequence
from typing import TYPE_CHECKING, NamedTuple

from uictest.core.document import Cell
from uictest.report.content import Campaign, CampaignColumn, CampaignTable, CampaignTest
from uictest.report.words import counted, listed, number, percent

if TYPE_CHECKING:
    from uictest.judging import evaluation
    from uictest.judging.series import JudgedTest
    from uictest.plans.series import ProgrammeFile

_VALID = {"valid": "yes", "not_valid": "no", "not_judged": "not judged"}


class MetRange(NamedTuple):
    """Where along friction a test is valid and met on a rail.

    Attributes:
        test: name of the test.
        rail: rail condition.
        intervals: lowest and highest friction of each interval; an end of the search is infinite.
        judged: whether criteria say if its stops are tests.
        stops: stops that were made for it.
        not_run: stops that could not be run, with which nothing is known.
    """

    test: str
    rail: str
    intervals: tuple[tuple[float, float], ...]
    judged: bool
    stops: int
    not_run: int = 0

    @property
    def text(self) -> str:
        """The intervals as a table shows them."""
        if self.not_run:
            return f"{self.not_run} of {counted(self.stops, 'stop')} could not be run"
        found = ", ".join(_interval_text(low, high) for low, high in self.intervals) or "none"
        return found if self.judged else f"{found} *"


def _interval_text(low: float, high: float) -> str:
    if math.isinf(low):
        return "all" if math.isinf(high) else f"up to {high:.3g}"
    if math.isinf(high):
        return f"from {low:.3g} on"
    return f"{low:.3g} to {high:.3g}" if high > low else f"at {low:.3g}"


_TESTS = (
    CampaignColumn("test", "test"),
    CampaignColumn("valid", "valid\ntest", wraps=True),
    CampaignColumn("rail_valid", "by the\nrail", wraps=True),
    CampaignColumn("distances", "distance\nm", wraps=True),
    CampaignColumn("mean", "mean\nm", 0),
    CampaignColumn("limit", "limit", wraps=True),
    CampaignColumn("verdict", "verdict", wraps=True),
    CampaignColumn("also", "misses of\nour criteria", wraps=True),
    *(CampaignColumn(key, "") for key in ("name", "stops", "valid_stops", "within_limit")),
    *(CampaignColumn(key, "") for key in ("above_m", "below_m", "largest_m")),
)
_INTERVALS = tuple(
    CampaignColumn(key, key) for key in ("test", "rail", "low", "high", "validity_judged", "stops")
)


def programme_campaign(
    file: ProgrammeFile, tests: Sequence[JudgedTest], ranges: Sequence[MetRange], *, strict: bool
) -> Campaign:
    """Return what reports show of a programme.

    Args:
        file: of the programme.
        tests: its tests, judged.
        ranges: where along friction they are met.
        strict: whether a test that is not valid and met fails.
    """
    noted = [test.planned.test for test in tests if test.planned.test.note]
    notes = [f"{test.name}: {test.note}" for test in noted]
    return Campaign(
        sentences=(f"Limits: {file.mark}.", *file.notes, *notes),
        tables=(_tests_table(tests), *_range_tables(file, ranges)),
        title=file.title or file.name,
        headline=_headline(tests, ranges),
        tests=tuple(_ci_test(test, ranges, strict=strict) for test in tests),
    )


def _headline(tests: Sequence[JudgedTest], ranges: Sequence[MetRange]) -> str:
    """Return how many tests with a limit are met, and what became of the others."""
    counts = Counter((test.limits is not None, test.status) for test in tests)
    limited = sum(test.limits is not None for test in tests)
    met = f"{counts.pop((True, 'met'), 0)} of {counted(limited, 'test')} with a limit met"
    parts = [met if limited else "no test with a limit"]
    parts += [
        f"{count} {status}" if has_limit else f"{count} without a limit: {status}"
        for (has_limit, status), count in counts.items()
        if status != "no limit"
    ]
    if also := list(dict.fromkeys(name for test in tests for name in test.missed_requirements)):
        parts.append(f"our own criteria missed: {listed(also)}")
    if not_run := sum(each.not_run for each in ranges):
        parts.append(f"{counted(not_run, 'stop')} along friction could not be run")
    return ", ".join(parts)


def _tests_table(tests: Sequence[JudgedTest]) -> CampaignTable:
    basis = "whether each stop or their mean must keep a limit is not known: both are shown"
    return CampaignTable.of_records("tests", "Tests", basis, "first", _TESTS, map(_record, tests))


def _record(test: JudgedTest) -> Mapping[str, Cell]:
    return {
        "test": test.planned.test.title or test.planned.test.name,
        "valid": _valid_text([stop.test_validity for stop in test.stops]),
        "rail_valid": _valid_text([_rail_validity(stop) for stop in test.stops]),
        "distances": ", ".join(number(distance, 4) for distance in test.distances),
        "mean": test.mean if len(test.stops) > 1 else None,
        "limit": _limit_text(test),
        "verdict": test.status,
        "also": ", ".join(test.missed_requirements),
        "name": test.planned.test.name,
        "stops": len(test.stops),
        "valid_stops": test.valid_stops,
        "within_limit": None if test.limits is None else test.within,
        **{
            f"{name}_m": None if test.limits is None else _finite(getattr(test.limits, name))
            for name in ("above", "below", "largest")
        },
    }


def _finite(value: float) -> float | None:
    return value if math.isfinite(value) else None


def _rail_validity(stop: evaluation.CaseResult) -> str:
    return "not_judged" if stop.rail is None else stop.rail.test_validity


def _valid_text(statuses: Sequence[str]) -> str:
    counts = Counter(_VALID[status] for status in statuses)
    if len(counts) <= 1:
        return next(iter(counts), "-")
    return ", ".join(f"{count} {word}" for word, count in counts.items())


def _limit_text(test: JudgedTest) -> str:
    limit, limits = test.planned.test.distance, test.limits
    if limit is None or limits is None:
        return "none"
    if limit.at_most is not None:
        of = f"{percent(float(limit.at_most))} of {limit.of}"
        return of if math.isnan(limits.largest) else f"up to {number(limits.largest)} m ({of})"
    if limit.below is None:
        return f"above {number(limits.above)} m"
    below = f"{number(limits.below)} m"
    return f"below {below}" if limit.above is None else f"{limit.above.text} to {below}"


def _range_tables(file: ProgrammeFile, ranges: Sequence[MetRange]) -> Iterator[CampaignTable]:
    """Yield the frictions for people, a row for each rail, and for programs, a row for each interval."""
    if not ranges:
        return
    rails = list(dict.fromkeys(each.rail for each in ranges))
    names = list(dict.fromkeys(each.test for each in ranges))
    found = {(each.rail, each.test): each.text for each in ranges}
    titles = {test.name: test.title or test.name for test in file.tests}
    columns = (CampaignColumn("rail", "rail"), *(CampaignColumn(n, titles[n], wraps=True) for n in names))
    assert file.friction is not None
    low, high = file.friction.values[0].text, file.friction.values[-1].text
    stops = sum(each.stops for each in ranges)
    unjudged = "" if all(each.judged for each in ranges) else "; *: no criterion says whether they are tests"
    basis = (
        f"all stops of a test, each under its own seed; sought from {low} to {high}, in"
        f" {counted(stops, 'stop')}{unjudged}"
    )
    records = [{"rail": rail, **{name: found[rail, name] for name in names}} for rail in rails]
    title = "Friction at which each test is valid and met"
    yield CampaignTable.of_records("friction", title, basis, "first", columns, records)
    intervals = [
        {"test": each.test, "rail": each.rail, "low": _finite(low), "high": _finite(high)}
        | {"validity_judged": each.judged, "stops": each.stops}
        for each in ranges
        if not each.not_run
        for low, high in each.intervals
    ]
    basis = f"an end that is empty lies outside of {low} to {high}"
    yield CampaignTable.of_records("intervals", title, basis, "file", _INTERVALS, intervals)


def _ci_test(test: JudgedTest, ranges: Sequence[MetRange], *, strict: bool) -> CampaignTest:
    """Return a test as a CI server is told of it; a stop that cannot be run fails, strict or not."""
    record, also = _record(test), test.missed_requirements
    name = test.planned.test.name
    of_test = [each for each in ranges if each.test == name]
    distances = f"{record['distances']} m" if test.distances else "no stop"
    message = f"{test.status}: {distances} (limit {record['limit']}), valid test: {record['valid']}"
    message += f"; our own criteria missed: {', '.join(also)}" if also else ""
    lines = (message, *(f"friction on {each.rail}: {each.text}" for each in of_test))
    if any(each.not_run for each in of_test):
        return CampaignTest(name, lines, "failure")
    if test.status == "met" and not also:
        return CampaignTest(name, lines, "passed")
    fails = strict and (test.limits is not None or bool(also))
    return CampaignTest(name, lines, "failure" if fails else "skipped")
