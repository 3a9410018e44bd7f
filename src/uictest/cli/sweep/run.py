"""Run the chunks of a sweep."""

from __future__ import annotations

import io
from collections.abc import Sequence
from dataclasses import dataclass, field
from pathlib import Path
from typing import Any

from uictest import rig, sweep
from uictest.cli.exit_codes import InvalidInputError
from uictest.cli.output import message
from uictest.cli.progress import announce_compilation
from uictest.cli.sweep.display import reason_missed
from uictest.cli.sweep.progress import sweep_progress
from uictest.report import counted
from uictest.sweep import (
    CaseSelection,
    ChangedInputsError,
    ChunkRunner,
    ChunkStore,
    FrontierSearch,
    Shard,
)


@dataclass(frozen=True)
class SweepRun:
    """The cases of a sweep, options of the run, and the folder of the results."""

    selection: CaseSelection
    manifest: dict[str, Any]
    folder: Path
    jobs: int
    shard: Shard = field(default_factory=Shard)
    merged: Sequence[Path] = ()
    """Folders of shards to merge."""
    cluster: str | None = None
    restart: bool = False
    maxfail: int | None = None
    pair: tuple[str, str] | None = None
    measures: Sequence[str] = ()
    search: FrontierSearch | None = None
    junit: Path | None = None
    formats: Sequence[str] = ()
    quiet: bool = False
    in_process: bool = False
    run_block: sweep.RunBlock = rig.run_block
    """Simulates blocks with controllers from outside."""


class MaxfailReached(Exception):  # noqa: N818 - nothing went wrong with the program
    """`--maxfail` cases missed their expectation; the message gives their number and the first."""


def run_missing_chunks(run: SweepRun, store: ChunkStore) -> None:
    """Run the chunks of the run's shard that are not finished, and write them to the store.

    Finished chunks are kept whatever is raised: InvalidInputError where the folder holds the chunks of other
    inputs, OSError where it cannot be written, KeyboardInterrupt, MaxfailReached.
    """
    _open_store(run, store)
    finished, damaged = store.finished()
    for path in damaged:
        message(f"uictest: {path} is damaged: recomputing this chunk")
    own_chunks = run.shard.chunk_numbers(run.selection.chunks)
    missing_chunks = [number for number in own_chunks if number not in finished]
    cases, missing_cases = (_cases_in(run, numbers) for numbers in (own_chunks, missing_chunks))
    _announce(run, cases, missing_cases)
    with sweep_progress(cases, cases - missing_cases, quiet=run.quiet) as advance:
        failures = _Failures(run.maxfail)

        def write_chunk(number: int, content: bytes) -> None:
            store.write(number, content)
            advance(run.selection.chunk(number).size)
            failures.add(content)

        if missing_chunks:
            _run_chunks(run, missing_chunks, write_chunk)


def _cases_in(run: SweepRun, numbers: Sequence[int]) -> int:
    return sum(run.selection.chunk(number).size for number in numbers)


def _announce(run: SweepRun, cases: int, missing: int) -> None:
    """Report how many cases are already finished, or how many no shard provided."""
    if run.merged and missing:
        verb = "is" if missing == 1 else "are"
        pronoun = "it" if missing == 1 else "them"
        message(
            f"uictest: {missing} of {counted(cases, 'case')} {verb} missing from the shards: "
            f"simulating {pronoun} here"
        )
    elif missing < cases and not run.quiet:
        message(f"uictest: {cases - missing} of {counted(cases, 'case')} are already finished")


def _open_store(run: SweepRun, store: ChunkStore) -> None:
    try:
        store.open(run.manifest, restart=run.restart)
    except ChangedInputsError as error:
        raise InvalidInputError(
            f"uictest: {run.folder} holds chunks of this sweep with other inputs ({error}); "
            "--restart discards them, -o names another folder"
        ) from error
    for folder in run.merged:
        _merge_shard(store, folder)


def _merge_shard(store: ChunkStore, folder: Path) -> None:
    try:
        merged_chunks, damaged = store.merge(ChunkStore(folder))
    except ChangedInputsError as error:
        raise InvalidInputError(f"uictest: not a shard of this sweep: {error}") from error
    for path in damaged:
        message(f"uictest: {path} is damaged: skipped")
    message(f"uictest: {counted(merged_chunks, 'chunk')} from {folder}")


def _run_chunks(run: SweepRun, numbers: Sequence[int], write_chunk: sweep.WriteChunk) -> None:
    if run.cluster is None:
        sweep.run_on_threads(prepared_runner(run), run.selection, numbers, run.jobs, write_chunk)
    else:
        _run_on_cluster(run, run.cluster, numbers, write_chunk)


def _run_on_cluster(
    run: SweepRun, address: str, numbers: Sequence[int], write_chunk: sweep.WriteChunk
) -> None:
    def on_wait() -> None:
        message(f"uictest: waiting for workers at {address}")

    try:
        sweep.run_on_cluster(run.selection, numbers, address, write_chunk, on_wait)
    except ImportError as error:
        raise InvalidInputError("uictest: --dask needs the extra: pip install 'uictest[dask]'") from error
    except sweep.ClusterError as error:
        raise OSError(str(error)) from error


def prepared_runner(run: SweepRun) -> ChunkRunner:
    """Return a runner with a compiled rig, after a message if it must be compiled first.

    Raises InvalidInputError where the sweep needs a GPU and there is none.
    """
    if run.selection.device == "cuda":
        return _runner_on_gpu(run)
    base = run.selection.plan.base.scenario
    warm = rig.block_is_compiled([base.controller.program], [rig.controller_of(base)])
    announce_compilation(warm=warm, quiet=run.quiet)
    runner = sweep.chunk_runner(run.selection.plan, run.run_block)
    runner.prepare()
    return runner


def _runner_on_gpu(run: SweepRun) -> ChunkRunner:
    try:
        runner = sweep.chunk_runner(run.selection.plan, run.run_block, "cuda")
        runner.prepare()
    except sweep.NoDeviceError as error:
        raise InvalidInputError(
            f"uictest: no CUDA device found ({error}); leave --device out to use the processor"
        ) from error
    except ImportError as error:
        # The compiler for GPUs belongs to the extra as well, and is imported at its first use.
        raise InvalidInputError(
            "uictest: --device cuda needs the extra: pip install 'uictest[cuda]'"
        ) from error
    return runner


class _Failures:
    """Counts the missed cases, chunk by chunk, up to `--maxfail`."""

    def __init__(self, maxfail: int | None) -> None:
        self._maxfail = maxfail
        self._count = 0
        self._first = ""

    def add(self, content: bytes) -> None:
        """Count the missed cases of a finished chunk. Raises MaxfailReached."""
        if self._maxfail is None:
            return
        missed = _missed(content)
        if missed and not self._first:
            outcome, name, reason = missed[0]
            self._first = f"{name}: {outcome}, {reason_missed(reason)}"
        self._count += len(missed)
        if self._count >= self._maxfail:
            raise MaxfailReached(f"{counted(self._count, 'case')} not met, the first: {self._first}")


def _missed(content: bytes) -> list[tuple[str, str, str]]:
    """Return outcome, id and reason of the missed cases in a chunk."""
    import pyarrow.parquet as pq

    names = ["met", "outcome", "id", "reason"]
    columns = pq.read_table(io.BytesIO(content), columns=names).to_pydict()
    rows = zip(*(columns[name] for name in names), strict=True)
    return [(outcome, name, reason) for met, outcome, name, reason in rows if not met]
