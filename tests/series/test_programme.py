"""Programmes: what a file may say, the verdict on each test, and where along friction it is met."""

import json
import math
from dataclasses import replace
from xml.etree import ElementTree

import pytest
import yaml

import uictest
from uictest.cli.commands.schema import SchemaKind, schema_text
from uictest.cli.entry import execute
from uictest.judging.evaluation import Verdict
from uictest.judging.series import Limits, judge_programme
from uictest.plans import library
from uictest.plans.scenario import ScenarioErrors
from uictest.plans.series import load_programme
from uictest.report.programme import MetRange, programme_campaign
from uictest.runs import programme as programmes

PROGRAMME = """\
schema: uictest/programme/1
name: own
title: Two tests
mark: ours
set: {vehicle: intercity-180}
tests:
  - {name: dry, scenario: dry-120, set: {criteria: uictest-stop}, distance: {above: 440 m, below: 490 m}}
  - name: wet
    scenario: slip-120
    set: {rail.condition: wet-cleaning, rail.friction: 0.061}
    stops: 2
    distance: {at_most: 150 %, of: dry}
"""
SCAN = "friction: {values: [0.05, 0.06, 0.08], rails: [wet-cleaning]}\n"


@pytest.fixture
def programme(write):
    """Return the programme of a text."""

    def load(text=PROGRAMME, *overrides):
        return load_programme(write("own.programme.yaml", text), overrides)

    return load


@pytest.mark.parametrize(
    ("text", "message"),
    [
        (PROGRAMME.replace("of: dry", "of: dri"), "no other test 'dri'"),
        (PROGRAMME.replace("of: dry", "of: wet"), "no other test 'wet'"),
        (PROGRAMME.replace("name: wet", "name: dry"), "a second test 'dry'"),
        (PROGRAMME.replace("above: 440 m", "above: 500 m"), "500 m is not below 490 m"),
        (
            PROGRAMME.replace("{at_most: 150 %, of: dry}", "{at_most: 150 %}"),
            "`at_most` and `of` belong together",
        ),
        (PROGRAMME.replace("{at_most: 150 %, of: dry}", "{}"), "a limit without a distance"),
        (PROGRAMME.replace("of: dry}", "of: dry, above: 400 m}"), "a share and distances are two limits"),
        (PROGRAMME.replace("0.061}", "0.061, until: 60 km/h}"), "not braked to standstill"),
        (PROGRAMME.replace("0.061}", "0.061, repeat: 3}"), "repeats its stop 3 times"),
        (PROGRAMME + SCAN.replace("[wet-cleaning]", "[wet, wet]"), "'wet' appears twice"),
        (
            PROGRAMME.replace("scenario: slip-120", "scenario: wet-80-command"),
            "a test is one stop of a car alone",
        ),
        (
            PROGRAMME.replace("slip-120", "train-120").replace("set: {vehicle: intercity-180}\n", ""),
            "a test is one stop of a car alone",
        ),
        (PROGRAMME + SCAN.replace("0.06, 0.08", "0.06, 0.06"), "0.06 does not exceed 0.06"),
        (PROGRAMME + SCAN.replace("wet-cleaning", "wet-cleening"), "wet-cleening"),
    ],
)
def test_what_no_programme_can_be_is_refused_with_its_place(programme, text, message):
    with pytest.raises(ScenarioErrors, match=r"own\.programme\.yaml") as caught:
        programme(text)
    assert message in str(caught.value)


@pytest.mark.parametrize(
    ("override", "message"),
    [
        ("controller=threshold,slip-band", "controller has 2 values"),
        ("rail.friction=0.07", "the test 'wet' sets rail.friction itself"),
        ("rail=null", "the test 'wet' sets rail itself"),
    ],
)
def test_a_programme_takes_one_value_for_a_key_that_tells_no_tests_apart(programme, override, message):
    with pytest.raises(ScenarioErrors, match=message):
        programme(PROGRAMME, override)


def test_stops_of_a_test_have_seeds_that_follow_and_decide_nothing_by_themselves(programme):
    dry, *wet = programme().cases
    assert [case.scenario.seed for case in wet] == [0, 1]
    assert [case.id for case in (dry, *wet)] == ["own.dry", "own.wet[stop=1]", "own.wet[stop=2]"]
    assert all(case.scenario.expect.is_allowance for case in (dry, *wet))
    assert {"locked-wheels", "standstill"} <= set(wet[0].scenario.expect.fail)
    assert wet[0].scenario.expect.invalid == ("initial-adhesion", "minimum-slide", "braking-distance")


def judged(planned, distances):
    """Return the verdicts of a programme whose stops have these distances in m; NaN: no standstill."""
    results = {result.id: result for result in uictest.run(planned.cases[:1])}
    [model] = results.values()
    stops = []
    for case, distance in zip(planned.cases, distances, strict=True):
        measures = {**model.measures, "braking_distance_m": distance}
        stops.append(replace(model, id=case.id, measures=measures, criteria=()))
    return {test.planned.test.name: test for test in judge_programme(planned, stops)}


@pytest.mark.parametrize(
    ("distances", "status"),
    [
        ((460.0, 680.0, 685.0), "met"),
        ((460.0, 690.1, 700.0), "missed"),
        ((460.0, 690.0, 680.0), "met"),
        ((460.0, 690.1, 680.0), "some met"),
        ((460.0, 600.0, math.nan), "no standstill"),
        ((math.nan, 600.0, 600.0), "no reference"),
        ((math.nan, math.nan, 600.0), "no standstill"),
    ],
)
def test_each_stop_and_the_mean_are_held_against_the_reference(programme, distances, status):
    tests = judged(programme(), distances)
    assert tests["wet"].status == status
    if not math.isnan(distances[0]):
        assert tests["wet"].limits == Limits(largest=1.5 * distances[0])


def test_a_reference_of_which_a_stop_is_missing_is_none(programme):
    planned = programme(PROGRAMME.replace("{name: dry,", "{name: dry, stops: 2,"))
    model = uictest.run("dry-120")[0]
    results = [replace(model, id=case.id) for case in planned.cases if case.id != "own.dry[stop=2]"]
    assert [test.status for test in judge_programme(planned, results)] == ["not run", "no reference"]


def test_a_stop_that_is_not_shown_to_be_a_test_meets_nothing(programme):
    """A criterion of validity that lacks data, not one that does not apply."""
    planned = programme()
    model = uictest.run("slip-120")[0]
    first, *others = model.criteria
    open_one = (replace(first, status="inconclusive"), *others)
    results = [replace(model, id=case.id, criteria=open_one) for case in planned.cases]
    assert {test.valid_stops for test in judge_programme(planned, results)} == {0}


def test_of_stops_that_are_not_all_tests_it_is_said_how_many_are(programme):
    planned = programme()
    wet = judged(planned, (460.0, 680.0, 685.0))["wet"]
    no_slide = Verdict("slid", "validity", 0.0, "%", 35.0, None, -35.0, "fail", "rolled")
    wet = replace(wet, stops=(wet.stops[0], replace(wet.stops[1], criteria=(no_slide,))))
    [row] = programme_campaign(planned.file, [wet], (), strict=False).tables[0].table.rows
    assert (row["valid"], row["valid_stops"]) == ("1 not judged, 1 no", 1)


def test_a_limit_excludes_its_ends_and_what_is_not_known():
    limits = Limits(440.0, 490.0)
    assert [limits.hold(each) for each in (440.0, 440.1, 489.9, 490.0, math.nan)] == [
        False,
        True,
        True,
        False,
        False,
    ]


@pytest.mark.parametrize(
    ("intervals", "judged", "text"),
    [
        ((), True, "none"),
        (((-math.inf, math.inf),), True, "all"),
        (((-math.inf, 0.06), (0.08, math.inf)), True, "up to 0.06, from 0.08 on"),
        (((0.06, 0.07123), (0.09, 0.09)), False, "0.06 to 0.0712, at 0.09 *"),
    ],
)
def test_intervals_of_friction_say_where_the_search_ended_and_what_no_criterion_judged(
    intervals, judged, text
):
    assert MetRange("wet", "wet", intervals, judged, 9).text == text


def rows_of(output, name):
    """The rows of a table of the newest run below a folder, by the keys that programs read."""
    document = json.loads((output / "latest" / "results.json").read_text("utf-8"))
    [table] = [table for table in document["campaign"]["tables"] if table["name"] == name]
    keys = [key for key, *_ in table["columns"]]
    return [dict(zip(keys, row, strict=True)) for row in table["rows"]]


def test_the_exit_code_is_neutral_unless_asked_and_each_test_is_a_testcase(write, tmp_path, capsys):
    text = PROGRAMME.replace("below: 490 m", "below: 450 m") + SCAN
    path = str(write("own.programme.yaml", text))
    assert execute(["run", path, "-o", str(tmp_path / "neutral")]) == 0
    shown = capsys.readouterr().out
    assert "SHOWN: 1 of 2 tests with a limit met, 1 missed" in shown
    assert execute(["run", path, "--strict", "--format", "github", "-o", str(tmp_path / "strict")]) == 1
    shown = capsys.readouterr().out
    assert "FAILED: 1 of 2 tests with a limit met, 1 missed" in shown
    assert "::error file=own.programme.yaml,title=fail dry::missed: 472.2 m" in shown
    outcomes = {}
    for folder in ("neutral", "strict"):
        suite = ElementTree.parse(tmp_path / folder / "latest" / "junit.xml").getroot()
        cases = {case.get("name"): case for case in suite.iter("testcase")}
        outcomes[folder] = {name: [child.tag for child in case] for name, case in cases.items()}
        message = next(iter(cases["dry"])).get("message")
        assert message.startswith("missed: 472.2 m (limit 440 m to 450 m)")
    assert outcomes["neutral"] == {"dry": ["skipped"], "wet": ["system-out"]}
    assert outcomes["strict"] == {"dry": ["failure"], "wet": ["system-out"]}
    dry, wet = rows_of(tmp_path / "neutral", "tests")
    assert (dry["verdict"], dry["above_m"], dry["below_m"], dry["within_limit"]) == (
        "missed",
        440.0,
        450.0,
        0,
    )
    assert (wet["verdict"], wet["stops"], wet["valid_stops"], wet["within_limit"]) == ("met", 2, 2, 2)
    assert wet["largest_m"] == pytest.approx(1.5 * 472.2, rel=1e-3)


def test_the_interval_of_friction_ends_where_the_verdict_turns(write, tmp_path):
    """Its ends are checked by stops of their own, just inside and just outside."""
    path = write("own.programme.yaml", PROGRAMME + SCAN)
    assert execute(["run", str(path), "-q", "-o", str(tmp_path / "runs")]) == 0
    [row] = rows_of(tmp_path / "runs", "intervals")
    rail, low, high = row["rail"], row["low"], row["high"]
    assert (row["test"], rail, row["validity_judged"]) == ("wet", "wet-cleaning", True)
    [shown] = rows_of(tmp_path / "runs", "friction")
    assert shown == {"rail": rail, "wet": f"{low:.3g} to {high:.3g}"}
    assert "sought from 0.05 to 0.08, in" in (tmp_path / "runs" / "latest" / "index.html").read_text("utf-8")
    limit = 1.5 * uictest.run("dry-120")[0].measures["braking_distance_m"]

    def met(friction):
        [case] = uictest.run(
            "slip-120", set={"rail.condition": rail, "rail.friction": f"{friction:.5f}"}, repeat=2
        )
        every = [stop.measures["braking_distance_m"] for stop in case.repeats.stops]
        return case.test_validity == "valid" and max(every) < limit

    assert [met(each) for each in (low - 0.003, low + 0.0001, high - 0.0001, high + 0.003)] == [
        *(False, True, True, False)
    ]


CRASHING = """
from uictest.controllers import Outputs


class Wsp:
    def __init__(self, config):
        pass

    def reset(self):
        self.cycles = 0

    def step(self, inputs):
        self.cycles += 1
        if self.cycles < 800 and min(inputs.wheel_speed) < 1.0:
            raise RuntimeError("a wheelset locks")
        return Outputs(hold=[False] * 4, vent=[False] * 4)
"""


def test_a_stop_along_friction_that_cannot_be_run_fails_and_says_nothing_of_friction(write, tmp_path, capsys):
    write("wsp.py", CRASHING)
    part = write("wsp.yaml", "schema: uictest/controller/1\nname: w\npython: wsp.py\nclass: Wsp\n")
    text = PROGRAMME.replace("0.061}", "0.3}") + SCAN
    path, runs = str(write("own.programme.yaml", text)), tmp_path / "runs"
    assert execute(["run", path, "--set", f"controller={part}", "-o", str(runs)]) == 1
    assert "6 stops along friction could not be run" in capsys.readouterr().out
    [row] = rows_of(runs, "friction")
    assert row["wet"] == "6 of 6 stops could not be run"
    assert rows_of(runs, "intervals") == []


def test_the_shipped_programme_is_what_was_read(write):
    """The table as printed: position, speed, limits; a second-hand source, which its mark says."""
    shipped = load_programme(library.scenarios()["slip-programme"])
    rows = {test.test.name: test for test in shipped.tests}
    limits = {
        name: (each.above, each.below)
        for name, each in ((n, t.test.distance) for n, t in rows.items())
        if each
    }
    assert limits == {
        "r-120-dry": (440.0, 490.0),
        "p-120-dry": (580.0, 620.0),
        "rr-160-dry": (720.0, 770.0),
        "r-120-wet": (None, 700.0),
        "p-120-wet": (None, 730.0),
        "r-160-wet": (None, None),
        "rr-160-wet": (None, None),
    }
    assert len(rows) == 10
    assert [len(rows[name].stops) for name in ("r-120-wet", "p-120-wet")] == [4, 4]
    assert "second-hand" in shipped.file.mark
    loads = {case.scenario.vehicle.total_mass / 4000.0 for case in shipped.cases}
    assert all(10.0 <= load <= 12.0 for load in loads)
    without = {name for name, test in rows.items() if test.stops[0].scenario.brake.supply == "off"}
    assert without == {"r-120-dry", "p-120-dry", "r-120-wet", "p-120-wet"}
    text = shipped.path.name + shipped.file.title + shipped.file.description
    assert "requires" not in text


def test_a_wsp_that_locks_wheels_meets_no_test_unnoticed(write, tmp_path, capsys):
    """The distances of locked wheels on a rail that they clean are short."""
    free = "  - {name: free, scenario: slip-120, set: {rail.condition: wet-cleaning, rail.friction: 0.061}}\n"
    path = str(write("own.programme.yaml", PROGRAMME + free))
    bypassed = ["run", path, "--set", "rig.wsp=bypassed", "-o", str(tmp_path / "runs")]
    assert execute(bypassed) == 0
    assert "our own criteria missed: locked-wheels" in capsys.readouterr().out
    assert execute([*bypassed, "--strict"]) == 1
    suite = ElementTree.parse(tmp_path / "runs" / "latest" / "junit.xml").getroot()
    failures = {case.get("name"): case.find("failure") for case in suite.iter("testcase")}
    assert failures.pop("dry") is None
    assert ["locked-wheels" in failures[name].get("message") for name in ("wet", "free")] == [True, True]


def interrupting(calls, module, monkeypatch, function):
    """Interrupt a call of a function after so many calls."""
    real, left = getattr(module, function), [calls]

    def called(*arguments, **options):
        left[0] -= 1
        if left[0] < 0:
            raise KeyboardInterrupt
        return real(*arguments, **options)

    monkeypatch.setattr(module, function, called)


@pytest.mark.parametrize("calls", [0, 3])
def test_an_interrupt_while_friction_is_sought_leaves_the_tests_that_were_run(
    write, tmp_path, capsys, monkeypatch, calls
):
    """In the scan, and while a verdict is being located."""
    path = str(write("own.programme.yaml", PROGRAMME + SCAN))
    module, function = (programmes, "simulate_cases") if calls == 0 else (programmes.campaign, "run_cases")
    interrupting(calls, module, monkeypatch, function)
    assert execute(["run", path, "-o", str(tmp_path / "runs")]) == 2
    document = json.loads((tmp_path / "runs" / "latest" / "results.json").read_text("utf-8"))
    assert not document["complete"]
    assert [table["name"] for table in document["campaign"]["tables"]] == ["tests"]
    assert "2 of 2 tests with a limit met" in capsys.readouterr().out


@pytest.mark.parametrize("option", ["--lf", "--suggest-expect", "--real-time"])
def test_options_that_say_nothing_of_a_programme_are_refused(write, capsys, option):
    path = str(write("own.programme.yaml", PROGRAMME))
    assert execute(["run", path, option]) == 4
    assert "a programme is run and judged as a whole" in capsys.readouterr().err


def test_a_stop_that_ends_undecided_is_judged_by_the_programme(write, tmp_path, capsys):
    short = PROGRAMME.replace("0.061}", "0.061, simulation.maximum_duration: 30 s}")
    path = str(write("own.programme.yaml", short))
    assert execute(["run", path, "-o", str(tmp_path / "runs")]) == 0
    assert "1 of 2 tests with a limit met, 1 no standstill" in capsys.readouterr().out
    assert execute(["run", path, "--strict", "-o", str(tmp_path / "runs")]) == 1


def test_a_difference_from_the_baseline_is_a_failed_testcase_of_the_run(write, tmp_path, capsys):
    """Also of a stop that ends undecided, of which the programme decides."""
    short = PROGRAMME.replace("0.061}", "0.061, simulation.maximum_duration: 30 s}")
    path, kept = str(write("own.programme.yaml", short)), str(tmp_path / "kept")
    assert execute(["run", path, "--baseline", kept, "--accept", "-q", "-o", str(tmp_path / "runs")]) == 0
    changed = ["run", path, "--baseline", kept, "--set", "vehicle.body.mass=36 t", "-q"]
    capsys.readouterr()
    assert execute([*changed, "-o", str(tmp_path / "runs")]) == 1
    assert "own.wet[stop=1] differs from the baseline" in capsys.readouterr().out
    suite = ElementTree.parse(tmp_path / "runs" / "latest" / "junit.xml").getroot()
    failed = {
        case.get("name"): case.find("failure").get("type")
        for case in suite.iter("testcase")
        if case.find("failure") is not None
    }
    assert failed["own.wet[stop=1]"] == "baseline"


def test_in_python_the_tests_stand_beside_the_cases(write):
    path = write("own.programme.yaml", PROGRAMME)
    results = uictest.run(path)
    assert [(test.name, test.status) for test in results.tests] == [("dry", "passed"), ("wet", "passed")]
    assert results.met
    with pytest.raises(ValueError, match="is a programme"):
        uictest.load(path)
    with pytest.raises(ValueError, match="a programme is run alone"):
        uictest.run([path, "dry-120"])
    assert execute(["list", str(path)]) == 0


def test_the_schema_for_editors_accepts_what_ships_and_refuses_an_unknown_key():
    from jsonschema import Draft7Validator

    validator = Draft7Validator(json.loads(schema_text(SchemaKind.PROGRAMME)))
    content = yaml.safe_load(library.scenarios()["slip-programme"].read_text("utf-8"))
    assert [error.message for error in validator.iter_errors(content)] == []
    assert not validator.is_valid({**content, "test": []})
