"""Run the chunks of a sweep on a dask.distributed cluster."""

from __future__ import annotations

import hashlib
import logging
import secrets
from collections.abc import Callable, Iterable, Iterator
from concurrent.futures import CancelledError
from itertools import islice
from pathlib import Path
from typing import Any, Final
from urllib.parse import urlsplit

import numpy as np
from numpy.typing import NDArray

from uictest import rig
from uictest.plans.sweeps import Plan, programs_of
from uictest.running.chunked.chunk import CaseSelection, ChunkRunner, WriteChunk, chunk_runner
from uictest.running.chunked.store import program_digest

_PER_THREAD: Final = 3
"""Chunks in flight per thread of the cluster: no thread idles, and the client holds few results."""
_RETRIES: Final = 5
_TIMEOUT: Final[str] = "10s"
"""Time that the scheduler may take to answer."""


class ClusterError(Exception):
    """The cluster cannot be reached, or gave up a chunk."""


def check_address(address: str) -> None:
    """Raise ValueError for what cannot be the address of a scheduler: no host, no port, or no such port."""
    message = f"{address!r} is not an address such as tcp://127.0.0.1:8786"
    try:
        parts = urlsplit(address if "://" in address else f"tcp://{address}")
        usable = parts.hostname is not None and parts.port is not None
    except ValueError as error:
        raise ValueError(message) from error
    if not usable:
        raise ValueError(message)


def run_on_cluster(
    selection: CaseSelection,
    numbers: Iterable[int],
    address: str,
    write_chunk: WriteChunk,
    on_wait: Callable[[], None] = lambda: None,
) -> None:
    """Run chunks on the cluster whose scheduler is at `address`; `write_chunk` gets each when it is finished.

    A chunk whose worker dies is given to another worker. If there is no worker at the start, `on_wait` is
    called once. Raises ClusterError; ImportError without the extra `dask`.
    """
    with _connected(address) as client:
        results = _results_of_chunks(client, selection, iter(numbers), on_wait)
        for number, content in _with_cluster_errors(address, results):
            write_chunk(number, content)


def _with_cluster_errors(address: str, results: Iterator[tuple[int, bytes]]) -> Iterator[tuple[int, bytes]]:
    """Yield the results. Errors of the cluster become ClusterError, those of the caller do not."""
    from distributed import KilledWorker

    try:
        yield from results
    # A lost connection is an OSError; a worker with another program raises a RuntimeError.
    except (KilledWorker, CancelledError, OSError, RuntimeError) as error:
        summary = f"{type(error).__name__}: {error}".partition("\n")[0]
        raise ClusterError(f"{address}: {summary}") from error


def _connected(address: str) -> Any:
    import distributed

    # Errors arrive as exceptions: its log would only say them again on stderr.
    for name in list(logging.root.manager.loggerDict):
        if name.partition(".")[0] == "distributed":
            logging.getLogger(name).setLevel(logging.CRITICAL)
    client: Any = distributed.Client
    try:
        return client(address, timeout=_TIMEOUT, set_as_default=False)
    except OSError as error:
        raise ClusterError(f"no scheduler answers at {address}") from error
    except ValueError as error:  # a protocol that distributed does not support
        raise ClusterError(f"{address}: {error}") from error


def _results_of_chunks(
    client: Any, selection: CaseSelection, numbers: Iterator[int], on_wait: Callable[[], None]
) -> Iterator[tuple[int, bytes]]:
    import distributed

    if not client.nthreads():
        on_wait()
        client.wait_for_workers(1)
    token, program = secrets.token_hex(8), program_digest()
    in_flight: dict[str, int] = {}

    def submit(number: int) -> Any:
        name = f"uictest-{token}-{number}"
        in_flight[name] = number
        arguments = (token, program, selection.plan, selection.chunk(number))
        return client.submit(_run_chunk, *arguments, key=name, pure=False, retries=_RETRIES)

    futures: Any = distributed.as_completed
    completed = futures(loop=client.loop)
    threads = max(1, sum(client.nthreads().values()))
    for number in islice(numbers, _PER_THREAD * threads):
        completed.add(submit(number))
    for future in completed:
        yield in_flight.pop(future.key), future.result()
        for number in islice(numbers, 1):
            completed.add(submit(number))


def _run_chunk(token: str, program: str, plan: Plan, indices: NDArray[np.int64]) -> bytes:
    """Run a chunk, on a worker of the cluster.

    Raises RuntimeError if its uictest is another version, or it lacks the file of a controller from outside.
    """
    if program != program_digest():
        raise RuntimeError("the worker has another version of uictest")
    return _cached_runner(token, plan).run(indices)


def _require_programs(plan: Plan) -> None:
    for program in programs_of(plan):
        path = Path(program.location)
        if program.sha256 and not (
            path.is_file() and hashlib.sha256(path.read_bytes()).hexdigest() == program.sha256
        ):
            raise RuntimeError(
                f"the worker does not have {path} as it is here: a controller from outside must lie"
                " at the same path on every machine of the cluster"
            )


_WORKERS: Final = rig.Workers()
"""Child processes of this process of the cluster; they end with it."""
_RUNNERS: dict[str, ChunkRunner] = {}
"""The runner of the sweep that this process of the cluster works on, by the token of the sweep."""


def _cached_runner(token: str, plan: Plan) -> ChunkRunner:
    if token not in _RUNNERS:
        _require_programs(plan)
        _RUNNERS.clear()
        _RUNNERS[token] = chunk_runner(plan, _WORKERS.run_block, _WORKERS.run_train)
    return _RUNNERS[token]
