"""What sentences and tables are made of: harmless texts, counts, quantities, headings, words of outcomes."""

from __future__ import annotations

import math
import re
import shlex
from collections.abc import Sequence
from typing import TYPE_CHECKING, Final, NamedTuple

from uictest.core.document import Tone
from uictest.core.measures import STOP_COLUMNS, WHEELSET_COLUMNS, column_unit, without_wheelset
from uictest.core.units import UNIT_SYMBOLS

if TYPE_CHECKING:
    from uictest.judging import evaluation
    from uictest.judging.series import SeriesResult

_FORMULA_STARTS: Final = ("=", "+", "-", "@", "\t", "\r", "\n", *"\uff1d\uff0b\uff0d\uff20")
_UNITS: Final = "|".join(map(re.escape, sorted(UNIT_SYMBOLS)))
_QUANTITY: Final = re.compile(rf"[+-]?(\d+\.?\d*|\.\d+)([eE][+-]?\d+)?( ?({_UNITS}))?")
_COMMAND: Final = re.compile(r"^(\s*):(?=:)")
_NOT_XML: Final = re.compile("[\0-\b\v\f\x0e-\x1f\x7f-\x84\x86-\x9f\ud800-\udfff\ufffe\uffff]")


def printable(text: str) -> str:
    """Return the text on one line with every control, format and unassigned character spelled out."""
    if text.isprintable():
        return text
    # It is not for exactly what can move the cursor, reverse the reading direction or hide.
    return "".join(
        letter if letter.isprintable() else letter.encode("unicode_escape").decode("ascii") for letter in text
    )


def argument(path: str) -> str:
    """Return a path as a shell takes it for one argument, and a command for no option: `./-x.yaml`."""
    return shlex.quote(f"./{path}" if path.startswith("-") else path)


def csv_cell(text: str) -> str:
    """Return the text as a cell no spreadsheet takes for a formula: an apostrophe goes in front of one.

    A number is none, nor is one with a unit, such as `-0.05 bar`.
    """
    shown = printable(text)
    harmless = not text.lstrip(" ").startswith(_FORMULA_STARTS) or _QUANTITY.fullmatch(text)
    return shown if harmless else f"'{shown}"


def xml_text(text: str) -> str:
    """Return the text without the characters that XML 1.0 forbids or discourages."""
    return _NOT_XML.sub("", text)


def workflow_message(text: str) -> str:
    """Return the text as the message of a GitHub workflow command (line breaks stay)."""
    lines = "\n".join(printable(line) for line in text.split("\n"))
    return lines.replace("%", "%25").replace("\n", "%0A")


def workflow_property(text: str) -> str:
    """Return the text as the value of a property of a GitHub workflow command."""
    return workflow_message(text).replace(":", "%3A").replace(",", "%2C")


def no_command(line: str) -> str:
    """Return a line of the log as one that GitHub does not take for a command, whatever it contains."""
    # The runner looks after leading blanks, and for commands of its first kind anywhere in a line.
    return _COMMAND.sub(r"\1\\x3a", line).replace("##[", r"#\x23[")


NAMED: Final = 3
"""Names that a list shows before it counts the rest."""


def counted(count: int, noun: str, plural: str = "") -> str:
    """Return a count with its noun, e.g. `1 case`, `2 cases`; `plural` where it is not the noun with an s."""
    return f"{count} {noun}" if count == 1 else f"{count} {plural or f'{noun}s'}"


def counted_in(cases: int, series: int) -> str:
    """Return counts of cases and series, e.g. `2 cases, 1 series`; without any series the cases alone."""
    of_cases = [counted(cases, "case")] if cases or not series else []
    return ", ".join([*of_cases, *([f"{series} series"] if series else [])])


def listed(names: Sequence[str]) -> str:
    """Return the first names, and how many more there are."""
    more = len(names) - NAMED
    first = ", ".join(map(printable, names[:NAMED]))
    return f"{first} and {more} more" if more > 0 else first


def number(value: float | None, digits: int = 4) -> str:
    """Return a number with so many significant digits, `-` where there is none (None or NaN)."""
    return "-" if value is None or math.isnan(value) else f"{value:.{digits}g}"


def quantity(value: float | None, unit: str, digits: int = 4) -> str:
    """Return a number with its unit; the unit 1 of a pure number is left out."""
    text = number(value, digits)
    return text if value is None or unit in ("", "1") else f"{text} {unit}"


def percent(share: float, digits: int = 4) -> str:
    """Return a share of 1 in per cent with so many significant digits."""
    return f"{100.0 * share:.{digits}g} %"


class MeasureHeading(NamedTuple):
    """The name of a column in words and its unit, empty where it has none of its own."""

    words: str
    unit: str = ""


def measure_heading(name: str) -> MeasureHeading:
    """Return the heading of a column: a measure in words with its unit, others under their name.

    The number of a wheelset (`..._3`) may follow the name of a measure.
    """
    measure, wheelset = without_wheelset(name)
    column = STOP_COLUMNS.get(measure) or WHEELSET_COLUMNS.get(measure)
    if column is None:
        return MeasureHeading(name)
    in_unit = f"_{column.unit.lower().replace('/', 'p')}"
    words = f"{measure.removesuffix(in_unit)} {wheelset}".rstrip().replace("_", " ")
    pure = "" if column.whole or measure.endswith("_residual") else "%"
    return MeasureHeading(words, pure if column.unit == "1" else column.unit)


def measure_words(column: str) -> str:
    """Return the name of a column of measures with the unit of its numbers, e.g. `braking distance, m`."""
    words, unit = measure_heading(column).words, column_unit(column)
    return words if unit == "1" else f"{words}, {unit}"


DIFFERS: Final = "differs"
"""The word for a case that meets its expectation and differs from the baseline."""
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
    """Return the word for an outcome that was expected (`met`), or was not.

    What is expected to fail, or to be invalid, and does so is an `expected fail` or `expected invalid`. What
    should not pass and does is an `unexpected pass`; a case to which no criterion applies is an `unexpected
    skip` unless that is expected. Otherwise the word is the outcome.
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


def tone(word: str) -> Tone:
    """Return the tone of a word of `CASE_WORDS`."""
    if word == "error" or word in ALLOWED:
        return "odd"
    return "good" if word in _AS_EXPECTED else "bad"
