"""What the cases and series of a run say of the requirements that they and their criteria name."""

from __future__ import annotations

from collections.abc import Iterable, Iterator
from itertools import chain
from typing import TYPE_CHECKING, Final, Literal, NamedTuple

from uictest.core.document import Cell, Tone
from uictest.judging import evaluation
from uictest.plans import scenario
from uictest.report.case_words import outcome_word

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
        id: of the case or series.
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
        """The id of a case; that of a series, which a case may have as well, behind the word `series`."""
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
        counted = [each.met for each in self.evidence if each.counts]
        return ("met" if all(counted) else "not met") if counted else "not tested"

    @property
    def counts(self) -> tuple[int, int]:
        """How many cases and how many series name it."""
        cases = sum(each.kind == "case" for each in self.evidence)
        return cases, len(self.evidence) - cases

    @property
    def tested(self) -> list[Evidence]:
        """The cases and series that put it to the test."""
        return [each for each in self.evidence if each.counts]

    @property
    def not_met(self) -> list[Evidence]:
        """Those of them that do not meet it."""
        return [each for each in self.tested if not each.met]


def verified_requirements(
    results: Iterable[evaluation.CaseResult], series: Iterable[SeriesResult] = ()
) -> list[VerifiedRequirement]:
    """Return the requirements that cases, series or their criteria name, in the order of their ids.

    The stops of a series are figures of it, and no evidence of their own.
    """
    found: dict[str, list[Evidence]] = {}
    for requirement, evidence in chain(*map(_evidence, results), *map(_evidence, series)):
        found.setdefault(requirement, []).append(evidence)
    return [VerifiedRequirement(each, tuple(found[each])) for each in scenario.in_order_of_ids(found)]


def requirements_of(result: evaluation.CaseResult | SeriesResult) -> tuple[str, ...]:
    """Return the requirements that a case or series tests: its own and those of criteria that apply."""
    judged = (verdict for verdict in _verdicts(result) if verdict.status != "not_applicable")
    of_criteria = (requirement for verdict in judged for requirement in verdict.requirements)
    return tuple(dict.fromkeys((*result.requirements, *of_criteria)))


def requirement_rows(requirements: Iterable[VerifiedRequirement]) -> Iterator[dict[str, Cell]]:
    """Yield a row for each requirement and case or series.

    The columns are `requirement`, `status`, `kind`, `id`, `verdict` and `criteria`.
    """
    for each in requirements:
        for evidence in each.evidence:
            own: dict[str, Cell] = {"requirement": each.id, "status": each.status}
            own |= {"kind": evidence.kind, "id": evidence.id}
            yield {**own, "verdict": evidence.word, "criteria": "; ".join(evidence.criteria)}


def _verdicts(result: evaluation.CaseResult | SeriesResult) -> list[evaluation.Verdict]:
    if not isinstance(result, evaluation.CaseResult):
        return [each.verdict for each in result.criteria]
    return list(result.decided)


def _evidence(result: evaluation.CaseResult | SeriesResult) -> Iterator[tuple[str, Evidence]]:
    kind: Literal["case", "series"] = "case" if isinstance(result, evaluation.CaseResult) else "series"
    for requirement in result.requirements:
        yield requirement, Evidence(kind, result.id, outcome_word(result.outcome, met=result.met))
    if result.expect.outcome != "pass":
        return  # what must not pass shows that its criteria can fail, not that a requirement is met
    verdicts = _verdicts(result)
    own: dict[str, list[evaluation.Verdict]] = {}
    for verdict in verdicts:
        for requirement in set(verdict.requirements) - set(result.requirements):
            own.setdefault(requirement, []).append(verdict)
    for requirement, naming in own.items():
        # Criteria of a series may have been judged although one of its stops failed to run.
        word = "error" if result.outcome == "error" else _word(naming, verdicts)
        yield requirement, Evidence(kind, result.id, word, tuple(verdict.id for verdict in naming))


def _word(own: list[evaluation.Verdict], verdicts: Iterable[evaluation.Verdict]) -> str:
    """Return what the criteria of one requirement say; what is no test shows nothing met."""
    of_validity = {
        verdict.status
        for verdict in verdicts
        if verdict not in own
        and (verdict.layer == "validity" or (verdict.is_check and verdict.status == "fail"))
    }
    statuses = {verdict.status for verdict in own} - {"not_applicable"}
    if not statuses:
        return NOT_APPLICABLE
    stands = any(verdict.status == "fail" and not verdict.in_valid_test for verdict in own)
    if stands and not evaluation.failed_checks(verdicts):
        return "fail"
    if "fail" in of_validity:
        return "invalid"
    if "fail" in statuses and "inconclusive" not in of_validity:
        return "fail"
    return "inconclusive" if "inconclusive" in statuses | of_validity else "pass"
