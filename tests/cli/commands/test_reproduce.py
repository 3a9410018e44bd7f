from __future__ import annotations

import builtins
import json
from collections.abc import Callable
from pathlib import Path
from typing import Any

import pytest

from uictest import studies
from uictest.studies import (
    OwnBand,
    SourceBand,
    StopRunner,
    Study,
    StudyFindings,
    StudyQuantity,
    StudyValue,
)

Call = Callable[..., Any]


OURS = OwnBand(lower=1.0, reason="ours")
DECLARED = SourceBand(lower=1.0, declared_miss="It is shorter.")


def study(name: str, value: float, band: OwnBand | SourceBand = OURS) -> Study:
    """A study that finds one value, which must be at least 1."""
    quantity = StudyQuantity("value", "value found", "m", "1 m", status="predicted", band=band)

    def draw(figure: Any) -> None:
        figure.subplots().plot([0.0, value])

    findings = StudyFindings(
        {"value": StudyValue(value)},
        {"data": {"value_m": [value]}},
        {"figure": draw},
    )
    return Study(name, f"Study {name}", "1 m", (quantity,), lambda stop_runner: findings)


@pytest.fixture(autouse=True)
def catalogue(monkeypatch: pytest.MonkeyPatch) -> None:
    """Two studies, of which the second misses its band."""
    chosen = {each.name: each for each in (study("sound", 2.0), study("amiss", 0.5))}
    monkeypatch.setattr(studies, "STUDIES", chosen)


def test_studies_are_listed(call: Call) -> None:
    assert call("reproduce", "--list").out == "sound  Study sound\namiss  Study amiss\n"
    assert [each["name"] for each in json.loads(call("reproduce", "--list", "--format", "json").out)] == [
        "sound",
        "amiss",
    ]


def test_exit_0_only_where_every_band_holds(call: Call) -> None:
    answer = call("reproduce", "sound")
    assert (answer.code, "1 study, 1 value: 1 hold, 0 miss, 0 shown; in" in answer.err) == (0, True)
    answer = call("reproduce")
    assert answer.code == 1
    counts = "2 studies, 2 values: 1 hold, 1 miss (0 declared), 0 shown; not as claimed: amiss; in"
    assert counts in answer.err


def test_a_declared_miss_of_the_papers_band_leaves_the_exit_code_alone(
    call: Call, monkeypatch: pytest.MonkeyPatch
) -> None:
    monkeypatch.setitem(studies.STUDIES, "amiss", study("amiss", 0.5, DECLARED))
    answer = call("reproduce", "amiss")
    assert answer.code == 0
    assert "1 value: 0 hold, 1 miss (1 declared), 0 shown; in" in answer.err
    assert "misses, declared  predicted  value found" in answer.out
    assert "Declared missed: value found. It is shorter." in answer.out


def test_a_declared_miss_that_holds_is_exit_1(call: Call, monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setitem(studies.STUDIES, "sound", study("sound", 2.0, DECLARED))
    answer = call("reproduce", "sound")
    assert answer.code == 1
    assert "holds, declared missed  predicted  value found" in answer.out
    assert "not as claimed: sound" in answer.err


def test_the_papers_value_stands_next_to_ours(call: Call) -> None:
    assert (
        "holds  predicted  value found: paper 1 m; ours 2.0 m; band >= 1 m (ours)\n"
        in call("reproduce", "sound").out
    )


def test_quiet_shows_only_what_misses_and_the_counts(call: Call) -> None:
    answer = call("reproduce", "-q")
    missed = answer.out.splitlines()[1]
    assert " ".join(missed.split()) == "amiss value found >= 1 m 0.5 m predicted misses"
    assert "sound" not in answer.out
    assert answer.out.splitlines()[-1].split() == ["all", "1", "1", "0"]
    assert answer.err == ""


def test_json_stands_alone_on_stdout(call: Call) -> None:
    document = json.loads(call("reproduce", "--format", "json").out)
    assert [each["result"] for each in document["studies"]] == ["holds", "misses"]


def test_an_unknown_study_is_a_usage_error_with_a_hint(call: Call) -> None:
    answer = call("reproduce", "soud")
    assert answer.code == 4
    assert "did you mean 'sound'" in answer.err


def test_data_and_figures_lie_by_study(call: Call) -> None:
    pytest.importorskip("matplotlib")
    call("reproduce", "sound", "-o", "there")
    assert {path.name for path in Path("there", "sound").iterdir()} == {
        "data.csv",
        "figure.svg",
        "figure.png",
        "index.html",
    }


def test_without_matplotlib_the_study_runs_and_says_what_to_install(
    call: Call, monkeypatch: pytest.MonkeyPatch
) -> None:
    imported = builtins.__import__

    def refuse(name: str, *rest: Any) -> Any:
        if name.startswith("matplotlib"):
            raise ModuleNotFoundError(f"No module named {name!r}", name=name)
        return imported(name, *rest)

    monkeypatch.setattr(builtins, "__import__", refuse)
    answer = call("reproduce", "sound", "-o", "there")
    assert answer.code == 0
    assert "pip install 'uictest[figures]'" in answer.err
    assert {path.name for path in Path("there", "sound").iterdir()} == {"data.csv", "index.html"}


def test_a_page_for_each_study_and_one_that_lists_them(call: Call) -> None:
    call("reproduce", "-o", "there")
    assert "word-bad" in Path("there", "amiss", "index.html").read_text("utf-8").split("<main", 1)[1]
    listed = Path("there", "index.html").read_text("utf-8")
    assert [f'href="{name}/index.html"' in listed for name in ("sound", "amiss")] == [True, True]


def test_a_study_that_fails_is_an_error_and_no_missed_band(
    call: Call, monkeypatch: pytest.MonkeyPatch
) -> None:
    def fail(stop_runner: StopRunner) -> StudyFindings:
        raise ZeroDivisionError("no wheel load")

    monkeypatch.setitem(studies.STUDIES, "sound", Study("sound", "", "", (), fail))
    answer = call("reproduce")
    assert answer.code == 3
    assert "ZeroDivisionError" in answer.err
