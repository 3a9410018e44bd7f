"""`uictest open`: show the index of the runs, or the page of one, in the browser."""

from __future__ import annotations

import os
import sys
import webbrowser
from pathlib import Path
from typing import Annotated

from uictest import report, runs
from uictest.cli.options import argument, option
from uictest.cli.output import ExitCode, data, message
from uictest.plans.scenario import yaml
from uictest.runs import history

Place = Annotated[
    str | None,
    argument(
        "RUN|FOLDER",
        "A run, by its name or folder, or a folder of runs [default: the folder of -o].",
        show_default=False,
    ),
]
Output = Annotated[Path, option("-o --output DIR", "Folder of the runs.")]
Last = Annotated[bool, option("--last", "Open the page of the newest run.")]


def open_page(place: Place = None, last: Last = False, output: Output = Path("reports")) -> ExitCode:
    """Open the index of the runs in the browser, or the page of a run. Prints the path of the page.

    Without a browser or a display it only prints the path.
    """
    page = _page(_folder(place, output), last=last)
    data(str(page))
    if problem := _show_in_browser(page):
        message(f"uictest: {problem}; open the file yourself")
    return ExitCode.MET


def _folder(place: str | None, output: Path) -> Path:
    """Return the folder that is named by its path, or by its name below `output`.

    Raises InvalidInputError where there is none.
    """
    for path in [output] if place is None else [Path(place), output / place]:
        folder = runs.run_folder(path)
        if folder.is_dir():
            return folder
    if place is None:
        raise runs.InvalidInputError(f"there is no folder {output}; name the folder of the runs with -o")
    names = [run.name for run in history.list_runs(output).runs] if output.is_dir() else []
    guess = yaml.nearest(place, names)
    hint = f"did you mean {guess!r}?" if guess else "uictest open shows the index of all"
    raise runs.InvalidInputError(f"there is no run {place!r} in {output}; {hint}")


def _page(folder: Path, *, last: bool) -> Path:
    """Return the page of a run, or the index of a folder of runs, written anew. Raises InvalidInputError."""
    entry = history.read_folder(folder.resolve())
    if isinstance(entry, history.ListedRun):
        return _page_of_run(folder.parent, entry, folder.name)
    listing = history.list_runs(folder)
    if not listing.runs:
        raise runs.InvalidInputError(f"{folder} holds no finished run: {_why_none(folder, entry, listing)}")
    if last:
        return _page_of_run(folder, listing.runs[0], listing.runs[0].name)
    problem = history.refresh_index(folder)
    index = folder / history.INDEX
    if problem:
        message(f"uictest: {problem}")
    if not history.is_own_index(index) or not index.exists():
        raise runs.InvalidInputError(f"{folder} has no index of its runs; --last opens the newest run")
    return index.absolute()


def _why_none(folder: Path, entry: history.Unlisted, listing: history.Listing) -> str:
    """Return why a folder is not a run, or, of a folder of runs, why the first of those in it is none."""
    if not listing.unlisted or (folder / history.MANIFEST).exists():
        return entry.reason
    first = listing.unlisted[0]
    return f"{first.name}: {first.reason}"


def _page_of_run(parent: Path, run: history.ListedRun, name: str) -> Path:
    if not run.page:
        raise runs.InvalidInputError(
            f"{parent / name} has no page: uictest report {report.argument(str(parent / name))} --format html"
            " writes it"
        )
    return (parent / name / Path(run.page).name).absolute()


def _show_in_browser(page: Path) -> str:
    """Show a page in the browser; return why that was not possible, empty if it was."""
    # Without a display only a browser for terminals would be found, and would take over this one.
    named = any(os.environ.get(name) for name in ("BROWSER", "DISPLAY", "WAYLAND_DISPLAY"))
    if not named and sys.platform not in ("win32", "darwin"):
        return "there is no display here"
    try:
        shown = webbrowser.open(page.as_uri())
    except (webbrowser.Error, OSError) as error:
        return f"no browser could be started: {error}"
    return "" if shown else "no browser could be started"
