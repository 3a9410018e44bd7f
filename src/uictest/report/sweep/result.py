"""The result of a sweep, as `sweep.json` holds it: counts, maps, trends, sensitivities, frontier."""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass
from typing import Annotated, Any, ClassVar, Final

from pydantic import ConfigDict, Field, TypeAdapter

from uictest.core import envelope
from uictest.judging import evaluation
from uictest.judging.evaluation import NamedParts, Number, WrittenCaseResult, required
from uictest.report.content import CaseDescription
from uictest.report.sweep.limits import SurveyStep, SweepDomain
from uictest.report.sweep.values import SweptValue, Written

MET: Final = "met"
"""Name of the map of cases that met their expectation; the other maps have names of measures."""

Circumstances = Mapping[str, Written]
"""The values of the other parameters at which something was found, by key."""


@dataclass(frozen=True, slots=True)
class OutcomeCount:
    """Number of cases with one value of a parameter, by outcome; `met` met their expectation."""

    value: SweptValue
    cases: int
    met: int
    outcomes: Mapping[str, int]

    @property
    def share_met(self) -> float | None:
        """Share of the cases that met their expectation; None without any case."""
        return self.met / self.cases if self.cases else None


@dataclass(frozen=True, slots=True)
class SweptController:
    """A controller under test: name and version as `summary.csv` has them, kind empty if it is built in."""

    name: str
    version: str
    kind: str = ""


@dataclass(frozen=True, slots=True)
class MissedCase:
    """A case that did not meet its expectation."""

    id: str
    outcome: str
    reason: str


@dataclass(frozen=True, slots=True)
class MapAxis:
    """A parameter of a map, and its values."""

    parameter: str
    values: tuple[SweptValue, ...]


@dataclass(frozen=True, slots=True)
class SweepMap:
    """Two parameters against each other; all cells have the shape (rows, columns).

    Args:
        measure: what is mapped: a measure, or :data:`MET`.
        rows: the parameter down.
        columns: the parameter across.
        means: mean of the measure in each cell, None where no case has it.
        met: number of cases that met their expectation.
        cases: number of cases.
        known: number of cases that have the measure; None where the map was read from a file.

    """

    measure: str
    rows: MapAxis
    columns: MapAxis
    means: list[list[float | None]]
    met: list[list[int]]
    cases: list[list[int]]
    known: Annotated[list[list[int]] | None, Field(exclude=True)] = None

    @property
    def shows_met(self) -> bool:
        """Whether the map shows the share of cases that met their expectation."""
        return self.measure == MET


@dataclass(frozen=True, slots=True, kw_only=True)
class MeasureRange:
    """Smallest, mean and largest value of a measure over the cases that have it.

    `columns` are the columns of the summary whose largest value the measure is.
    """

    measure: str
    unit: str
    columns: tuple[str, ...] = ()
    cases: int
    minimum: float
    mean: float
    maximum: float


@dataclass(frozen=True, slots=True, kw_only=True)
class Trend:
    """A measure at each value of a parameter; None where no case has the measure."""

    parameter: str
    values: tuple[SweptValue, ...]
    measure: str
    unit: str
    columns: tuple[str, ...] = ()
    cases: list[int]
    minimum: list[float | None]
    mean: list[float | None]
    maximum: list[float | None]


@dataclass(frozen=True, slots=True)
class SobolIndex:
    """A Sobol index with its 95 % confidence interval."""

    value: Number
    low: Number
    high: Number

    @property
    def uncertainty(self) -> float:
        """Width of the interval."""
        return self.high - self.low


@dataclass(frozen=True, slots=True)
class SobolSensitivity:
    """First-order and total Sobol index of one parameter for one measure, at values of listed parameters."""

    measure: str
    circumstances: Circumstances
    key: str
    first: SobolIndex
    total: SobolIndex


@dataclass(frozen=True, slots=True)
class Flip:
    """Two neighbouring values between which the verdict changes."""

    low: Written
    high: Written
    met_at_low: bool


@dataclass(frozen=True, slots=True)
class FrontierScan:
    """The flips along one parameter for one combination of the others."""

    circumstances: Circumstances
    flips: tuple[Flip, ...]
    note: str


@dataclass(frozen=True, slots=True)
class Frontier:
    """The flips along one parameter for every combination of the others."""

    parameter: str
    scans: Annotated[tuple[FrontierScan, ...], Field(alias="stretches")]


@dataclass(frozen=True, slots=True, kw_only=True)
class SweepResult:
    """The result of a finished sweep.

    Args:
        name: of the sweep.
        title: one line, or empty.
        cases: number of cases.
        met: number of cases that met their expectation.
        outcomes: number of cases by outcome.
        missed: the first cases that did not meet their expectation.
        rates: counts for each value of each parameter, by key.
        maps: of the cases met and of measures.
        measures: the smallest, mean and largest value of each.
        trends: measures along parameters.
        base: the parts of the case that is varied, by role.
        varied: keys of the parameters.
        logarithmic: those of them that were spaced or drawn logarithmically.
        requirements: ids of those that the varied case or its criteria verify.
        test_case: its id in a test management tool, or empty.
        controllers: of all cars of all cases, each once.
        nominal: the case that is varied, or all cars of the train, with how firm the verdicts are; none where
            nobody asked.
        worst: the cases most worth looking at, those not met first.
        subjects: descriptions of these cases, by id.
        sensitivities: Sobol indices.
        frontier: where the verdict flips, None where it was not searched.
        domain_of_validity: how many cases lie outside of what was validated; None where nobody asked.
        survey: the steps of a survey, None where all cases were simulated in their own.
        notes: sentences that every report shows.

    """

    __pydantic_config__: ClassVar = ConfigDict(defer_build=True)

    name: str
    title: str
    cases: int
    met: int
    outcomes: Mapping[str, int]
    missed: tuple[MissedCase, ...]
    rates: Mapping[str, tuple[OutcomeCount, ...]]
    maps: tuple[SweepMap, ...]
    measures: tuple[MeasureRange, ...]
    trends: tuple[Trend, ...]
    base: NamedParts
    varied: tuple[str, ...] = ()
    logarithmic: tuple[str, ...] = ()
    requirements: tuple[str, ...] = ()
    test_case: str = ""
    controllers: tuple[SweptController, ...]
    worst: tuple[WrittenCaseResult, ...]
    subjects: Mapping[str, Annotated[CaseDescription, required("title", "tags", "settings")]]
    sensitivities: tuple[SobolSensitivity, ...]
    frontier: Frontier | None
    domain_of_validity: SweepDomain | None = None
    survey: SurveyStep | None = None
    nominal: tuple[WrittenCaseResult, ...] = ()
    notes: tuple[str, ...]

    def subject(self, case_id: str) -> CaseDescription:
        """Return the description of a case; an empty one where there is none."""
        return self.subjects.get(case_id, CaseDescription())


_RESULT: Final = TypeAdapter(SweepResult)


def sweep_document(result: SweepResult) -> dict[str, Any]:
    """Return the JSON form of a result; parts are there once, by id."""
    form: dict[str, Any] = evaluation.to_json_form(_RESULT, result)
    names = list(form)
    place = names.index("worst")
    of_cases = (case.parts for case in (*result.worst, *result.nominal))
    parts = evaluation.parts_document([result.base, *of_cases])
    head, tail = ({name: form[name] for name in some} for some in (names[:place], names[place:]))
    return {**envelope.head(envelope.RESULT, "sweep"), **head, "parts": parts, **tail}


def read_sweep_document(content: Mapping[str, Any]) -> SweepResult:
    """Return the result in a document. Raises ValueError where it is none."""
    envelope.require(content, envelope.RESULT, "sweep")
    return evaluation.from_json_form(_RESULT, content, context=evaluation.parts_of(content))
