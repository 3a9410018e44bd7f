"""What a criteria file may say of readings."""

import pytest
from pydantic import ValidationError

from uictest.plans.scenario.parts.criteria import Criteria

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
