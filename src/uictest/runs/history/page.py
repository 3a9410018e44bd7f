"""The page of a folder of runs, and its `index.html`."""

from __future__ import annotations

import os
from collections.abc import Mapping
from pathlib import Path
from typing import Final, NamedTuple
from urllib.parse import quote

from uictest import report
from uictest.core import files
from uictest.report.page import render
from uictest.runs.history.entry import encodable
from uictest.runs.history.listing import FOLDERS_READ, Listing, list_runs
from uictest.runs.history.run_in_folder import ListedRun

MARK: Final = "uictest/index/1"
"""Stands in every index, so that a page of somebody else is never replaced."""
_UNLISTED_SHOWN: Final = 50


class RunRow(NamedTuple):
    """A run in the table of runs."""

    run: ListedRun
    href: str
    verdict: str
    tone: str
    tally: str
    distance: str


def index_html(folder: str, listing: Listing) -> str:
    """Return the page of a folder: one document that loads nothing and runs no script."""
    return render(
        "index.html.j2",
        with_plots=False,
        running_head=folder,
        mark=MARK,
        folder=folder,
        rows=[_run_row(run) for run in listing.runs],
        bounds=_bounds(listing),
        unlisted=listing.unlisted[:_UNLISTED_SHOWN],
        more_unlisted=len(listing.unlisted[_UNLISTED_SHOWN:]),
    )


def page_href(run: ListedRun) -> str:
    """Return the link to a run; empty where there is none. No name can make it leave the folder."""
    return f"./{quote(os.fsencode(run.page))}" if run.page else ""


def _run_row(run: ListedRun) -> RunRow:
    return RunRow(run, page_href(run), *_verdict(run), _tally(run), _distance(run))


def _verdict(run: ListedRun) -> tuple[str, str]:
    """Return whether all cases are as expected, and the tone of that."""
    if not run.complete:
        return "incomplete", "odd"
    counts = [*run.counts, *run.series]
    if not counts:
        return "–", "none"  # noqa: RUF001 - a dash on paper
    if "error" in counts:
        return "error", "odd"
    return ("not met", "bad") if run.not_met else ("met", "good")


def _tally(run: ListedRun) -> str:
    """Return the counts of a run in words; the note where there are none."""
    of_series = ", ".join(f"{count} {word}" for word, count in run.series.items())
    cases = sum(run.counts.values())
    texts = [
        f"{report.counted(cases, 'case')}: {report.counts_text(run.counts, 0)}" if cases else "",
        f"{sum(run.series.values())} series: {of_series}" if of_series else "",
        run.note,
    ]
    return "; ".join(filter(None, texts))


def _distance(run: ListedRun) -> str:
    """Return the braking distance of a run, of several stops the shortest and the longest; empty without."""
    shown = dict.fromkeys(f"{distance:.1f}" for distance in run.distances or ())
    return " .. ".join(shown)


def _bounds(listing: Listing) -> list[str]:
    """Return what the page leaves out."""
    sentences: Mapping[str, int] = {
        f"Read: the {FOLDERS_READ} folders changed last; {listing.not_read} older are not.": listing.not_read,
        f"{report.counted(listing.partial, 'folder')} being filled, or left by a killed run.": (
            listing.partial
        ),
    }
    return [sentence for sentence, count in sentences.items() if count > 0]


INDEX: Final = "index.html"
_PATIENCE: Final = 10.0
"""How long another process may take to write the index, s."""


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
