"""`uictest sweep`: the same files whatever happened on the way, and an exit code for everything."""

import errno
import json
import random
import signal
import subprocess
import time
from pathlib import Path

import pytest

from uictest.analysis.summaries.summary import Summary
from uictest.core.files import FolderLock
from uictest.running import chunked
from uictest.running.chunked.chunk import ChunkRunner

from ..conftest import HANGING

pytestmark = pytest.mark.usefixtures("two_worst_cases")

TEXT = """\
schema: uictest/scenario/1
name: study
extends: scenarios/stop.yaml
vary:
  matrix:
    rail.friction: [0.08, 0.09, 0.12]
  sample: {size: 32, parameters: {brake.command: {uniform: [60 %, 100 %]}}}
"""
FILE = "study.sweep.yaml"
FOLDER = Path("reports/study")
KEPT = "uictest: interrupted\nuictest: finished chunks are kept in reports/study; the same"
UNFINISHED = "holds a sweep that is not finished"


@pytest.fixture
def study(scenario):
    """A sweep of 96 stops from 15 km/h in six chunks."""
    path = scenario("stop", "rail: {condition: wet}\n")
    path.write_text(path.read_text().replace("30 km/h", "15 km/h"))
    Path(FILE).write_text(TEXT)
    return Path(FILE)


def append_to_scenario(text):
    with Path("scenarios/stop.yaml").open("a") as file:
        file.write(text)


def contents(folder=FOLDER):
    """Every file of a result by its name."""
    files = (path for path in Path(folder).rglob("*") if path.is_file())
    return {path.relative_to(folder).as_posix(): path.read_bytes() for path in files}


def chunk_files(folder="reports"):
    """The complete chunks: one that is being written has a dot before its name."""
    return sorted(Path(folder, "study", "chunks").glob("[0-9]*"))


@pytest.fixture
def whole(call, study, made_once):
    """The files of the finished sweep, which lies in its folder."""
    made_once(lambda: call("sweep", study))
    return contents()


@pytest.fixture
def counted(monkeypatch):
    """The numbers of cases that were simulated, chunk by chunk."""
    sizes = []
    run = ChunkRunner.run_together

    def counting(self, chunks):
        sizes.extend(len(indices) for indices in chunks)
        return run(self, chunks)

    monkeypatch.setattr(ChunkRunner, "run_together", counting)
    return sizes


def test_results_are_the_same_for_any_number_of_threads(call, study, whole):
    for threads in ("1", "3"):
        call("sweep", study, "-n", threads, "-o", threads, code=0)
        assert contents(f"{threads}/study") == whole
    files = {
        "manifest.json",
        "summary.csv",
        "summary.parquet",
        "tables/rates.csv",
        "results.json",
        "junit.xml",
    }
    assert files <= set(whole)
    assert len(chunk_files()) == 6


def test_merged_shards_are_the_whole_wherever_they_were_run(call, study, whole, counted, monkeypatch):
    Path("below").mkdir()
    with monkeypatch.context() as patch:
        patch.chdir("below")
        call("sweep", f"../{study}", "--shard", "1/3", "-o", "../shard1", code=0)
    for number in (2, 3):
        says = f"shard {number} of 3 is finished"
        call("sweep", study, "--shard", f"{number}/3", "-o", f"shard{number}", code=0, says=says)
    call("report", "shard3/study", code=4, says=UNFINISHED)
    counted.clear()
    shards = [word for number in (1, 2, 3) for word in ("--merge", f"shard{number}/study")]
    call("sweep", study, "-o", "merged", *shards, code=0)
    assert counted == []
    assert contents("merged/study") == whole
    call("sweep", study, "--set", "seed=1", "-o", "other", "--merge", "shard1/study", code=4)


def test_shards_without_a_chunk_or_with_a_damaged_one_are_reported_and_can_be_merged(call, study, counted):
    answer = call("sweep", study, "--shard", "77/100", "-o", "shard77", code=0)
    assert answer.err == "uictest: shard 77 of 100 has no cases: the sweep has only 6 chunks\n"
    assert counted == []
    call("sweep", study, "-o", "whole", "--merge", "shard77/study", says="0 chunks from shard77/study")
    for number in (1, 2):
        call("sweep", study, "--shard", f"{number}/3", "-o", f"shard{number}")
    damaged = chunk_files("shard2")[0]
    damaged.write_bytes(b"")
    counted.clear()
    shards = ("--merge", "shard1/study", "--merge", "shard2/study")
    answer = call("sweep", study, "-q", *shards, code=0, says=f"{damaged} is damaged: skipped")
    assert counted == [16, 16, 16]
    assert "48 of 96 cases are missing from the shards: simulating them here" in answer.err
    assert "missing from the shards" not in call("sweep", study, *shards).err


def test_a_damaged_chunk_is_run_again_and_a_finished_sweep_only_for_other_inputs_with_restart(
    call, study, whole, counted
):
    damaged = chunk_files()[2]
    damaged.write_bytes(damaged.read_bytes()[:-100])
    call("sweep", study, code=0, says="is damaged: recomputing this chunk")
    assert counted == [16]
    counted.clear()
    assert contents() == whole
    call("sweep", study, code=0, says="96 of 96 cases are already finished")
    assert contents() == whole
    append_to_scenario("seed: 5\n")
    call("sweep", study, code=4, says="inputs: scenarios/stop.yaml")
    assert counted == []
    call("sweep", study, "--restart", code=0)
    assert sum(counted) == 96


@pytest.mark.parametrize("options", [(), ("--restart",), ("--shard", "1/2"), ("--shard", "1/2", "--restart")])
def test_a_second_sweep_in_a_folder_is_rejected_and_touches_nothing(call, study, options):
    FOLDER.mkdir(parents=True)
    with FolderLock(FOLDER):
        answer = call("sweep", study, *options, code=4, says=f"{FOLDER} is in use by process")
        assert "-o" in answer.err
        assert [path.name for path in FOLDER.iterdir()] == [".uictest.lock"]


def test_shards_share_a_folder_and_nobody_discards_their_chunks(call, study):
    FOLDER.mkdir(parents=True)
    with FolderLock(FOLDER, shared=True):
        call("sweep", study, "--shard", "1/2", code=0)
        for options in ((), ("--shard", "2/2", "--restart")):
            call("sweep", study, *options, code=4)
        call("sweep", study, "--shard", "2/2", code=0)
    call("sweep", study, code=0)
    assert not (FOLDER / ".uictest.lock").exists()


@pytest.mark.parametrize(
    ("error", "code", "said"),
    [
        (OSError(errno.ENOSPC, "No space left on device"), 3, "No space left on device"),
        (KeyboardInterrupt(), 2, KEPT),
    ],
)
def test_a_full_disk_and_ctrl_c_leave_what_is_finished(call, study, whole, monkeypatch, error, code, said):
    write = chunked.ChunkStore.write

    def breaks(self, number, content):
        if number == 3:
            raise error
        write(self, number, content)

    with monkeypatch.context() as patch:
        patch.setattr(chunked.ChunkStore, "write", breaks)
        call("sweep", study, "-n", "1", "--restart", code=code, says=said)
    kept = {path: path.stat().st_mtime_ns for path in chunk_files()}
    assert len(kept) == 3
    # The result of the chunks that were discarded is not taken for that of these.
    call("report", FOLDER, code=4, says=UNFINISHED)
    call("sweep", study, code=0)
    assert all(path.stat().st_mtime_ns == written for path, written in kept.items())
    assert contents() == whole


def test_ctrl_c_while_the_findings_are_written_keeps_the_chunks(call, study, monkeypatch):
    def interrupted(*arguments, **options):
        raise KeyboardInterrupt

    with monkeypatch.context() as patch:
        patch.setattr(Summary, "result", interrupted)
        call("sweep", study, code=2, says=KEPT)
    call("sweep", study, says="96 of 96 cases are already finished")


def killed_at_random(start, times):
    """Start the sweep and kill it a random while after its next chunk, several times; return how often."""
    moments = random.Random(4)
    killed = 0
    for _ in range(times):
        before = len(chunk_files("broken"))
        process = start("sweep", FILE, "-n", "2", "-q", "-o", "broken")
        while len(chunk_files("broken")) == before and process.poll() is None:
            time.sleep(0.001)
        time.sleep(moments.uniform(0.0, 0.05))
        process.send_signal(signal.SIGKILL)
        killed += process.wait() == -signal.SIGKILL
    return killed


@pytest.mark.parametrize("times", [2, pytest.param(20, marks=pytest.mark.slow)])
def test_killed_and_resumed_gives_the_same_bytes(call, start, study, times):
    Path(FILE).write_text(TEXT.replace("size: 32", f"size: {32 * times}"))
    call("sweep", study, "-o", "whole", code=0)
    # After the first of many chunks the sweep cannot be over within the while that it is given.
    assert killed_at_random(start, times) > 0
    call("sweep", study, "-o", "broken", code=0)
    assert contents("broken/study") == contents("whole/study")


@pytest.mark.skipif("sys.platform == 'win32'")
@pytest.mark.parametrize("cancelled", [signal.SIGINT, signal.SIGTERM])
def test_ctrl_c_and_a_cancelled_job_are_2_and_resumable(start, study, cancelled):
    # Minutes of work: it cannot be over before the signal, however late that is sent.
    Path(FILE).write_text(TEXT.replace("size: 32", "size: 2048"))
    process = start("sweep", FILE, stderr=subprocess.PIPE)
    while not chunk_files() and process.poll() is None:
        time.sleep(0.02)
    process.send_signal(cancelled)
    _, err = process.communicate(timeout=HANGING)
    assert process.returncode == 2
    assert "the same command continues" in err


def test_missed_is_1_and_maxfail_ends_early(call, study):
    append_to_scenario("expect: fail\n")
    answer = call("sweep", study, "-x", "-n", "1", code=1)
    first = "study[friction=0.08,sample=0]: pass, another outcome was expected"
    assert answer.err.splitlines()[-2:] == [
        f"uictest: stopped at --maxfail: 16 cases not met, the first: {first}",
        "uictest: finished chunks are kept in reports/study; the same command without --maxfail continues",
    ]
    assert len(chunk_files()) == 1
    call("sweep", study, "--junitxml", "junit.xml", code=1)
    assert 'failures="3"' in Path("junit.xml").read_text()


def test_quiet_shows_what_is_missed_and_nothing_else(call, study, whole):
    answer = call("sweep", study, "-q", code=0)
    assert (answer.out, answer.err) == ("", "")
    append_to_scenario("expect: fail\n")
    answer = call("sweep", study, "-q", "--restart", code=1)
    first, example, command, _, last = answer.out.splitlines()
    assert answer.err == ""
    assert first == "96 cases should not have passed"
    assert example.startswith("  worst study[friction=")
    assert command.startswith("  uictest sweep study.sweep.yaml -k 'study[friction=")
    assert last == "all of them: summary.csv"


def test_what_a_sweep_shows_in_lists_documents_and_quietly(call, study):
    ids = [f"study[friction=0.09,sample={k}]" for k in range(32)]
    for command in (["sweep", study, "--dry-run"], ["list", study]):
        assert call(*command, "-k", "friction=0.09").out.splitlines() == ids
    assert not Path("reports").exists()
    answer = call("sweep", study, "-k", "friction=0.09", "--format", "json")
    assert json.loads(answer.out)["cases"] == 32
    assert answer.out == (FOLDER / "results.json").read_text()


@pytest.mark.parametrize("command", [["sweep", "--dry-run"], ["list", FILE]])
def test_a_list_ends_when_its_reader_leaves(program, study, command):
    study.write_text(TEXT.replace("size: 32", "size: 16777216"))
    process = subprocess.Popen([program, *command, study], stdout=subprocess.PIPE, stderr=subprocess.PIPE)
    assert process.stdout.readline() == b"study[friction=0.08,sample=0]\n"
    process.stdout.close()
    assert process.wait(timeout=HANGING) == 0
    assert process.stderr.read() == b""
    process.stderr.close()


def test_check_finds_what_is_wrong_with_a_sweep_and_a_file_in_place_of_reports_is_no_folder(call, study):
    good = Path("scenarios", FILE)
    good.write_text(TEXT.replace("scenarios/", ""))
    call("check", code=0, says="1 scenario with 1 case and 1 sweep, no error")
    good.write_text(TEXT.replace("scenarios/", "").replace("0.08", "6"))
    call("check", code=4, says=f"scenarios/{FILE}:6:21: rail.friction: 6 is out of range")
    Path("reports").write_text("")
    answer = call("sweep", study, code=3)
    assert answer.err == "uictest: cannot write reports/study: Not a directory\n"
