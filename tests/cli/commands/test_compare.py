from __future__ import annotations

import json
from collections.abc import Callable
from pathlib import Path
from typing import Any

import numpy as np
import pytest

from uictest.core.recording import Recording, write_parquet

Call = Callable[..., Any]
Write = Callable[..., Path]


def _recording(path: str, shift: float = 0.0) -> Path:
    time = np.linspace(0.0, 10.0, 101)
    write_parquet(
        Recording({"time": time, "speed": 30.0 - time + shift}, {"time": "s", "speed": "m/s"}), Path(path)
    )
    return Path(path)


def test_a_run_and_itself_agree_and_another_differs(call: Call, scenario: Write, made_up: list[str]) -> None:
    scenario("a")
    call("run", "-o", "one")
    scenario("a", "tags: [fail]\n")
    call("run", "-o", "other")
    same = call("compare", "one/latest", "one/latest")
    assert (same.code, same.out) == (0, "")
    assert "no difference" in same.err
    differing = call("compare", "one/latest", "other/latest")
    assert differing.code == 1
    assert "differs  a     outcome" in differing.out
    assert "note: inputs: scenarios/a.yaml" in differing.out


def test_the_parameter_that_changed_is_named_and_so_it_is_against_a_baseline(
    call: Call, scenario: Write, made_up: list[str]
) -> None:
    scenario("a", "controller: {extends: threshold, slip_threshold: 4 km/h}\n")
    call("run", "-o", "one", "--baseline", "kept", "--accept")
    changed = ["--set", "controller.slip_threshold=3 km/h"]
    against = call("run", "-o", "other", "--baseline", "kept", *changed)
    line = "parameter controller.slip_threshold: 4 km/h -> 3 km/h (in a)"
    assert line in against.err
    assert line in call("compare", "one/latest", "other/latest").out.splitlines()


def test_recordings_are_compared_channel_by_channel(call: Call) -> None:
    first, second = _recording("a.parquet"), _recording("b.parquet", shift=0.5)
    assert call("compare", first, first).code == 0
    answer = call("compare", first, second, "--html", "page.html")
    assert answer.code == 1
    assert "speed" in answer.out
    assert 'class="panels"' in Path("page.html").read_text()
    assert call("compare", first, second, "--tolerance", "speed=1.9").code == 0
    document = json.loads(call("compare", first, second, "--format", "json").out)
    assert [each["quantity"] for each in document["differences"]] == ["speed"]


def test_channels_are_chosen_for_the_page(call: Call) -> None:
    first, second = _recording("a.parquet"), _recording("b.parquet", shift=0.5)
    assert call("compare", first, second, "--channel", "speed").code == 4
    answer = call("compare", first, second, "--html", "page.html", "--channel", "sped")
    assert (answer.code, Path("page.html").exists()) == (4, False)
    assert "did you mean 'speed'? both have: speed" in answer.err


def test_stops_without_two_recordings_are_named(call: Call, scenario: Write, made_up: list[str]) -> None:
    scenario("a")
    call("run", "-o", "one")
    scenario("a", "tags: [fail]\n")
    call("run", "-o", "other")
    answer = call("compare", "one/latest", "other/latest", "--html", "page.html")
    assert "not drawn: a: neither run has a recording; run both with --record all" in answer.err
    assert "a: neither run has a recording" in Path("page.html").read_text()


@pytest.mark.parametrize(
    "arguments",
    [
        ["missing.parquet", "missing.parquet"],
        ["notes.txt", "notes.txt"],
        ["broken.parquet", "broken.parquet"],
        ["folder", "folder"],
        ["folder", "a.parquet"],
        ["a.parquet", "a.parquet", "--tolerance", "much"],
    ],
)
def test_what_cannot_be_compared_exits_4(call: Call, arguments: list[str]) -> None:
    _recording("a.parquet")
    Path("folder").mkdir()
    for name in ("notes.txt", "broken.parquet"):
        Path(name).write_text("notes")
    answer = call("compare", *arguments)
    assert (answer.code, answer.out) == (4, "")
    assert "Traceback" not in answer.err


WET = "rail: {condition: wet, friction: 0.08}\ncriteria: uictest-stop\n"


def test_two_controllers_are_compared_stop_by_stop(call: Call, scenario: Write) -> None:
    path = scenario("stop", WET)
    for name in ("threshold", "slip-band"):
        call("run", path, "--repeat", "3", "--set", f"controller={name}", "-o", name)
    answer = call("compare", "threshold/latest", "slip-band/latest", "--format", "json")
    (group,) = json.loads(answer.out)["paired"]["groups"]
    assert (group["name"], group["pairs"], group["seeds"]) == ("stop", 3, [0, 1, 2])
    stops = [
        json.loads(Path(name, "latest/results.json").read_text())["cases"][0]["repeats"]["stops"]
        for name in ("threshold", "slip-band")
    ]
    distances = [[stop["measures"]["braking_distance_m"] for stop in side] for side in stops]
    differences = [second - first for first, second in zip(*distances, strict=True)]
    shown = next(each for each in group["differences"] if each["quantity"] == "braking_distance_m")
    assert shown["mean"]["value"] == pytest.approx(sum(differences) / 3)
    assert shown["median"]["value"] == pytest.approx(sorted(differences)[1])
    call("run", path, "--repeat", "3", "--seed", "40", "-o", "later")
    other = call("compare", "threshold/latest", "later/latest")
    assert "not paired: stop: no seed is on both sides: seeds 0..2; seeds 40..42" in other.out.splitlines()


def test_the_variants_of_one_run_are_compared(call: Call, scenario: Write) -> None:
    path = scenario("stop", WET)
    call("run", path, "--repeat", "2", "--set", "controller=threshold,slip-band")
    answer = call("compare", "reports/latest", "--over", "controller", "--html", "page.html")
    assert answer.code == 0
    assert answer.out.startswith("first controller=threshold, second controller=slip-band\npaired: second")
    assert "paired: stop: 2 pairs, seeds 0, 1" in answer.out.splitlines()
    assert answer.err == "uictest: 1 group of stops of 2 variants paired\n"
    assert "controller=slip-band" in Path("page.html").read_text()
    document = json.loads(call("compare", "reports/latest", "--over", "controller", "--format", "json").out)
    assert document["variants"][0]["second"] == "controller=slip-band"


def test_variants_without_pairs_exit_5_and_wrong_usage_exits_4(call: Call, scenario: Write) -> None:
    path = scenario("stop", WET)
    call("run", path, "--set", "controller=threshold,slip-band")
    single = call("compare", "reports/latest", "--over", "controller")
    assert (single.code, "no case or series has several stops" in single.out) == (5, True)
    for arguments in (
        ["reports/latest"],
        ["reports/latest", "reports/latest", "--over", "controller"],
        ["reports/latest", "--over", "controller", "--tolerance", "1"],
        ["reports/latest", "--over", "friction"],
        ["reports/latest", "--over", "controller", "--over", "controller"],
        ["scenarios", "--over", "controller"],
    ):
        answer = call("compare", *arguments)
        assert (answer.code, answer.out) == (4, ""), arguments
        assert "Traceback" not in answer.err


def test_what_is_no_run_is_named_for_what_it_is(call: Call, scenario: Write, made_up: list[str]) -> None:
    scenario("a")
    call("run", "-o", "one")
    Path("study").mkdir()
    Path("study/manifest.json").write_text('{"schema": "uictest/sweep-manifest/1"}')
    takes = "; compare takes the folders of two runs, or two recordings\n"
    for arguments, said in (
        (("study", "study"), "study holds a sweep"),
        (("one/latest", "study"), "study holds a sweep"),
        (("scenarios", "one/latest"), "scenarios holds no run: it has no results.json"),
        (("one/latest", "nowhere"), "there is no nowhere"),
        (("one/latest", "scenarios/a.yaml"), "scenarios/a.yaml is a file"),
    ):
        answer = call("compare", *arguments)
        assert (answer.code, answer.err) == (4, f"uictest: {said}{takes}")


def test_reports_for_people_are_chosen(call: Call, scenario: Write, made_up: list[str]) -> None:
    scenario("a")
    call("run", "--report", "xlsx,md")
    names = {path.name for path in Path("reports/latest/").iterdir()}
    assert {"report.xlsx", "summary.md", "results.json", "summary.csv"} <= names
    assert "index.html" not in names
    assert call("run", "--report", "pdf").code == 4


def test_the_summary_of_a_job_is_appended(
    call: Call, scenario: Write, made_up: list[str], monkeypatch: pytest.MonkeyPatch
) -> None:
    scenario("a")
    monkeypatch.setenv("GITHUB_STEP_SUMMARY", "step.md")
    assert call("run").code == 0
    assert "## uictest: 1 case: 1 pass" in Path("step.md").read_text()
    monkeypatch.setenv("GITHUB_STEP_SUMMARY", "no/such/folder")
    answer = call("run")
    assert answer.code == 0
    assert "GITHUB_STEP_SUMMARY cannot be written" in answer.err
