"""A finished run as all that reports it sees it: results, manifest, descriptions, what its stops show."""

from __future__ import annotations

import hashlib
import json
import math
import platform
from collections import Counter
from collections.abc import Collection, Iterable, Mapping, Sequence
from dataclasses import asdict, dataclass, field
from functools import cache
from importlib import metadata
from pathlib import Path, PurePath
from typing import TYPE_CHECKING, Any, ClassVar, Final, Literal, NamedTuple

from pydantic import ConfigDict, TypeAdapter

from uictest.core import envelope
from uictest.core.document import Cell, Column, Digits, Lines, Table
from uictest.judging import evaluation
from uictest.report.case_conditions import controllers_text, part_sentence
from uictest.report.difference import BaselineComparison, Difference, case_explanation, case_word, run_tally
from uictest.report.series_report import series_tally

if TYPE_CHECKING:
    from uictest.judging.series import SeriesResult
    from uictest.report.traces.trace import PlotTrace


CASES_IN_PYTHON: Final = "(cases loaded in Python)"
"""In a command, after `run`: a program gave the cases, and no files of their own name them."""
_PACKAGES: Final = ("uictest", "numpy", "pydantic", "pyyaml")


@dataclass(frozen=True, slots=True)
class RunManifest:
    """Where the results of a run come from.

    Args:
        schema: version of this form.
        kind: kind of the results: `run`.
        command: the program and its arguments as typed, without the folders of the machine.
        seed: the seed given for all cases; None where each scenario has its own.
        cases: how many cases were selected.
        versions: program or package -> version.
        inputs: file that was read -> its SHA-256.
        parts: id of a part -> the part in words.
    """

    __pydantic_config__: ClassVar = ConfigDict(defer_build=True)

    schema: str = envelope.MANIFEST
    kind: str = "run"
    command: tuple[str, ...] = ("uictest",)
    seed: int | None = None
    cases: int = 0
    versions: Mapping[str, str] = field(default_factory=dict)
    inputs: Mapping[str, str] = field(default_factory=dict)
    parts: Mapping[str, str] = field(default_factory=dict)


_MANIFEST: Final = TypeAdapter(RunManifest)


def manifest_form(manifest: RunManifest) -> dict[str, Any]:
    """Return the JSON form of a manifest."""
    # pydantic does not keep a name of `inputs` that is no UTF-8.
    return asdict(manifest)


def read_manifest(content: Mapping[str, Any]) -> RunManifest:
    """Return the manifest in the results of a run.

    Raises ValueError where there is none, a field holds something else, or it is of another schema or kind.
    """
    form = content.get("manifest")
    try:
        envelope.require(form if isinstance(form, Mapping) else {}, envelope.MANIFEST, "run")
    except ValueError as error:
        raise ValueError(f"manifest: {error}") from error
    return evaluation.from_json_form(_MANIFEST, form, place="manifest")


def run_manifest(
    command: Sequence[str],
    seed: int | None,
    inputs: Mapping[str, str],
    cases: int,
    parts: Iterable[Mapping[str, evaluation.EffectivePart]] = (),
) -> RunManifest:
    """Return the manifest of a run.

    Args:
        command: the arguments as typed; absolute paths are shown without the machine's folders.
        seed: the seed given for all cases, None where each scenario has its own.
        inputs: every file read -> its SHA-256.
        cases: how many cases were selected.
        parts: parts of each case, by role.
    """
    return RunManifest(
        command=("uictest", *(without_machine(word) for word in command)),
        seed=seed,
        cases=cases,
        versions=dict(_versions()),
        inputs={without_machine(name): digest for name, digest in sorted(inputs.items())},
        parts=named_parts(parts),
    )


def named_parts(cases: Iterable[Mapping[str, evaluation.EffectivePart]]) -> dict[str, str]:
    """Return every distinct part of some cases in words, by id; the sections of a scenario are no parts."""
    table = sorted(evaluation.parts_table(cases).items())
    return {part_id: part_sentence(part) for part_id, part in table if part.name}


def manifest_digest(manifest: RunManifest) -> str:
    """Return the first eight hexadecimal digits of the SHA-256 of a manifest."""
    text = json.dumps(manifest_form(manifest), sort_keys=True)
    return hashlib.sha256(text.encode("utf-8", "surrogatepass")).hexdigest()[:8]


def without_machine(word: str) -> str:
    """Return a path, or an option with one, without the folders of this machine."""
    option, equals, value = word.partition("=") if word.startswith("--") else ("", "", word)
    path = PurePath(value)
    if not path.is_absolute():
        return word
    shown = path.relative_to(Path.cwd()) if path.is_relative_to(Path.cwd()) else PurePath("...", path.name)
    return f"{option}{equals}{shown.as_posix()}"


@cache
def _versions() -> Mapping[str, str]:
    return {"python": platform.python_version()} | {name: metadata.version(name) for name in _PACKAGES}


Place = Literal["first", "detail", "file"]
"""Where a table over the stops of a log stands: before the stops, after them, or in its file alone."""
STOPS: Final = "stops"
"""Key of the column that names stops, separated by commas."""
_MOST_DIGITS: Final = 15
_MOST_ROWS: Final = 30
"""Rows of a table over the stops of a log that a reader of a summary is given; chosen."""


class CampaignColumn(NamedTuple):
    """A column: its key for programs, its heading for people, and how many digits of its numbers they see.

    Without a heading only programs see it.

    `digits` is None for a column of texts, of which long ones may wrap; `significant` where the rows have
    numbers of different size.
    """

    key: str
    heading: str
    digits: Digits = None
    wraps: bool = False


@dataclass(frozen=True, slots=True)
class CampaignTable:
    """A table over the stops of a log or of a programme.

    Args:
        name: name of its file and its sheet.
        title: what it shows.
        basis: what it rests on, in one sentence.
        place: where it stands.
        columns: columns of the rows.
        rows: a cell for each column; None where there is none, or a number that is not known.
    """

    name: str
    title: str
    basis: str
    place: Place
    columns: tuple[CampaignColumn, ...]
    rows: tuple[tuple[Cell, ...], ...]

    def __post_init__(self) -> None:
        """Raise ValueError for what no table can show: a document may have been changed by hand."""
        if any(len(row) != len(self.columns) for row in self.rows):
            raise ValueError(f"table {self.name!r}: a row has not one cell for each column")
        digits = [column.digits for column in self.columns if isinstance(column.digits, int)]
        if not all(0 <= number <= _MOST_DIGITS for number in digits):
            raise ValueError(f"table {self.name!r}: digits of a column must be 0 to {_MOST_DIGITS}")
        known = tuple(tuple(cell if cell == cell else None for cell in row) for row in self.rows)
        object.__setattr__(self, "rows", known)

    @classmethod
    def of_records(
        cls,
        name: str,
        title: str,
        basis: str,
        place: Place,
        columns: tuple[CampaignColumn, ...],
        records: Iterable[Mapping[str, Cell]],
    ) -> CampaignTable:
        """Return the table of records that have a cell under the key of each column."""
        rows = tuple(tuple(record[column.key] for column in columns) for record in records)
        return cls(name, title, basis, place, columns, rows)

    @property
    def table(self) -> Table:
        """The table that formats render; the stops that a row names come first where there is no room."""
        columns: list[Column[Mapping[str, Cell]]] = [
            Column(**column._asdict(), rank=rank) for rank, column in enumerate(self.columns)
        ]
        keys = [column.key for column in self.columns]
        rows = [dict(zip(keys, row, strict=True)) for row in self.rows]
        return Table(columns, rows, self.title, self.basis, f"campaign_{self.name}", most=_MOST_ROWS)


class CampaignTest(NamedTuple):
    """A test of a programme, as a CI server is told of it.

    Attributes:
        name: of the test.
        lines: what came out; the first is the message.
        status: passed, failure, or skipped where the verdict decides nothing.
    """

    name: str
    lines: tuple[str, ...]
    status: Literal["passed", "failure", "skipped"]


@dataclass(frozen=True, slots=True)
class Campaign:
    """What the stops of a log or of a programme show together.

    Args:
        sentences: in words.
        tables: in tables.
        title: heading of both.
        headline: answer of the whole in one sentence, in place of the counts of cases; empty for a log.
        tests: tests of a programme, which are the testcases of its run; none for a log.
    """

    sentences: tuple[str, ...] = ()
    tables: tuple[CampaignTable, ...] = ()
    title: str = "All stops together"
    headline: str = ""
    tests: tuple[CampaignTest, ...] = ()

    @property
    def failed(self) -> bool:
        """Whether a test failed that decides."""
        return any(test.status == "failure" for test in self.tests)

    def at(self, place: Place) -> list[Table]:
        """Return the tables that stand at a place and have rows."""
        return [table.table for table in self.tables if table.place == place and table.rows]

    @property
    def at_the_top(self) -> list[Table | Lines]:
        """What a reader sees first: sentences and tables of a log; of a programme tables and sentences."""
        lines = [Lines(self.sentences, self.title)] if self.sentences else []
        return [*self.at("first"), *lines] if self.tests else [*lines, *self.at("first")]

    @property
    def sections(self) -> list[Table | Lines]:
        """The sections of a summary."""
        return [*self.at_the_top, *self.at("detail")]


_CAMPAIGN: Final = TypeAdapter(tuple[Campaign, ...], config=ConfigDict(extra="forbid", defer_build=True))


def campaign_form(campaign: Campaign) -> dict[str, Any]:
    """Return the JSON form of a campaign."""
    form: dict[str, Any] = evaluation.to_json_form(_CAMPAIGN, (campaign,))[0]
    return form


def read_campaign(document: Mapping[str, Any]) -> Campaign | None:
    """Return the campaign of a document, None without one. Raises ValueError where it is none."""
    content = document.get("campaign")
    return evaluation.from_json_form(_CAMPAIGN, [content], place="campaign")[0] if content else None


DRAWN = 18
"""Cases drawn on one page. Each takes up to 270 kB, and a page must still open from a mail attachment."""
MOST_DRAWN = 60
"""Cases drawn on one page if somebody asks for them: at most 16 MB."""


def drawn_cases(
    results: Iterable[evaluation.CaseResult], drawn_first: Collection[str] = ()
) -> list[evaluation.CaseResult]:
    """Return the cases that a page draws: at most `MOST_DRAWN` of those asked for, then others up to `DRAWN`.

    Of the others, those not as expected come first, then those with the narrowest margins: the worst case of
    each scenario, then the second of each. `drawn_first` has the ids of those that somebody asked for.
    """
    turns: Counter[tuple[bool, str]] = Counter()
    ranked = []
    for result in worst_first(results):
        turns[result.met, result.scenario] += 1
        ranked.append((result.met, turns[result.met, result.scenario], result))
    ranked.sort(key=lambda turn: turn[:2])
    asked_for = [result for *_, result in ranked if result.id in drawn_first][:MOST_DRAWN]
    others = [result for *_, result in ranked if result.id not in drawn_first]
    return [*asked_for, *others[: max(DRAWN - len(asked_for), 0)]]


def worst_first(results: Iterable[evaluation.CaseResult]) -> list[evaluation.CaseResult]:
    """Return the results: not as expected, of these a requirement missed, first; then the nearest to failing.

    That is by the narrowest margin, and where it is that of a lock that never began, by the largest slide.
    """

    def rank(result: evaluation.CaseResult) -> tuple[bool, bool, bool, float, float]:
        margin, _ = evaluation.narrowest_margin(result)
        missed, narrowest = result.requirement_status == "missed", 1.0 if margin is None else margin
        guides = [evaluation.guiding_margin(result, verdict.id) for verdict in result.criteria]
        nearest = min((guide for guide in guides if not math.isnan(guide)), default=math.inf)
        return result.met, not missed, result.outcome == "pass", narrowest, nearest

    return sorted(results, key=rank)


@dataclass(frozen=True, slots=True)
class CaseDescription:
    """Description of a case in the user's words: title, tags and main settings, name -> text.

    `settings` are those that a simulated stop was run with, or the conditions that a recorded stop was judged
    by. `recorded` states the origin of the samples of a recorded stop; it is empty for a simulated one.
    """

    title: str = ""
    tags: tuple[str, ...] = ()
    settings: Mapping[str, str] = field(default_factory=dict)
    recorded: Mapping[str, str] = field(default_factory=dict)


def _location_text(row: Mapping[str, Cell]) -> str:
    """Return the rail, the time and the place of a stop, as far as an earlier version wrote them."""
    rail, place, in_file = row.get("rail"), row.get("place_m"), row.get("distance_m")
    texts = [f"{rail} rail"] if rail else []
    texts += [str(row.get("clock", ""))]
    if isinstance(place, int | float):
        texts.append(f"at {place:.0f} m on the line")
    elif isinstance(in_file, int | float):
        texts.append(f"{in_file:.0f} m into the file")
    return ", ".join(texts)


@dataclass(frozen=True, slots=True)
class RunContent:
    """What a report shows.

    Args:
        name: name of the run.
        results: every case.
        manifest: where the results come from.
        complete: False where an interrupt ended the run, or selected cases are missing from the results.
        subjects: descriptions of cases, by id; a case may have none.
        traces: what the plots are drawn from, by id.
        baseline: the comparison with the baseline; None without one.
        series: every series, with the results of its own cases, which are not among `results`.
        drawn_first: ids of the cases that are to be drawn before all others.
        passed_over: what was found and not judged, a sentence with the reason each.
        campaign: what the stops of a log show together; None without a log.
    """

    name: str
    results: Sequence[evaluation.CaseResult]
    manifest: RunManifest = field(default_factory=RunManifest)
    complete: bool = True
    subjects: Mapping[str, CaseDescription] = field(default_factory=dict)
    traces: Mapping[str, PlotTrace] = field(default_factory=dict)
    baseline: BaselineComparison | None = None
    series: Sequence[SeriesResult] = ()
    drawn_first: Collection[str] = ()
    passed_over: Sequence[str] = ()
    campaign: Campaign | None = None

    def subject(self, case_id: str) -> CaseDescription:
        """Return the description of a case; an empty one where there is none."""
        return self.subjects.get(case_id, CaseDescription())

    def locations(self, case_ids: Collection[str]) -> dict[str, str]:
        """Return on which rail, when and where stops of a log were, the worst first; of others nothing."""
        tables = self.campaign.tables if self.campaign else ()
        rows = [row for table in tables if table.name == STOPS for row in table.table.rows]
        return {row[STOPS]: _location_text(row) for row in rows if row[STOPS] in case_ids}

    def differences(self, case_id: str) -> Sequence[Difference]:
        """Return the quantities of a case that are out of the tolerance of the baseline."""
        return self.baseline.differences.get(case_id, ()) if self.baseline else ()

    def expected(self, result: evaluation.CaseResult) -> bool:
        """Return whether a case came out as expected; of what ends undecided a programme decides."""
        of_programme = self.campaign is not None and bool(self.campaign.tests)
        return result.met or (of_programme and result.outcome == "inconclusive")

    def passes(self, result: evaluation.CaseResult) -> bool:
        """Return whether a case came out as expected and does not differ from the baseline."""
        return self.expected(result) and not self.differences(result.id)

    def word(self, result: evaluation.CaseResult) -> str:
        """Return the word of a case, from its expectation and the baseline."""
        return case_word(result, self.differences(result.id))

    def explanation(self, result: evaluation.CaseResult, *, briefly: bool = False) -> list[str]:
        """Return the reasons for the outcome of a case, and its differences from the baseline.

        Of a stop that is drawn the reasons say when the values were taken. `briefly` leaves out what a table
        of the criteria says.
        """
        differences = self.differences(result.id)
        return case_explanation(result, differences, self._instants(result), briefly=briefly)

    def _instants(self, result: evaluation.CaseResult) -> dict[str, str]:
        """Return when, and at which wheelset, the value of each criterion was taken; {} where not drawn."""
        # The value of a repeated case is not that of the stop that is drawn.
        trace = self.traces.get(result.id)
        if trace is None or result.met or result.repeats is not None:
            return {}
        from uictest.report.traces.instants import taken_at

        taken = {verdict.id: taken_at(verdict, trace) for verdict in result.criteria}
        return {name: instant.text for name, instant in taken.items() if instant is not None}

    @property
    def tally(self) -> str:
        """The counts of the run, or the answer of its programme."""
        if self.campaign is not None and self.campaign.headline:
            return self.campaign.headline
        of_cases = [run_tally(self.results, self.baseline)] if self.results or not self.series else []
        differing = len(self.baseline.series) if self.baseline else 0
        of_series = [series_tally(self.series)] if self.series else []
        beyond = [f"{differing} series different from the baseline"] if differing else []
        return "; ".join([*of_cases, *of_series, *beyond])

    @property
    def uictest_version(self) -> str:
        """The version of the package that made the run; empty where it is not known."""
        return self.manifest.versions.get("uictest", "")

    @property
    def controllers(self) -> str:
        """The controllers under test with their versions; empty where none is known."""
        return controllers_text(self.all_results, self.uictest_version)

    @property
    def ranked(self) -> list[evaluation.CaseResult]:
        """The cases, those not as expected or different from the baseline first, then by margin."""
        return sorted(worst_first(self.results), key=self.passes)

    @property
    def all_results(self) -> list[evaluation.CaseResult]:
        """Every case, those of series too."""
        return [*self.results, *(each.case for result in self.series for each in result.cases)]
