"""What a series file may say, and what is refused."""

import re
from dataclasses import replace
from pathlib import Path

import pytest
from hypothesis import given, strategies as st

from uictest.plans import scenario, series
from uictest.plans.scenario import LONGEST, ScenarioErrors
from uictest.plans.scenario.yaml import Entry, Scalar, whole_file
from uictest.plans.series import loading, stops
from uictest.plans.series.model import PlannedStop

PAIR = "dry: dry.yaml\nwet: wet.yaml\n"
WET = "dry: dry.yaml\nwet: {scenario: wet.yaml, %s}\n"

SCENARIOS = Path(__file__).parents[2] / "scenarios"
DRY = SCENARIOS / "dry-120.yaml"
SHIPPED = sorted(SCENARIOS.glob("*.series.yaml"))


def ids(planned):
    return [(stop.role, stop.case.id.removeprefix(f"{planned.id}.")) for stop in planned.stops]


def test_the_least_that_a_series_says_and_the_criteria_it_is_judged_by(load):
    (planned,) = load()
    assert planned.id == "campaign"
    assert ids(planned) == [("dry", "dry"), ("wet", "wet")]
    assert [profile.name for profile in planned.criteria] == ["uictest-wsp"]
    assert (planned.file.valid_stops, planned.file.confidence) == (0.8, 0.95)
    assert [each.name for each in planned.stops[1].case.scenario.criteria] == ["uictest-stop", "uictest-wsp"]
    # What a scenario expects of itself has no part in a series.
    wet = Path("wet.yaml")
    wet.write_text(f"{wet.read_text('utf-8')}expect: invalid\n", "utf-8")
    (planned,) = load()
    assert [str(stop.case.scenario.expect) for stop in planned.stops] == ["pass", "pass"]


def test_values_of_an_entry_make_stops_whose_ids_name_them(load):
    (planned,) = load(WET % "set: {rail.friction: [0.07, 0.09], brake.command: 100 %}")
    assert ids(planned)[1:] == [
        ("wet", "wet[friction=0.07,command=100]"),
        ("wet", "wet[friction=0.09,command=100]"),
    ]
    assert [float(stop.case.scenario.rail.friction or 0) for stop in planned.stops[1:]] == [0.07, 0.09]


def test_what_is_set_for_all_gives_way_to_an_entry_and_that_to_the_command_line(load):
    text = "repeat: 5\nset: {seed: 7}\ndry: {scenario: dry.yaml, repeat: 1, set: {seed: 8}}\nwet: wet.yaml\n"
    for options, seed, stops_of in (((), None, [(1, 8), (5, 7)]), (("repeat=2",), 9, [(2, 9), (2, 9)])):
        (planned,) = load(text, *options, seed=seed)
        scenarios = [stop.case.scenario for stop in planned.stops]
        assert [(each.repeat, each.seed) for each in scenarios] == stops_of


def test_one_value_of_the_command_line_is_for_all_stops_also_in_place_of_an_axis(load):
    (planned,) = load(PAIR, "controller=slip-band")
    assert planned.id == "campaign"
    assert {stop.case.scenario.controller.name for stop in planned.stops} == {"slip-band"}
    (planned,) = load(f"{PAIR}matrix: {{controller: [threshold, slip-band]}}\n", "controller=slip-band")
    assert planned.id == "campaign"
    assert planned.stops[1].case.scenario.controller.name == "slip-band"


def test_several_values_make_a_series_each_as_those_under_matrix_do(load):
    for planned in (
        load(PAIR, "controller=threshold,slip-band"),
        load(f"{PAIR}matrix: {{controller: [threshold, slip-band]}}\n"),
    ):
        names = ["threshold", "slip-band"]
        assert [each.id for each in planned] == [f"campaign[controller={name}]" for name in names]
        assert [each.parameters for each in planned] == [{"controller": name} for name in names]
        assert [each.stops[1].case.scenario.controller.name for each in planned] == names


def test_two_speeds_have_a_dry_stop_each_and_stops_that_differ_are_run(load):
    speeds = "set: {initial_speed: [80 km/h, 120 km/h]}"
    (planned,) = load(f"dry: {{scenario: dry.yaml, {speeds}}}\nwet: {{scenario: wet.yaml, {speeds}}}\n")
    assert [round(stop.speed * 3.6) for stop in planned.stops] == [80, 120, 80, 120]
    (planned,) = load(WET % "repeat: 3, set: {seed: [0, 3], rail.friction: [0.08, 0.09]}")
    assert len(planned.stops) == 5


@pytest.mark.parametrize(
    ("text", "line", "message"),
    [
        ("dry: dry.yaml\n", 1, "missing key 'wet'"),
        ("dry: []\nwet: wet.yaml\n", 3, "an empty list"),
        ("dry: dri.yaml\nwet: wet.yaml\n", 3, "no such file: 'dri.yaml'"),
        ("dry: dry.yaml\nwet: [wet.yaml, wet.yaml]\n", 4, "a second stop 'campaign.wet'"),
        (WET % "set: {rail.fricton: 0.1}", 4, "unknown key 'fricton'"),
        (WET % "set: {initial_speed: 80 km/h}", 3, "no wet stop from 120 km/h"),
        (WET % "set: {brake.command: 80 %}", 4, "differ in 'brake.command'"),
        (WET % "set: {vehicle: crh380a}", 4, "differ in 'vehicle'"),
        (f"{PAIR}criteria: uictest-wps\n", 5, "no criteria 'uictest-wps' in the library"),
        (f"{PAIR}criteria: [uictest-wsp, uictest-wsp]\n", 5, "is in profile 'uictest-wsp' as well"),
        (f"{PAIR}valid_stops: 120 %\n", 5, "out of range"),
        (f"{PAIR}repeat: 0\n", 5, "at least 1"),
        (f"{PAIR}matrix: {{name: [a, b]}}\n", 5, "'name' belongs to the file"),
        (WET % "recordings: [a.csv]", 4, "no such file: 'a.csv'"),
        (WET % "recordings: [wet.yaml], set: {seed: [1, 2]}", 4, "one stop, the scenario has 2 cases"),
        (WET % "set: {rail.friction: []}", 4, "an empty list makes no stop"),
        ("dry: wet.yaml\nwet: dry.yaml\n", 3, "the rail of 'campaign.wet' is 'wet'"),
    ],
)
def test_what_makes_no_series_is_refused_at_its_place(load, text, line, message):
    with pytest.raises(ScenarioErrors) as caught:
        load(text)
    shown = [each for each in caught.value.diagnostics if message in each.message]
    assert shown, caught.value.diagnostics
    assert shown[0].line == line


@pytest.mark.parametrize(
    ("text", "message", "hint"),
    [
        ("name: x\n", "missing key 'schema'", "uictest/series/1"),
        ("schema: uictest/scenario/1\nname: x\n", "expected uictest/series/1", "not end in .series.yaml"),
    ],
)
def test_a_file_of_another_kind_is_refused(write, text, message, hint):
    with pytest.raises(ScenarioErrors) as caught:
        series.load_series(write("x.series.yaml", text))
    (diagnostic,) = caught.value.diagnostics
    assert message in diagnostic.message
    assert hint in diagnostic.hint


CRITERIA = "schema: uictest/criteria/1\nname: own\ncriteria: [{%s}]\n"
K_WET = "id: k-wet, layer: requirement, scope: series, measure: k_wet, lower: 1"
STANDSTILL = "id: standstill, layer: requirement, measure: standstill, lower: 1"
LENGTH = "id: length, layer: requirement, measure: braking_distance, upper: %s m"


def test_the_id_of_a_stop_names_the_series_and_has_room_for_so_many_characters(write):
    """That of a stop with the WSP bypassed, which is longer by a word, is cut."""
    write("own.yaml", CRITERIA % K_WET)
    wet = f"wet-{'w' * 90}"
    write("wet.yaml", Path("wet.yaml").read_text("utf-8").replace("name: wet", f"name: {wet}"))

    def ids_of(name):
        head = f"schema: uictest/series/1\nname: {name}\ncriteria: own.yaml\n"
        stops = "dry: dry.yaml\nwet: {scenario: wet.yaml, set: {rail.friction: [0.08, 0.09]}}\n"
        (planned,) = series.load_series(write("x.series.yaml", head + stops))
        return [stop.case.id for stop in planned.stops]

    own = f"{wet}[friction=0.08]"
    name = "s" * (LONGEST - len(own) - 1)
    shown = ids_of(name)
    assert shown[1] == f"{name}.{own}"
    assert shown[3] == f"{name}.bypassed.{own}"[:LONGEST]
    with pytest.raises(ScenarioErrors, match=f"is longer than {LONGEST} characters"):
        ids_of(f"{name}s")


def test_a_criterion_in_both_profiles_is_refused_and_another_profile_of_the_same_name(load, write):
    write("own.yaml", CRITERIA % STANDSTILL)
    with pytest.raises(ScenarioErrors, match="'standstill' is in the profiles of the series and of the scen"):
        load(f"{PAIR}criteria: own.yaml\n")
    write("own.yaml", CRITERIA % (LENGTH % 5))
    write("other/own.yaml", CRITERIA % (LENGTH % 500))
    text = f"{WET}criteria: own.yaml\n" % "set: {criteria: %s}"
    with pytest.raises(ScenarioErrors, match="different profiles named 'own'"):
        load(text % "other/own.yaml")
    (planned,) = load(text % "own.yaml")
    assert [profile.name for profile in planned.stops[1].case.scenario.criteria] == ["own"]


def test_the_schema_accepts_what_is_accepted(write):
    jsonschema = pytest.importorskip("jsonschema")
    schema = series.series_schema()
    jsonschema.Draft7Validator.check_schema(schema)
    head = {"schema": "uictest/series/1", "name": "campaign"}
    for document in (
        {"dry": "dry.yaml", "wet": ["wet.yaml", {"scenario": "wet.yaml", "set": {"seed": [1, 2]}}]},
        {
            "dry": {"scenario": "dry.yaml"},
            "wet": ["wet.yaml"],
            "criteria": ["uictest-wsp"],
            "valid_stops": "90 %",
        },
    ):
        jsonschema.validate(head | document, schema)
    for document in ({"dry": "dry.yaml"}, {"dry": "dry.yaml", "wet": [1]}, {"dry": [], "wet": ["w.yaml"]}):
        with pytest.raises(jsonschema.ValidationError):
            jsonschema.validate(head | document, schema)


@pytest.mark.parametrize(
    "wet",
    [
        "{scenario: wet.yaml, repeat: 3, set: {seed: [0, 1]}}",
        "[wet.yaml, {scenario: wet.yaml, set: {seed: 0}}]",
        "[{scenario: wet.yaml, repeat: 3}, {scenario: again.yaml, set: {seed: 2}}]",
    ],
)
def test_a_stop_that_is_run_twice_is_refused(load, write, wet):
    write("again.yaml", Path("wet.yaml").read_text("utf-8").replace("name: wet", "name: again"))
    with pytest.raises(ScenarioErrors, match="again with seed"):
        load(f"dry: dry.yaml\nwet: {wet}\n")


@given(st.lists(st.tuples(st.integers(0, 12), st.integers(1, 4), st.booleans()), min_size=1, max_size=8))
def test_a_stop_is_refused_where_it_meets_an_earlier_one_in_a_seed_under_the_same_conditions(listed):
    (case,) = scenario.load([DRY])
    entry = Entry(whole_file(DRY), Scalar(None, "", whole_file(DRY)))
    read = []
    for number, (seed, repeat, slower) in enumerate(listed):
        brake = case.scenario.brake.model_copy(update={"position": "G" if slower else "R"})
        own = case.scenario.model_copy(update={"seed": seed, "repeat": repeat, "brake": brake})
        changed = replace(case, id=f"s{number}", scenario=own)
        read.append((PlannedStop("dry", changed), entry))
    seeds = [set(range(seed, seed + repeat)) for seed, repeat, _ in listed]
    assert [each.message.split("'")[1] for each in stops._drawn_twice(read)] == [
        f"s{number}"
        for number, (_, _, slower) in enumerate(listed)
        if any(seeds[number] & seeds[k] and listed[k][2] is slower for k in range(number))
    ]


GRADIENTS = ("rail.gradient=range(0 permille,3 permille,1 permille)",)


@pytest.mark.parametrize(
    ("text", "overrides", "counted"),
    [
        ("set: {seed: %s, brake.command: %s}}\n", (), "119601 stops (1 series of 119601)"),
        ("set: {seed: %s}}\nmatrix: {brake.command: %s}\n", (), "119899 stops (299 series of 401)"),
        ("set: {seed: %s, brake.command: %s}}\n", GRADIENTS, "478404 stops (4 series of 119601)"),
    ],
)
def test_stops_are_counted_before_any_is_read(load, monkeypatch, text, overrides, counted):
    commands = [f"{command / 10} %" for command in range(500, 799)]
    monkeypatch.setattr(loading, "read_stops", None)
    with pytest.raises(ScenarioErrors, match=re.escape(counted)):
        load(f"dry: dry.yaml\nwet: {{scenario: wet.yaml, {text % (list(range(400)), commands)}", *overrides)


@pytest.mark.parametrize("role", ["dry", "wet"])
def test_a_recording_is_one_stop(load, write, role):
    write("a.csv", "")
    write("b.csv", "")
    dry = "a.csv, a.csv" if role == "dry" else "a.csv"
    wet = "a.csv, b.csv" if role == "wet" else "b.csv"
    entry = "{role}: {{scenario: {role}.yaml, recordings: [{files}]}}\n"
    with pytest.raises(ScenarioErrors, match=r"'a\.csv' is named twice"):
        load(entry.format(role="dry", files=dry) + entry.format(role="wet", files=wet))


@pytest.mark.parametrize("path", SHIPPED, ids=lambda path: path.name)
def test_shipped_series_are_called_like_their_files(path):
    (planned,) = series.load_series(path)
    assert f"{planned.id}.series.yaml" == path.name
