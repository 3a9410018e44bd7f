"""The result of a sweep, as `results.json` holds it: counts, maps, trends, sensitivities, frontier."""

from __future__ import annotations

import json
from collections.abc import Mapping
from dataclasses import dataclass, field
from pathlib import Path
from typing import Annotated, Any, ClassVar, Final

from pydantic import ConfigDict, Field, TypeAdapter

from uictest.core import envelope, files
from uictest.judging import evaluation
from uictest.judging.evaluation import Deviation, NamedParts, Number, WrittenCaseResult, required
from uictest.report.content import CaseDescription
from uictest.report.formats import WITH_TEST_PROPERTIES
from uictest.report.run_folder import RESULTS, read_traces, require_names
from uictest.report.sweep.values import SweptValue, Written
from uictest.report.traces.trace import PlotTrace


@dataclass(frozen=True, slots=True)
class OutsideCount:
    """The cases beyond what was validated in one condition; of numbers, `found` spans all of theirs."""

    cases: int
    deviation: Deviation


@dataclass(frozen=True, slots=True)
class SweepDomain:
    """How many cases lie outside of the domain of a validation.

    Args:
        validation: its name.
        sha256: SHA-256 of its file.
        outside: number of cases with any condition beyond it.
        conditions: those conditions, the one of most cases first; a case may be in several.
    """

    validation: str
    sha256: str
    outside: int
    conditions: tuple[OutsideCount, ...] = ()


@dataclass(frozen=True, slots=True)
class SurveyBias:
    """What the survey step moves a measure by, as shares of its mean.

    Args:
        measure: its name.
        bias: of the mean over many stops, at most: the farther end of its 95 % interval, in the shipped case
            in which that is largest.
        case: this case.
        of_single_stops: what 95 % of the single stops of a shipped case differ by at most, in the case in
            which that is largest. Where WSP cycling makes stops differ anyway, this is mostly their scatter.
    """

    measure: str
    bias: float
    case: str
    of_single_stops: float


@dataclass(frozen=True, slots=True)
class SurveyStep:
    """The steps of a survey.

    Args:
        time_step: time step that the cases were simulated in, as written.
        regular_step: that those were repeated in of which a value lay within its bias of a limit, and those
            that the survey step could not simulate or decide, as written.
        repeated: number of these cases.
        biases: biases of the measures that are judged or mapped.
        unknown: names of those whose bias is not known: every case in which one is judged is repeated.
    """

    time_step: str
    regular_step: str
    repeated: int
    biases: tuple[SurveyBias, ...]
    unknown: tuple[str, ...] = ()


VALID: Final = ("pass", "fail")
"""Outcomes of cases that are valid tests."""
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
        valid: number of cases that are valid tests; None where an older version wrote the result.
        known: number of cases that have the measure; None where the map was read from a file.
    """

    measure: str
    rows: MapAxis
    columns: MapAxis
    means: list[list[float | None]]
    met: list[list[int]]
    cases: list[list[int]]
    valid: list[list[int]] | None = None
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
        name: name of the sweep.
        title: one line, or empty.
        cases: number of cases.
        met: number of cases that met their expectation.
        outcomes: number of cases by outcome.
        missed: the first cases that did not meet their expectation.
        rates: counts for each value of each parameter, by key.
        maps: maps of the cases met and of measures.
        measures: the smallest, mean and largest value of each.
        trends: measures along parameters.
        base: the parts of the case that is varied, by role.
        varied: keys of the parameters.
        logarithmic: those of them that were spaced or drawn logarithmically.
        requirements: ids of those that the varied case or its criteria verify.
        test_case: its id in a test management tool, or empty.
        controllers: controllers of all cars of all cases, each once.
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
    of_cases = (case.parts for case in (*result.worst, *result.nominal))
    document: dict[str, Any] = dict(envelope.head(envelope.RESULT, "sweep"))
    for name, value in form.items():
        if name == "worst":
            document["parts"] = evaluation.parts_document([result.base, *of_cases])
        document[name] = value
    return document


def read_sweep_document(content: Mapping[str, Any]) -> SweepResult:
    """Return the result in a document. Raises ValueError where it is none."""
    envelope.require(content, envelope.RESULT, "sweep")
    return evaluation.from_json_form(_RESULT, content, context=evaluation.parts_of(content))


@dataclass(frozen=True, slots=True)
class SweepContent:
    """What a report of a sweep shows.

    Args:
        folder: folder of the sweep; it holds the tables.
        result: what `results.json` holds.
        manifest: where the results come from.
        traces: what there is to draw of the worst cases, by id.
    """

    folder: Path
    result: SweepResult
    manifest: Mapping[str, Any]
    traces: Mapping[str, PlotTrace] = field(default_factory=dict)


def read_sweep(folder: Path, *, traces: bool = False) -> SweepContent:
    """Return the sweep in a folder; with `traces`, what there is to draw of its worst cases, too.

    Raises OSError, and ValueError where results.json, manifest.json or a recording is not what it should be.
    """
    path = folder / RESULTS
    document = _read_object(path, "the result")
    try:
        result = read_sweep_document(document)
        require_names(case.id for case in result.worst)
    except ValueError as error:
        raise ValueError(f"{path}: not the result of a sweep: {error}") from error
    drawn = read_traces(folder, result.worst) if traces else {}
    return SweepContent(folder, result, _read_object(folder / "manifest.json", "the manifest"), drawn)


def _read_object(path: Path, what: str) -> dict[str, Any]:
    try:
        content = json.loads(path.read_bytes())
        if not isinstance(content, dict):
            raise ValueError("expected an object")
    except (ValueError, RecursionError) as error:  # RecursionError: nested deeper than JSON is read
        raise ValueError(f"{path}: not {what} of a sweep: {error}") from error
    return content


_OF_ONE_RESULT: Final = ("tables/*.csv", WITH_TEST_PROPERTIES, "index.html", "report.xlsx", "summary.md")
"""Files that not every result has, or that not every run writes."""


def write_sweep_result(folder: Path, result: SweepResult) -> str:
    """Write `results.json` and return its text.

    Files that an earlier, other result of the sweep left in the folder are removed: they would be wrong.
    Raises OSError.
    """
    document = evaluation.to_json(sweep_document(result))
    path = folder / RESULTS
    if path.is_file() and path.read_text("utf-8") != document:
        files.remove_listed(folder, *_OF_ONE_RESULT)
    files.write(folder, RESULTS, document)
    return document
