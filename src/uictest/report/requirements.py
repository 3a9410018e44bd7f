"""What the cases and series of a run say of the requirements that they and their criteria name."""

from __future__ import annotations

from collections.abc import Iterable, Iterator
from itertools import chain
from typing import TYPE_CHECKING, Final, Literal, NamedTuple

from uictest.core.document import Column, Table, Tone
from uictest.judging import evaluation
from uictest.plans import scenario
from uictest.report.words import listed, outcome_word

if TYPE_CHECKING:
    from uictest.judging.series import SeriesResult


NOT_APPLICABLE: Final = "not applicable"

_NO_EVIDENCE: Final = frozenset({NOT_APPLICABLE, "skipped", "unexpected skip"})
_MET: Final = frozenset({"pass", "expected fail", "expected invalid"})

RequirementStatus = Literal["met", "not met", "not tested"]
REQUIREMENT_TONES: Final[dict[str, Tone]] = {"met": "good", "not met": "bad", "not tested": "odd"}


class Evidence(NamedTuple):
    """What one case or series says of a requirement.

    Args:
        kind: which of the two.
        id: id of the case or series.
        word: that of the case or series where it names the requirement itself. Otherwise pass, fail, invalid,
            inconclusive, error or not applicable: the verdict of the criteria that name it.
        criteria: ids of these criteria; empty where the case or series names the requirement itself.
    """

    kind: Literal["case", "series"]
    id: str
    word: str
    criteria: tuple[str, ...] = ()

    @property
    def name(self) -> str:
        """The id of a case; that of a series, which a case may have as well, after the word `series`."""
        return self.id if self.kind == "case" else f"series {self.id}"

    @property
    def counts(self) -> bool:
        """Whether the requirement was put to the test here."""
        return self.word not in _NO_EVIDENCE

    @property
    def met(self) -> bool:
        """Whether the requirement is met here."""
        return self.word in _MET


class VerifiedRequirement(NamedTuple):
    """A requirement, and what each case or series that names it says of it, cases first."""

    id: str
    evidence: tuple[Evidence, ...]

    @property
    def status(self) -> RequirementStatus:
        """met: in every case and series that puts it to the test; not tested: there is none."""
        if not self.tested:
            return "not tested"
        return "not met" if self.not_met else "met"

    @property
    def counts(self) -> tuple[int, int]:
        """How many cases and how many series name it."""
        cases = sum(evidence.kind == "case" for evidence in self.evidence)
        return cases, len(self.evidence) - cases

    @property
    def tested(self) -> list[Evidence]:
        """The cases and series that put it to the test."""
        return [evidence for evidence in self.evidence if evidence.counts]

    @property
    def not_met(self) -> list[Evidence]:
        """Those of them that do not meet it."""
        return [evidence for evidence in self.tested if not evidence.met]


def verified_requirements(
    results: Iterable[evaluation.CaseResult], series: Iterable[SeriesResult] = ()
) -> list[VerifiedRequirement]:
    """Return the requirements that cases, series or their criteria name, in the order of their ids.

    The stops of a series are figures of it, and no evidence of their own.
    """
    found: dict[str, list[Evidence]] = {}
    for requirement, evidence in chain(
        *map(_evidence_by_requirement, results), *map(_evidence_by_requirement, series)
    ):
        found.setdefault(requirement, []).append(evidence)
    return [VerifiedRequirement(name, tuple(found[name])) for name in scenario.in_order_of_ids(found)]


def requirements_of(result: evaluation.CaseResult | SeriesResult) -> tuple[str, ...]:
    """Return the requirements that a case or series tests: its own and those of criteria that apply."""
    judged = (verdict for verdict in _verdicts(result) if verdict.status != "not_applicable")
    of_criteria = (requirement for verdict in judged for requirement in verdict.requirements)
    return tuple(dict.fromkeys((*result.requirements, *of_criteria)))


class _Row(NamedTuple):
    requirement: VerifiedRequirement
    evidence: Evidence


_EVIDENCE: Final[tuple[Column[_Row], ...]] = (
    Column(key="requirement", value=lambda row: row.requirement.id),
    Column(key="status", value=lambda row: row.requirement.status),
    Column(key="kind", value=lambda row: row.evidence.kind),
    Column(key="id", value=lambda row: row.evidence.id),
    Column(key="verdict", value=lambda row: row.evidence.word),
    Column(key="criteria", value=lambda row: "; ".join(row.evidence.criteria)),
)
_REQUIREMENTS: Final[tuple[Column[VerifiedRequirement], ...]] = (
    Column(heading="requirement", text=lambda row: row.id, literal=True),
    Column(heading="status", text=lambda row: row.status, tone=lambda row: REQUIREMENT_TONES[row.status]),
    Column(heading="tested in", value=lambda row: len(row.tested), digits=0),
    Column(
        heading="not met in",
        text=lambda row: listed([f"{evidence.name} ({evidence.word})" for evidence in row.not_met]),
    ),
)


def evidence_table(requirements: Iterable[VerifiedRequirement]) -> Table:
    """Return one row for each requirement and case or series that names it, for programs."""
    rows = [_Row(requirement, evidence) for requirement in requirements for evidence in requirement.evidence]
    return Table(_EVIDENCE, rows, name="requirements")


def requirements_table(requirements: Iterable[VerifiedRequirement], most: int) -> Table:
    """Return one row for each requirement, those not met first, for people."""
    rows = sorted(requirements, key=lambda requirement: requirement.status == "met")
    return Table(_REQUIREMENTS, rows, all_in="tables/requirements.csv", most=most)


def _verdicts(result: evaluation.CaseResult | SeriesResult) -> list[evaluation.Verdict]:
    if isinstance(result, evaluation.CaseResult):
        return list(result.decided)
    return [judged.verdict for judged in result.criteria]


def _evidence_by_requirement(result: evaluation.CaseResult | SeriesResult) -> Iterator[tuple[str, Evidence]]:
    kind: Literal["case", "series"] = "case" if isinstance(result, evaluation.CaseResult) else "series"
    for requirement in result.requirements:
        yield requirement, Evidence(kind, result.id, outcome_word(result.outcome, met=result.met))
    if result.expect.outcome != "pass":
        return  # what must not pass shows that its criteria can fail, not that a requirement is met
    verdicts = _verdicts(result)
    by_requirement: dict[str, list[evaluation.Verdict]] = {}
    for verdict in verdicts:
        for requirement in set(verdict.requirements) - set(result.requirements):
            by_requirement.setdefault(requirement, []).append(verdict)
    for requirement, naming in by_requirement.items():
        # Criteria of a series may have been judged although one of its stops failed to run.
        word = "error" if result.outcome == "error" else _requirement_word(naming, verdicts)
        yield requirement, Evidence(kind, result.id, word, tuple(verdict.id for verdict in naming))


def _requirement_word(naming: list[evaluation.Verdict], verdicts: Iterable[evaluation.Verdict]) -> str:
    """Return the word for one requirement by its criteria; a stop that is not a test shows nothing met."""
    of_validity = {
        verdict.status
        for verdict in verdicts
        if verdict not in naming
        and (verdict.layer == "validity" or (verdict.is_check and verdict.status == "fail"))
    }
    statuses = {verdict.status for verdict in naming} - {"not_applicable"}
    if not statuses:
        return NOT_APPLICABLE
    stands = any(verdict.status == "fail" and not verdict.in_valid_test for verdict in naming)
    if stands and not evaluation.failed_checks(verdicts):
        return "fail"
    if "fail" in of_validity:
        return "invalid"
    if "fail" in statuses and "inconclusive" not in of_validity:
        return "fail"
    return "inconclusive" if "inconclusive" in statuses | of_validity else "pass"
