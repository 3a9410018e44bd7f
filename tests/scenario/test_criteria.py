"""What a criteria file may say of series, of bounds that refer to the dry stop, and of readings."""

import pytest
from pydantic import ValidationError

from uictest.plans.scenario.parts.criteria import Criteria

PROFILE = """criteria:
  name: own
  criteria:
    - id: one
      layer: {layer}
      {text}
"""
DISTANCE = "measure: braking_distance\n"
LOCK = "measure: longest_lock\nwheelsets: all\n"
SERIES = "scope: series\nmeasure: "


def written(text, layer="requirement"):
    return PROFILE.format(layer=layer, text=text.replace("\n", "\n      "))


@pytest.fixture
def criterion(loaded, head):
    def read(text):
        (case,) = loaded(head + written(text))
        return case.scenario.criteria[0].criteria[0]

    return read


@pytest.mark.parametrize(
    ("text", "share"),
    [
        ("125 % of the dry stop", 1.25),
        ("  1250 permille of the  dry stop ", 1.25),
        ("'90 % of the dry stop'", 0.9),
        ("{value: 125 % of the dry stop, source: scenario}", 1.25),
    ],
)
def test_a_bound_is_a_share_of_the_dry_stop(criterion, text, share):
    read = criterion(f"measure: braking_distance\nupper: {text}")
    assert read.upper == pytest.approx(share)
    assert read.of_dry_stop
    assert read.needs_series
    assert read.unit == "%"


def test_a_criterion_of_a_series_has_the_unit_of_its_measure_and_one_of_stops_needs_no_series(criterion):
    read = criterion("scope: series\nmeasure: worst_contact_energy\nupper: 1.5 MJ")
    assert (read.unit, read.upper, read.needs_series) == ("kJ", 1.5e6, True)
    assert not criterion("measure: braking_distance\nupper: 600 m").needs_series


@pytest.mark.parametrize(
    ("text", "message", "hint"),
    [
        (DISTANCE + "upper: 125 of the dry stop", "'125' has no unit", "`125 %`"),
        (DISTANCE + "upper: 125 % of dry", "is no share of the dry stop", "`125 % of the dry stop`"),
        (DISTANCE + "upper: 125 m of the dry stop", "unknown unit 'm'", "%"),
        (DISTANCE + "upper: 0 % of the dry stop", "not above zero", "125 %"),
        (DISTANCE + "lower: 400 m\nupper: 9 % of the dry stop", "'lower' is no share", "write two criteria"),
        (LOCK + "upper: 125 % of the dry stop", "'longest_lock' has no value of", "braking_distance"),
        (SERIES + "passing_share\nlower: 90 % of the dry stop", "has no value", "median_braking_distance"),
        ("measure: k_wet\nlower: 0.8", "'k_wet' is a measure of a series", "scope: series"),
        (SERIES + "braking_distance\nupper: 500 m", "is a measure of a stop", "scope: stop"),
        (SERIES + "k_wett\nlower: 0.8", "unknown measure 'k_wett'", "'k_wet'"),
        (SERIES + "k_wet\nlower: 0.8\nwheelsets: all", "belongs to a criterion of stops", "leave it out"),
        ("scope: train\nmeasure: k_wet\nlower: 0.8", "expected one of stop, series", ""),
    ],
)
def test_what_makes_no_sense_is_refused_at_its_place(refused, head, text, message, hint):
    diagnostics = refused(head + written(text))
    shown = [each for each in diagnostics if message in each.message]
    assert shown, diagnostics
    assert hint in shown[0].hint


def test_which_stops_count_cannot_depend_on_the_dry_stop(refused, head):
    text = written("measure: braking_distance\nupper: 125 % of the dry stop", layer="validity")
    (diagnostic,) = refused(head + text)
    assert "validity" in diagnostic.message
    assert diagnostic.hint == "write `layer: requirement`"


DEFINITION = {
    "sliding_below": {"value": "90 %", "range": ["85 %", "95 %"]},
    "end_speed": {"value": "60 km/h", "range": ["40 km/h", "80 km/h"]},
}
DEPTH = {
    "id": "depth",
    "measure": "maximum_slide_above_cutoff",
    "wheelsets": "all",
    "definition": {"low_speed_cutoff": {"value": "30 km/h", "range": ["10 km/h", "60 km/h"]}},
}


def criteria(*readings, **changes):
    own = {"id": "slides", "layer": "validity", "measure": "sliding_share", "lower": "35 %", **changes}
    written = {"definition": DEFINITION, "reading": "at-once", "readings": list(readings), **own}
    return Criteria.model_validate({"name": "tested", "criteria": [written]})


def test_a_reading_is_the_criterion_with_another_measure_and_its_own_definitions():
    profile = criteria(DEPTH)
    read = profile.criteria[0].read_as(profile.criteria[0].readings[0])
    assert (read.measure, read.wheelsets, read.lower) == (
        "maximum_slide_above_cutoff",
        "all",
        profile.criteria[0].lower,
    )
    assert list(read.definition.parameters()) == ["low_speed_cutoff"]
    assert read.readings == ()


@pytest.mark.parametrize(
    ("changes", "readings", "message"),
    [
        ({"reading": ""}, [DEPTH], "its own has no name"),
        ({}, [DEPTH, DEPTH], "a second reading is called 'depth'"),
        ({}, [{**DEPTH, "id": "at-once"}], "a second reading is called 'at-once'"),
        ({}, [{"id": "lock", "measure": "longest_lock", "wheelsets": "all"}], "the same bounds cannot hold"),
        ({}, [{**DEPTH, "wheelsets": None}], "must say how many keep it"),
        ({}, [{**DEPTH, "definition": {}}], "needs the definition 'low_speed_cutoff'"),
        ({}, [{**DEPTH, "source": "nowhere"}], "unknown source 'nowhere'"),
    ],
)
def test_readings_that_do_not_fit_are_refused(changes, readings, message):
    with pytest.raises(ValidationError, match=message):
        criteria(*readings, **changes)


@pytest.mark.parametrize(
    ("name", "value"), [("sliding_below", "88 %"), ("end_speed", "55 km/h"), ("end_speed", "61 km/h")]
)
def test_definitions_come_in_the_classes_that_are_measured(name, value):
    own = {**DEFINITION, name: {**DEFINITION[name], "value": value}}
    with pytest.raises(ValidationError, match="no multiple of"):
        criteria(definition=own)


@pytest.mark.parametrize("value", ["80 %", "100 %"])
def test_a_share_of_the_speed_that_is_not_measured_is_refused(value):
    own = {**DEFINITION, "sliding_below": {"value": value, "range": [value, value]}}
    with pytest.raises(ValidationError, match=r"85 %|95 %"):
        criteria(definition=own)
