"""The page of a folder of runs: its `index.html`."""

from __future__ import annotations

import os
from pathlib import Path
from typing import Final
from urllib.parse import quote

from uictest import report
from uictest.core import files
from uictest.report.page import render
from uictest.runs.history.listing import FOLDERS_READ, ListedRun, Listing, encodable, list_runs

INDEX: Final = "index.html"
MARK: Final = "uictest/index/1"
"""Stands in every index, so that a page of somebody else is never replaced."""
_UNLISTED_SHOWN: Final = 50
_PATIENCE: Final = 10.0
"""How long another process may take to write the index, s."""


def index_html(folder: str, listing: Listing) -> str:
    """Return the page of a folder: one document that loads nothing and runs no script."""
    return render(
        "index.html.j2",
        with_plots=False,
        running_head=folder,
        mark=MARK,
        folder=folder,
        listing=listing,
        folders_read=FOLDERS_READ,
        unlisted_shown=_UNLISTED_SHOWN,
        page_href=page_href,
        verdict_of=verdict_of,
        tally=tally,
    )


def page_href(run: ListedRun) -> str:
    """Return the link to a run; empty where there is none. No name can make it leave the folder."""
    return f"./{quote(os.fsencode(run.page))}" if run.page else ""


def verdict_of(run: ListedRun) -> tuple[str, str]:
    """Return whether all cases are as expected, and the tone of that."""
    if not run.complete:
        return "incomplete", "odd"
    words = [*run.counts, *run.series]
    if not words:
        return "–", "none"  # noqa: RUF001 - a dash on paper
    if "error" in words:
        return "error", "odd"
    return ("not met", "bad") if run.not_met else ("met", "good")


def tally(run: ListedRun) -> str:
    """Return the counts of a run in words; the note where there are none."""
    texts = []
    if cases := sum(run.counts.values()):
        texts.append(f"{report.counted(cases, 'case')}: {report.counts_text(run.counts, 0)}")
    if run.series:
        of_series = ", ".join(f"{count} {word}" for word, count in run.series.items())
        texts.append(f"{sum(run.series.values())} series: {of_series}")
    return "; ".join(filter(None, [*texts, run.note]))


def refresh_index(folder: Path) -> str:
    """Write the index of a folder of runs; return why it was not written, empty if it was.

    A page of somebody else is left alone. Processes that end at the same time write one after the other, so
    that the last index has the runs of all. Raises nothing: what the index lists is published already.
    """
    path = folder / INDEX
    try:
        if not is_own_index(path):
            return f"{path} is no index of runs: it is left as it is, and there is no list of the runs here"
        with files.FolderLock(folder, patience=_PATIENCE):
            page = index_html(folder.resolve().name or str(folder), list_runs(folder))
            files.write(folder, INDEX, encodable(page))
    except files.FolderInUseError as error:
        return f"{path} is not refreshed: {folder} is in use by {error}; the next run refreshes it"
    except OSError as error:
        about = "" if error.filename in (None, str(path), str(folder)) else f"{error.filename} "
        return f"{path} is not refreshed: {about}{error.strerror or error}"
    return ""


def is_own_index(path: Path) -> bool:
    """Return whether a file is an index, or there is none. Raises OSError."""
    return report.may_replace(path, MARK)
