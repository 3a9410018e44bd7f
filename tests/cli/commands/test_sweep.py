"""`uictest sweep`: the same files whatever happened on the way, and an exit code for everything."""

import errno
import json
import random
import signal
import subprocess
import time
from html import unescape
from pathlib import Path

import pyarrow.parquet as pq
import pytest

from uictest import report
from uictest.analysis.summaries.summary import Summary
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


@pytest.fixture
def study(scenario):
    """A sweep of 96 stops from 15 km/h in six chunks."""
    scenario("stop", "rail: {condition: wet}\n")
    path = Path("scenarios/stop.yaml")
    path.write_text(path.read_text().replace("30 km/h", "15 km/h"))
    Path(FILE).write_text(TEXT)
    return Path(FILE)


def append_to_scenario(text):
    with Path("scenarios/stop.yaml").open("a") as file:
        file.write(text)


def contents(folder="reports/study"):
    """Every file of a result by its name."""
    root = Path(folder)
    return {
        path.relative_to(root).as_posix(): path.read_bytes() for path in root.rglob("*") if path.is_file()
    }


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
        assert call("sweep", study, "-n", threads, "-o", threads).code == 0
        assert contents(f"{threads}/study") == whole
    files = {"manifest.json", "summary.csv", "summary.parquet", "rates.csv", "sweep.json", "junit.xml"}
    assert files <= set(whole)
    assert sum(name.startswith("chunks/") for name in whole) == 6


def test_a_finished_sweep_is_not_done_again_nor_for_other_inputs_without_restart(call, study, whole, counted):
    answer = call("sweep", study)
    assert (answer.code, counted) == (0, [])
    assert "96 of 96 cases are already finished" in answer.err
    assert contents() == whole
    append_to_scenario("seed: 5\n")
    answer = call("sweep", study)
    assert (answer.code, counted) == (4, [])
    assert "inputs: scenarios/stop.yaml" in answer.err
    assert call("sweep", study, "--restart").code == 0
    assert sum(counted) == 96


def test_merged_shards_are_the_whole_wherever_they_were_run(call, study, whole, counted, monkeypatch):
    Path("below").mkdir()
    with monkeypatch.context() as patch:
        patch.chdir("below")
        assert call("sweep", f"../{study}", "--shard", "1/3", "-o", "../shard1").code == 0
    for number in (2, 3):
        answer = call("sweep", study, "--shard", f"{number}/3", "-o", f"shard{number}", code=0)
        assert f"shard {number} of 3 is finished" in answer.err
    assert "holds a sweep that is not finished" in call("report", "shard3/study").err
    counted.clear()
    shards = [word for number in (1, 2, 3) for word in ("--merge", f"shard{number}/study")]
    assert call("sweep", study, "-o", "merged", *shards).code == 0
    assert counted == []
    assert contents("merged/study") == whole
    assert call("sweep", study, "--set", "seed=1", "-o", "other", "--merge", "shard1/study").code == 4


def test_help_names_the_formats_of_a_sweep(call):
    help_text = " ".join(call("sweep", "--help").out.split())
    assert f"joined by commas: {', '.join(report.sweep_format_names())}. [default" in help_text


def test_a_shard_without_a_chunk_is_reported_and_can_be_merged(call, study, counted):
    answer = call("sweep", study, "--shard", "77/100", "-o", "shard77")
    assert (answer.code, counted) == (0, [])
    assert "shard 77 of 100 has no cases: the sweep has only 6 chunks" in answer.err
    assert "is finished" not in answer.err
    assert "0 chunks from shard77/study" in call("sweep", study, "--merge", "shard77/study").err


def test_cases_missing_from_the_shards_are_reported_before_they_are_run(call, study, counted):
    for number in (1, 2):
        call("sweep", study, "--shard", f"{number}/3", "-o", f"shard{number}")
    damaged = min(Path("shard2/study/chunks").iterdir())
    damaged.write_bytes(b"")
    counted.clear()
    shards = ("--merge", "shard1/study", "--merge", "shard2/study")
    answer = call("sweep", study, "-q", *shards)
    assert (answer.code, counted) == (0, [16, 16, 16])
    assert f"{damaged} is damaged: skipped" in answer.err
    assert "48 of 96 cases are missing from the shards: simulating them here" in answer.err
    assert "missing from the shards" not in call("sweep", study, *shards).err


def test_a_damaged_chunk_is_found_and_run_again(call, study, whole, counted):
    damaged = sorted(Path("reports/study/chunks").iterdir())[2]
    damaged.write_bytes(damaged.read_bytes()[:-100])
    answer = call("sweep", study)
    assert (answer.code, counted) == (0, [16])
    assert "is damaged: recomputing this chunk" in answer.err
    assert contents() == whole


KEPT = "uictest: interrupted\nuictest: finished chunks are kept in reports/study; the same"


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
        answer = call("sweep", study, "-n", "1", "--restart")
    assert answer.code == code
    assert said in answer.err
    kept = {path: path.stat().st_mtime_ns for path in Path("reports/study/chunks").iterdir()}
    assert len(kept) == 3
    # The result of the chunks that were discarded is not taken for that of these.
    assert "holds a sweep that is not finished" in call("report", "reports/study").err
    assert call("sweep", study).code == 0
    assert all(path.stat().st_mtime_ns == written for path, written in kept.items())
    assert contents() == whole


def test_ctrl_c_while_the_findings_are_written_keeps_the_chunks(call, study, monkeypatch):
    def interrupted(*arguments, **options):
        raise KeyboardInterrupt

    with monkeypatch.context() as patch:
        patch.setattr(Summary, "result", interrupted)
        answer = call("sweep", study)
    assert answer.code == 2
    assert KEPT in answer.err
    assert "96 of 96 cases are already finished" in call("sweep", study).err


def chunk_files(folder):
    """The complete chunks: one that is being written has a dot before its name."""
    return list(Path(folder, "study", "chunks").glob("[0-9]*"))


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
    assert call("sweep", study, "-o", "whole").code == 0
    # After the first of many chunks the sweep cannot be over within the while that it is given.
    assert killed_at_random(start, times) > 0
    assert call("sweep", study, "-o", "broken").code == 0
    assert contents("broken/study") == contents("whole/study")


@pytest.mark.skipif("sys.platform == 'win32'")
@pytest.mark.parametrize("cancelled", [signal.SIGINT, signal.SIGTERM])
def test_ctrl_c_and_a_cancelled_job_are_2_and_resumable(start, study, cancelled):
    # Minutes of work: it cannot be over before the signal, however late that is sent.
    Path(FILE).write_text(TEXT.replace("size: 32", "size: 2048"))
    process = start("sweep", FILE, stderr=subprocess.PIPE)
    while not chunk_files("reports") and process.poll() is None:
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
    assert len(list(Path("reports/study/chunks").iterdir())) == 1
    assert call("sweep", study, "--junitxml", "junit.xml").code == 1
    assert 'failures="3"' in Path("junit.xml").read_text()


@pytest.mark.parametrize("options", [(), ("--report", "csv")])
def test_so_many_cases_are_written_as_csv_only_when_asked(call, study, monkeypatch, options):
    monkeypatch.setattr("uictest.report.sweep.LARGEST_CSV", 95)
    monkeypatch.setattr("uictest.report.LARGEST_CSV", 95, raising=False)
    answer = call("sweep", study, "--set", "expect=fail", *options)
    assert Path("reports/study/summary.csv").exists() == bool(options)
    assert Path("reports/study/summary.parquet").exists()
    assert ("note: every case is a row of summary.parquet" in answer.err + answer.out) != bool(options)
    assert "more, see summary.parquet" in answer.err + answer.out


def test_cases_that_no_criterion_applies_to_are_counted(call, study):
    options = ("--set", "criteria=[uic-541-05-appendix-b]", "-k", "friction=0.12")
    # The stops are from 30 km/h; with the WSP bypassed they are of no kind that the profile is for.
    done = call("sweep", study, *options, code=1)
    assert "32 cases: 32 inconclusive; 32 not as expected" in done.err
    done = call("sweep", study, *options, "--set", "rig.wsp=bypassed", "--restart", code=1)
    assert "32 cases: 32 skipped; 32 not as expected" in done.err
    assert "0.12         32     0    0       32          ░░░░░░░░░░" in done.out
    assert "note: 32 cases not judged, since no criterion applies" in done.out


def test_quiet_shows_what_is_missed_and_nothing_else(call, study, whole):
    answer = call("sweep", study, "-q")
    assert (answer.code, answer.out, answer.err) == (0, "", "")
    append_to_scenario("expect: fail\n")
    answer = call("sweep", study, "-q", "--restart")
    first, *_, last = answer.out.splitlines()
    assert (answer.code, answer.err) == (1, "")
    assert first == "pass  study[friction=0.08,sample=0]  another outcome was expected"
    assert last == "and 86 more, see summary.csv"


def test_junit_with_no_place_is_rejected_before_the_first_case(call, study, counted):
    for file in ("no/junit.xml", "scenarios"):
        call("sweep", study, "--junitxml", file, code=3, says=f"cannot write {file}: ")
    assert not counted
    assert call("sweep", study, "-k", "friction=0.09", "--junitxml", "reports/junit.xml").code == 0


def test_no_chunks_are_reported_where_there_are_none(call, study):
    Path("reports").write_text("")
    answer = call("sweep", study, code=3)
    assert answer.err == "uictest: cannot write reports/study: Not a directory\n"


def test_the_frontier_is_written_and_shown(call, study):
    Path(FILE).write_text(
        TEXT.split("  matrix")[0] + "  matrix: {rail.friction: [0.02, 0.2], brake.command: [100 %]}\n"
    )
    scenario = Path("scenarios/stop.yaml")
    scenario.write_text(scenario.read_text().replace("15 km/h", "40 km/h") + "rig: {wsp: bypassed}\n")
    answer = call("sweep", study, "--frontier", "rail.friction", "--tolerance", "0.02")
    assert "Frontier along rail.friction" in answer.out
    lines = Path("reports/study/frontier.csv").read_text().splitlines()
    assert lines[0] == "brake.command,from,to,met_at_from,flips,note"
    assert lines[1].startswith("100 %,0.")


def test_a_survey_says_what_it_repeated_and_what_its_step_does(call, study):
    result = call("sweep", study, "--set", "simulation.time_step=survey", "--report", "html,md,xlsx")
    document = json.loads(Path("reports/study/sweep.json").read_text())
    survey = document["survey"]
    bias = next(each for each in survey["biases"] if each["measure"] == "uncorrected_braking_distance")
    assert (survey["time_step"], survey["regular_step"]) == ("1 ms", "0.5 ms")
    assert survey["repeated"] == 0
    begin = "survey in steps of 1 ms, which settled all of 96 cases"
    assert f"note: {begin}" in result.out
    assert "note: bias of the survey step: uncorrected_braking_distance at most" in result.out
    assert bias["case"] in result.out
    for name in ("summary.md", "index.html"):
        assert begin in unescape(Path("reports/study", name).read_text()), name
    rows = pq.read_table("reports/study/summary.parquet").to_pylist()
    distance = {row["id"]: row["braking_distance_m"] for row in rows}
    for case in document["worst"]:
        assert case["measures"]["braking_distance_m"] == distance[case["id"]]
    assert call("sweep", study).code == 4  # the chunks of a survey are no others
    assert "time step: survey before, none now" in call("sweep", study).err


def test_survey_is_refused_where_a_verdict_is_given(call, study):
    done = call("run", "scenarios", "--set", "simulation.time_step=survey", code=4)
    assert "'survey' is the time step of a whole sweep" in done.err
    assert "uictest sweep ... --set simulation.time_step=survey" in done.err


def test_list_and_dry_run_show_ids_and_run_nothing(call, study):
    ids = [f"study[friction=0.09,sample={k}]" for k in range(32)]
    for command in (["sweep", study, "--dry-run"], ["list", study]):
        assert call(*command, "-k", "friction=0.09").out.splitlines() == ids
        assert call(*command, "-k", "nothing").code == 5
    assert not Path("reports").exists()


@pytest.mark.parametrize("command", [["sweep", "--dry-run"], ["list", FILE]])
def test_a_list_ends_when_its_reader_leaves(program, study, command):
    study.write_text(TEXT.replace("size: 32", "size: 16777216"))
    process = subprocess.Popen([program, *command, study], stdout=subprocess.PIPE, stderr=subprocess.PIPE)
    assert process.stdout.readline() == b"study[friction=0.08,sample=0]\n"
    process.stdout.close()
    assert process.wait(timeout=HANGING) == 0
    assert process.stderr.read() == b""
    process.stderr.close()


def test_stdout_is_the_document_alone(call, study):
    answer = call("sweep", study, "-k", "friction=0.09", "--format", "json")
    assert json.loads(answer.out)["cases"] == 32
    assert answer.out == Path("reports/study/sweep.json").read_text()


@pytest.mark.parametrize(
    ("options", "said"),
    [
        (["--shard", "3/2"], "is not a shard"),
        (["--frontier", "initial_speed"], "needs two values or more"),
        (["--frontier", "rail.friction", "--tolerance", "x"], "is not a number"),
        (["--map", "rail.friction,brake"], "name two parameters of rail.friction, brake.command"),
        (["--measure", "braking_distance"], "did you mean 'braking_distance_m'?"),
        (["-k", "("], "expected a word"),
        (["--set", "rail.frictoin=1"], "did you mean 'friction'?"),
    ],
)
def test_usage(call, study, options, said):
    call("sweep", study, *options, code=4, says=said)


def test_check_finds_what_is_wrong_with_a_sweep(call, study):
    good = Path("scenarios", FILE)
    good.write_text(TEXT.replace("scenarios/", ""))
    assert "1 scenario with 1 case and 1 sweep, no error" in call("check").err
    good.write_text(TEXT.replace("scenarios/", "").replace("0.08", "6"))
    call("check", code=4, says=f"scenarios/{FILE}:6:21: rail.friction: 6 is out of range")
