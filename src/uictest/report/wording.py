"""How results and verdicts are put into words, the same in every format."""

from __future__ import annotations

from collections.abc import Container, Iterable, Iterator, Sequence

from uictest import evaluation
from uictest.report.escaping import printable

DIFFERS = "DIFFERS"
"""The word for a case that meets its expectation and differs from the baseline."""

_NAMED = 3
"""Names that a list shows before it counts the rest."""


def number(value: float | None) -> str:
    """Return a figure with five significant digits, `-` where there is none (None or NaN)."""
    return "-" if value is None or value != value else f"{value:.5g}"


def quantity(value: float | None, unit: str) -> str:
    """Return a figure with its unit; the unit 1 of a pure number is left out."""
    return number(value) if value is None or unit in ("", "1") else f"{number(value)} {unit}"


def limits(verdict: evaluation.Verdict, word: str = "limits ") -> str:
    """Return the limits of a criterion, e.g. `limits 440 .. 490 m`, `lower limit 35 %`, `no limit`.

    `word` stands before a pair of limits.
    """
    if verdict.lower is not None and verdict.upper is not None:
        return f"{word}{number(verdict.lower)} .. {quantity(verdict.upper, verdict.unit)}"
    if verdict.lower is not None:
        return f"lower limit {quantity(verdict.lower, verdict.unit)}"
    if verdict.upper is not None:
        return f"upper limit {quantity(verdict.upper, verdict.unit)}"
    return "no limit"


def value_and_limits(verdict: evaluation.Verdict) -> str:
    """Return what a criterion found beside its limits, e.g. `0.3 %, upper limit 0.1 %`."""
    return f"{quantity(verdict.value, verdict.unit)}, {limits(verdict)}"


_MOST_URGENT = ("fail", "inconclusive", "pass", "not_applicable")


def failing_first(verdicts: Iterable[evaluation.Verdict]) -> list[evaluation.Verdict]:
    """Return verdicts with the failing ones first, then the inconclusive ones, then those that passed."""
    return sorted(verdicts, key=lambda verdict: _MOST_URGENT.index(verdict.status))


def verdict_sentence(verdict: evaluation.Verdict) -> str:
    """Return one line that says what a criterion found: verdict and reason, or value, limits and margin."""
    value, margin = (quantity(figure, verdict.unit) for figure in (verdict.value, verdict.margin))
    found = verdict.reason or f"{value}, {limits(verdict)}, margin {margin}"
    return printable(f"{verdict.id} ({verdict.layer}) {verdict.status.replace('_', ' ')}: {found}")


def definition_sentence(verdict: evaluation.Verdict) -> str:
    """Return the definitions a verdict rests on, e.g. `first_phase_duration = 3 s`, or an empty text."""
    return printable(", ".join(f"{name} = {text}" for name, text in verdict.definition.items()))


def explanation(result: evaluation.CaseResult) -> list[str]:
    """Return why a case came out as it did: expectation, reason, and each criterion that decided it."""
    deciding = [verdict_sentence(verdict) for verdict in _deciding(result)]
    # With criteria the reason of a result repeats theirs; without any it is all there is.
    reason = [printable(result.reason)] if result.reason and not deciding else []
    return [f"expected {result.expect}, came out {result.outcome}", *reason, *deciding]


def criterion_sentences(result: evaluation.CaseResult) -> Iterator[str]:
    """Yield what each criterion found, failing ones first, and how firmly it stands on its definitions."""
    for verdict in failing_first(result.criteria):
        yield verdict_sentence(verdict)
        for sensitivity in verdict.sensitivity:
            yield printable(f"{verdict.id}: {sensitivity}")


def _deciding(result: evaluation.CaseResult) -> Iterator[evaluation.Verdict]:
    for verdict in result.criteria:
        undecided = verdict.status == "inconclusive" and result.outcome == "inconclusive"
        if verdict.status == "fail" or undecided or result.outcome == "skipped":
            yield verdict


def verdict_word(result: evaluation.CaseResult) -> str:
    """Return `met`, `MISSED` or `ERROR`: how a case stands to its expectation."""
    if result.outcome == "error":
        return "ERROR"
    return "met" if result.met else "MISSED"


def tally(results: Iterable[evaluation.CaseResult], differing: Container[str] = ()) -> str:
    """Return the counts of a run, e.g. `12 cases: 9 met, 3 missed (1 inconclusive)`.

    A case that is met counts as different where its id is among those `differing` from the baseline.
    """
    results = list(results)
    words = [DIFFERS if result.met and result.id in differing else verdict_word(result) for result in results]
    undecided = sum(result.outcome == "inconclusive" for result in results)
    met, missed, errors, different = (words.count(word) for word in ("met", "MISSED", "ERROR", DIFFERS))
    shown = counts_words(met, missed, errors, undecided, different)
    return f"{counted(len(words), 'case')}: {shown}" if words else "no case"


def counts_words(met: int, missed: int, errors: int, inconclusive: int, different: int = 0) -> str:
    """Return counts of cases, those of none left out; the `inconclusive` ones are among the `missed`."""
    open_ = f" ({inconclusive} inconclusive)" if inconclusive else ""
    counts = {"met": met, f"missed{open_}": missed, "in error": errors}
    counts["different from the baseline"] = different
    return ", ".join(f"{count} {word}" for word, count in counts.items() if count)


def listed(names: Sequence[str]) -> str:
    """Return the first names, and how many more there are."""
    more = len(names) - _NAMED
    shown = ", ".join(map(printable, names[:_NAMED]))
    return f"{shown} and {more} more" if more > 0 else shown


def counted(count: int, noun: str) -> str:
    """Return a count with its noun, e.g. `1 case`, `2 cases`."""
    return f"{count} {noun}" if count == 1 else f"{count} {noun}s"
