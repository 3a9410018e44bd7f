"""`--lf` after other commands have left their results beside the runs."""

from __future__ import annotations

from collections.abc import Callable
from pathlib import Path
from typing import Any

import numpy as np
import pytest

from uictest.core.recording import Recording
from uictest.core.recording.formats import writer_of

Call = Callable[..., Any]
Write = Callable[..., Path]
STATED = ("--rail", "dry", "--position", "R", "--wsp", "active", "--criteria", "uictest-stop")


@pytest.fixture
def recording(workplace: Path) -> Path:
    """A train of rolling wheels that stops from 10 m/s."""
    time = np.arange(0.0, 10.5, 0.01)
    speed = np.maximum(10.0 - time, 0.0)
    channels = {"time": time, "speed": speed, **{f"wheel_speed_{n}": speed for n in (1, 2, 3, 4)}}
    units = {name: "s" if name == "time" else "m/s" for name in channels}
    path = workplace / "recorded.csv"
    writer_of("csv")(Recording(channels, units, {"brake_command_time": "0 s"}), path)
    return path


def evaluate(call: Call, recording: Path) -> None:
    assert call("evaluate", recording, *STATED).code == 0
    assert '"recorded"' in Path("reports/latest/results.json").read_text()


def test_an_evaluation_in_between_is_not_the_newest_run(
    call: Call, scenario: Write, made_up: list[str], recording: Path
) -> None:
    scenario("a")
    scenario("b", "tags: [fail]\n")
    call("run")
    evaluate(call, recording)
    made_up.clear()
    assert call("run", "--lf").code == 1
    assert made_up == ["b"]


def test_evaluations_alone_are_no_run(
    call: Call, scenario: Write, made_up: list[str], recording: Path
) -> None:
    scenario("a")
    evaluate(call, recording)
    assert "no earlier run" in call("run", "--lf").err


def test_of_several_runs_the_newest_counts(
    call: Call, scenario: Write, made_up: list[str], recording: Path
) -> None:
    """Within a second, too, and whatever the hash in their names."""
    for failing in ("a", "b", "c"):
        for name in ("a", "b", "c"):
            scenario(name, "tags: [fail]\n" if name == failing else "")
        call("run")
    evaluate(call, recording)
    made_up.clear()
    call("run", "--lf")
    assert made_up == ["c"]
