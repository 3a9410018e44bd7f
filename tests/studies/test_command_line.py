"""`./reproduce`: which studies it runs, what it shows, and its exit code."""

from __future__ import annotations

import builtins
import json
import os
import re
import shutil
import subprocess
import sys
from pathlib import Path
from typing import NamedTuple

import pytest

from studies import __main__ as command_line
from studies.quantity import OwnBand, SourceBand, StudyQuantity, StudyValue
from studies.study import STUDIES, Study, StudyFindings

REPOSITORY = Path(__file__).parents[2]


class Answer(NamedTuple):
    code: int
    out: str
    err: str


@pytest.fixture
def call(tmp_path, monkeypatch, capsys):
    monkeypatch.chdir(tmp_path)

    def answer(*arguments):
        try:
            code = command_line.main(arguments)
        except SystemExit as end:
            code = int(end.code or 0)
        return Answer(code, *capsys.readouterr())

    return answer


OURS = OwnBand(lower=1.0, reason="ours")
DECLARED = SourceBand(lower=1.0, declared_miss="It is shorter.")


def study(name, value, band=OURS):
    """A study that finds one value, which must be at least 1."""
    quantity = StudyQuantity("value", "value found", "m", "1 m", status="predicted", band=band)

    def draw(figure):
        figure.subplots().plot([0.0, value])

    findings = StudyFindings({"value": StudyValue(value)}, {"data": {"value_m": [value]}}, {"figure": draw})
    return Study(name, f"Study {name}", "1 m", (quantity,), lambda stop_runner: findings)


@pytest.fixture(autouse=True)
def catalogue(monkeypatch):
    """Two studies, of which the second misses its band."""
    chosen = {each.name: each for each in (study("sound", 2.0), study("amiss", 0.5))}
    monkeypatch.setattr(command_line, "STUDIES", chosen)


def test_studies_are_listed_and_json_stands_alone_on_stdout(call):
    assert call("--list").out == "sound  Study sound\namiss  Study amiss\n"
    assert [each["name"] for each in json.loads(call("--list", "--format", "json").out)] == ["sound", "amiss"]
    document = json.loads(call("--format", "json").out)
    assert [each["result"] for each in document["studies"]] == ["holds", "misses"]


def test_exit_0_only_where_every_band_holds(call):
    answer = call("sound")
    assert (answer.code, "1 study, 1 value: 1 hold, 0 miss, 0 shown; in" in answer.err) == (0, True)
    answer = call()
    assert answer.code == 1
    counts = "2 studies, 2 values: 1 hold, 1 miss (0 declared), 0 shown; not as claimed: amiss; in"
    assert counts in answer.err


def test_a_declared_miss_leaves_the_exit_code_alone_unless_it_holds(call, monkeypatch):
    monkeypatch.setitem(command_line.STUDIES, "amiss", study("amiss", 0.5, DECLARED))
    answer = call("amiss")
    assert answer.code == 0
    assert "1 value: 0 hold, 1 miss (1 declared), 0 shown; in" in answer.err
    assert "misses, declared  predicted  value found" in answer.out
    assert "Declared missed: value found. It is shorter." in answer.out
    monkeypatch.setitem(command_line.STUDIES, "sound", study("sound", 2.0, DECLARED))
    answer = call("sound")
    assert answer.code == 1
    assert "holds, declared missed  predicted  value found" in answer.out
    assert "not as claimed: sound" in answer.err


def test_quiet_shows_only_what_misses_and_the_counts(call):
    answer = call("-q")
    missed = answer.out.splitlines()[1]
    assert " ".join(missed.split()) == "amiss value found >= 1 m 0.5 m predicted misses"
    assert "sound" not in answer.out
    assert answer.out.splitlines()[-1].split() == ["all", "1", "1", "0"]
    assert answer.err == ""


def test_an_unknown_study_is_a_usage_error_with_a_hint(call):
    hint = "uictest: no study 'soud'; did you mean 'sound'?\nTry './reproduce --help'.\n"
    assert call("soud") == (4, "", hint)


@pytest.mark.parametrize("arguments", [("--jobs", "0"), ("--format", "xml"), ("--lsit",)])
def test_a_wrong_option_is_a_usage_error(call, arguments):
    assert call(*arguments).code == 4


def test_data_and_figures_lie_by_study(call):
    pytest.importorskip("matplotlib")
    call("sound", "-o", "there")
    made = {path.name for path in Path("there", "sound").iterdir()}
    assert made == {"data.csv", "figure.svg", "figure.png", "index.html"}


def test_without_matplotlib_the_study_runs_and_says_what_to_install(call, monkeypatch):
    imported = builtins.__import__

    def refuse(name, *rest):
        if name.startswith("matplotlib"):
            raise ModuleNotFoundError(f"No module named {name!r}", name=name)
        return imported(name, *rest)

    monkeypatch.setattr(builtins, "__import__", refuse)
    answer = call("sound", "-o", "there")
    assert answer.code == 0
    assert "pip install 'uictest[figures]'" in answer.err
    assert {path.name for path in Path("there", "sound").iterdir()} == {"data.csv", "index.html"}


@pytest.mark.parametrize(
    ("error", "code", "said"),
    [
        (ZeroDivisionError("no load"), 3, r".*Traceback.*internal error: ZeroDivisionError: no load"),
        (KeyboardInterrupt(), 2, "uictest: interrupted"),
    ],
)
def test_a_study_that_fails_or_is_interrupted_is_no_missed_band(call, monkeypatch, error, code, said):
    def fail(stop_runner):
        raise error

    monkeypatch.setitem(command_line.STUDIES, "sound", Study("sound", "", "", (), fail))
    answer = call("sound")
    assert answer.code == code
    assert re.fullmatch(rf"uictest: sound\.\.\.\n{said}\n", answer.err, re.DOTALL)


def test_a_folder_that_cannot_be_made_is_an_error(call):
    Path("file").touch()
    answer = call("sound", "-o", "file/there")
    assert answer.code == 3
    assert "file" in answer.err


@pytest.mark.skipif(shutil.which("sh") is None, reason="no shell")
def test_the_script_lists_the_studies(tmp_path):
    """From any folder, in an environment that has all that it needs."""
    environment = tmp_path / "environment"
    (environment / "bin").mkdir(parents=True)
    (environment / "bin" / "python").symlink_to(sys.executable)
    checksum = subprocess.run(
        ["sh", "-c", "cksum <pyproject.toml"], cwd=REPOSITORY, capture_output=True, text=True, check=True
    )
    (environment / ".uictest[dev]").write_text(f"{checksum.stdout.strip()} {REPOSITORY}\n")
    done = subprocess.run(
        [REPOSITORY / "reproduce", "--list"],
        cwd=tmp_path,
        env={**os.environ, "UICTEST_VENV": str(environment), "PYTHONPATH": os.pathsep.join(sys.path)},
        capture_output=True,
        text=True,
        check=True,
    )
    assert [line.split()[0] for line in done.stdout.splitlines()] == list(STUDIES)
