"""A sweep from its lock to its published results, and what it is asked for besides its cases."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import replace
from pathlib import Path

from uictest import controllers, rig
from uictest.analysis import summaries
from uictest.core import files
from uictest.plans import sweeps
from uictest.plans.scenario import yaml
from uictest.plans.sweeps import programs_of
from uictest.running import chunked
from uictest.running.chunked import ChunkStore
from uictest.runs.scenario_files import InvalidInputError
from uictest.runs.sweep.publishing import FinishedSweep, publish
from uictest.runs.sweep.run import SweepObserver, SweepRun, run_missing_chunks


def run_sweep(run: SweepRun, observer: SweepObserver) -> FinishedSweep | None:
    """Run a sweep; chunks that are finished already are not run again.

    Returns the finished sweep, None where this run is one shard of several. Finished chunks are kept whatever
    is raised: InvalidInputError where the folder is in use or holds the chunks of other inputs, OSError,
    KeyboardInterrupt, MaxfailReached.
    """
    with _locked(run.folder, shared=run.shard.count > 1 and not run.restart), rig.Workers() as workers:
        if run.in_process and any(programs_of(run.selection.plan)):
            observer.foreign_in_process()
        isolated = run if run.in_process else replace(run, run_block=workers.run_block)
        try:
            return _run_and_publish(isolated, observer)
        except KeyboardInterrupt:
            controllers.interrupt_turns()
            raise


def _run_and_publish(run: SweepRun, observer: SweepObserver) -> FinishedSweep | None:
    store = ChunkStore(run.folder)
    run_missing_chunks(run, store, observer)
    return None if run.shard.count > 1 else publish(run, store, observer)


def _locked(folder: Path, *, shared: bool) -> files.FolderLock:
    """Return the lock on the folder of a sweep; shards of the sweep share it."""
    if folder.is_symlink():
        raise InvalidInputError(
            f"{folder} is a link, and a sweep writes through none: name another output folder",
            arguments=("output",),
        )
    try:
        files.make_folder(folder)
        return files.FolderLock(folder.parent, folder.name, shared=shared)
    except files.FolderInUseError as error:
        raise InvalidInputError(
            f"{folder} is in use by {error}: wait until it ends, or name another output folder",
            arguments=("output",),
        ) from error


class ToleranceError(ValueError):
    """A tolerance of a frontier that is no number with a unit."""


def first_pair(plan: sweeps.Plan) -> tuple[str, str] | None:
    """Return the first two parameters with several listed values, None without two of them."""
    listed = [key for key, values in plan.listed().items() if len(values) > 1]
    return (listed[0], listed[1]) if len(listed) > 1 else None


def measure_names(names: Sequence[str] | None) -> tuple[str, ...]:
    """Return columns of measures, else the braking distance. Raises ValueError for another name."""
    columns = chunked.measure_columns()
    for name in names or ():
        if name not in columns:
            raise ValueError(f"no measure {name!r}; {yaml.suggestion(name, columns)}")
    return tuple(dict.fromkeys(names or ("braking_distance_m",)))


def frontier_search(
    plan: sweeps.Plan, key: str | None, tolerance: str | None
) -> summaries.FrontierSearch | None:
    """Return the search of a frontier along a parameter.

    Raises FrontierError for the parameter, ToleranceError for the tolerance.
    """
    if key is None:
        return None
    try:
        width = None if tolerance is None else yaml.parse_decimal_quantity(tolerance)
        return summaries.FrontierSearch(plan, key, width)
    except summaries.FrontierError:
        raise
    except ValueError as error:
        raise ToleranceError(str(error)) from error
