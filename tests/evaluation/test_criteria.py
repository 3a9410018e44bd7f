"""The criteria files: what is shipped, and what a file may not say."""

import jsonschema
import pytest
from pydantic import ValidationError

from uictest.plans.scenario.parts.criteria import Criteria
from uictest.plans.scenario.yaml.model import quantities_in

SHIPPED = ("uic-541-05-appendix-b", "uictest-stop")


def test_appendix_b_is_its_three_limits_and_nothing_else(shipped):
    limits = {
        c.id: (c.measure, c.lower and c.lower.text, c.upper and c.upper.text, c.layer)
        for c in shipped("uic-541-05-appendix-b").criteria
    }
    assert limits == {
        "initial-adhesion": ("initial_adhesion", None, "0.08 g", "validity"),
        "minimum-slide": ("sliding_share", "35 %", None, "validity"),
        "braking-distance": ("braking_distance", "440 m", "490 m", "validity"),
    }


@pytest.mark.parametrize("name", SHIPPED)
def test_every_shipped_number_names_a_described_source(shipped, name):
    profile = shipped(name)
    found = list(quantities_in(profile))
    assert found
    assert all(quantity.source in profile.sources for _, quantity in found)


def test_only_the_quoted_limits_are_marked_as_stated(shipped):
    profile = shipped("uic-541-05-appendix-b")
    stated = {q.text for _, q in quantities_in(profile) if profile.sources[q.source].mark == "stated"}
    assert stated == {"0.08 g", "35 %", "440 m", "490 m", "120 km/h"}
    assert all(source.mark == "chosen" for source in shipped("uictest-stop").sources.values())


@pytest.mark.parametrize("name", SHIPPED)
def test_a_profile_comes_back_from_its_own_form(shipped, name):
    profile = shipped(name)
    assert Criteria.model_validate(profile.model_dump(by_alias=True)) == profile


@pytest.mark.parametrize("name", SHIPPED)
def test_an_editor_that_knows_the_schema_accepts_what_is_shipped(written, name):
    jsonschema.validate(written(name), Criteria.model_json_schema())


PHASE = {"first_phase_duration": {"value": "3 s", "range": ["2 s", "5 s"]}}


def cutoff(value="30 km/h", first="10 km/h", last="60 km/h"):
    return {"low_speed_cutoff": {"value": value, "range": [first, last]}}


SLIDE = {"measure": "maximum_slide_above_cutoff", "lower": "35 %", "wheelsets": "all"}


@pytest.mark.parametrize(
    ("fields", "message"),
    [
        ({"measure": "braking_distanc", "upper": "490 m"}, "unknown measure 'braking_distanc'"),
        ({"measure": "braking_distance"}, "criterion 'tested' has no bound"),
        ({"measure": "braking_distance", "upper": "490 s"}, "unknown unit 's' for a length"),
        ({"measure": "braking_distance", "upper": 490}, "'490' has no unit"),
        ({"measure": "braking_distance", "upper": ".nan m"}, "not a finite number"),
        (
            {"measure": "braking_distance", "lower": "5 m", "upper": "4 m"},
            "lower bound 5 m is above the upper",
        ),
        ({"measure": "braking_distance", "upper": "5 m", "wheelsets": "all"}, "a measure of the whole stop"),
        ({"measure": "locked_time", "upper": "1 s"}, "'wheelsets' must say how many"),
        ({"measure": "locked_time", "upper": "1 s", "wheelsets": {"at_least": 5}}, "less than or equal to 4"),
        (
            {"measure": "initial_adhesion", "upper": "0.08 g"},
            "needs the definition 'first_phase_duration', which is missing",
        ),
        (
            {"measure": "braking_time", "upper": "9 s", "definition": PHASE},
            "does not use the definition 'first_phase_duration'",
        ),
        ({**SLIDE, "definition": cutoff("35 km/h")}, "35 km/h is no multiple of 10 km/h"),
        ({**SLIDE, "definition": cutoff(last="65 km/h")}, "65 km/h is no multiple of 10 km/h"),
        ({**SLIDE, "definition": cutoff(last="300 km/h")}, "out of range"),
        (
            {**SLIDE, "definition": cutoff("70 km/h")},
            "70 km/h is outside its own range of 10 km/h to 60 km/h",
        ),
        (
            {**SLIDE, "definition": cutoff(first="60 km/h", last="10 km/h")},
            "the range falls from 60 km/h to 10 km/h",
        ),
        ({"measure": "braking_time", "upper": "9 s", "id": "No Blanks"}, "should match pattern"),
        ({"measure": "braking_time", "upper": "9 s", "layer": "maybe"}, "'validity' or 'requirement'"),
        (
            {"measure": "braking_time", "upper": {"value": "9 s", "source": "nowhere"}},
            "unknown source 'nowhere'",
        ),
        ({"measure": "braking_time", "upper": "9 s", "source": "nowhere"}, "unknown source 'nowhere'"),
    ],
)
def test_what_makes_no_criterion_is_refused(fields, message):
    whole = {"id": "tested", "layer": "validity", **fields}
    with pytest.raises(ValidationError, match=message.replace("(", r"\(")):
        Criteria.model_validate({"name": "mine", "criteria": [whole]})


def test_a_mistyped_measure_is_answered_with_the_nearest():
    wrong = {"id": "a", "layer": "validity", "measure": "braking_distanc", "upper": "490 m"}
    with pytest.raises(ValidationError) as caught:
        Criteria.model_validate({"criteria": [wrong]})
    (error,) = caught.value.errors()
    assert error["ctx"]["hint"] == "did you mean 'braking_distance'?"
    assert error["loc"] == ("criteria", 0, "measure")


def test_a_profile_of_another_kind_without_criteria_or_with_two_of_a_name_is_refused():
    one = {"id": "same", "layer": "validity", "measure": "standstill", "lower": 1}
    with pytest.raises(ValidationError, match="a second criterion is called 'same'"):
        Criteria.model_validate({"criteria": [one, one]})
    with pytest.raises(ValidationError, match="uictest/criteria/1"):
        Criteria.model_validate({"schema": "uictest/rail/1", "criteria": [one]})
    with pytest.raises(ValidationError, match="the profile has no criterion"):
        Criteria.model_validate({"criteria": []})
