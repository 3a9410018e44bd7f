"""The parts of a sweep on a dask.distributed cluster."""

from __future__ import annotations

import logging
import secrets
from collections.abc import Callable, Iterable, Iterator
from itertools import islice
from typing import Any, Final
from urllib.parse import urlsplit

import numpy as np
from numpy.typing import NDArray

from uictest.sweep.plan.plan import Plan
from uictest.sweep.running.chunk import ChunkRunner, chunk_runner
from uictest.sweep.running.execution import OnPart
from uictest.sweep.running.manifest import program_digest
from uictest.sweep.running.selection import Selection

_PER_THREAD: Final = 3
"""Parts in flight per thread of the cluster: none idles, and the client holds few results."""
_RETRIES: Final = 5
_PATIENCE: Final[str] = "10s"
"""How long the scheduler may take to answer."""


class ClusterError(Exception):
    """The cluster cannot be reached, or gave a part up."""


def check_address(address: str) -> None:
    """Raise ValueError for what cannot be the address of a scheduler: no host, no port, or no such port."""
    form = f"{address!r} is not an address such as tcp://127.0.0.1:8786"
    try:
        parts = urlsplit(address if "://" in address else f"tcp://{address}")
        usable = parts.hostname is not None and parts.port is not None
    except ValueError as error:
        raise ValueError(form) from error
    if not usable:
        raise ValueError(form)


def run_on_cluster(
    selection: Selection,
    numbers: Iterable[int],
    address: str,
    on_part: OnPart,
    on_wait: Callable[[], None] = lambda: None,
) -> None:
    """Work out parts on the cluster whose scheduler is at `address`; `on_part` gets each as it comes.

    A part whose worker dies is given to another; where there is none at the start, `on_wait` is called once.
    Raises ClusterError; ImportError without the extra `dask`.
    """
    with _connected(address) as client:
        results = _results(client, selection, iter(numbers), on_wait)
        for number, content in _translated(address, results):
            on_part(number, content)


def _translated(address: str, results: Iterator[tuple[int, bytes]]) -> Iterator[tuple[int, bytes]]:
    """Pass results on; what the cluster fails by becomes a ClusterError, what `on_part` raises does not."""
    try:
        yield from results
    except _errors() as error:
        raise ClusterError(f"{address}: {_first_line(error)}") from error


def _first_line(error: Exception) -> str:
    return f"{type(error).__name__}: {error}".partition("\n")[0]


def _silence() -> None:
    """Keep what distributed logs off stderr: what matters of it arrives as an error."""
    for name in list(logging.root.manager.loggerDict):
        if name.partition(".")[0] == "distributed":
            logging.getLogger(name).setLevel(logging.CRITICAL)


def _connected(address: str) -> Any:
    import distributed

    _silence()
    client: Any = distributed.Client
    try:
        return client(address, timeout=_PATIENCE, set_as_default=False)
    except OSError as error:
        raise ClusterError(f"no scheduler answers at {address}") from error
    except ValueError as error:  # a scheme that distributed does not speak
        raise ClusterError(f"{address}: {error}") from error


def _errors() -> tuple[type[Exception], ...]:
    from concurrent.futures import CancelledError

    from distributed import KilledWorker

    # A lost connection is an OSError; a worker with another program raises a RuntimeError.
    return KilledWorker, CancelledError, OSError, RuntimeError


def _results(
    client: Any, selection: Selection, waiting: Iterator[int], on_wait: Callable[[], None]
) -> Iterator[tuple[int, bytes]]:
    import distributed

    if not client.nthreads():
        on_wait()
        client.wait_for_workers(1)
    token, program = secrets.token_hex(8), program_digest()
    flying: dict[str, int] = {}

    def submit(number: int) -> Any:
        name = f"uictest-{token}-{number}"
        flying[name] = number
        arguments = (token, program, selection.plan, selection.part(number))
        return client.submit(_part, *arguments, key=name, pure=False, retries=_RETRIES)

    futures: Any = distributed.as_completed
    running = futures(loop=client.loop)
    threads = max(1, sum(client.nthreads().values()))
    for number in islice(waiting, _PER_THREAD * threads):
        running.add(submit(number))
    for future in running:
        yield flying.pop(future.key), future.result()
        for number in islice(waiting, 1):
            running.add(submit(number))


def _part(token: str, program: str, plan: Plan, indices: NDArray[np.int64]) -> bytes:
    """Runs on a worker of the cluster. Raises RuntimeError where that has another version of this program."""
    if program != program_digest():
        raise RuntimeError("the worker has another version of uictest")
    return _worker(token, plan).part(indices)


_WORKERS: dict[str, ChunkRunner] = {}
"""The worker of the sweep that this process of the cluster works on: records are assembled from one base."""


def _worker(token: str, plan: Plan) -> ChunkRunner:
    if token not in _WORKERS:
        made = chunk_runner(plan)
        _WORKERS.clear()
        _WORKERS[token] = made
        return made
    return _WORKERS[token]
