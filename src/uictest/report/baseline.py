"""How a run compares with its baseline: data that every report of the run shows."""

from __future__ import annotations

from collections.abc import Iterable, Iterator, Mapping, Sequence
from dataclasses import dataclass, field

from uictest.judging import evaluation
from uictest.report.difference import (
    Difference,
    difference_sentence,
    furthest_out,
    worst_of_wheelsets,
)
from uictest.report.escaping import printable
from uictest.report.wording import DIFFERS, counted, explanation, listed, result_word, tally


@dataclass(frozen=True, slots=True)
class BaselineComparison:
    """A run against its baseline.

    Args:
        folder: the baseline's folder, without the machine's folders.
        sha256: digest of the baseline's results.json.
        compared: how many quantities were compared.
        within: how many of them differ within their tolerance.
        differences: quantities out of tolerance by the id of a case or series; `first` is the baseline,
            `second` the run.
        missing: cases that the scenario files no longer have, id -> file; `differences` has them as well.
        series: files of the series in `differences`, by id.
        not_run: ids of cases of the baseline that were selected and not run.
        not_selected: ids of cases of the baseline that were not selected.
        series_not_compared: ids of series of the baseline that were not run or not selected.
        notes: inputs that differ.

    """

    folder: str
    sha256: str
    compared: int = 0
    within: int = 0
    differences: Mapping[str, Sequence[Difference]] = field(default_factory=dict)
    missing: Mapping[str, str] = field(default_factory=dict)
    series: Mapping[str, str] = field(default_factory=dict)
    not_run: Sequence[str] = ()
    not_selected: Sequence[str] = ()
    series_not_compared: Sequence[str] = ()
    notes: Sequence[str] = ()

    @property
    def agrees(self) -> bool:
        """Whether everything that was compared is within tolerance."""
        return not self.differences

    @property
    def beside_cases(self) -> Mapping[str, str]:
        """What differs and is no case of the run: missing cases, and series; id -> file."""
        return {**self.missing, **self.series}

    @property
    def all_differences(self) -> list[Difference]:
        """The quantities out of tolerance, case after case."""
        return [difference for each in self.differences.values() for difference in each]


def case_word(result: evaluation.CaseResult, differences: Sequence[Difference]) -> str:
    """Return the word of a case: `differs` where it meets its expectation and differs from the baseline."""
    return DIFFERS if differences and result.met else result_word(result)


def case_explanation(
    result: evaluation.CaseResult, differences: Sequence[Difference], most: int | None = None
) -> list[str]:
    """Return the reasons for the outcome of a case, and the quantities out of tolerance, `most` of them."""
    outcome, *reasons = explanation(result)
    if differences:
        outcome += ". Differs from the baseline"
    return [outcome, *reasons, *difference_sentences(differences, most)]


def difference_sentences(differences: Sequence[Difference], most: int | None = None) -> list[str]:
    """Return one line per quantity of a case that is out of tolerance.

    With `most` only so many, those furthest out first, and a line that counts the others.
    """
    worst = worst_of_wheelsets(differences)
    shown = worst if most is None else furthest_out(worst)[:most]
    lines = [f"baseline: {difference_sentence(each)}" for each in shown]
    if more := len(worst) - len(shown):
        lines.append(
            f"baseline: {counted(more, 'more quantity', 'more quantities')} out of tolerance, in results.json"
        )
    return lines


def run_tally(results: Iterable[evaluation.CaseResult], baseline: BaselineComparison | None) -> str:
    """Return the counts of a run, e.g. `3 cases: 2 pass, 1 different from the baseline`."""
    counts = tally(results, baseline.differences if baseline else ())
    missing = len(baseline.missing) if baseline else 0
    return f"{counts}; {counted(missing, 'case')} of the baseline missing" if missing else counts


def baseline_summary(baseline: BaselineComparison) -> str:
    """Return the result of the comparison with the baseline on one line."""
    quantities = counted(baseline.compared, "quantity", "quantities")
    beyond = len(baseline.all_differences)
    counts = f"{beyond} out of tolerance, {baseline.within} different within tolerance"
    result = counts if beyond or baseline.within else "no difference"
    return f"{quantities} compared with the baseline {printable(baseline.folder)}: {result}"


def not_compared_sentences(baseline: BaselineComparison) -> Iterator[str]:
    """Yield which cases and series of the baseline were not compared, and why."""
    for ids, reason in ((baseline.not_run, "not run"), (baseline.not_selected, "not selected")):
        if ids:
            yield f"not compared with the baseline: {counted(len(ids), 'case')} {reason} ({listed(ids)})"
    if ids := baseline.series_not_compared:
        yield f"not compared with the baseline: {len(ids)} series not run or not selected ({listed(ids)})"
