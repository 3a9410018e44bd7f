"""The result of a series: stops, measures with their confidence, verdicts and outcome; its document."""

from __future__ import annotations

import math
from collections.abc import Mapping, Sequence
from dataclasses import dataclass
from operator import attrgetter
from typing import Annotated, Any, Final

from pydantic import (
    BeforeValidator,
    ConfigDict,
    Field,
    PlainSerializer,
    PlainValidator,
    SerializerFunctionWrapHandler,
    TypeAdapter,
    ValidationInfo,
    WrapSerializer,
)

from uictest.core.series_measures import SERIES_MEASURES, Estimate, Rail, SeriesValue
from uictest.judging import evaluation
from uictest.judging.evaluation import (
    CaseResult,
    Outcome,
    Verdict,
    WrittenFirmness,
    absent_if_empty,
    is_expected,
    json_form,
)
from uictest.plans.scenario import WrittenExpectation
from uictest.plans.series import Role

_NUMBERS: Final = ("value", "low", "high", "smallest", "largest", "covered")


def _with_nulls(value: object, write: SerializerFunctionWrapHandler) -> dict[str, Any]:
    form: dict[str, Any] = json_form(write(value))
    return form


def _with_nan(content: object) -> object:
    """Return an estimate, or a value that has one, with NaN for the numbers that it lacks."""
    if isinstance(content, Mapping):
        return {
            name: math.nan if value is None and name in _NUMBERS else _with_nan(value)
            for name, value in content.items()
        }
    return content


WrittenEstimate = Annotated[Estimate, WrapSerializer(_with_nulls), BeforeValidator(_with_nan)]
"""An estimate whose missing numbers are null in JSON."""

WrittenValue = Annotated[SeriesValue, WrapSerializer(_with_nulls), BeforeValidator(_with_nan)]
"""The value of a measure of series; what has no number is null in JSON."""


def _case_named(name: object, info: ValidationInfo) -> CaseResult:
    """Return the case of an id; the context of the validation holds all by id."""
    cases: Mapping[object, CaseResult] = info.context or {}
    if not isinstance(name, str) or name not in cases:
        raise ValueError(f"the document has no case {name!r}")
    return cases[name]


NamedCase = Annotated[CaseResult, PlainValidator(_case_named), PlainSerializer(attrgetter("id"))]
"""In JSON a series names its cases by their ids."""


@dataclass(frozen=True, slots=True)
class SeriesCase:
    """The result of one case of a series; a repeated case holds several stops."""

    role: Role
    speed_kmh: float
    case: NamedCase
    rail: Rail = ""


@dataclass(frozen=True, slots=True)
class StopCounts:
    """How many stops were run, and how many of them count."""

    run: int
    counted: int

    @property
    def share(self) -> float:
        """The share of stops that count; 0 without any."""
        return self.counted / self.run if self.run else 0.0


@dataclass(frozen=True, slots=True)
class UncountedStop:
    """A stop that does not count as a test of its series, and why. `seed` is None where it has no repeats."""

    case: str
    role: Role
    seed: int | None
    outcome: Outcome
    reason: str


@dataclass(frozen=True, slots=True)
class SpeedResult:
    """What the stops from one nominal initial speed (km/h) show.

    `dry` and `wet` count the stops; `measures` maps the name of a measure of series to its value. Where the
    wet stops of a series are on several kinds of rail, each has a result of its own, and `rail` names it.
    """

    speed_kmh: float
    dry: StopCounts
    wet: StopCounts
    measures: Mapping[str, WrittenValue]
    rail: Rail = ""

    @property
    def place(self) -> str:
        """The speed, and the rail where there are several, as text."""
        return place_text(self.speed_kmh, self.rail)


def place_text(speed_kmh: float | None, rail: str) -> str:
    """Return a speed, and the rail where there are several: `120 km/h, cleaned rail`; empty without both."""
    if speed_kmh is None:
        return f"all speeds, {rail} rail" if rail else ""
    return f"{speed_kmh:g} km/h{f', {rail} rail' if rail else ''}"


WrittenVerdict = Annotated[Verdict, absent_if_empty("requirements", "over_stops", "missed_by", "lacks_data")]
"""In JSON what only some verdicts have is absent from the others."""


@dataclass(frozen=True, slots=True)
class SeriesVerdict:
    """The verdict of one criterion over a series.

    Args:
        verdict: status, value, bounds, margin and reason, as for a stop.
        estimate: the value with its interval, in the unit of the verdict; None where there is none.
        confident: whether the whole interval says the same; None without an interval.
        speed_kmh: the initial speed that decides; None where all do.
        rail: the kind of rail that decides, where the series has several and not all do.
        kept: for a criterion of stops: how many of the stops keep it that count and that it applies to.
        stops: of how many.
        of_dry_stop: whether value and bounds are in % of the dry stop.

    """

    verdict: WrittenVerdict
    estimate: WrittenEstimate | None = None
    confident: bool | None = None
    speed_kmh: float | None = None
    kept: int | None = None
    stops: int | None = None
    of_dry_stop: bool = False
    rail: Rail = ""

    @property
    def place(self) -> str:
        """The speed and rail that decide, as text; empty where all do."""
        return place_text(self.speed_kmh, self.rail)


_WrittenSpeed = Annotated[SpeedResult, absent_if_empty("rail")]
_WrittenCase = Annotated[SeriesCase, absent_if_empty("rail")]
_WrittenVerdict = Annotated[SeriesVerdict, absent_if_empty("rail")]


@dataclass(frozen=True, slots=True)
class SeriesResult:
    """One series, judged.

    `file` is shown with forward slashes. `confidence` is that of all intervals, `valid_stops` the least share
    of wet stops that must count; both are shares of 1. `speed_tolerance_kmh` is that of the initial speed.
    `measures` are those of the whole series. `requirements` are the ids of those that the series verifies as
    a whole; its criteria may verify others. `test_case` is its id in a test management tool. `bypassed_k_wet`
    is K_wet of the same wet stops with the WSP bypassed, where K_wet is judged; `firmness` says whether
    numbers that nobody measured turn the verdicts, where that was asked. The document has these four only
    where there is something in them.
    """

    id: str
    file: str
    title: str
    parameters: Mapping[str, str]
    expect: WrittenExpectation
    outcome: Outcome
    reason: str
    confidence: Annotated[float, Field(gt=0.0, lt=1.0)]
    valid_stops: Annotated[float, Field(gt=0.0, le=1.0)]
    speed_tolerance_kmh: Annotated[float, Field(ge=0.0)]
    criteria: tuple[_WrittenVerdict, ...]
    measures: Mapping[str, WrittenValue]
    speeds: tuple[_WrittenSpeed, ...]
    not_counted: tuple[UncountedStop, ...]
    cases: tuple[_WrittenCase, ...]
    requirements: tuple[str, ...] = ()
    test_case: str = ""
    bypassed_k_wet: WrittenValue | None = None
    firmness: WrittenFirmness | None = None

    @property
    def wet_stops(self) -> StopCounts:
        """How many wet stops of all speeds were run, and how many count."""
        wet = [speed.wet for speed in self.speeds]
        return StopCounts(sum(each.run for each in wet), sum(each.counted for each in wet))

    @property
    def strict(self) -> bool:
        """Whether its cases are met only if nothing is left open; then it is, too."""
        return any(each.case.strict for each in self.cases)

    @property
    def as_expected(self) -> bool:
        """Whether it came out as expected, by the criteria that are named for it."""
        return is_expected(self.outcome, (each.verdict for each in self.criteria), self.expect)

    @property
    def unsettled(self) -> tuple[tuple[str, Verdict], ...]:
        """What keeps a strict series from being met: the id of a case, or of the series, and the verdict."""
        own = [(self.id, each.verdict) for each in self.criteria if self.strict and not each.verdict.settled]
        judged = [each.case for each in self.cases if each.role != "bypassed"]
        return (*own, *((case.id, verdict) for case in judged for verdict in case.unsettled))

    @property
    def met(self) -> bool:
        """Whether it is as expected and, if its cases are `strict`, firm and settled in every verdict."""
        uses_allowance = self.expect.is_allowance and self.outcome != "pass"
        is_open = self.strict and (self.expect.lacks_names or uses_allowance)
        return self.as_expected and not (self.unsettled or self.lacks_firmness or is_open)

    @property
    def is_firm(self) -> bool:
        """Whether it was asked how firm the outcome is, and this very outcome is shown to be."""
        return self.firmness is not None and self.firmness.shows(self.outcome)

    @property
    def lacks_firmness(self) -> bool:
        """Whether, if its cases are `strict`, it was asked how firm it is, and it is not shown to be."""
        return self.strict and self.firmness is not None and not self.is_firm


_FIELDS: Final = frozenset({"parts", "cases", "series"})
_WrittenSeries = Annotated[
    SeriesResult, evaluation.absent_if_empty("requirements", "test_case", "bypassed_k_wet", "firmness")
]
_SERIES: Final = TypeAdapter(list[_WrittenSeries], config=ConfigDict(extra="forbid", defer_build=True))


def series_document(results: Sequence[SeriesResult]) -> dict[str, Any]:
    """Return `{"parts": {...}, "cases": [...], "series": [...]}`.

    A series names its cases by their ids; the cases of all series stand once, as in a result document.
    """
    cases = [each.case for result in results for each in result.cases]
    return {
        "parts": evaluation.parts_document(case.parts for case in cases),
        "cases": evaluation.cases_document(cases),
        "series": evaluation.to_json_form(_SERIES, list(results)),
    }


def series_results_of(document: object) -> list[SeriesResult]:
    """Return the series in the form that :func:`series_document` gives.

    Raises ValueError where it lacks or adds a field, holds a value of another type, or names a case that it
    does not hold.
    """
    if not isinstance(document, Mapping):
        raise ValueError(f"series: expected an object, found {document!r}")
    if document.keys() != _FIELDS:
        raise ValueError(f"series: expected the fields {', '.join(sorted(_FIELDS))}")
    cases = evaluation.cases_of(document["cases"], evaluation.parts_of(document), "series.cases")
    by_id = {case.id: case for case in cases}
    if len(by_id) < len(cases):
        raise ValueError("series.cases: two cases have the same id")
    results = evaluation.from_json_form(_SERIES, document["series"], place="series", context=by_id)
    for place, result in enumerate(results):
        _require_possible(result, f"series.{place}")
    return results


def _require_possible(result: SeriesResult, place: str) -> None:
    """Raise ValueError for a measure that no series has, or for more stops than there are."""
    for measures in (result.measures, *(speed.measures for speed in result.speeds)):
        if unknown := sorted(measures.keys() - SERIES_MEASURES.keys()):
            raise ValueError(f"{place}: no series has a measure {unknown[0]!r}")
    for each in result.criteria:
        if each.kept is not None and not 0 <= each.kept <= (each.stops or 0):
            raise ValueError(f"{place}.criteria: {each.kept} of {each.stops} stops keep {each.verdict.id!r}")
    for speed in result.speeds:
        for counts in (speed.dry, speed.wet):
            if not 0 <= counts.counted <= counts.run:
                raise ValueError(f"{place}.speeds: {counts.counted} of {counts.run} stops count")
