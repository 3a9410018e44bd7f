"""The page of pairs of stops: which comes to less, how firm that is, and which numbers it hangs on."""

from __future__ import annotations

from collections.abc import Sequence
from typing import Final

from uictest.judging.evaluation import Firmness, VerdictFirmness
from uictest.report.firmness_sentences import FirmPair
from uictest.report.page.axis import spanned
from uictest.report.page.plot import ROW_PIXELS, Plot, Shape, dot, row_at, rows_plot
from uictest.report.page.rendering import render

_MOST: Final = 10
"""Numbers in a drawing; chosen. The table has all."""


def firm_pairs_html(name: str, pairs: Sequence[FirmPair]) -> str:
    """Return one page with how firm it is which stop of each pair comes to less; it loads nothing."""
    return render(
        "firm_pairs.html.j2",
        run=name,
        pairs=pairs,
        reach_of_numbers=reach_of_numbers,
        with_plots=False,
        running_head=name,
    )


def reach_of_numbers(pair: FirmPair, verdict: VerdictFirmness) -> Plot | None:
    """Return where the difference of a quantity goes as each number alone goes to its ends."""
    reaches = _reaches(pair.firmness, verdict)
    if not reaches:
        return None
    axis = spanned([0.0, *(end for _, *ends in reaches for end in ends)], *ROW_PIXELS)
    shapes = [Shape("zero", f"M{axis.at(0.0):.1f} {row_at(0) - 10}V{row_at(len(reaches)) - 10}")]
    for place, (key, low, nominal, high) in enumerate(reaches):
        y, words = row_at(place), f"{key}: {low:+.3g} .. {high:+.3g} %, nominal {nominal:+.3g} %"
        clear = " clear" if low > 0.0 or high < 0.0 else ""
        shapes += [
            Shape("interval-line", f"M{axis.at(low):.1f} {y}H{axis.at(high):.1f}", words),
            Shape(f"effect{clear}", dot(axis.at(nominal), y, 4.0), words),
        ]
    names = [".".join(key.split(".")[-2:]) for key, *_ in reaches]
    about = f"{verdict.criterion}: the difference with each number at the ends of its range"
    x_title = "B - A, % of A; filled: the same side comes to less at both ends"
    return rows_plot(names, shapes, axis.tick_marks(7), about, x_title)


def _reaches(firmness: Firmness, verdict: VerdictFirmness) -> list[tuple[str, float, float, float]]:
    """Return the keys that change a difference most, each with its lowest, nominal and highest value in %."""
    name, margin = verdict.criterion, verdict.margin
    if margin is None:
        return []
    reaches = []
    for number in sorted(firmness.numbers, key=lambda each: -each.effect(name, margin))[:_MOST]:
        ends = [100.0 * end for end in (*number.margins.get(name, ()), margin) if end is not None]
        reaches.append((number.key, min(ends), 100.0 * margin, max(ends)))
    return reaches
