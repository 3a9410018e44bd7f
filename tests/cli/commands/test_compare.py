import json
from pathlib import Path

import numpy as np
import pytest

from uictest.core.recording import Recording, parquet_bytes

from ..conftest import results_of


@pytest.fixture
def two_runs(call, scenario, made_up):
    """The folders of two runs of the case a, which passes in the first and fails in the other."""
    scenario("a")
    call("run", "-o", "one")
    scenario("a", "tags: [fail]\n")
    call("run", "-o", "other")
    return "one/latest", "other/latest"


@pytest.fixture
def recordings(workplace):
    """Two recordings, whose speeds differ by 0.5 m/s."""
    time = np.linspace(0.0, 10.0, 101)
    paths = Path("a.parquet"), Path("b.parquet")
    for path, speed in zip(paths, (30.0, 30.5), strict=True):
        channels = {"time": time, "speed": speed - time}
        path.write_bytes(parquet_bytes(Recording(channels, {"time": "s", "speed": "m/s"})))
    return paths


def test_a_run_and_itself_agree_and_another_differs(call, two_runs):
    one, other = two_runs
    same = call("compare", one, one)
    assert same.code == 0
    assert "against itself: no difference shown" in same.out
    assert "no difference" in same.err
    differing = call("compare", one, other, "--html", "page.html", code=1)
    verbose = call("compare", one, other, "-v", code=1)
    assert any(line.split()[:3] == ["new", "a", "outcome"] for line in verbose.out.splitlines())
    assert "note: inputs: scenarios/a.yaml" in differing.out
    why = "a: neither run has a recording"
    assert f"not drawn: {why}; run both with --record all" in differing.err
    assert why in Path("page.html").read_text()


def test_the_parameter_that_changed_is_named_and_so_it_is_against_a_baseline(call, scenario, made_up):
    scenario("a", "controller: {extends: threshold, slip_threshold: 4 km/h}\n")
    call("run", "-o", "one", "--baseline", "kept", "--accept")
    changed = ["--set", "controller.slip_threshold=3 km/h"]
    against = call("run", "-o", "other", "--baseline", "kept", *changed)
    line = "parameter controller.slip_threshold: 4 km/h -> 3 km/h (in a)"
    assert line in against.err
    assert line in call("compare", "one/latest", "other/latest").out.splitlines()


def test_recordings_are_compared_by_channels_that_the_page_chooses(call, recordings):
    first, second = recordings
    assert call("compare", first, first).code == 0
    answer = call("compare", first, second, "--html", "page.html", code=1)
    assert "speed" in answer.out
    assert 'class="panels"' in Path("page.html").read_text()
    call("compare", first, second, "--tolerance", "speed=1.9", code=0)
    document = json.loads(call("compare", first, second, "--format", "json").out)
    assert [each["quantity"] for each in document["differences"]] == ["speed"]


WET = "rail: {condition: wet, friction: 0.08}\ncriteria: uictest-stop\n"


def test_two_controllers_are_compared_stop_by_stop(call, scenario):
    path = scenario("stop", WET)
    for name in ("threshold", "slip-band"):
        call("run", path, "--repeat", "3", "--set", f"controller={name}", "-o", name)
    answer = call("compare", "threshold/latest", "slip-band/latest", "--format", "json")
    (group,) = json.loads(answer.out)["paired"]["groups"]
    assert (group["name"], group["pairs"], group["seeds"]) == ("stop", 3, [0, 1, 2])
    stops = [
        results_of(f"{name}/latest")["cases"][0]["repeats"]["stops"] for name in ("threshold", "slip-band")
    ]
    distances = [[stop["measures"]["braking_distance_m"] for stop in side] for side in stops]
    differences = [second - first for first, second in zip(*distances, strict=True)]
    shown = next(each for each in group["differences"] if each["quantity"] == "braking_distance_m")
    assert shown["mean"]["value"] == pytest.approx(sum(differences) / 3)
    assert shown["median"]["value"] == pytest.approx(sorted(differences)[1])
    call("run", path, "--repeat", "3", "--seed", "40", "-o", "later")
    other = call("compare", "threshold/latest", "later/latest")
    assert "not comparable: no seed is on both sides: seeds 0..2; seeds 40..42" in other.out


def test_nothing_that_differs_where_nothing_ran_is_no_agreement(call, scenario, workplace):
    (workplace / "scenarios").mkdir(exist_ok=True)
    (workplace / "scenarios/crash.py").write_text("class Wsp:\n    pass\n", "utf-8")
    call("run", scenario("crash", "extends: slip-120\ncontroller: {python: crash.py, class: Wsp}\n"), code=3)
    answer = call("compare", "reports/latest", "reports/latest", code=5)
    assert "cannot be compared" in answer.out + answer.err


def test_the_variants_of_one_run_are_compared_where_they_have_pairs(call, scenario):
    call("run", scenario("stop", WET), "--set", "controller=threshold,slip-band")
    single = call("compare", "reports/latest", "--over", "controller", code=5)
    assert "no case or series has several stops" in single.err
    assert single.out.startswith("slip-band against threshold: ")
    path = scenario("stop", WET)
    call("run", path, "--repeat", "2", "--set", "controller=threshold,slip-band")
    answer = call("compare", "reports/latest", "--over", "controller", "--html", "page.html", code=0)
    assert answer.out.startswith("slip-band against threshold: ")
    assert "2 pairs of stops per condition" in answer.out
    assert answer.err == "uictest: 1 group of stops of 2 variants paired\n"
    assert "slip-band" in Path("page.html").read_text()
    rows = call("compare", "reports/latest", "--over", "controller", "--format", "csv").out.splitlines()
    assert [row.split(",")[:3] for row in rows] == [
        ["subject", "against", "condition"],
        ["slip-band", "threshold", "stop"],
    ]
    markdown = call("compare", "reports/latest", "--over", "controller", "--format", "markdown").out
    assert markdown.startswith("# threshold and slip-band\n")
    document = json.loads(call("compare", "reports/latest", "--over", "controller", "--format", "json").out)
    assert document["variants"][0]["second"] == "controller=slip-band"
