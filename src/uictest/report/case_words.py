"""The word of a case or a series: its outcome against what was expected of it."""

from __future__ import annotations

from typing import TYPE_CHECKING, Final

from uictest.core.document import Tone
from uictest.judging import evaluation

if TYPE_CHECKING:
    from uictest.judging.series import SeriesResult

DIFFERS: Final = "differs"
"""The word for a case that meets its expectation and differs from the baseline."""

EXPLAINED: Final = ("fail", "invalid")
"""Outcomes whose criteria a terminal shows with value and limit even where they are expected."""

UNSETTLED: Final = "unsettled"
"""The word for what has its expected outcome, but not every verdict settled, where that was asked for."""

ALLOWED: Final = ("allowed fail", "allowed invalid")
"""Words for what misses what it may miss by name, under another controller than the scenario's own."""
_AS_EXPECTED: Final = ("pass", "expected fail", "expected invalid", "skipped")
_NOT_AS_EXPECTED: Final = (
    *("fail", "invalid", "inconclusive", UNSETTLED, "unexpected pass", "unexpected skip", "error"),
)

CASE_WORDS: Final = (*_AS_EXPECTED, *ALLOWED, *_NOT_AS_EXPECTED, DIFFERS)
"""Words for cases, by outcome and expectation, in the order in which they are counted."""


def outcome_word(outcome: str, *, met: bool) -> str:
    """Return the word for an outcome that was expected, or was not.

    A case that is expected to fail, or to be invalid, and does so is an `expected fail` or `expected
    invalid`. A case that should not pass and does is an `unexpected pass`; one to which no criterion applies
    is an `unexpected skip` unless it is expected. In all other cases the word is the outcome.

    Args:
        outcome: of the case.
        met: whether the case was expected to come out so.

    """
    if met:
        return outcome if outcome in _AS_EXPECTED else f"expected {outcome}"
    return {"pass": "unexpected pass", "skipped": "unexpected skip"}.get(outcome, outcome)


def result_word(result: evaluation.CaseResult | SeriesResult) -> str:
    """Return the word of a case or a series of `CASE_WORDS`, without regard to a baseline."""
    if result.as_expected and (result.unsettled or result.lacks_firmness):
        return UNSETTLED
    if result.met and result.expect.is_allowance and result.outcome != "pass":
        return f"allowed {result.outcome}"
    return outcome_word(result.outcome, met=result.met)


def line_word(word: str) -> str:
    """Return a word of `CASE_WORDS` without blanks: in a line for grep it is the first field."""
    return word.replace(" ", "-")


def tone(word: str) -> Tone:
    """Return the tone of a word of `CASE_WORDS`."""
    if word == "error" or word in ALLOWED:
        return "odd"
    return "good" if word in _AS_EXPECTED else "bad"
