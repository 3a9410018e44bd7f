"""The installed program in a process of its own, with the real rig, also when it is asked to stop."""

import os
import resource
import signal
import subprocess
import sys
import time
from itertools import product
from pathlib import Path

import pytest

from .conftest import HANGING, results_of, verdicts_in

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


pytestmark = pytest.mark.skipif(sys.platform == "win32", reason="signals are POSIX")

ASKING = [signal.SIGINT, signal.SIGTERM, signal.SIGHUP]
# Asks as soon as the named module is looked for, which is a moment that does not depend on the machine.
ASKED_WHILE_IMPORTING = """
import os, sys
module, number = sys.argv.pop(1), int(sys.argv.pop(1))
class Asking:
    @staticmethod
    def find_spec(name, path=None, target=None):
        if name == module:
            os.kill(os.getpid(), number)
sys.meta_path.insert(0, Asking)
from uictest.cli import main
main()
"""


SECOND_HANGS = """\
import time
from pathlib import Path
from uictest.controllers import Outputs

class Wsp:
    started = 0

    def __init__(self, config):
        pass

    def reset(self):
        Wsp.started += 1

    def step(self, inputs):
        if Wsp.started == 2:
            Path("hanging").touch()
            time.sleep(600.0)
        return Outputs([0, 0, 0, 0], [0, 0, 0, 0])
"""
"""A controller that never ends its second stop."""


def heeding():
    """Undo what the caller of the tests may ignore, such as SIGHUP under nohup."""
    for number in ASKING:
        signal.signal(number, signal.SIG_DFL)


def ignoring():
    signal.signal(signal.SIGHUP, signal.SIG_IGN)


# Each signal before and after the program has begun, and moments further on.
@pytest.mark.parametrize(
    ("module", "number"),
    [
        *product(["uictest.cli.entry", "uictest.cli.commands.run"], ASKING),
        *zip(["typer", "pydantic", "numpy"], ASKING, strict=True),
    ],
)
def test_asked_while_it_starts(scenario, module, number):
    scenario("stop")
    command = [sys.executable, "-c", ASKED_WHILE_IMPORTING, module, str(int(number)), "run"]
    done = subprocess.run(
        command, capture_output=True, text=True, check=False, timeout=HANGING, preexec_fn=heeding
    )
    assert (done.returncode, done.stdout, done.stderr) == (2, "", "uictest: interrupted\n")
    assert not Path("reports").exists()


@pytest.mark.parametrize("number", [signal.SIGINT, signal.SIGHUP])
def test_ctrl_c_and_a_closed_terminal_leave_what_is_finished(program, scenario, number):
    path = scenario("stop", "controller: {python: wsp.py, class: Wsp}\nmatrix: {seed: [1, 2, 3]}\n")
    path.with_name("wsp.py").write_text(SECOND_HANGS, "utf-8")
    command = [program, "run", "-n1", "--in-process", path]
    pipes = {"stdout": subprocess.PIPE, "stderr": subprocess.PIPE}
    with subprocess.Popen(command, text=True, preexec_fn=heeding, **pipes) as running:
        while not Path("hanging").exists() and running.poll() is None:
            time.sleep(0.01)
        running.send_signal(number)
        shown, err = running.communicate(timeout=HANGING)
    assert running.returncode == 2, err
    assert verdicts_in(shown) == {"stop[seed=1]": "pass"}
    assert "; interrupted; 2 not run; took " in shown
    document = results_of()
    assert document["complete"] is False
    assert [case["id"] for case in document["cases"]] == ["stop[seed=1]"]
    assert [path.name for path in Path("reports").iterdir() if path.name.startswith(".")] == []


def test_what_the_caller_ignores_stays_ignored(scenario):
    """As nohup wants it."""
    scenario("stop")
    command = [sys.executable, "-c", ASKED_WHILE_IMPORTING, "numpy", str(int(signal.SIGHUP)), "run"]
    done = subprocess.run(
        command, capture_output=True, text=True, check=False, timeout=HANGING, preexec_fn=ignoring
    )
    assert done.returncode == 0, done.stderr
