"""`uictest sweep`: run many cases of one scenario, in chunks that survive an interruption."""

from __future__ import annotations

from pathlib import Path
from typing import Annotated

from uictest import report, runs
from uictest.cli import sweep_run
from uictest.cli.options import (
    CalibratedBy,
    DryRun,
    ExitFirst,
    Expression,
    Firm,
    Format,
    InProcess,
    Jobs,
    JUnitFile,
    MaxFail,
    Overrides,
    Quiet,
    Seed,
    Trusted,
    Validated,
    argument,
    calibration,
    junit_file,
    option,
    report_formats,
)
from uictest.cli.output import ExitCode, message, warn_of_implausible
from uictest.plans import sweeps
from uictest.running import chunked

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
    Format,
    option(
        "--format",
        "Output on stdout: text (maps and rates), json (sweep.json) or github (text, annotations).",
    ),
]
Shard = Annotated[
    str | None,
    option("--shard I/N", "Run shard I of N only; --merge combines shards."),
]
Merged = Annotated[
    list[Path] | None,
    option("--merge DIR", "Merge the chunks of the shard in DIR. May be repeated."),
]
Dask = Annotated[str | None, option("--dask ADDRESS", "Simulate on the cluster of this scheduler.")]
SweepReports = Annotated[
    str | None,
    option(
        "--report FORMATS",
        f"Reports to write, joined by commas: {', '.join(report.sweep_format_names())}.",
        show_default=f"csv,html; html for more than {report.LARGEST_CSV} cases",
    ),
]
Restart = Annotated[bool, option("--restart", "Discard finished chunks and start again.")]
SweepOutput = Annotated[
    Path,
    option("-o --output DIR", "Folder for results; the sweep gets a folder of its name in it."),
]


def sweep(
    file: SweepFile,
    expression: Expression = None,
    overrides: Overrides = None,
    seed: Seed = None,
    trusted: Trusted = None,
    exit_first: ExitFirst = False,
    maxfail: MaxFail = None,
    jobs: Jobs = "auto",  # type: ignore[assignment]  # typer hands the text to the option's parser
    shard: Shard = None,
    merged: Merged = None,
    dask: Dask = None,
    restart: Restart = False,
    dry_run: DryRun = False,
    frontier: Frontier = None,
    tolerance: Tolerance = None,
    pair: MapPair = None,
    validated: Validated = None,
    firm: Firm = False,
    calibrated_by: CalibratedBy = None,
    measures: Measures = None,
    output: SweepOutput = Path("reports"),
    junit: JUnitFile = None,
    shown: SweepFormat = Format.TEXT,
    formats: SweepReports = None,
    quiet: Quiet = False,
    in_process: InProcess = False,
) -> ExitCode:
    """Run a sweep. After an interruption the same command continues it."""
    accepted = report.sweep_format_names()
    format_names = None if formats is None else report_formats(formats, "--report", accepted)
    plan = sweeps.load_sweep(file, tuple(overrides or ()), seed, trusted or ())
    warn_of_implausible(runs.implausible_trains([plan.base]))
    sweep_run.load_arrow()
    selection = sweep_run.selected_cases(plan, expression)
    if selection.size == 0:
        message(f"uictest: nothing selected among {report.counted(plan.size, 'case')}")
        return ExitCode.NOTHING_SELECTED
    if dry_run:
        sweep_run.show_ids(selection)
        return ExitCode.MET
    request = runs.SweepRequest(
        selection=selection,
        manifest=chunked.sweep_manifest(
            selection, expression=expression, overrides=overrides or (), seed=seed
        ),
        folder=output / plan.name,
        jobs=jobs,
        shard=sweep_run.shard_of(shard),
        merged=tuple(merged or ()),
        cluster=sweep_run.cluster_address(dask),
        restart=restart,
        maxfail=1 if exit_first else maxfail,
        pair=sweep_run.map_pair(plan, pair),
        measures=sweep_run.measure_names(measures),
        search=sweep_run.frontier_search(plan, frontier, tolerance),
        reference=runs.reference_of(validated, plan.base.scenario.validated),
        firm=firm or plan.base.scenario.firm,
        calibration=calibration(calibrated_by, trusted, firm=firm),
        formats=format_names,
        in_process=in_process,
    )
    return sweep_run.execute_sweep(request, shown, junit_file(junit, request.folder), quiet=quiet)
