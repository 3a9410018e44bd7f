"""The comparison with the paper as a table on a terminal."""

from __future__ import annotations

from typing import TYPE_CHECKING

from uictest.studies.comparison import band_text, declared_misses, ours_text, paper_text, result_text
from uictest.studies.study import StudyResult

if TYPE_CHECKING:
    from rich.console import Group

_STYLES = {"holds": "green", "misses": "yellow", "shown": "dim"}


def study_table(result: StudyResult) -> Group:
    """Return title, what the paper says, a row for every quantity, and the notes."""
    from rich.console import Group
    from rich.padding import Padding
    from rich.table import Table
    from rich.text import Text

    study = result.study
    table = Table(box=None, pad_edge=False, header_style="bold")
    table.add_column("quantity", overflow="fold", ratio=5)
    table.add_column("paper", overflow="fold", ratio=3)
    table.add_column("ours", overflow="fold", ratio=4)
    table.add_column("band", overflow="fold", ratio=3)
    table.add_column("status", no_wrap=True)
    table.add_column("result", no_wrap=True)
    for comparison in result.comparisons:
        quantity = comparison.quantity
        cells = (quantity.title, quantity.paper, ours_text(comparison), band_text(quantity), quantity.status)
        style = "bold red" if comparison.fails else _STYLES[comparison.result]
        table.add_row(*map(Text, cells), Text(result_text(comparison), style=style))
    heading = Text(f"{study.name}  ", style="bold").append(study.title, style="not bold")
    paper = Text(paper_text(study), style="dim")
    notes = [Text(note, style="dim") for note in (*declared_misses(result), *result.findings.notes)]
    return Group(heading, paper, Padding(table, (1, 0, 1, 2)), *notes, Text())
