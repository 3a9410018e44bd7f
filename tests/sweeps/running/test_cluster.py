"""A cluster of processes computes the same chunks as this process, even if a worker dies."""

import contextlib
import json
import logging
import os
import signal
import subprocess
import sys
import time
from pathlib import Path

import numpy as np
import pytest

from uictest import rig
from uictest.cli.entry import execute
from uictest.running.chunked import CaseSelection, chunk_runner, cluster as cluster_module
from uictest.running.chunked.cluster import ClusterError, check_address, run_on_cluster

distributed = pytest.importorskip("distributed")

# What dask does with its own sockets and loops when a process is killed is not ours to judge.
pytestmark = pytest.mark.filterwarnings("ignore")
TEXT = """\
matrix: {rail.friction: [0.08, 0.12]}
sample: {size: 48, parameters: {brake.command: {uniform: [60 %, 100 %]}}}
"""


@pytest.fixture(scope="module")
def cluster():
    """Two processes of one thread each; a dead one is started again."""
    settings = {"distributed.logging.distributed": "critical", "distributed.worker.daemon": True}
    import dask

    with (
        dask.config.set(settings),
        distributed.LocalCluster(
            n_workers=2, threads_per_worker=1, processes=True, dashboard_address=None
        ) as started,
    ):
        yield started


def test_chunks_are_the_same_and_a_dead_worker_is_survived(load, cluster):
    selection = CaseSelection(load(TEXT, "initial_speed=15 km/h"))
    here = chunk_runner(selection.plan, rig.run_block)
    found = {}

    def write_chunk(number, content):
        found[number] = content
        if len(found) == 2:
            os.kill(next(iter(cluster.workers.values())).pid, signal.SIGKILL)

    run_on_cluster(selection, range(selection.chunks), cluster.scheduler_address, write_chunk)
    assert sorted(found) == list(range(6))
    for number, content in found.items():
        assert content == here.run(selection.chunk(number))


def test_only_missing_chunks_are_run(load, cluster):
    selection = CaseSelection(load(TEXT, "initial_speed=15 km/h"), np.arange(40))
    found = []
    run_on_cluster(selection, [2], cluster.scheduler_address, lambda number, content: found.append(number))
    assert found == [2]


def test_a_scheduler_that_does_not_answer_is_reported(load, monkeypatch):
    monkeypatch.setattr(cluster_module, "_TIMEOUT", "100ms")
    with pytest.raises(ClusterError, match=r"no scheduler answers at tcp://127\.0\.0\.1:9"):
        run_on_cluster(CaseSelection(load(TEXT)), [0], "tcp://127.0.0.1:9", lambda number, content: None)


def test_waiting_for_workers_is_reported_once(load):
    selection = CaseSelection(load(TEXT, "initial_speed=15 km/h"))
    found = []
    told = []
    with distributed.LocalCluster(n_workers=0, processes=False, dashboard_address=None) as empty:
        address = empty.scheduler_address

        def on_wait():
            told.append(None)
            empty.scale(1)

        run_on_cluster(selection, [0, 1], address, lambda number, content: found.append(number), on_wait)
    assert sorted(found) == [0, 1]
    assert len(told) == 1


def announced_address(file, scheduler):
    """Wait for the file in which a scheduler tells its address; while it is being written it is no JSON."""
    while scheduler.poll() is None:
        with contextlib.suppress(FileNotFoundError, json.JSONDecodeError):
            return str(json.loads(file.read_text())["address"])
        time.sleep(0.005)
    raise AssertionError("the scheduler did not start")


def test_a_scheduler_that_dies_is_one_line(load):
    log = logging.getLogger("distributed.client")
    log.setLevel(logging.WARNING)
    program = [sys.executable, "-m", "distributed.cli.dask_scheduler", "--host", "127.0.0.1", "--port", "0"]
    said = Path("scheduler.json")
    scheduler = subprocess.Popen(
        [*program, "--no-dashboard", "--scheduler-file", said], stderr=subprocess.DEVNULL
    )
    address = announced_address(said, scheduler)
    with pytest.raises(ClusterError) as raised:
        run_on_cluster(CaseSelection(load(TEXT)), [0], address, lambda number, content: None, scheduler.kill)
    scheduler.wait()
    assert str(raised.value).startswith(address)
    assert "\n" not in str(raised.value)
    assert not log.isEnabledFor(logging.ERROR)


@pytest.mark.parametrize("address", ["foo", "foo:x", "tcp://127.0.0.1:", "127.0.0.1:99999", ":8786", ""])
def test_what_is_no_address_is_rejected(load, capsys, address):
    assert execute(["sweep", load(TEXT).file, "--dask", address]) == 4
    said = capsys.readouterr().err
    assert f"--dask: {address!r} is not an address such as tcp://127.0.0.1:8786" in said
    assert not Path("reports").exists()


@pytest.mark.parametrize("address", ["foo:1", "tcp://foo:1", "tls://127.0.0.1:8786", "[::1]:8786"])
def test_addresses(address):
    check_address(address)


def test_the_command_line_gives_the_summary_that_a_local_run_gives(load, cluster):
    plan = load(TEXT, "initial_speed=15 km/h")
    arguments = ["sweep", plan.file, "--set", "initial_speed=15 km/h", "-q"]
    assert execute([*arguments, "-o", "far", "--dask", cluster.scheduler_address]) == 0
    assert execute([*arguments, "-o", "near"]) == 0
    assert Path("far/study/summary.csv").read_bytes() == Path("near/study/summary.csv").read_bytes()
