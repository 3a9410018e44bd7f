"""`uictest sweep`: run many cases of one scenario, in chunks that survive an interruption."""

from __future__ import annotations

import sys
from pathlib import Path
from time import perf_counter
from typing import Annotated

import typer

from uictest import report, runs
from uictest.analysis import summaries
from uictest.cli import options
from uictest.cli.cases import malformed
from uictest.cli.options import argument, option
from uictest.cli.output import ExitCode, append_summary, data, message, output_width, warn_of_implausible
from uictest.cli.run_display import TerminalObserver
from uictest.core import files
from uictest.plans import sweeps
from uictest.report import counted, printable
from uictest.running import chunked
from uictest.runs import history

SweepFile = Annotated[Path, argument("FILE", "Sweep file (*.sweep.yaml).")]
Frontier = Annotated[
    str | None,
    option("--frontier KEY", "Find where the verdict flips along KEY, between its values in the sweep."),
]
Tolerance = Annotated[
    str | None,
    option(
        "--tolerance VALUE",
        "Accuracy of --frontier, such as 0.001 or '0.5 km/h' [default: 1/64 of the smallest step].",
    ),
]
MapPair = Annotated[
    str | None,
    option("--map KEY,KEY", "Parameters down and across the maps [default: the first two listed]."),
]
Measures = Annotated[
    list[str] | None,
    option(
        "--measure NAME",
        "Measure to map and to compute sensitivities of: a column of summary.csv. May be repeated.",
    ),
]
SweepFormat = Annotated[
    options.Format,
    option(
        "--format",
        "Output on stdout: text (maps and rates), json (results.json) or github (text, annotations).",
    ),
]
Shard = Annotated[str | None, option("--shard I/N", "Run shard I of N only; --merge combines shards.")]
Merged = Annotated[
    list[Path] | None, option("--merge DIR", "Merge the chunks of the shard in DIR. May be repeated.")
]
Dask = Annotated[str | None, option("--dask ADDRESS", "Simulate on the cluster of this scheduler.")]
SweepReports = Annotated[
    str | None,
    option(
        "--report FORMATS",
        f"Reports to write, joined by commas: {', '.join(report.FORMATS)}.",
        show_default=f"csv,html; html for more than {report.LARGEST_CSV} cases",
    ),
]
Restart = Annotated[bool, option("--restart", "Discard finished chunks and start again.")]
SweepOutput = Annotated[
    Path, option("-o --output DIR", "Folder for results; the sweep gets a folder of its name in it.")
]


def sweep(
    file: SweepFile,
    expression: options.Expression = None,
    overrides: options.Overrides = None,
    seed: options.Seed = None,
    trusted: options.Trusted = None,
    exit_first: options.ExitFirst = False,
    maxfail: options.MaxFail = None,
    jobs: options.Jobs = "auto",  # type: ignore[assignment]  # typer hands the text to the option's parser
    shard: Shard = None,
    merged: Merged = None,
    dask: Dask = None,
    restart: Restart = False,
    dry_run: options.DryRun = False,
    frontier: Frontier = None,
    tolerance: Tolerance = None,
    pair: MapPair = None,
    validated: options.Validated = None,
    firm: options.Firm = False,
    calibrated_by: options.CalibratedBy = None,
    measures: Measures = None,
    output: SweepOutput = Path("reports"),
    junit: options.JUnitFile = None,
    shown: SweepFormat = options.Format.TEXT,
    formats: SweepReports = None,
    quiet: options.Quiet = False,
    in_process: options.InProcess = False,
) -> ExitCode:
    """Run a sweep. After an interruption the same command continues it."""
    format_names = None if formats is None else options.report_formats(formats, "--report", report.FORMATS)
    plan = sweeps.load_sweep(file, tuple(overrides or ()), seed, trusted or ())
    warn_of_implausible(runs.implausible_trains([plan.base]))
    selection = selected_cases(plan, expression)
    if selection.size == 0:
        message(f"uictest: nothing selected among {report.counted(plan.size, 'case')}")
        return ExitCode.NOTHING_SELECTED
    if dry_run:
        show_ids(selection)
        return ExitCode.MET
    with options.rejected("--shard"):
        own_shard = chunked.Shard() if shard is None else chunked.parse_shard(shard)
    with options.rejected("--dask"):
        if dask is not None:
            chunked.check_address(dask)
    with options.rejected("--measure"):
        columns = runs.measure_names(measures)
    with (
        options.rejected("--frontier", summaries.FrontierError),
        options.rejected("--tolerance", runs.ToleranceError),
    ):
        search = runs.frontier_search(plan, frontier, tolerance)
    request = runs.SweepRequest(
        selection=selection,
        manifest=chunked.sweep_manifest(
            selection, expression=expression, overrides=overrides or (), seed=seed
        ),
        folder=output / plan.name,
        jobs=jobs,
        shard=own_shard,
        merged=tuple(merged or ()),
        cluster=dask,
        restart=restart,
        maxfail=1 if exit_first else maxfail,
        pair=_map_pair(plan, pair),
        measures=columns,
        search=search,
        reference=runs.reference_of(validated, plan.base.scenario.validated),
        firm=firm or plan.base.scenario.firm,
        calibration=options.calibration(calibrated_by, trusted, firm=firm),
        formats=format_names,
        in_process=in_process,
    )
    return _execute(request, shown, options.junit_file(junit, request.folder), quiet=quiet)


def selected_cases(plan: sweeps.Plan, expression: str | None) -> chunked.CaseSelection:
    """Return the cases that `-k` selects. Raises typer.BadParameter for a malformed expression."""
    with malformed("-k", expression):
        return chunked.select_cases(plan, expression)


def _map_pair(plan: sweeps.Plan, text: str | None) -> tuple[str, str] | None:
    """Return the parameters that `--map` names, else the first two with several listed values."""
    if text is None:
        return runs.first_pair(plan)
    first, _, second = text.partition(",")
    pair = (first.strip(), second.strip())
    unknown = [key for key in pair if key not in plan.keys]
    if unknown or pair[0] == pair[1]:
        accepted = ", ".join(plan.keys)
        raise typer.BadParameter(f"name two parameters of {accepted}, as KEY,KEY", param_hint="--map")
    return pair


def show_ids(selection: chunked.CaseSelection) -> bool:
    """Write the ids of the selected cases to stdout, one per line; return whether all were accepted."""
    return all(data("\n".join(map(printable, ids))) for ids in selection.id_blocks())


def _show_result(finished: runs.FinishedSweep, shown: options.Format, *, quiet: bool) -> None:
    """Write the result document, or the sweep as text, to stdout; if `quiet`, only what is missed.

    Annotations list that already.
    """
    if shown is options.Format.JSON:
        data(finished.document.rstrip("\n"))
        return
    if quiet and shown is options.Format.GITHUB:
        return
    content = finished.content
    for line in report.sweep_lines(content.result, content.manifest, output_width(sys.stdout), quiet=quiet):
        data(report.no_command(line))


class SweepObserver(TerminalObserver):
    """Writes messages and progress to stderr; if `quiet`, only what went wrong or was asked for.

    `merging` says whether the chunks of shards are merged.
    """

    def __init__(self, *, quiet: bool, merging: bool) -> None:
        super().__init__(quiet=quiet)
        self._merging = merging

    def damaged(self, chunk: Path) -> None:
        """Report a damaged chunk."""
        message(f"uictest: {chunk} is damaged: recomputing this chunk")

    def damaged_in_shard(self, chunk: Path) -> None:
        """Report a damaged chunk of a shard."""
        message(f"uictest: {chunk} is damaged: skipped")

    def merged(self, chunks: int, shard: Path) -> None:
        """Report what a shard brought."""
        message(f"uictest: {counted(chunks, 'chunk')} from {shard}")

    def found(self, cases: int, missing: int) -> None:
        """Report how many cases are already finished, or how many no shard provided."""
        if self._merging and missing:
            verb = "is" if missing == 1 else "are"
            pronoun = "it" if missing == 1 else "them"
            message(
                f"uictest: {missing} of {counted(cases, 'case')} {verb} missing from the shards: "
                f"simulating {pronoun} here"
            )
        elif missing < cases and not self.quiet:
            message(f"uictest: {cases - missing} of {counted(cases, 'case')} are already finished")

    def waiting(self, address: str) -> None:
        """Report that a cluster has no workers yet."""
        message(f"uictest: waiting for workers at {address}")

    def searching(self, key: str) -> None:
        """Report that the frontier is being searched."""
        if not self.quiet:
            message(f"uictest: searching the frontier along {key}")


def _execute(
    request: runs.SweepRequest, shown: options.Format, junit: Path | None, *, quiet: bool
) -> ExitCode:
    """Run a sweep and show its result; return its exit code. Raises InvalidInputError, OSError."""
    try:
        return _run_and_show(request, shown, junit, quiet=quiet)
    except runs.MaxfailReached as reached:
        message(f"uictest: stopped at --maxfail: {reached}")
        message(
            f"uictest: finished chunks are kept in {request.folder}; "
            "the same command without --maxfail continues"
        )
        return ExitCode.MISSED
    except KeyboardInterrupt:
        message("uictest: interrupted")
        _report_finished_chunks(request)
        return ExitCode.INTERRUPTED
    except OSError:
        _report_finished_chunks(request)
        raise


def _run_and_show(
    request: runs.SweepRequest, shown: options.Format, junit: Path | None, *, quiet: bool
) -> ExitCode:
    started = perf_counter()
    finished = runs.run_sweep(request, SweepObserver(quiet=quiet, merging=bool(request.merged)))
    if finished is None:
        shard, chunks = request.shard, request.selection.chunks
        ended = f"is finished in {request.folder}"
        if not shard.chunk_numbers(chunks):
            ended = f"has no cases: the sweep has only {counted(chunks, 'chunk')}"
        message(f"uictest: shard {shard.number} of {shard.count} {ended}")
        return ExitCode.MET
    if problem := history.refresh_index(request.folder.parent):
        message(f"uictest: {problem}")
    append_summary(lambda: report.append_step_summary(finished.publication))
    if junit is not None:
        files.write_to(junit, finished.publication.junit())
    _show_result(finished, shown, quiet=quiet)
    if shown is options.Format.GITHUB:
        for line in report.sweep_annotations(finished.result, finished.content.manifest):
            data(line)
    if not quiet:
        seconds = perf_counter() - started
        tally = report.sweep_tally(finished.result)
        message(f"uictest: {tally} in {seconds:.1f} s; results in {request.folder}")
    if finished.result.outcomes["error"]:
        return ExitCode.ERROR
    return ExitCode.MET if finished.result.met == finished.result.cases else ExitCode.MISSED


def _report_finished_chunks(request: runs.SweepRequest) -> None:
    if chunked.ChunkStore(request.folder).has_chunks():
        message(f"uictest: finished chunks are kept in {request.folder}; the same command continues")
