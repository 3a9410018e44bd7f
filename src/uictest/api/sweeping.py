"""Run a sweep of many cases."""

from __future__ import annotations

from collections.abc import Sequence
from pathlib import Path
from typing import Literal

from uictest import runs
from uictest.api.arguments import (
    PathName,
    Trusted,
    as_paths,
    checked_seed,
    expression_of,
    thread_count,
)
from uictest.api.assignments import Assignments, override_texts
from uictest.api.sweep_results import SweepResults
from uictest.core import files
from uictest.plans import sweeps
from uictest.running import chunked
from uictest.runs import history


def sweep(
    file: PathName,
    *,
    set: Assignments | None = None,  # noqa: A002 - the name of the option
    seed: int | None = None,
    select: str | None = None,
    measures: str | Sequence[str] = ("braking_distance_m",),
    frontier: str | None = None,
    tolerance: str | None = None,
    validated: PathName | None = None,
    trust: Trusted = (),
    jobs: int | Literal["auto"] = "auto",
    output: PathName | None = None,
    restart: bool = False,
) -> SweepResults:
    """Run a sweep file: the same digits as `uictest sweep`.

    With `output`, finished chunks are kept in that folder: after an interruption the same call continues, and
    a sweep that is finished is not run again. Without it, nothing is kept.

    Args:
        file: a `*.sweep.yaml`.
        set: dotted key -> value in every case, as for :func:`uictest.load`.
        seed: of the sensor noise in every case, 0 to 2^32 - 1.
        select: expression over ids, as `-k`.
        measures: columns of the table to map and to compute sensitivities of, one or several.
        frontier: parameter along which to find where the verdict flips.
        tolerance: accuracy of the frontier, such as `0.001` or `0.5 km/h` [default: 1/64 of the smallest
            step].
        validated: validation.json of a validation: cases outside of it are counted and named in the column
            `outside`; in place of what the scenario names under `validated`.
        trust: folders that scenarios may refer to, besides their own and the working folder.
        jobs: number of threads, `auto`: one for each processor.
        output: folder for results; the sweep gets a folder of its name in it, as with `-o`.
        restart: discard finished chunks and start again.

    Raises:
        uictest.ScenarioErrors: the file is invalid, or a key of `set`; the message has every error in it.
        ValueError: nothing is selected, an argument is invalid, or the folder is in use or holds the chunks
            of other inputs.
        OSError: the results cannot be written.

    """
    texts, folders, seed = override_texts(set), as_paths(trust), checked_seed(seed)
    plan = sweeps.load_sweep(Path(file), tuple(texts), seed, folders)
    with expression_of("select", select):
        selection = chunked.select_cases(plan, select)
    if selection.size == 0:
        raise ValueError(f"nothing selected among {plan.size} cases")

    option = None if validated is None else Path(validated)
    reference = runs.reference_of(option, plan.base.scenario.validated)

    def run_in(folder: Path, formats: Sequence[str] | None) -> runs.SweepRun:
        return runs.SweepRun(
            selection=selection,
            manifest=chunked.sweep_manifest(selection, expression=select, overrides=texts, seed=seed),
            folder=folder / plan.name,
            jobs=thread_count(jobs),
            restart=restart,
            pair=runs.first_pair(plan),
            measures=runs.measure_names([measures] if isinstance(measures, str) else measures),
            search=runs.frontier_search(plan, frontier, tolerance),
            reference=reference,
            formats=formats,
        )

    if output is not None:
        return _finished(run_in(Path(output), None), keep=True)
    with files.temporary_folder() as folder:
        return _finished(run_in(folder, ()), keep=False)


def _finished(run: runs.SweepRun, *, keep: bool) -> SweepResults:
    finished = runs.run_sweep(run, runs.SweepObserver())
    assert finished is not None  # there is one shard
    if keep:
        history.refresh_index(run.folder.parent)
    return SweepResults.read(finished.result, run.folder, keep=keep)
