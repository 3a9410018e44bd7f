"""The page of a folder of runs, and its `index.html`."""

from __future__ import annotations

import os
import shlex
from collections.abc import Mapping
from datetime import datetime
from pathlib import Path
from typing import Final, NamedTuple
from urllib.parse import quote

from uictest import report
from uictest.analysis import comparison
from uictest.core import files
from uictest.report.page import case_anchor, fragment, render, series_anchor
from uictest.runs.history.case_history import (
    HEIGHT,
    CaseHistory,
    case_histories,
    changed_inputs,
    runs_with_cases,
    strip,
    summary,
    width,
)
from uictest.runs.history.entry import encodable
from uictest.runs.history.listing import FOLDERS_READ, Listing, list_runs
from uictest.runs.history.run_in_folder import ListedRun

MARK: Final = "uictest/index/1"
"""Stands in every index, so that a page of somebody else is never replaced."""
_CASES_SHOWN: Final = 1000
_UNFOLDED: Final = 20
"""Runs in the table that is open at first."""
_UNLISTED_SHOWN: Final = 50
_UNCHANGED: Final = "same inputs, same versions"
_UNCHANGED_RECORDED: Final = "same recording and versions; preparation not compared"
"""Filter, raster, trigger and channel map of a recorded stop are not part of the entry of its run."""


class RunRow(NamedTuple):
    """A run in the table of runs."""

    run: ListedRun
    href: str
    verdict: str
    tone: str
    command: str
    tally: str
    version: str


def index_html(folder: str, listing: Listing) -> str:
    """Return the page of a folder: one document that loads nothing, and can be read without JavaScript."""
    shown = runs_with_cases(listing.runs)
    histories = case_histories(shown)
    turned = [_turn(each) for each in histories if each.turned]
    return render(
        "index.html.j2",
        with_plots=False,
        running_head=folder,
        mark=MARK,
        folder=folder,
        runs=[_run_row(run) for run in listing.runs],
        unfolded=_UNFOLDED,
        shown=shown,
        slots=[{"label": _slot_label(run), "href": page_href(run)} for run in shown],
        cases=histories[:_CASES_SHOWN],
        strip=strip,
        summary=summary,
        change=_change,
        inputs=_inputs,
        href=_href,
        anchor=_anchor,
        turned=comparison.differences_table(turned) if turned else None,
        rows_by_case={each.id: fragment(_anchor(each)) for each in histories[:_CASES_SHOWN]},
        bounds=_bounds(listing, len(shown), len(histories)),
        unlisted=listing.unlisted[:_UNLISTED_SHOWN],
        more_unlisted=len(listing.unlisted[_UNLISTED_SHOWN:]),
        strip_height=HEIGHT,
        strip_width=width(len(shown)),
        counted=report.counted,
        moment=moment,
    )


def moment(time: datetime) -> str:
    """Return a time for people, UTC."""
    return f"{time:%Y-%m-%d %H:%M:%S}"


def page_href(run: ListedRun) -> str:
    """Return the link to a run; empty where there is none. No name can make it leave the folder."""
    return f"./{quote(os.fsencode(run.page))}" if run.page else ""


def _run_row(run: ListedRun) -> RunRow:
    verdict, tone = _verdict(run)
    version = run.versions.get("uictest", "")
    return RunRow(run, page_href(run), verdict, tone, shlex.join(run.command), _tally(run), version)


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


def _slot_label(run: ListedRun) -> str:
    return f"{moment(run.started)} UTC · {shlex.join(run.command)}"


def _href(history: CaseHistory) -> str:
    """Return the link to a case in the newest run that has it; empty where there is none."""
    href = page_href(history.runs[history.places[-1]])
    return f"{href}#{fragment(_anchor(history))}" if href else ""


def _anchor(history: CaseHistory) -> str:
    return (series_anchor if history.newest.is_series else case_anchor)(history.id)


def _turn(history: CaseHistory) -> report.Difference:
    """Return the verdict of the newest run that has the case against that of the run before it."""
    before, now = (history.entry(place).word for place in history.places[-2:])
    run = f"run of {moment(history.runs[history.places[-1]].started)} UTC"
    return report.Difference(history.id, "outcome", before, now, within=False, remark=run)


def _change(history: CaseHistory) -> tuple[str, str]:
    """Return by how much the distance changed, m, and in per cent; empty where that is not known."""
    change, distance = history.change, history.newest.distance
    if not change or distance is None:
        return "" if change is None else "0", ""
    percent = report.relative_percent(distance - change, distance)
    return f"{change:+.5g}", "" if percent is None else f"{report.percent_text(percent)} %"


def _inputs(history: CaseHistory) -> str:
    """Return what changed in the inputs between the newest two runs that have the case."""
    if len(history.places) < 2:
        return "no earlier run"
    before, now = history.places[-2:]
    changed = changed_inputs(
        (history.runs[before], history.entry(before)), (history.runs[now], history.entry(now))
    )
    if changed is None:
        return "not known"
    unchanged = _UNCHANGED_RECORDED if "recording" in history.entry(now).parts_by_kind else _UNCHANGED
    return ", ".join(changed) or unchanged


def _bounds(listing: Listing, shown: int, cases: int) -> list[str]:
    """Return what the page leaves out."""
    older = sum(bool(run.counts) and not run.cases and run.kind != "sweep" for run in listing.runs)
    sentences: Mapping[str, int] = {
        f"Read: the {FOLDERS_READ} folders changed last; {listing.not_read} older are not.": listing.not_read,
        f"The history covers the newest {shown} runs; {older} older are in the table alone.": older,
        f"{_CASES_SHOWN} of {cases} cases are shown: those not as expected first, then those that turned, "
        "then by the change of the distance.": cases - _CASES_SHOWN,
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
