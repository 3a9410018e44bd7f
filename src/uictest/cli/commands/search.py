"""`uictest search`: look for the stop in which a WSP fails, and write the smallest scenario that shows it."""

from __future__ import annotations

import json
import math
from pathlib import Path
from time import monotonic
from typing import Annotated

import typer

from uictest import report, searching
from uictest.cli import options
from uictest.cli.options import argument, option
from uictest.cli.output import ExitCode, data, message
from uictest.cli.run_display import HEARTBEAT, TerminalObserver
from uictest.core import files
from uictest.plans import search as plans

SearchFile = Annotated[Path, argument("FILE", "Scenario with the section `search`.", show_default=False)]
Stops = Annotated[
    int | None,
    option("--stops N", "Stops to simulate, in place of those of the section.", min=16, max=1_000_000),
]
PointSeed = Annotated[
    int | None, option("--seed", "Seed of the points, in place of that of the section.", min=0, max=2**32 - 1)
]
Resume = Annotated[
    Path | None,
    option(
        "--resume DIR", "Continue the search in DIR, which was interrupted.", exists=True, file_okay=False
    ),
]
SearchOutput = Annotated[
    Path, option("-o --output DIR", "Folder for results; the search gets a folder in it.")
]


def search(
    context: typer.Context,
    file: SearchFile,
    overrides: options.Overrides = None,
    seed: PointSeed = None,
    stops: Stops = None,
    trusted: options.Trusted = None,
    jobs: options.Jobs = "auto",  # type: ignore[assignment]  # typer hands the text to the option's parser
    resume: Resume = None,
    output: SearchOutput = Path("reports"),
    shown: options.ListFormat = options.PlainFormat.TEXT,
    in_process: options.InProcess = False,
) -> ExitCode:
    """Search for stops in which a WSP fails. Exit code 1: found, and written as scenarios; 0: none found."""
    space = plans.load_search(file, tuple(overrides or ()), seed, trusted or (), stops)
    observer = TerminalObserver()
    if in_process and space.loaded.case.is_from_outside:
        observer.foreign_in_process()
    folder = resume or files.new_folder(output, f"{space.name}-search")
    request = searching.SearchRequest(
        space, folder, jobs, resume is not None, in_process=in_process, arguments=context.obj
    )
    try:
        outcome = searching.run_search(request, _Progress(space.search.stops), observer)
    except KeyboardInterrupt:
        kept = f"--resume {report.argument(str(folder))}"
        message(f"uictest: interrupted; finished stops are kept: {kept} continues")
        return ExitCode.INTERRUPTED
    if shown is options.PlainFormat.JSON:
        data(json.dumps(outcome.document(), indent=2, default=str))
    for line in outcome.lines if shown is options.PlainFormat.TEXT else ():
        data(report.no_command(report.printable(line)))
    for number, _ in enumerate(outcome.found, start=1):
        path = report.argument(str(folder / f"found-{number}.yaml"))
        message(f"uictest: uictest run {path}{_trust(file, *trusted or ())}")
    message(f"uictest: {outcome.page or folder}")
    if outcome.found:
        return ExitCode.MISSED
    return ExitCode.NOTHING_SELECTED if outcome.judges_nothing else ExitCode.MET


def _trust(file: Path, *trusted: Path) -> str:
    """Return the options with which the found cases may refer to the scenario and to what it refers to."""
    folders = dict.fromkeys((file.parent, *trusted))
    outside = (each for each in folders if not each.resolve().is_relative_to(Path.cwd()))
    return "".join(f" --trust {report.argument(str(folder))}" for folder in outside)


class _Progress:
    """Writes how far a search is: when the smallest margin has fallen, and now and then."""

    step = 0.1
    """By which the smallest margin must fall to be worth a line; chosen."""

    def __init__(self, stops: int) -> None:
        self._stops = stops
        self._shown = float("inf")
        self._shown_at = monotonic()

    def __call__(self, stops: int, margin: float) -> None:
        has_fallen = margin < self._shown and margin <= self._shown - self.step
        if not has_fallen and monotonic() - self._shown_at < HEARTBEAT:
            return
        self._shown, self._shown_at = margin, monotonic()
        if margin < 0.0:
            message(f"uictest: {stops} stops: making small what was found")
        else:
            nearest = f": smallest margin {margin:.2f}" if math.isfinite(margin) else ""
            message(f"uictest: {stops} of {self._stops} stops{nearest}")
