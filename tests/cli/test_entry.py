"""The installed program in a process of its own, with the real rig."""

import json
import os
import resource
import signal
import subprocess
import sys
from pathlib import Path

import pytest

from .conftest import HANGING

_LARGE = ("rich", "pandas", "scipy", "control", "pyarrow", "matplotlib", "plotly")
_RUNS = (
    "uictest.rig.simulation",
    "uictest.judging.evaluation.result",
    "uictest.report.page",
    "uictest.judging.series.result",
)
_RARE = (
    "uictest.rig.backends.lanes",
    "uictest.rig.identification",
    "uictest.judging.series.result",
    *("uictest.plans.sweeps", "uictest.running.chunked", "uictest.analysis.summaries"),
)
_WORDS = ("uictest.core.document", "uictest.judging.evaluation", "uictest.report.verdict_sentences")
"""What results are told with."""
_FORBIDDEN = {
    ("--help",): (*_LARGE, "uictest.report.verdict_sentences", "numpy", "pydantic", "yaml"),
    ("check",): (
        *_LARGE,
        *_RUNS,
        *_WORDS,
        "numpy",
        "uictest.plans.sweeps.plan",
        "uictest.plans.series.model",
    ),
    ("check", str(Path(__file__).parents[2] / "scenarios")): (*_LARGE, *_RUNS, *_WORDS, "numpy"),
    ("list",): (*_LARGE, *_RUNS, "numpy"),
    ("run",): (*_LARGE, *_RARE, "numpy.ma"),
}


@pytest.mark.parametrize(
    "arguments", _FORBIDDEN, ids=lambda words: " ".join(Path(word).name for word in words)
)
def test_a_command_imports_only_what_it_needs(scenario, arguments):
    scenario("stop")
    program = """if True:
        import sys
        from uictest.cli.entry import execute
        code = execute(sys.argv[2:])
        print([name for name in sys.argv[1].split() if name in sys.modules], file=sys.stderr)
        sys.exit(code)
    """
    command = [sys.executable, "-c", program, " ".join(_FORBIDDEN[arguments]), *arguments]
    done = subprocess.run(command, capture_output=True, text=True, check=False, timeout=HANGING)
    assert done.returncode == 0, done.stderr
    assert done.stderr.splitlines()[-1] == "[]"


def test_a_sweep_loads_no_pandas_and_arrow_still_takes_its_objects(scenario):
    path = scenario("study", "vary: {ranges: {initial_speed: {first: 20 km/h, last: 30 km/h, count: 2}}}\n")
    program = """if True:
        import sys
        from uictest.cli.entry import execute
        code = execute(["sweep", sys.argv[1], "-q"])
        loaded = "pandas" in sys.modules
        import pandas
        import pyarrow
        table = pyarrow.Table.from_pandas(pandas.DataFrame({"a": pandas.Series([1.0, float("nan")])}))
        print(code, loaded, table.column("a").null_count, table.to_pandas()["a"].isna().sum())
    """
    command = [sys.executable, "-c", program, str(path)]
    done = subprocess.run(command, capture_output=True, text=True, check=False, timeout=HANGING)
    assert done.returncode == 0, done.stderr
    assert done.stdout.splitlines()[-1] == "0 False 1 1"


def test_the_child_of_a_controller_imports_nothing_of_scenarios():
    program = "import sys, uictest.rig.external.child as _; print([*filter(sys.modules.get, sys.argv[1:])])"
    forbidden = (*_LARGE, "pydantic", "yaml", "uictest.plans.scenario.model", "uictest.rig.assembly")
    command = [sys.executable, "-c", program, *forbidden]
    assert subprocess.run(command, capture_output=True, text=True, check=True).stdout == "[]\n"


@pytest.mark.parametrize(("given", "kept"), [({}, "1"), ({"OPENBLAS_NUM_THREADS": "3"}, "3")])
def test_a_process_has_no_threads_for_matrices_unless_told_to(given, kept):
    environment = {name: os.environ[name] for name in os.environ if name != "OPENBLAS_NUM_THREADS"} | given
    program = "import os; os._exit = print; from uictest.cli import main; main(); "
    program += "print(os.environ['OPENBLAS_NUM_THREADS'])"
    command = [sys.executable, "-c", program, "--version"]
    done = subprocess.run(command, capture_output=True, text=True, check=True, env=environment)
    assert done.stdout.splitlines()[-1] == kept


def test_the_program_can_be_run_as_a_module(process):
    command = [sys.executable, "-m", "uictest", "--version"]
    as_module = subprocess.run(command, capture_output=True, text=True, check=True)
    assert as_module.stdout == process("--version").out


def test_a_full_disk_exits_3_and_leaves_nothing(process, scenario):
    scenario("stop", "expect: invalid\n")

    def small_files():
        signal.signal(signal.SIGXFSZ, signal.SIG_IGN)
        resource.setrlimit(resource.RLIMIT_FSIZE, (600, 600))

    answer = process("run", preexec_fn=small_files, env={**os.environ, "PYTHONDONTWRITEBYTECODE": "1"})
    assert answer.code == 3, answer.err
    assert "File too large" in answer.err
    assert "Traceback" not in answer.err
    assert not Path("reports").exists()


def test_a_met_case_is_recorded_when_asked_and_a_missed_one_always(process, call, scenario):
    scenario("stop", "matrix:\n  brake.command: [80 %, 90 %]\n")
    answer = process("run", "--record", "all", "--record-rate", "50", "--format", "json")
    assert answer.code == 0, answer.err
    ids = ["stop[command=80]", "stop[command=90]"]
    assert [case["id"] for case in json.loads(answer.out)["cases"]] == ids
    assert "2 cases: 2 pass" in answer.err
    assert sorted(path.stem for path in Path("reports/latest/recordings").iterdir()) == ids
    scenario("stop")
    answer = call("run", code=0)
    assert answer.out.startswith(
        "pass stop outcome=pass expect=pass test_validity=not_judged requirements=met braking_"
    )
    assert not Path("reports/latest/recordings").exists()
    scenario("stop", "expect: invalid\n")
    call("run", code=1)
    assert Path("reports/latest/recordings/stop.parquet").is_file()


def test_results_are_the_same_bits_with_and_without_recording_and_on_any_number_of_threads(call, scenario):
    scenario("stop", "matrix:\n  rail.friction: [0.05, 0.1]\n  rail.condition: [wet]\n")
    options = (["-n1"], ["-n2"], ["-n", "auto"], ["--record", "all", "--record-rate", "200"])
    results = []
    for given in options:
        call("run", *given)
        results.append(json.loads(Path("reports/latest/results.json").read_text())["cases"])
    assert results == [results[0]] * len(options)


def test_hostile_file_names_are_shown_as_text(call, scenario):
    scenario("stop", file="[red]\x1b[31m\n::error::=1+1.yaml")
    scenario("other", "nonsense: 1\n", file="[bold]\x1b[2J.yaml")
    for arguments in (["check"], ["check", "--format", "github"], ["run"]):
        answer = call(*arguments, code=4)
        assert "\x1b" not in answer.out + answer.err
        assert r"\x1b[2J" in answer.out + answer.err
    Path("scenarios", "[bold]\x1b[2J.yaml").unlink()
    for arguments in (["run", "--format", "text"], ["run", "--format", "github", "--set", "expect=fail"]):
        answer = call(*arguments)
        assert "\x1b" not in answer.out + answer.err
        assert not [line for line in answer.out.splitlines() if line.startswith("::error::")]
