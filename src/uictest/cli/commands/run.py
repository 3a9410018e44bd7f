"""`uictest run`: simulate, judge, report."""

from __future__ import annotations

from collections.abc import Sequence
from pathlib import Path
from typing import Annotated

import typer

from uictest import report, runs
from uictest.cli import earlier_runs, options, run_display
from uictest.cli.cases import case_lines, drawn_first, select_by_options, selection_json, series_lines
from uictest.cli.options import option
from uictest.cli.output import ExitCode, data, message, of_run, warn_of_implausible, worst
from uictest.judging import evaluation
from uictest.plans import scenario, series
from uictest.running import campaign

LastFailed = Annotated[bool, option("--lf", "Select the cases that were not as expected in the newest run.")]
BaselineFolder = Annotated[
    Path | None,
    option("--baseline DIR", "Compare with the baseline in DIR; exit 1 if a measure is out of tolerance."),
]
Accept = Annotated[bool, option("--accept", "Make the results of the selected cases the new baseline.")]
Repeat = Annotated[
    int | None,
    option(
        "--repeat N",
        "Run the stop of every case N times, under its seed and those that follow it.",
        min=1,
        max=1000,
    ),
]
SuggestExpect = Annotated[
    bool, option("--suggest-expect", "Also print the `expect` lines that what came out meets, to paste.")
]
Durations = Annotated[int | None, option("--durations N", "List the N slowest cases; 0 lists all.", min=0)]


def run(
    context: typer.Context,
    paths: options.Paths = None,
    expression: options.Expression = None,
    tag: options.Tag = None,
    last_failed: LastFailed = False,
    overrides: options.Overrides = None,
    seed: options.Seed = None,
    repeat: Repeat = None,
    trusted: options.Trusted = None,
    exit_first: options.ExitFirst = False,
    maxfail: options.MaxFail = None,
    jobs: options.Jobs = "auto",  # type: ignore[assignment]  # typer hands the text to the option's parser
    dry_run: options.DryRun = False,
    output: options.Output = Path("reports"),
    keep: options.KeptRuns = None,
    junit: options.JUnitFile = None,
    recorded: options.RecordingChoice = options.Recorded.FAILED,
    record_rate: options.RecordRate = 100.0,
    shown: options.RunFormat = options.Format.TEXT,
    formats: options.Reports = "csv,html",
    draw: options.Draw = None,
    baseline: BaselineFolder = None,
    accept: Accept = False,
    tolerance: options.ToleranceTexts = None,
    validated: options.Validated = None,
    strict: options.Strict = False,
    firm: options.Firm = False,
    calibrated_by: options.CalibratedBy = None,
    durations: Durations = None,
    suggest_expect: SuggestExpect = False,
    in_process: options.InProcess = False,
    real_time: options.RealTime = False,
    quiet: options.Quiet = False,
    verbose: options.Verbose = False,
) -> ExitCode:
    """Run scenarios, judge each case and write the reports."""
    spared = earlier_runs.named_paths(baseline, validated, junit, *(paths or ()))
    report_formats = options.report_formats(formats, "--report", report.FORMATS)
    choice = earlier_runs.BaselineChoice.of(baseline, options.tolerances_of(tolerance), accepting=accept)
    changes = overrides if repeat is None else [*(overrides or ()), f"repeat={repeat}"]
    programme = runs.load_programme(paths, changes or (), seed, trusted)
    if programme is not None:
        _require_whole(suggest_expect=suggest_expect, lf=last_failed, real_time=real_time)
    if programme is not None:
        cases, planned = programme.cases, list[series.Series]()
    else:
        cases, planned = runs.load_cases_and_series(paths, changes, seed, trusted)
    selected = select_by_options(cases, expression, tag)
    of_series = select_by_options(planned, expression, tag)
    if last_failed:
        selected, of_series = earlier_runs.failed_last(selected, of_series, output)
    if not (selected or of_series):
        message(f"uictest: {runs.nothing_selected(cases, planned)}")
        return ExitCode.NOTHING_SELECTED
    if real_time:
        _require_paced(selected, of_series)
    if dry_run:
        _show_selection(selected, of_series, shown)
        return ExitCode.MET
    searched = () if expression or tag or last_failed else runs.scenario_paths(paths)
    accepted = earlier_runs.open_baseline(choice, earlier_runs.scope_of(selected, of_series, searched))
    settings = campaign.RunSettings(
        jobs,
        campaign.RecordingRequest(recorded.value, every=1.0 / record_rate),
        maxfail=1 if exit_first else maxfail,
        in_process=in_process,
        real_time=real_time,
        strict=strict,
        firm=firm or None,
        calibration=options.calibration(calibrated_by, trusted, firm=firm),
    )
    batch = runs.batch_of(
        *(selected, of_series, context.obj, seed, settings),
        validated=validated,
        baseline=None if accept else accepted,
        drawn_first=drawn_first(selected, of_series, draw),
    )
    batch = batch if programme is None else runs.of_programme(batch, programme)
    warn_of_implausible(runs.implausible_trains(batch.all_cases))
    display = run_display.chosen_display(shown, quiet=quiet, verbose=verbose)
    junit_file = options.junit_file(junit, output)
    published = run_display.publish_and_show(batch, output, report_formats, junit_file, display)
    if published is None:
        return ExitCode.INTERRUPTED
    _show_slowest(published.content.all_results, durations)
    for line in report.expectation_lines(published.content.results) if suggest_expect else ():
        (data if shown is options.Format.TEXT else message)(line)
    compared = earlier_runs.accept_or_compare(choice, accepted, published, quiet=quiet)
    code = worst(of_run(published), compared)
    earlier_runs.keep_newest(code, keep, published.place, "run", spared)
    return code


def _require_whole(**options: bool) -> None:
    """Raise typer.BadParameter for an option that says nothing of a programme."""
    for name in (name for name, is_set in options.items() if is_set):
        hint = f"--{name.replace('_', '-')}"
        raise typer.BadParameter("a programme is run and judged as a whole", param_hint=hint)


def _require_paced(cases: Sequence[scenario.Case], planned: Sequence[series.Series]) -> None:
    """Raise typer.BadParameter unless the controllers are programs at a socket, each for one stop."""
    of_series = [f"{one.id} is a series; run single stops in real time" for one in planned]
    for reason in filter(None, (*map(_why_not_paced, cases), *of_series)):
        raise typer.BadParameter(reason, param_hint="--real-time")


def _why_not_paced(case: scenario.Case) -> str:
    """Return the reason for which a stop cannot be paced by the clock; empty where it can."""
    if case.scenario.repeat > 1:
        return f"{case.id} repeats its stop {case.scenario.repeat} times; run one stop: --repeat 1"
    if case.train is not None:
        return f"{case.id} is {case.train.label}: cycles of a train are not paced, run a car alone"
    program = case.scenario.controller.program
    if program is None or program.kind != "connect":
        name = case.scenario.controller.name
        return f"{case.id} has the controller {name!r}; expected one with `connect`, a program at a socket"
    return ""


def _show_selection(
    cases: Sequence[scenario.Case], planned: Sequence[series.Series], shown: options.Format
) -> None:
    """Show what would run. JSON has the cases and then the series in one array."""
    if shown is options.Format.JSON:
        data(selection_json(cases, planned))
        return
    for lines in filter(None, (case_lines(cases), series_lines(planned))):
        data(lines)


def _show_slowest(results: Sequence[evaluation.CaseResult], count: int | None) -> None:
    """Show the slowest cases on stderr: `count` of them, all for 0, none for None."""
    if count is None:
        return
    slowest = sorted(results, key=lambda result: result.duration, reverse=True)[: count or len(results)]
    message(f"uictest: the slowest {len(slowest)} of {len(results)} cases")
    for result in slowest:
        message(f"{result.duration:9.3f} s  {result.id}")
