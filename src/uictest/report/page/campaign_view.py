"""How a page colours the maps of a campaign."""

from __future__ import annotations

from uictest.core.document import Cell
from uictest.report.campaign import CampaignTable

_LIGHTEST, _DARKEST = 6.0, 85.0
"""% of the colour of a shaded cell; chosen so that its text keeps its contrast."""
_WORST_FIRST = ("error", "fail", "inconclusive", "invalid", "skipped", "pass")


def cell_class(cell: Cell) -> str:
    """Return the class of a cell of a map: that of the worst outcome that it counts, or not-seen."""
    if not isinstance(cell, str):
        return "shaded"
    words = cell.replace(",", "").split()
    worst = next((outcome for outcome in _WORST_FIRST if outcome in words), "")
    return f"outcome-{worst}" if worst else "not-seen"


def shade(table: CampaignTable, cell: Cell) -> float | None:
    """Return how dark the cell of a number is, %, between the least and the largest of its map."""
    if cell is None or isinstance(cell, str):
        return None
    numbers = [each for row in table.rows for each in row[1:] if isinstance(each, float)]
    low, high = min(numbers), max(numbers)
    share = (float(cell) - low) / (high - low) if high > low else 0.5
    return round(_LIGHTEST + share * (_DARKEST - _LIGHTEST), 1)
