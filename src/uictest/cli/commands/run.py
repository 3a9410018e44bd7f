"""`uictest run`: simulate, judge, report."""

from __future__ import annotations

from collections.abc import Sequence
from pathlib import Path
from typing import Annotated

import typer

from uictest import campaign, evaluation, report, scenario
from uictest.cli import options, running
from uictest.cli.cases import (
    case_lines,
    cases_json,
    load_cases,
    nothing_selected,
    scenario_paths,
    select_by_options,
)
from uictest.cli.exit_codes import ExitCode, of_batch, worst
from uictest.cli.output import data, message

LastFailed = Annotated[
    bool, typer.Option("--lf", help="Select the cases that were not as expected in the newest run.")
]
BaselineFolder = Annotated[
    Path | None,
    typer.Option(
        "--baseline",
        metavar="DIR",
        help="Compare with the baseline in DIR; exit 1 if a measure is out of tolerance.",
    ),
]
Accept = Annotated[
    bool, typer.Option("--accept", help="Make the results of the selected cases the new baseline.")
]
Durations = Annotated[
    int | None, typer.Option("--durations", metavar="N", min=0, help="List the N slowest cases; 0 lists all.")
]


def run(
    context: typer.Context,
    paths: options.Paths = None,
    expression: options.Expression = None,
    tag: options.Tag = None,
    last_failed: LastFailed = False,
    overrides: options.Overrides = None,
    seed: options.Seed = None,
    trusted: options.Trusted = None,
    exit_first: options.ExitFirst = False,
    maxfail: options.MaxFail = None,
    jobs: options.Jobs = "auto",  # type: ignore[assignment]  # typer hands the text to the option's parser
    dry_run: options.DryRun = False,
    output: options.Output = Path("reports"),
    junit: options.JUnitFile = None,
    recorded: options.RecordingChoice = options.Recorded.FAILED,
    record_rate: options.RecordRate = 100.0,
    shown: options.RunFormat = options.Format.TEXT,
    formats: options.Reports = "csv,html",
    baseline: BaselineFolder = None,
    accept: Accept = False,
    tolerance: options.ToleranceTexts = None,
    durations: Durations = None,
    in_process: options.InProcess = False,
    real_time: options.RealTime = False,
    quiet: options.Quiet = False,
    verbosity: options.Verbosity = 0,
    colour: options.Colouring = options.Colour.AUTO,
) -> ExitCode:
    """Run scenarios, judge each case and write the reports."""
    names = options.report_formats(formats, "--report", report.format_names())
    choice = running.BaselineChoice.of(baseline, options.tolerances_of(tolerance), accepting=accept)
    cases = load_cases(paths, overrides, seed, trusted)
    selected = _selected(cases, expression, tag, output if last_failed else None)
    if not selected:
        message(nothing_selected(cases))
        return ExitCode.NOTHING_SELECTED
    if real_time:
        _require_sockets(selected)
    if dry_run:
        data(cases_json(selected) if shown is options.Format.JSON else case_lines(selected))
        return ExitCode.MET
    searched = () if expression or tag or last_failed else scenario_paths(paths)
    accepted = running.open_baseline(choice, running.scope_of(selected, searched))
    parts = campaign.parts_of_cases(selected)
    batch = running.Batch(
        cases=selected,
        parts=parts,
        manifest=_manifest(context.obj.arguments, seed, selected, parts),
        recording=campaign.RecordingRequest(recorded.value, every=1.0 / record_rate),
        jobs=min(jobs, len(selected)),
        maxfail=1 if exit_first else maxfail,
        output=output,
        junit=options.junit_file(junit, output),
        formats=names,
        quiet=quiet,
        verbose=verbosity > 0,
        in_process=in_process,
        real_time=real_time,
        baseline=None if accept else accepted,
    )
    done, published = running.run_batch(
        batch, running.chosen_display(shown, colour, quiet=quiet, verbose=verbosity > 0)
    )
    _show_slowest(done.results, durations)
    return worst(of_batch(done), running.accept_or_compare(choice, accepted, done, published, quiet=quiet))


def _selected(
    cases: Sequence[scenario.Case], expression: str | None, tag: str | None, last_run: Path | None
) -> list[scenario.Case]:
    """Return the cases selected by expression and tag, and by their last run below `last_run`, if given."""
    selected = select_by_options(cases, expression, tag)
    return selected if last_run is None else running.failed_last(selected, last_run)


def _require_sockets(cases: Sequence[scenario.Case]) -> None:
    """Raise typer.BadParameter unless the controllers of all cases are programs at a socket."""
    for case in cases:
        program = case.scenario.controller.program
        if program is None or program.kind != "connect":
            expected = "expected one with `connect`, a program at a socket"
            message = f"{case.id} has the controller {case.scenario.controller.name!r}; {expected}"
            raise typer.BadParameter(message, param_hint="--real-time")


def _manifest(
    arguments: Sequence[str],
    seed: int | None,
    cases: Sequence[scenario.Case],
    parts: campaign.PartsOfCases,
) -> report.RunManifest:
    return report.run_manifest(arguments, seed, _inputs(cases), len(cases), parts.values())


def _inputs(cases: Sequence[scenario.Case]) -> dict[str, str]:
    return {name: digest for case in cases for name, digest in case.inputs.items()}


def _show_slowest(results: Sequence[evaluation.CaseResult], count: int | None) -> None:
    """Show the slowest cases on stderr: `count` of them, all for 0, none for None."""
    if count is None:
        return
    slowest = sorted(results, key=lambda result: result.duration, reverse=True)[: count or len(results)]
    message(f"uictest: the slowest {len(slowest)} of {len(results)} cases")
    for result in slowest:
        message(f"{result.duration:9.3f} s  {result.id}")
