"""`uictest compare`: two runs, two recordings, or the variants of one run side by side."""

from __future__ import annotations

import itertools
import sys
from collections.abc import Sequence
from enum import StrEnum
from pathlib import Path
from typing import Annotated

import typer

from uictest import report, runs
from uictest.analysis import comparison
from uictest.cli.options import ToleranceTexts, Verbose, argument, option, tolerances_of
from uictest.cli.output import ExitCode, data, message, output_width
from uictest.core import files


class ComparisonFormat(StrEnum):
    """Format of a comparison on stdout."""

    TEXT = "text"
    JSON = "json"
    CSV = "csv"
    MARKDOWN = "markdown"


def compare(
    first: Annotated[Path, argument("A", "Folder of a run, or a recording.")],
    second: Annotated[Path | None, argument("B", "Another run or recording.", show_default=False)] = None,
    tolerance: ToleranceTexts = None,
    channels: Annotated[
        list[str] | None,
        option("--channel NAME", "Draw this channel on the page; NAME may contain *. May be repeated."),
    ] = None,
    over: Annotated[
        list[str] | None,
        option(
            "--over KEY",
            "Compare the variants of run A that differ in KEY, such as controller. May be repeated.",
        ),
    ] = None,
    page: Annotated[
        Path | None, option("--html FILE", "Also write a page, with overlay plots of A and B.")
    ] = None,
    shown: Annotated[
        ComparisonFormat, option("--format", "Output on stdout: text, json, csv or markdown.")
    ] = ComparisonFormat.TEXT,
    verbose: Verbose = False,
) -> ExitCode:
    """Compare two runs or two recordings: which is better. Exit 1 if anything is out of tolerance.

    With --over, compare the variants of one run, stop by stop under the same noise.
    """
    if over:
        if second is not None:
            raise typer.BadParameter("compares the variants of one run; leave B out", param_hint="--over")
        if tolerance or channels:
            raise typer.BadParameter("goes with neither --tolerance nor --channel", param_hint="--over")
        return _compare_variants(first, over, shown, page, every=verbose)
    if second is None:
        raise typer.BadParameter("give a second run or recording, or --over KEY", param_hint="B")
    if channels and page is None:
        raise typer.BadParameter("there is no --html page to draw on", param_hint="--channel")
    compared = _compare_paths(
        first, second, tolerances_of(tolerance), None if page is None else channels or []
    )
    _show([compared], shown, comparison.comparison_json(compared), every=verbose)
    if page is not None:
        files.write_to(page, comparison.comparison_html(compared))
        for line in compared.undrawn:
            message(f"uictest: not drawn: {line}")
    message(f"uictest: {comparison.verdict_line(compared)}")
    if compared.is_empty:
        return ExitCode.NOTHING_SELECTED
    return ExitCode.MET if compared.agrees else ExitCode.MISSED


def _show(
    compared: Sequence[comparison.Comparison], shown: ComparisonFormat, json_text: str, *, every: bool
) -> None:
    """Print comparisons in a format."""
    if shown is ComparisonFormat.JSON:
        data(json_text)
    elif shown is ComparisonFormat.CSV:
        heading, *rows = report.csv_text(comparison.csv_table(compared[0])).splitlines()
        others = (report.csv_text(comparison.csv_table(each)).splitlines()[1:] for each in compared[1:])
        for line in (heading, *rows, *itertools.chain.from_iterable(others)):
            data(line)
    elif shown is ComparisonFormat.MARKDOWN:
        data(report.document_markdown(comparison.comparison_document(*compared, every=True)).rstrip("\n"))
    else:
        document = comparison.comparison_document(*compared, every=every)
        for line in report.spaced_lines(document, output_width(sys.stdout)):
            data(line)


def _compare_paths(
    first: Path, second: Path, tolerances: comparison.Tolerances, channels: Sequence[str] | None
) -> comparison.Comparison:
    """Compare two runs or two recordings; `channels` are patterns to draw, None where there is no page."""
    paths = [runs.run_folder(path) for path in (first, second)]
    if any(path.is_dir() for path in paths):
        return _compared_runs(paths[0], paths[1], tolerances, channels)
    one, other = runs.each_file(paths, runs.read_recording)
    same = first.name == second.name
    names = (str(first), str(second)) if same else (first.name, second.name)
    try:
        return comparison.compare_recordings(one, other, names, tolerances, channels or ())
    except ValueError as error:
        raise runs.InvalidInputError(f"--channel: {error}") from error


def _compared_runs(
    first: Path, second: Path, tolerances: comparison.Tolerances, channels: Sequence[str] | None
) -> comparison.Comparison:
    """Compare two runs, and draw the stops that both have recorded and that differ."""
    if reason := runs.why_no_run(first) or runs.why_no_run(second):
        raise runs.InvalidInputError(f"{reason}; compare takes the folders of two runs, or two recordings")
    try:
        compared = comparison.compare_run_folders(first, second, tolerances)
        if channels is None:
            return compared
        return comparison.with_overlays(compared, first, second, channels, tolerances)
    except (OSError, ValueError) as error:
        raise runs.InvalidInputError(f"cannot compare as runs: {error}") from error


def _compare_variants(
    first: Path, keys: Sequence[str], shown: ComparisonFormat, page: Path | None, *, every: bool
) -> ExitCode:
    """Print the paired differences of the variants of a run. Exit 5 where no several stops pair."""
    folder = runs.run_folder(first)
    if reason := runs.why_no_run(folder):
        raise runs.InvalidInputError(f"{reason}; --over takes the folder of a run")
    try:
        run = report.read_run(folder)
    except (OSError, ValueError) as error:
        raise runs.InvalidInputError(f"cannot compare its variants: {error}") from error
    try:
        compared = comparison.compare_variants(run, keys, comparison.Tolerances())
    except ValueError as error:
        raise runs.InvalidInputError(f"--over: {error}") from error
    _show(compared, shown, comparison.variants_json(run.name, compared), every=every)
    if page is not None:
        files.write_to(page, comparison.comparison_html(*compared, run=run.name))
    several = sum(each.groups_with_intervals for each in compared)
    counts = report.counted(several, "group of stops", "groups of stops")
    message(f"uictest: {counts} of {report.counted(len(compared) + 1, 'variant')} paired")
    if not several:
        message("uictest: no case or series has several stops on both sides: --repeat 5 makes them")
    return ExitCode.MET if several else ExitCode.NOTHING_SELECTED
