"""The summary in Markdown, as a job's summary on GitHub shows it."""

from __future__ import annotations

from functools import partial
from typing import TYPE_CHECKING

from uictest.report.markdown_table import MarkdownTable, row
from uictest.report.markdown_text import code, figure, prose
from uictest.report.step_summary import LIMIT, append_to_step_summary
from uictest.report.wording import explanation, tally, verdict_word

if TYPE_CHECKING:
    from uictest.evaluation import CaseResult
    from uictest.report.content import RunContent

_FIGURES = {
    "braking_distance_m": ".1f",
    "braking_time_s": ".1f",
    "mean_deceleration_mps2": ".3f",
    "initial_adhesion_g": ".4f",
}
_COLUMNS = (
    *("verdict", "case", "outcome"),
    *("distance, m", "time, s", "mean, m/s²", "initial, g", "slide, %"),
    "why",
)


def markdown_summary(content: RunContent, limit: int = LIMIT) -> str:
    """Return the summary: the tally, then one row per case, those not met first.

    What would go beyond `limit` bytes is left out, and a last line says how many cases that is.
    """
    text = f"## uictest: {tally(content.results)}\n\n"
    if not content.complete:
        text += "**Incomplete**: selected cases were not run.\n\n"
    ordered = sorted(content.results, key=lambda result: result.met)
    rows = [_row(result, recorded=bool(content.subject(result.id).recorded)) for result in ordered]
    table = MarkdownTable(_COLUMNS, "lllrrrrrl", rows, "more cases are in `summary.csv` and `results.json`.")
    return text + table.within(limit - len(text.encode()))


def append_step_summary(content: RunContent) -> None:
    """Append the summary to the file that GitHub Actions names, where it does. Raises OSError."""
    append_to_step_summary(partial(markdown_summary, content))


def _row(result: CaseResult, *, recorded: bool) -> str:
    word = verdict_word(result)
    slide = max((wheelset.maximum_slide for wheelset in result.wheelsets), default=None)
    figures = [figure(getattr(result.measures, name, None), form) for name, form in _FIGURES.items()]
    figures.append(figure(None if slide is None else 100 * slide, ".1f"))
    why = "" if result.met else prose("; ".join(explanation(result)))
    outcome = f"{result.outcome} (recorded stop)" if recorded else result.outcome
    cells = (word if result.met else f"**{word}**", code(result.id), outcome, *figures, why)
    return row(cells)
