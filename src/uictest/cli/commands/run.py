"""`uictest run`: simulate, judge, report."""

from __future__ import annotations

from collections.abc import Sequence
from pathlib import Path
from typing import Annotated

import typer

from uictest import campaign, evaluation, report, scenario
from uictest.cli.baseline import accept_run, open_baseline, scope_of, show_comparison
from uictest.cli.cases import (
    case_lines,
    cases_json,
    load_cases,
    nothing_selected,
    scenario_paths,
    select_cases,
)
from uictest.cli.exit_codes import ExitCode, of_campaign, worst
from uictest.cli.options import (
    Colour,
    Colouring,
    DryRun,
    ExitFirst,
    Expression,
    Format,
    Jobs,
    JUnitFile,
    MaxFail,
    Output,
    Overrides,
    Paths,
    Quiet,
    Recorded,
    Recording,
    RecordRate,
    Reports,
    RunFormat,
    Seed,
    Tag,
    ToleranceTexts,
    Trusted,
    Verbosity,
    junit_file,
    report_formats,
    tolerances_of,
)
from uictest.cli.streams import data, message


def run(
    context: typer.Context,
    paths: Paths = None,
    expression: Expression = None,
    tag: Tag = None,
    last_failed: Annotated[bool, typer.Option("--lf", help="Cases that failed in the newest run.")] = False,
    overrides: Overrides = None,
    seed: Seed = None,
    trusted: Trusted = None,
    exit_first: ExitFirst = False,
    maxfail: MaxFail = None,
    jobs: Jobs = "auto",  # type: ignore[assignment]  # typer hands the text to the option's parser
    dry_run: DryRun = False,
    output: Output = Path("reports"),
    junit: JUnitFile = None,
    recorded: Recording = Recorded.FAILED,
    record_rate: RecordRate = 100.0,
    shown: RunFormat = Format.TEXT,
    formats: Reports = "csv,html",
    baseline: Annotated[
        Path | None,
        typer.Option(
            "--baseline",
            metavar="DIR",
            help="Compare with the baseline in DIR; exit 1 if a figure is out of tolerance.",
        ),
    ] = None,
    accept: Annotated[
        bool, typer.Option("--accept", help="Make the results of the selected cases the --baseline.")
    ] = False,
    tolerance: ToleranceTexts = None,
    durations: Annotated[
        int | None, typer.Option("--durations", metavar="N", min=0, help="Show the N slowest cases; 0: all.")
    ] = None,
    quiet: Quiet = False,
    verbosity: Verbosity = 0,
    colour: Colouring = Colour.AUTO,
) -> ExitCode:
    """Run scenarios, judge each case and write the reports."""
    wanted = report_formats(formats, "--report", report.format_names())
    tolerances = tolerances_of(tolerance)
    if accept and baseline is None:
        raise typer.BadParameter("there is no --baseline to update", param_hint="--accept")
    cases = load_cases(paths, overrides, seed, trusted)
    selected = select_cases(cases, expression, tag)
    if last_failed:
        from uictest.cli.last_failed import failed_last

        selected = failed_last(selected, output)
    if not selected:
        message(nothing_selected(cases))
        return ExitCode.NOTHING_SELECTED
    if dry_run:
        data(cases_json(selected) if shown is Format.JSON else case_lines(selected))
        return ExitCode.MET

    accepted = None
    if baseline is not None:
        searched = () if expression or tag or last_failed else scenario_paths(paths)
        accepted = open_baseline(baseline, scope_of(selected, searched), tolerances, accepting=accept)

    from uictest.cli.batch import Batch, run_batch
    from uictest.cli.display import chosen_display

    parts = campaign.parts_of_cases(selected)
    batch = Batch(
        cases=selected,
        parts=parts,
        manifest=report.run_manifest(
            context.obj.arguments, seed, _inputs(selected), len(selected), parts.values()
        ),
        recording=campaign.RecordingRequest(recorded.value, every=1.0 / record_rate),
        jobs=min(jobs, len(selected)),
        maxfail=1 if exit_first else maxfail,
        output=output,
        junit=junit_file(junit, output),
        formats=wanted,
        quiet=quiet,
        verbose=verbosity > 0,
        baseline=None if accept else accepted,
    )
    done, published = run_batch(
        batch, chosen_display(shown, colour, quiet=batch.quiet, verbose=batch.verbose)
    )
    if durations is not None:
        _show_slowest(done.results, durations or len(done.results))
    code = of_campaign(done)
    if baseline is None or published is None:
        return code
    if not accept:
        return worst(code, show_comparison(published.content.baseline, quiet=quiet))
    if done.interrupted:
        message(f"uictest: interrupted: {baseline} stays as it was")
    else:
        accept_run(published, baseline, accepted)
    return code


def _inputs(cases: Sequence[scenario.Case]) -> dict[str, str]:
    return {name: digest for case in cases for name, digest in case.inputs.items()}


def _show_slowest(results: Sequence[evaluation.CaseResult], count: int) -> None:
    slowest = sorted(results, key=lambda result: result.duration, reverse=True)[:count]
    message(f"uictest: the slowest {len(slowest)} of {len(results)} cases")
    for result in slowest:
        message(f"{result.duration:9.3f} s  {result.id}")
