"""The space of a search: from vectors to values as users write them, and back to the scenario."""

from dataclasses import replace

import pytest
from hypothesis import given, strategies as st

from uictest.plans import scenario
from uictest.plans.faults import FAULT_KINDS
from uictest.plans.scenario import ScenarioErrors, fault_name, kinds_named
from uictest.plans.scenario.yaml import parse_decimal_quantity
from uictest.plans.search import NOMINAL, Axis, FaultAxes, load_search

SPACE = """
schema: uictest/scenario/1
name: space
extends: slip-120
seed: 7
faults: [{part: brake, kind: cut-out, wheelset: 4, at: 20 s}]
search:
  criteria: [locked-wheels]
  ranges: {initial_speed: [60 km/h, 160 km/h], rig.caliper.piston_area: [0.018 m2, 0.0183 m2]}
  profile: {points: 3, spacing: 100 m, friction: [0.05, 0.25]}
  faults: {kinds: [speed-sensor], from: [90 km/h, 120 km/h], count: 2}
"""
BEGIN = Axis("from", 0.0, 30.0, "s")
ROWS = tuple(FAULT_KINDS.values())


@pytest.fixture
def space(write):
    return load_search(write(SPACE))


def test_a_point_is_a_scenario_with_its_values(space):
    point = space.point([0.5] * len(space.columns))
    case = space.case(point, seed=3)
    assert case.scenario.initial_speed.text == "110 km/h"
    assert (case.scenario.seed, case.scenario.repeat) == (10, 1)
    assert float(case.scenario.rail.friction) == 0.15  # the same at all points: one number
    assert [fault.part for fault in case.scenario.faults] == ["brake", "speed-sensor", "speed-sensor"]
    assert case.scenario.faults[1].at.text == "105 km/h"


def test_the_nominal_point_is_the_scenario_itself(space):
    assert space.contents(space.nominal) == {}
    assert space.case(space.nominal).scenario == space.loaded.case.scenario


def test_a_profile_off_nominal_at_one_point_keeps_the_friction_of_the_scenario_elsewhere(space):
    point = list(space.nominal)
    point[space.profile[1]] = "0.2"
    points = space.contents(tuple(point))["rail.friction"]["points"]
    assert [each["friction"] for each in points] == [0.09, 0.2, 0.09]
    assert [each["position"] for each in points] == ["0 m", "100 m", "200 m"]


def test_numbers_are_named_by_the_last_of_their_key_where_that_is_enough(space):
    keys = ["faults.0.at", "body.mass", "bogie.mass", "vehicle.full_load"]
    search = space.search.model_copy(update={"ranges": dict.fromkeys(keys)})
    points = [BEGIN._replace(name=f"friction at {position} m") for position in (0, 12.5)]
    space = replace(space, search=search, axes=(*[BEGIN] * len(keys), *points))
    names = [name for name, _ in space.numbers_off_nominal(("1 s",) * 4 + ("", "0.1"))]
    assert names == [*keys[:3], "full load", "friction at 12.5 m"]


@given(st.floats(0.0, 1.0), st.floats(0.0, 1.0))
def test_an_axis_keeps_its_order_and_its_ends(one, other):
    for axis in (
        Axis("speed", 60.0, 160.0, "km/h"),
        Axis("offset", -200.0, 200.0, "km/h", origin=0.0),
        Axis("factor", 0.0, 500.0, "%", origin=100.0),
        Axis("leak", 0.0, 3e-8, "m3/(s Pa)", origin=0.0),
        Axis("teeth", 1.0, 100.0, "", origin=0.0, whole=True),
    ):
        texts = (axis.text_at(share) for share in sorted((one, other)))
        low, high = (float(parse_decimal_quantity(text).number) for text in texts)
        assert axis.low <= low <= high <= axis.high
    assert Axis("speed", 60.0, 160.0, "km/h").text_at(1.0) == "160 km/h"


@given(st.lists(st.floats(0.0, 1.0), min_size=4, max_size=4), st.sampled_from(ROWS))
def test_every_fault_is_one_that_a_scenario_accepts(shares, row):
    name, wheelset, begin, size = FaultAxes(0, (row,), BEGIN).texts_at(shares)
    fault = {"part": row.part, "kind": row.name, "at": begin}
    fault |= {"wheelset": int(wheelset)} if wheelset else {}
    fault |= {"value": size} if size else {}
    assert fault_name(scenario.Fault.model_validate(fault).declared) == name
    assert (wheelset != NOMINAL) == row.of_wheelset


@pytest.mark.parametrize("row", [row for row in ROWS if row.value is not None], ids=fault_name)
def test_small_sizes_are_as_likely_as_large_ones(row):
    axis = FaultAxes(0, (row,), BEGIN).size_axis(fault_name(row))
    assert axis.unit == parse_decimal_quantity(row.value.at_most).unit
    harmful_at_any_size = {"lost", "stuck", "silent"}
    assert (axis.origin is None) == (row.name in harmful_at_any_size)


@pytest.mark.parametrize(
    ("name", "kinds"),
    [
        ("speed-sensor-offset", ["speed-sensor-offset"]),
        ("speed-offset", ["speed-sensor-offset", "train-speed-offset"]),
        (
            "valve-stuck",
            [f"{part}-valve-stuck-{way}" for part in ("fill", "vent") for way in ("open", "closed")],
        ),
        ("sensor-speed", []),
    ],
)
def test_some_words_in_order_name_kinds_of_faults(name, kinds):
    assert list(map(fault_name, kinds_named(name))) == kinds


def test_kinds_that_the_car_cannot_have_are_left_out(write):
    space = load_search(write(SPACE.replace("[speed-sensor]", "[speed-sensor, sander, track-brake]")))
    names = {kind.part for kind in space.faults[0].kinds}
    assert names == {"speed-sensor"}


def test_a_point_that_does_not_fit_is_refused(write):
    space = load_search(write(SPACE.replace("[90 km/h, 120 km/h]", "[90 km/h, 500 km/h]")))
    with pytest.raises(ScenarioErrors, match="the train never runs at"):
        space.case(space.point([0.5] * 5 + [0.5, 0.5, 1.0, 0.5] * 2))


@pytest.mark.parametrize(
    ("section", "says"),
    [
        ("rail: {friction: {points: [{position: 0 m, friction: 0.1}]}}", "is not one number"),
        ("train: [{vehicle: intercity-180, count: 2}]", "the cars of a train"),
    ],
)
def test_scenarios_that_cannot_be_searched(write, section, says):
    text = SPACE.replace("search:\n", f"{section}\nsearch:\n")
    with pytest.raises(ScenarioErrors, match=says):
        load_search(write(text))
