"""The program as its users meet it: in a folder of its own, in this process or in one of its own."""

import json
import re
import shutil
import signal
import subprocess
import sysconfig
from collections.abc import Callable
from dataclasses import dataclass
from functools import cache, partial
from pathlib import Path

import numpy as np
import pytest

from uictest.analysis.summaries import worst
from uictest.cli.entry import execute
from uictest.core.measures import STOP_COLUMNS
from uictest.core.recording import Recording
from uictest.judging.evaluation import CaseResult, error_result
from uictest.rig.identification.lines import FittedLine, computed_force
from uictest.running.campaign import CaseRun, StopRun, stop as stop_module

STATED = tuple(
    f"--set={each}"
    for each in ("rail.condition=dry", "brake.position=R", "rig.wsp=active", "criteria=uictest-stop")
)
"""What `evaluate` asks of a recorded stop."""
HANGING = 600.0
"""Seconds after which a test takes something for hanging: no machine is so busy that it takes this long."""
PROGRAM = Path(sysconfig.get_path("scripts"), "uictest")
FIGURES = dict.fromkeys(STOP_COLUMNS, float("nan")) | {
    "braking_distance_m": 465.25,
    "braking_time_s": 27.5,
    "mean_deceleration_mps2": 1.195,
    "minimum_deceleration_mps2": 0.9,
    "maximum_deceleration_mps2": 1.31,
    "reservoir_minimum_bar": 7.2,
    "air_consumed_nl": 180.0,
    "energy_residual": 1e-8,
    "air_residual": 1e-12,
    "air_energy_residual": 1e-12,
}


@dataclass(frozen=True)
class Answer:
    """What one call of the program came to."""

    code: int
    out: str
    err: str


Call = Callable[..., Answer]
Start = Callable[..., "subprocess.Popen[str]"]
Write = Callable[..., Path]


def rolling_train(end=10.5, **changes):
    """A train of rolling wheels that stops from 10 m/s within ten seconds."""
    time = np.arange(0.0, end, 0.01)
    speed = np.maximum(10.0 - time, 0.0)
    channels = {"time": time, "speed": speed, **{f"wheel_speed_{n}": speed for n in (1, 2, 3, 4)}, **changes}
    units = {name: "s" if name == "time" else "m/s" for name in channels}
    return Recording(channels, units, {"brake_command_time": "0 s"})


def verdicts_in(text):
    """The table of a run as it is shown: id -> verdict."""
    _, _, table = text.partition("case  ")
    lines = re.split("\n\n|\nseries  |\nnot shown", table)[0].splitlines()
    rows = [re.split("  +", line) for line in lines[1:]]
    return {cells[0]: cells[1] for cells in rows if cells[0] and len(cells) > 1}


def results_of(folder="reports/latest"):
    """The document of a run or a sweep."""
    return json.loads(Path(folder, "results.json").read_text("utf-8"))


def manifest_of(folder="reports/latest"):
    """The manifest of a run or a sweep."""
    return json.loads(Path(folder, "manifest.json").read_text("utf-8"))


SQUEEZING, RELEASING = FittedLine(0.042, -1800.0), FittedLine(0.0475, -1650.0)
CALIPER_LINES = {"bc_squeezing": SQUEEZING, "bc_releasing": RELEASING}
CALIPER_LINES |= {"wsp_squeezing": SQUEEZING, "wsp_releasing": RELEASING}


@cache
def caliper():
    """A caliper of these lines, released between two brakings; its cylinder lags 30 ms behind the tank."""
    time = 0.001 * np.arange(22_001)
    pressure = np.interp(time, [0, 5, 10, 13, 16, 19, 22], [0, 4, 0, 3, 0.5, 4, 0])
    still = np.zeros(time.size)
    force = computed_force(1e5 * pressure, still > 0.0, CALIPER_LINES, 0.0, 0.001, 0.0) / 1e3
    channels = {
        "time": (time, "s"),
        "cylinder_pressure_1": (pressure, "bar"),
        "clamping_force_1": (force, "kN"),
        "valve_command_1": (still, "1"),
        "measured_pressure_2": (np.interp(time + 0.03, time, pressure), "bar"),
    }
    return Recording(
        {name: samples for name, (samples, _) in channels.items()},
        {name: unit for name, (_, unit) in channels.items()},
    )


@pytest.fixture(autouse=True)
def workplace(tmp_path, monkeypatch):
    """A working folder of its own, and no setting of the terminal that runs the tests."""
    monkeypatch.chdir(tmp_path)
    for variable in ("CI", "NO_COLOR", "COLUMNS", "TERM", "GITHUB_STEP_SUMMARY"):
        monkeypatch.delenv(variable, raising=False)
    return tmp_path


@pytest.fixture(scope="module")
def kept_places(tmp_path_factory):
    """Where working folders are kept that several tests of a file begin with."""
    return tmp_path_factory.mktemp("kept")


@pytest.fixture
def made_once(workplace, kept_places):
    """Fill the working folder as a function does: it is called for the first test of a file alone."""

    def fill(make):
        kept = kept_places / make.__qualname__.partition(".")[0]
        if not kept.exists():
            make()
            shutil.copytree(workplace, kept, symlinks=True)
        else:
            shutil.copytree(kept, workplace, symlinks=True, dirs_exist_ok=True)

    return fill


@pytest.fixture
def scenario(workplace):
    """Write a scenario below scenarios/; the text is appended to what every scenario needs."""

    def write(name="stop", text="", file=None):
        path = Path("scenarios", file or f"{name}.yaml")
        path.parent.mkdir(exist_ok=True)
        path.write_text(f"schema: uictest/scenario/1\nname: {name}\ninitial_speed: 30 km/h\n{text}", "utf-8")
        return path

    return write


@pytest.fixture
def call(capsys):
    """Call the program in this process; a test may state its exit code and what stderr says."""

    def run(*arguments, code=None, says=""):
        exit_code = execute([str(argument) for argument in arguments])
        captured = capsys.readouterr()
        assert code is None or exit_code == code, captured.err
        assert says in captured.err
        return Answer(int(exit_code), captured.out, captured.err)

    return run


@pytest.fixture
def program():
    """The installed program."""
    return PROGRAM


@pytest.fixture
def start():
    """Start the installed program in a process that answers Ctrl-C; it is killed at the end of the test."""
    started = []

    def run(*arguments, **options):
        # A shell that starts the tests in the background lets every process below it ignore SIGINT.
        answers = partial(signal.signal, signal.SIGINT, signal.SIG_DFL)
        command = [PROGRAM, *map(str, arguments)]
        started.append(subprocess.Popen(command, text=True, preexec_fn=answers, **options))
        return started[-1]

    yield run
    for process in started:
        with process:
            process.kill()


@pytest.fixture
def process():
    """Call the installed program in a process of its own."""

    def run(*arguments, **options):
        options = {"stdout": subprocess.PIPE, "stderr": subprocess.PIPE, "timeout": HANGING, **options}
        done = subprocess.run([PROGRAM, *map(str, arguments)], text=True, check=False, **options)
        return Answer(done.returncode, done.stdout or "", done.stderr or "")

    return run


@pytest.fixture
def two_worst_cases(monkeypatch):
    """Let a sweep draw two of its worst cases, not twelve: what a page draws has tests of its own."""
    monkeypatch.setattr(worst, "MOST", 2)


@pytest.fixture
def made_up(monkeypatch):
    """Let stops come out as their tags say (`fail`, `invalid`, `error`, else `pass`); the ids as examined."""
    examined = []

    def examine(stop, wish, run):
        case = stop.case
        examined.append(case.id)
        if "error" in case.scenario.tags:
            return StopRun(stop, CaseRun(error_result(case, "ZeroDivisionError: no wheel load")))
        outcome = next((tag for tag in ("fail", "invalid") if tag in case.scenario.tags), "pass")
        given = (case.id, case.path.as_posix(), dict(case.parameters), case.scenario.expect)
        result = CaseResult(*given, outcome, measures=FIGURES, reason="made up")
        return StopRun(stop, CaseRun(result))

    monkeypatch.setattr(stop_module, "run_stop", examine)
    return examined
