import math

import pytest
from pydantic import ConfigDict, TypeAdapter

from uictest.judging.evaluation import (
    AppliedDefinition,
    Sensitivity,
    Verdict,
    VerdictInterval,
    WrittenVerdict,
    from_json_form,
    to_json_form,
)

# The interface's names; `sensitivity` says what definitions do to it, the last two as data what was judged.
FIELDS = [
    "id",
    "layer",
    "value",
    "unit",
    "lower",
    "upper",
    "margin",
    "verdict",
    "reason",
    "definition",
    "sensitivity",
    "measure",
    "definitions",
]
VERDICTS = TypeAdapter(list[WrittenVerdict], config=ConfigDict(extra="forbid"))
SLIDE = Sensitivity(
    "low_speed_cutoff",
    "km/h",
    10.0,
    60.0,
    (VerdictInterval(10.0, 40.0, "pass"), VerdictInterval(50.0, 60.0, "fail")),
)
STEADY = Sensitivity("first_phase_duration", "s", 2.0, 5.0, (VerdictInterval(2.0, 5.0, "pass"),))


def verdict(**changes):
    fields = {
        "id": "minimum-slide",
        "layer": "validity",
        "value": 80.0,
        "unit": "%",
        "lower": 35.0,
        "upper": None,
    }
    fields |= {"margin": 45.0, "status": "pass", "reason": "2 of 4", "definition": {"clause": "Appendix B"}}
    cutoff = AppliedDefinition("low_speed_cutoff", 30 / 3.6, "m/s", "chosen", 10 / 3.6, 60 / 3.6)
    fields |= {"measure": "maximum_slide", "definitions": (cutoff,)}
    return Verdict(**{**fields, "sensitivity": (SLIDE, STEADY), **changes})


def form_of(verdict):
    return to_json_form(VERDICTS, [verdict])[0]


def read_back(form):
    return from_json_form(VERDICTS, [form])[0]


def test_the_json_form_has_the_fields_of_the_interface_and_comes_back_also_in_its_first_version():
    form = form_of(verdict())
    assert list(form) == [*FIELDS, "requirements"]
    assert read_back(form) == verdict()
    del form["measure"], form["definitions"]
    assert read_back(form) == verdict(measure="", definitions=())
    form = form_of(verdict(value=math.inf, margin=math.nan))
    assert (form["value"], form["margin"]) == (None, None)


def test_a_verdict_knows_its_definitions_and_whether_it_flips_and_cannot_be_changed():
    assert verdict().defined("low_speed_cutoff") == 30 / 3.6
    assert verdict().defined("first_phase_duration") is None
    assert [entry["flips"] for entry in form_of(verdict())["sensitivity"]] == [True, False]
    assert not verdict().steady
    assert verdict(sensitivity=(STEADY,)).steady
    assert verdict(sensitivity=()).steady
    with pytest.raises(AttributeError):
        verdict().status = "fail"


@pytest.mark.parametrize(
    ("changes", "message"),
    [
        ({"verdict": "maybe"}, "verdict: Input should be 'pass', 'fail'"),
        ({"value": "far"}, "value: Input should be a valid number"),
        ({"status": "pass"}, "status: Unexpected keyword argument"),
        ({"sensitivity": [{"definition": "low_speed_cutoff"}]}, "sensitivity.0.unit: Field required"),
    ],
)
def test_a_verdict_of_another_form_is_refused(changes, message):
    with pytest.raises(ValueError, match=message):
        read_back(form_of(verdict()) | changes)
