"""A search, from its scenario to the case that it finds."""

import math
from collections import Counter
from dataclasses import replace

import pytest
import yaml

import uictest
from tests.searching.conftest import OFFSET, SOUND
from uictest import searching
from uictest.core import files
from uictest.judging.evaluation import CaseResult
from uictest.plans.search import load_search
from uictest.searching import Engine, Findings, Trial, Trials
from uictest.searching.shrinking import Shrinking


@pytest.fixture(scope="module")
def found(tmp_path_factory):
    """Return the outcome of the search that finds the offset, on one thread."""
    folder = tmp_path_factory.mktemp("found")
    (folder / "search.yaml").write_text(OFFSET, "utf-8")
    return uictest.search(folder / "search.yaml", jobs=1, output=folder / "reports", trust=[folder])


def test_what_is_found_runs_alone_and_meets_its_expectation(found):
    for number, case in enumerate(found.found, start=1):
        path = found.folder / f"found-{number}.yaml"
        [result] = uictest.run(path, trust=[found.folder.parents[1]])
        assert (result.outcome, result.met) == ("fail", True)
        failing = [stop for stop in result.repeats.stops if fails(stop, "locked-wheels")]
        assert len(failing) == case.failing >= 3
    page = found.page.read_text("utf-8")  # where they are failures, whatever the files expect
    assert '<h1 class="tally-bad">' in page


def fails(stop, criterion):
    return any(verdict.id == criterion and verdict.status == "fail" for verdict in stop.criteria)


def test_what_is_found_is_small_and_its_sentence_says_what_matters(found):
    first = found.found[0]
    assert first.off_nominal <= 2
    assert first.sentence.startswith("speed sensor offset of wheelset")
    assert f"locked-wheels {first.sentence.partition('locked-wheels ')[2]}" in first.sentence
    assert f"in {first.failing} of 4 stops" in first.sentence


def test_the_result_does_not_depend_on_threads(found, write, search):
    outcome = search(write(OFFSET), "two", jobs=2)
    assert (found.folder / "search.csv").read_bytes() == (outcome.folder / "search.csv").read_bytes()
    assert [case.sentence for case in found.found] == [case.sentence for case in outcome.found]


@pytest.mark.parametrize("torn", [0, 7])
def test_a_search_that_was_killed_goes_on_to_the_same_end(found, write, search, torn):
    path = write(OFFSET)

    def kill(stops, margin):
        raise KeyboardInterrupt

    with pytest.raises(KeyboardInterrupt):
        search(path, "killed", progress=kill)
    file = path.parent / "killed" / "search.csv"
    rows = file.read_bytes()
    assert 0 < len(rows) < len((found.folder / "search.csv").read_bytes())
    file.write_bytes(rows[: len(rows) - torn])  # killed while a row was written
    outcome = search(path, "killed", resume=True)
    assert file.read_bytes() == (found.folder / "search.csv").read_bytes()
    assert [case.sentence for case in outcome.found] == [case.sentence for case in found.found]


def test_another_search_is_not_resumed(write, search, tmp_path):
    search(write(SOUND), "sound")
    with pytest.raises(ValueError, match="another search"):
        search(write(SOUND.replace("48", "64")), "sound", resume=True)
    with pytest.raises(ValueError, match="holds no search: it has no"):
        search(write(SOUND), "none", resume=True)
    assert not (tmp_path / "none").exists()


@pytest.mark.parametrize(
    ("line", "says"),
    [
        ("0,nominal,0.1", "search.csv:3: 3 values for 5 columns"),
        ("0,nominal,0.1,pass\r,0.5", "search.csv:3: new-line character"),
        ("one,nominal,0.1,pass,0.5", "search.csv:3: invalid literal"),
        ("0,loud,0.1,pass,0.5", "search.csv:3: "),
        ("0,nominal,0.1,pass,much", "search.csv:3: could not convert"),
    ],
)
def test_a_file_of_stops_that_somebody_edited_is_refused(write, search, line, says):
    path = write(SOUND)
    search(path, "edited")
    file = path.parent / "edited/search.csv"
    file.write_bytes("\n".join([*file.read_text().splitlines()[:2], line, ""]).encode("utf-8-sig"))
    with pytest.raises(ValueError, match=says):
        search(path, "edited", resume=True)


def test_two_searches_do_not_work_in_one_folder(write, search):
    path = write(SOUND)
    search(path, "one")
    with files.FolderLock(path.parent / "one"), pytest.raises(ValueError, match="is in use by process"):
        search(path, "one", resume=True)


def test_a_profile_is_made_small_and_written_from_the_folder_of_the_case(write, search, tmp_path):
    """Its controller is a file beside the scenario, and the command line sets the load."""
    write("schema: uictest/controller/1\nextends: threshold\n", "wsp.yaml")
    text = SOUND.replace(
        "slip-120\n", "slip-120\ncontroller: wsp.yaml\nvehicle: {extends: intercity-180}\n", 1
    )
    profile = "profile: {points: 4, spacing: 150 m, friction: [0.02, 0.30]}"
    text = text.replace("ranges: {rail.friction: [0.08, 0.20]}", profile).replace("48", "128")
    path = write(text.replace("[locked-wheels]", "[distance-over-reference]"))
    space = load_search(path, ["vehicle.payload=9 t", "controller.cycle_time=20 ms"])
    outcome = search(space, "below/deeper/profile")
    case = outcome.found[0]
    assert case.off_nominal <= 4
    written = yaml.safe_load((outcome.folder / "found-1.yaml").read_text("utf-8"))
    assert written["extends"] == "../../../search.yaml"
    assert written["vehicle"] == {"payload": "9 t"}
    assert written["controller"] == {"extends": "../../../wsp.yaml", "cycle_time": "20 ms"}
    [again] = uictest.run(outcome.folder / "found-1.yaml", trust=[tmp_path])
    assert again.met


def test_where_nothing_is_found_the_stops_bound_what_can_fail(write, search):
    outcome = search(write(SOUND))
    assert outcome.found == ()
    share, points = outcome.findings.largest_share["locked-wheels"], outcome.findings.judged["locked-wheels"]
    assert (1.0 - share) ** points == pytest.approx(0.05)
    assert 0.0 < outcome.findings.margins["locked-wheels"] < 2.0
    assert outcome.stops >= 48
    assert f"none of {points} random points did" in outcome.lines[1]


def test_points_that_are_refused_are_skipped_counted_and_said(write, search):
    outcome = search(
        write(SOUND.replace("[0.08, 0.20]}", "[0.08, 0.20], simulation.time_step: [0.25 ms, 0.5 ms]}"))
    )
    assert outcome.findings.refused > 0
    assert f"{outcome.findings.refused} points could not be run" in outcome.lines[-1]


def test_a_space_in_which_nothing_can_be_run_ends(write, search, monkeypatch):
    monkeypatch.setattr(Trials, "simulate", lambda self, stops: [None] * len(stops))
    outcome = search(write(SOUND))
    assert (outcome.stops, outcome.found, outcome.findings.largest_share) == (0, (), {})


def test_a_criterion_that_jumps_is_found_as_well(write, search, monkeypatch):
    """Its margin says nothing of how near a stop comes: the search is random then."""
    real = Trials.run

    def jumping(self, stops):
        trials = real(self, stops)
        signs = [tuple(-1.0 if margin < 0.0 else 1.0 for margin in each.margins[:-1]) for each in trials]
        return [
            trial._replace(margins=(*sign, trial.margins[-1]))
            for trial, sign in zip(trials, signs, strict=True)
        ]

    monkeypatch.setattr(Trials, "run", jumping)
    assert search(write(OFFSET)).found


CRASHES = """
class Wsp:
    def __init__(self, config):
        self.wheelsets = config.wheelsets

    def reset(self):
        pass

    def step(self, inputs):
        from uictest.controllers import Outputs
        if inputs.wheel_speed[0] > 30.0:
            raise RuntimeError("too fast for me")
        return Outputs(hold=[False] * self.wheelsets, vent=[False] * self.wheelsets)
"""


def test_a_controller_that_crashes_is_a_finding_and_does_not_end_the_search(write, search):
    write(CRASHES, "crashes.py")
    scenario = SOUND.replace(
        "extends: slip-120", "extends: slip-120\ncontroller: {python: crashes.py, class: Wsp}"
    )
    scenario = scenario.replace(
        "ranges: {rail.friction: [0.08, 0.20]}", "ranges: {initial_speed: [80 km/h, 140 km/h]}"
    )
    outcome = search(write(scenario), "crash")
    [(number, case)] = [
        (number, case) for number, case in enumerate(outcome.found, start=1) if case.target == "error"
    ]
    assert "too fast for me" in case.sentence
    assert [case.target for case in outcome.found if case.target != "error"]  # it never vents
    written = yaml.safe_load((outcome.folder / f"found-{number}.yaml").read_text("utf-8"))
    assert written["expect"] == "pass"  # a crash is never expected: the scenario is met once it is mended


def test_a_search_in_memory_writes_nothing(write, tmp_path):
    path = write(SOUND)
    outcome = uictest.search(path, stops=16, seed=3)
    assert outcome.folder is None
    assert [each.name for each in tmp_path.iterdir()] == ["search.yaml"]


def test_a_run_of_the_scenario_takes_no_notice_of_its_search(write):
    [result] = uictest.run(write(SOUND))
    assert isinstance(result, CaseResult)
    assert result.outcome == "pass"


def test_numbers_of_a_part_that_the_scenario_only_names_are_written_below_it(write, search):
    text = OFFSET.replace("initial_speed: [100 km/h, 140 km/h]", "vehicle.payload: [9 t, 12 t]")
    outcome = search(write(text.replace("slip-120\n", "slip-120\ncontroller: threshold\n")), "parts")
    space = load_search(outcome.folder.parent / "search.yaml")
    assert space.columns[1] == "vehicle.payload"
    assert outcome.found


def test_random_points_that_were_not_judged_are_said():
    findings = Findings(margins={"c": 0.5}, random=10, judged={"c": 7})
    lines = searching.SearchOutcome("x", ("c",), (), findings, 20, 0).lines
    assert lines[1].endswith("none of 7 random points did; 3 more were not judged")


def test_a_criterion_that_judges_no_stop_is_said(write, search):
    """The one of Appendix B judges dry stops alone."""
    text = SOUND.replace("[locked-wheels]", "[locked-wheels, braking-distance]")
    lines = search(write(text)).lines
    place = lines.index("braking-distance: nothing found; it judged no stop")
    assert lines[place + 1].endswith(" stops")  # and of the space nothing is said


def test_every_random_point_that_fails_is_run_again(write, search, monkeypatch):
    """Else it would count among those that did not fail."""
    asked = set()

    def lucky(self, stops):
        stops = list(stops)
        asked.update(stops)
        lucky_ones = [stop.seed == 0 and float(stop.point[0]) < 0.14 for stop in stops]
        return [Trial.of("pass", [-1.0 if failing else 0.5]) for failing in lucky_ones]

    monkeypatch.setattr(Trials, "run", lucky)
    outcome = search(write(SOUND), guided=False)
    failing = {stop.point for stop in asked if float(stop.point[0]) < 0.14}
    assert len(failing) > 9
    assert {stop.point for stop in asked if stop.seed == 1} >= failing
    assert outcome.findings.margins["locked-wheels"] == 0.5


@pytest.mark.parametrize("repeats", [True, False])
def test_a_crash_under_some_seeds_is_shown_under_one_of_them(write, search, monkeypatch, repeats):
    """Where the same stops do not crash again there is nothing to show."""
    [done] = uictest.run(write(SOUND))
    crashed = replace(done, outcome="error", reason="controller: boom")
    calls = Counter()

    def simulate(self, stops):
        calls.update(stops)
        crash = [(stop.seed or not stop.own_noise) and (repeats or calls[stop] == 1) for stop in stops]
        return [crashed if each else done for each in crash]

    monkeypatch.setattr(Trials, "simulate", simulate)
    if repeats:
        case = search(write(SOUND)).found[0]
        assert (case.failing, yaml.safe_load(case.text)["seed"]) == (2, 1)
    else:
        with pytest.raises(ValueError, match="the same stops do not fail again"):
            search(write(SOUND))


@pytest.mark.parametrize(
    ("failing", "others", "fails", "passes"),
    [
        (8, "pass", True, False),
        (3, "pass", False, False),
        (2, "pass", False, True),
        (0, "refused", False, False),
        (0, "inconclusive", False, False),
    ],
)
def test_a_case_passes_in_as_many_stops_as_it_fails(write, monkeypatch, failing, others, fails, passes):
    """A stop that cannot be run, or is not judged, does neither."""

    def run(self, stops):
        margin = 1.0 if others == "pass" else math.nan
        return [Trial.of(others, [-1.0 if stop.seed < failing else margin]) for stop in stops]

    monkeypatch.setattr(Trials, "run", run)
    space = load_search(write(SOUND.replace("2 of 3", "8 of 10")))
    shrinking = Shrinking(Engine(Trials(space)), "locked-wheels")
    assert (shrinking.fails(("0.1",)), shrinking.passes(("0.1",))) == (fails, passes)


def test_each_new_search_has_a_folder_of_its_own(write, tmp_path):
    space = load_search(write(SOUND))
    folders = [files.new_folder(tmp_path, f"{space.name}-search") for _ in range(2)]
    assert [folder.name for folder in folders] == ["sound-search", "sound-search-2"]
