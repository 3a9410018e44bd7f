"""`uictest sweep`: many cases of one scenario, in chunks that survive an interruption."""

from __future__ import annotations

import sys
from collections.abc import Sequence
from enum import StrEnum
from pathlib import Path
from time import perf_counter
from typing import TYPE_CHECKING, Annotated

import typer

from uictest import campaign, report
from uictest.cli.exit_codes import ExitCode
from uictest.cli.options import (
    Expression,
    Format,
    Jobs,
    Overrides,
    Quiet,
    Reports,
    Seed,
    Trusted,
    Verbosity,
    junit_file,
    report_formats,
)
from uictest.cli.problems import InvalidInputError
from uictest.cli.streams import data, message, terminal_width
from uictest.report import counted, no_command, printable, wrapped_name
from uictest.scenario import yaml

if TYPE_CHECKING:
    from uictest.cli.sweep_run import SweepRun
    from uictest.folder_lock import FolderLock
    from uictest.sweep import CaseSelection, ChunkStore, FrontierSearch, Plan, Shard

_IDS_AT_ONCE = 4096


class Device(StrEnum):
    """What simulates."""

    CPU = "cpu"
    CUDA = "cuda"


SweepFile = Annotated[Path, typer.Argument(metavar="FILE", help="A *.sweep.yaml.")]
Frontier = Annotated[
    str | None,
    typer.Option(
        "--frontier", metavar="KEY", help="Find where the verdict flips along KEY; its values are the scan."
    ),
]
Tolerance = Annotated[
    str | None,
    typer.Option(
        "--tolerance",
        metavar="VALUE",
        help="How closely a flip is located: 0.001, '0.5 km/h' [default: 1/64 of the smallest step].",
    ),
]
MapPair = Annotated[
    str | None,
    typer.Option(
        "--map",
        metavar="KEY,KEY",
        help="Parameters down and across the maps [default: the first two listed].",
    ),
]
Measures = Annotated[
    list[str] | None,
    typer.Option(
        "--measure",
        metavar="NAME",
        help="Measure to map and to compute sensitivities of: a column of summary.csv. May be repeated.",
    ),
]
OnDevice = Annotated[Device, typer.Option("--device", help="What simulates.")]
SweepFormat = Annotated[
    Format,
    typer.Option(
        "--format",
        help="What stdout carries: maps and rates, sweep.json, or maps and rates with annotations.",
    ),
]
JUnit = Annotated[
    Path | None, typer.Option("--junitxml", metavar="FILE", help="Write the JUnit XML to this file, too.")
]


def sweep(
    file: SweepFile,
    expression: Expression = None,
    overrides: Overrides = None,
    seed: Seed = None,
    trusted: Trusted = None,
    exit_first: Annotated[bool, typer.Option("-x", help="Stop once a case is not met.")] = False,
    maxfail: Annotated[
        int | None, typer.Option("--maxfail", metavar="N", min=1, help="Stop once N cases are not met.")
    ] = None,
    jobs: Jobs = "auto",  # type: ignore[assignment]  # typer hands the text to the option's parser
    shard: Annotated[
        str | None,
        typer.Option("--shard", metavar="I/N", help="Run shard I of N only; --merge combines shards."),
    ] = None,
    merged: Annotated[
        list[Path] | None,
        typer.Option("--merge", metavar="DIR", help="Merge the chunks of the shard in DIR. May be repeated."),
    ] = None,
    dask: Annotated[
        str | None,
        typer.Option("--dask", metavar="ADDRESS", help="Simulate on the cluster of this scheduler."),
    ] = None,
    device: OnDevice = Device.CPU,
    restart: Annotated[
        bool, typer.Option("--restart", help="Discard finished chunks and start again.")
    ] = False,
    dry_run: Annotated[bool, typer.Option("--dry-run", help="List what would run, and run nothing.")] = False,
    frontier: Frontier = None,
    tolerance: Tolerance = None,
    pair: MapPair = None,
    measures: Measures = None,
    output: Annotated[
        Path,
        typer.Option(
            "-o", "--output", metavar="DIR", help="Folder of the sweep's folder, which has the sweep's name."
        ),
    ] = Path("reports"),
    junit: JUnit = None,
    shown: SweepFormat = Format.TEXT,
    formats: Reports = "csv,html",
    quiet: Quiet = False,
    verbosity: Verbosity = 0,
) -> ExitCode:
    """Run a sweep. After an interruption the same command continues it."""
    wanted = report_formats(formats, "--report", report.SWEEP_FORMATS)
    selection = selected_cases(load_plan(file, overrides, seed, trusted), expression, device)
    if selection.size == 0:
        message(f"uictest: nothing selected among {counted(selection.plan.size, 'case')}")
        return ExitCode.NOTHING_SELECTED
    if dry_run:
        show_ids(selection)
        return ExitCode.MET

    from uictest.cli.sweep_run import SweepRun
    from uictest.sweep import sweep_manifest

    folder = output / selection.plan.name
    run = SweepRun(
        selection=selection,
        manifest=sweep_manifest(selection, expression=expression, overrides=overrides or (), seed=seed),
        folder=folder,
        jobs=1 if device is Device.CUDA else jobs,
        shard=_shard(shard),
        merged=tuple(merged or ()),
        cluster=_cluster(dask),
        restart=restart,
        maxfail=1 if exit_first else maxfail,
        pair=_pair(selection.plan, pair),
        measures=_measures(measures),
        search=_search(selection.plan, frontier, tolerance),
        junit=junit_file(junit, folder),
        formats=wanted,
        quiet=quiet,
    )
    with _alone_in(folder, shared=run.shard.count > 1 and not restart):
        return _swept(run, shown)


def _alone_in(folder: Path, *, shared: bool) -> FolderLock:
    """Return the lock on the folder of a sweep; shards of the sweep share it."""
    from uictest.folder_lock import FolderInUseError, FolderLock

    folder.mkdir(parents=True, exist_ok=True)
    try:
        return FolderLock(folder, shared=shared)
    except FolderInUseError as error:
        raise InvalidInputError(
            f"uictest: {folder} is in use by {error}: wait until it ends, or name another folder with -o"
        ) from error


def _swept(run: SweepRun, shown: Format) -> ExitCode:
    from uictest.cli.sweep_run import MaxfailReached
    from uictest.sweep import ChunkStore

    store = ChunkStore(run.folder)
    try:
        return _simulated_and_shown(run, store, shown)
    except MaxfailReached as reached:
        message(f"uictest: stopped at --maxfail: {reached}")
        message(
            f"uictest: finished chunks are kept in {run.folder}; the same command without --maxfail continues"
        )
        return ExitCode.MISSED
    except KeyboardInterrupt:
        message("uictest: interrupted")
        _report_finished_chunks(store)
        return ExitCode.INTERRUPTED
    except OSError:
        _report_finished_chunks(store)
        raise


def _simulated_and_shown(run: SweepRun, store: ChunkStore, shown: Format) -> ExitCode:
    from uictest.cli.sweep_run import exit_code, publish, run_missing_chunks, sum_up

    started = perf_counter()
    run_missing_chunks(run, store)
    if run.shard.count > 1:
        message(f"uictest: {_shard_words(run)}")
        return ExitCode.MET
    result, document, content = publish(run, store)
    show_result(result, document, shown, quiet=run.quiet)
    if shown is Format.GITHUB:
        show_annotations(content)
    if not run.quiet:
        sum_up(run, result, started)
    return exit_code(result)


def _report_finished_chunks(store: ChunkStore) -> None:
    if store.has_chunks():
        message(f"uictest: finished chunks are kept in {store.folder}; the same command continues")


def _shard_words(run: SweepRun) -> str:
    shard, chunks = f"shard {run.shard.number} of {run.shard.count}", run.selection.chunks
    if run.shard.chunk_numbers(chunks):
        return f"{shard} is finished in {run.folder}"
    return f"{shard} has no cases: the sweep has only {counted(chunks, 'chunk')}"


def load_plan(
    file: Path, overrides: Sequence[str] | None, seed: int | None, trusted: Sequence[Path] | None = None
) -> Plan:
    """Return the plan of a sweep file. Raises InvalidInputError with every diagnostic."""
    from uictest.sweep import load_sweep

    try:
        return load_sweep(file, tuple(overrides or ()), seed, trusted or ())
    except yaml.ScenarioErrors as errors:
        raise InvalidInputError(str(errors)) from errors


def selected_cases(plan: Plan, expression: str | None, device: Device = Device.CPU) -> CaseSelection:
    """Return the cases that `-k` selects. Raises typer.BadParameter for a malformed expression."""
    from uictest.sweep import select_cases

    try:
        return select_cases(plan, expression, device.value)
    except campaign.ExpressionError as error:
        raise typer.BadParameter(f"{error} in {expression!r}", param_hint="-k") from error


def show_ids(selection: CaseSelection) -> bool:
    """Write the ids of the selected cases to stdout, one per line; return whether somebody read them all."""
    for first in range(0, selection.size, _IDS_AT_ONCE):
        indices = selection.indices(first, min(first + _IDS_AT_ONCE, selection.size))
        if not data("\n".join(map(printable, selection.plan.ids(indices)))):
            return False
    return True


def show_result(result: report.SweepResult, document: str, shown: Format, *, quiet: bool) -> None:
    """Write the result document, or maps, rates and the frontier as text, to stdout.

    If `quiet`, write only the cases that missed their expectation; annotations list these already.
    """
    from uictest.cli.sweep_display import missed_lines, result_lines

    if shown is Format.JSON:
        data(document.rstrip("\n"))
        return
    if quiet and shown is Format.GITHUB:
        return
    width = terminal_width(sys.stdout)
    for line in missed_lines(result) if quiet else result_lines(result, width):
        text = printable(line) if line else line
        if shown is Format.GITHUB:
            data(no_command(text))
        else:
            data(text if width is None else "\n".join(wrapped_name(text, width)))


def show_annotations(content: report.SweepContent) -> None:
    """Write the worst cases that are not met, and what the sweep came to, as annotations to stdout."""
    for line in report.sweep_annotations(content):
        data(line)


def _shard(text: str | None) -> Shard:
    from uictest.sweep import Shard, parse_shard

    try:
        return Shard() if text is None else parse_shard(text)
    except ValueError as error:
        raise typer.BadParameter(str(error), param_hint="--shard") from error


def _cluster(address: str | None) -> str | None:
    if address is None:
        return None
    from uictest.sweep import check_address

    try:
        check_address(address)
    except ValueError as error:
        raise typer.BadParameter(str(error), param_hint="--dask") from error
    return address


def _search(plan: Plan, key: str | None, tolerance: str | None) -> FrontierSearch | None:
    from uictest.sweep import FrontierError, FrontierSearch, parse_decimal_quantity

    if key is None:
        return None
    try:
        return FrontierSearch(plan, key, None if tolerance is None else parse_decimal_quantity(tolerance))
    except FrontierError as error:
        raise typer.BadParameter(str(error), param_hint="--frontier") from error
    except ValueError as error:
        raise typer.BadParameter(str(error), param_hint="--tolerance") from error


def _pair(plan: Plan, text: str | None) -> tuple[str, str] | None:
    """Return the parameters of the maps: the two named, else the first two with several listed values."""
    if text is None:
        listed = [key for key, values in plan.listed().items() if len(values) > 1]
        return (listed[0], listed[1]) if len(listed) > 1 else None
    first, _, second = text.partition(",")
    pair = (first.strip(), second.strip())
    unknown = [key for key in pair if key not in plan.keys]
    if unknown or pair[0] == pair[1]:
        accepted = ", ".join(plan.keys)
        raise typer.BadParameter(f"name two parameters of {accepted}, as KEY,KEY", param_hint="--map")
    return pair


def _measures(names: Sequence[str] | None) -> tuple[str, ...]:
    from uictest.sweep import measure_columns

    if not names:
        return ("braking_distance_m",)
    for name in names:
        if name not in measure_columns():
            hint = yaml.suggestion(name, measure_columns())
            raise typer.BadParameter(f"no measure {name!r}; {hint}", param_hint="--measure")
    return tuple(dict.fromkeys(names))
