"""`uictest search` on the command line."""

import json
import shlex

import pytest

SEARCH = """
extends: slip-120
search:
  criteria: [locked-wheels]
  ranges: {rail.friction: [0.08, 0.20]}
  fails_in: 2 of 3
  stops: 16
"""
BYPASSED = SEARCH + "rig: {wsp: bypassed}\n"


def test_nothing_found_exits_0_and_says_what_that_excludes(call, scenario):
    answer = call("search", scenario("sound", SEARCH), "-n", "1", code=0)
    first, second, last = answer.out.splitlines()
    assert first.startswith("locked-wheels: nothing found; smallest margin ")
    assert second.startswith("    at most ")
    assert "of the searched space fails (95 %): none of 8 random points did" in second
    assert int(last.partition(" ")[0]) in range(16, 20)
    assert "reports/sound-search" in answer.err


def test_found_exits_1_and_leaves_a_scenario_that_runs_alone(call, scenario, workplace):
    answer = call("search", scenario("bypassed", BYPASSED), "-n", "1", code=1)
    assert answer.out.startswith("found: ")
    folder = workplace / "reports/bypassed-search"
    assert {"search.csv", "search.json", "found-1.yaml"} <= {path.name for path in folder.iterdir()}
    call("run", folder / "found-1.yaml", code=0)
    call("check", folder / "found-1.yaml", code=0)
    document = json.loads((folder / "search.json").read_text("utf-8"))
    assert document["found"][0]["target"] == "locked-wheels"


def test_json_has_what_search_json_has(call, scenario, workplace):
    answer = call(
        "search", scenario("sound", SEARCH), "--format", "json", "--seed", "4", "--stops", "20", code=0
    )
    document = json.loads((workplace / "reports/sound-search/search.json").read_text("utf-8"))
    document.pop("search")
    assert json.loads(answer.out) == document
    assert document["findings"]["judged"] == {"locked-wheels": 10}
    assert document["findings"]["largest_share"] == {"locked-wheels": pytest.approx(1.0 - 0.05**0.1)}
    assert "Infinity" not in answer.out


def test_a_search_of_the_same_name_gets_a_folder_of_its_own_and_resume_goes_on(call, scenario, workplace):
    path = scenario("sound", SEARCH)
    for _ in range(2):
        call("search", path, code=0)
    assert (workplace / "reports/sound-search-2/search.csv").is_file()
    rows = (workplace / "reports/sound-search/search.csv").read_text("utf-8")
    call("search", path, "--resume", workplace / "reports/sound-search", code=0)
    assert (workplace / "reports/sound-search/search.csv").read_text("utf-8") == rows
    call(
        "search",
        path,
        "--seed",
        "9",
        "--resume",
        workplace / "reports/sound-search",
        code=4,
        says="another search",
    )


@pytest.mark.parametrize(
    ("before", "after", "says"),
    [
        ("[locked-wheels]", "[locked-wheel]", "did you mean 'locked-wheels'?"),
        ("[locked-wheels]", "[standstill]", "a stop that does not end is inconclusive, not a failure"),
        ("rail.friction:", "rail.fricton:", "did you mean 'friction'?"),
        ("rail.friction: [0.08, 0.20]", "name: [1, 2]", "belongs to the file"),
        ("rail.friction: [0.08, 0.20]", "controller: [1, 2]", "controller"),
        ("[0.08, 0.20]", "[0.20, 0.08]", "the bounds must rise from 0.20 to 0.08"),
        ("[0.08, 0.20]", "[8 bar, 9 bar]", "bar"),
        ("rail.friction: [0.08, 0.20]", "initial_speed: [60 km/h, 30 m/s]", "different units"),
        ("2 of 3", "4 of 3", "4 of 3 is impossible"),
        ("2 of 3", "often", "write `8 of 10`"),
        ("ranges: {rail.friction: [0.08, 0.20]}", "seed: 1", "there is nothing to search"),
        ("rail.friction: [0.08, 0.20]", "seed: [1, 5]", "search.ranges.seed: the search sets it"),
        ("0.20]", f"0.08{17 * '0'}1]", "the bounds must rise"),
        ("ranges:", "faults: {kinds: [sander-blocked]}\n  ranges:", "has no sander"),
        ("ranges:", "faults: {kinds: [sandr]}\n  ranges:", "no fault is called 'sandr'"),
        (
            "ranges:",
            "profile: {points: 4, spacing: 100 m, friction: [0.1, 0.2]}\n  ranges:",
            "stands in place of",
        ),
        ("  stops", "vary: {matrix: {rail.friction: [0.1]}}\n  stops", "'search'"),
    ],
)
def test_what_is_wrong_in_the_section_is_said_by_check_and_by_search(call, scenario, before, after, says):
    text = SEARCH.replace(before, after, 1)
    if after.startswith("vary"):
        text = SEARCH + "vary: {matrix: {rail.friction: [0.1]}}\n"
    path = scenario("wrong", text, "wrong.sweep.yaml" if "vary:" in text else None)
    commands = ("sweep",) if "vary:" in text else ("check", "search")
    for command in commands:
        answer = call(command, path, code=4)
        assert says in answer.err, answer.err


def test_a_criterion_that_judges_no_stop_is_no_green_answer(call, scenario):
    answer = call("search", scenario("dry-only", SEARCH.replace("locked-wheels", "braking-distance")), code=5)
    assert "braking-distance: nothing found; it judged no stop" in answer.out
    progress = [line for line in answer.err.splitlines() if "stops" in line]
    assert len(progress) == len(set(progress))


def test_the_command_that_runs_a_found_case_trusts_the_folder_of_its_scenario(
    call, scenario, workplace, monkeypatch
):
    path = scenario("bypassed", BYPASSED).resolve()
    (workplace / "elsewhere").mkdir()
    monkeypatch.chdir(workplace / "elsewhere")
    answer = call("search", path, "-n", "1", code=1)
    [command] = [line for line in answer.err.splitlines() if "found-1.yaml" in line]
    call(*shlex.split(command.partition("uictest: uictest ")[2]), code=0)


def test_a_scenario_without_the_section_cannot_be_searched(call, scenario):
    call("search", scenario(), code=4, says="the scenario has no 'search'")


def test_a_search_has_one_case(call, scenario):
    path = scenario("two", SEARCH + "matrix: {brake.command: [80 %, 90 %]}\n")
    call("search", path, code=4, says="the scenario has 2 cases")
    call("search", path, "--set", "brake.command=90 %", code=0)


def test_an_interrupt_keeps_the_finished_stops(call, scenario, workplace, monkeypatch):
    from uictest.searching import Trials

    real, calls = Trials.run, []

    def interrupted(self, stops):
        calls.append(1)
        if len(calls) > 1:
            raise KeyboardInterrupt
        return real(self, stops)

    monkeypatch.setattr(Trials, "run", interrupted)
    answer = call("search", scenario("sound", SEARCH), code=2)
    assert "--resume reports/sound-search continues" in answer.err
    monkeypatch.setattr(Trials, "run", real)
    call("search", "scenarios/sound.yaml", "--resume", "reports/sound-search", code=0)
