"""The installed program in a process of its own, with the real rig."""

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
    "uictest.rig.lanes",
    "uictest.rig.identification",
    "uictest.judging.series.result",
    *("uictest.plans.sweeps", "uictest.running.chunked", "uictest.analysis.summaries"),
)
_WORDS = ("uictest.judging.evaluation", "uictest.report.verdict_sentences")
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


@pytest.mark.parametrize(("command", "cases"), [("run", "{}"), ("sweep", "vary: {{{}}}")])
def test_a_kernel_that_cannot_be_used_ends_a_run_or_a_sweep_and_is_no_result_of_cases(
    scenario, process, command, cases
):
    path = scenario(text=cases.format("matrix: {seed: [1, 2, 3]}"))
    answer = process(command, path, env={**os.environ, "UICTEST_PROCESSOR": "none"})
    assert (answer.code, answer.out) == (3, "")
    assert answer.err.count("this processor runs") == 1
