"""Which cases of a run a page draws."""

from __future__ import annotations

from collections import Counter
from collections.abc import Collection, Iterable

from uictest.judging import evaluation

DRAWN = 18
"""Cases drawn on one page. Each takes up to 270 kB, and a page must still open from a mail attachment."""
MOST_DRAWN = 60
"""Cases drawn on one page if somebody asks for them: at most 16 MB."""


def drawn_cases(
    results: Iterable[evaluation.CaseResult], chosen: Collection[str] = ()
) -> list[evaluation.CaseResult]:
    """Return the cases that a page draws: at most `MOST_DRAWN` of those chosen, then others up to `DRAWN`.

    Of the others, those not as expected come first, then those with the narrowest margins, from every
    scenario in turn.

    Args:
        results: of all cases that can be drawn.
        chosen: ids of the cases that somebody asked for.

    """
    ranked = from_scenarios_in_turn(results)
    asked_for = [result for result in ranked if result.id in chosen][:MOST_DRAWN]
    others = [result for result in ranked if result.id not in chosen]
    return [*asked_for, *others[: max(DRAWN - len(asked_for), 0)]]


def from_scenarios_in_turn(results: Iterable[evaluation.CaseResult]) -> list[evaluation.CaseResult]:
    """Return the worst case of each scenario, then the second of each; cases not as expected go first."""
    places: Counter[tuple[bool, str]] = Counter()
    ranked = []
    for result in worst_first(results):
        places[result.met, result.scenario] += 1
        ranked.append((places[result.met, result.scenario], result))
    return [result for _, result in sorted(ranked, key=lambda each: (each[1].met, each[0]))]


def worst_first(results: Iterable[evaluation.CaseResult]) -> list[evaluation.CaseResult]:
    """Return the results with those not as expected first, then those with the narrowest margins."""
    return sorted(results, key=_rank)


def _rank(result: evaluation.CaseResult) -> tuple[bool, bool, float]:
    margin, _ = evaluation.narrowest_margin(result)
    return result.met, result.outcome == "pass", 1.0 if margin is None else margin
