"""How the findings of a sweep are put into words, the same in every format."""

from __future__ import annotations

import shlex
from collections.abc import Mapping, Sequence
from typing import Any

from uictest.measures import column_unit
from uictest.report.wording import counted, counts_text

_NAMED = 3  # values that are listed rather than counted
STRETCH = " .. "
"""What stands between the ends of a stretch of numbers."""


def sweep_tally(document: Mapping[str, Any]) -> str:
    """Return the counts of a sweep, e.g. `75 cases: 70 pass, 4 fail, 1 error; 5 not as expected`."""
    cases = document["cases"]
    shown = counts_text(document["outcomes"], cases - document["met"])
    return f"{counted(cases, 'case')}: {shown}"


def not_judged_words(outcomes: Mapping[str, int]) -> str:
    """Return how many cases no criterion applies to, e.g. ` (2 not judged)`; nothing where there are none."""
    return f" ({outcomes['skipped']} not judged)" if outcomes["skipped"] else ""


def command_alone(manifest: Mapping[str, Any]) -> str:
    """Return the command that works out one `CASE` of a sweep alone, as the sweep did."""
    words = ["uictest", "sweep", str(manifest.get("file", "FILE"))]
    words += [word for text in manifest.get("set") or () for word in ("--set", str(text))]
    if (seed := manifest.get("seed")) is not None:
        words += ["--seed", str(seed)]
    # A folder holds the parts of one selection: neither the sweep's own nor that of another case will do.
    return f"{shlex.join(words)} -k 'CASE' -o 'alone/CASE'"


def swept_words(labels: Sequence[str]) -> str:
    """Return what a parameter takes, e.g. `0.02 .. 0.16 (15 values)`, from the labels of its classes."""
    if labels and all(STRETCH in label for label in labels):
        return f"{labels[0].partition(STRETCH)[0]}{STRETCH}{labels[-1].partition(STRETCH)[2]}, drawn"
    if len(labels) <= _NAMED:
        return ", ".join(labels)
    return f"{labels[0]}{STRETCH}{labels[-1]} ({len(labels)} values)"


def share_words(met: int, cases: int) -> str:
    """Return the share met in percent; `100` and `0` only where no case is an exception."""
    if not cases:
        return "–"  # noqa: RUF001 - a dash on paper
    return str(_parts(100, met, cases))


def bar(met: int, cases: int) -> str:
    """Return the share met as ten blocks, full and empty; all or none only where no case is an exception."""
    if not cases:
        return ""
    full = _parts(10, met, cases)
    return full * "█" + (10 - full) * "░"


def circumstances_words(circumstances: Mapping[str, str]) -> str:
    """Return at which values of the other parameters something was found."""
    return ", ".join(f"{key} = {text}" for key, text in circumstances.items()) or "all cases"


def figure_words(column: str) -> str:
    """Return the name of a column of figures as a reader says it, e.g. `braking distance, m`."""
    name, unit = column, column_unit(column)
    if unit != "1":
        name, _, _ = column.rpartition("_")
        return f"{name.replace('_', ' ')}, {unit}"
    return name.replace("_", " ")


def flip_words(flip: Mapping[str, Any]) -> str:
    """Return where a verdict flips, e.g. `met up to 0.10, not met from 0.11`."""
    before, after = ("met", "not met") if flip["met_at_low"] else ("not met", "met")
    return f"{before} up to {flip['low']}, {after} from {flip['high']}"


def _parts(whole: int, met: int, cases: int) -> int:
    share = round(whole * met / cases)
    # One case of a thousand that misses must be seen.
    return share if met in (0, cases) else min(max(share, 1), whole - 1)
