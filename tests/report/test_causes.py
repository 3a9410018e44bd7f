"""What the program knows of why a stop came out as it did, said in every report."""

import pytest

from uictest.judging.evaluation import EffectivePart, Parameter
from uictest.plans.faults import FAULT_KINDS
from uictest.report import case_line, run_suites
from uictest.report.causes import cause_sentences, fault_words, label_words
from uictest.report.formats.md import markdown_summary
from uictest.report.page import page_html
from uictest.report.part_wording import changed_parameters
from uictest.report.verdict_sentences import explanation, missed_by_text

from .builders import make_content, make_result, make_verdict


def _part(kind, **values):
    own = tuple(Parameter(key, text, "", text, "user", differs=True) for key, text in values.items())
    return EffectivePart(kind, kind.removeprefix("scenario").removeprefix("."), "", None, own)


def _faults(**values):
    return _part("scenario", **{f"faults.0.{name}": text for name, text in values.items()})


STUCK = _faults(at="6 s", wheelset="3", part="vent-valve", kind="stuck-closed")
IN_WORDS = "injected fault: vent valve of wheelset 3: stuck closed from 6 s"
LOCKED = make_verdict(
    id="locked-wheels", layer="requirement", value=42.3, unit="s",
    lower=None, upper=1.0, margin=-41.3, status="fail", missed_by=(3,),
)  # fmt: skip


def test_an_injected_fault_is_said_in_words_in_every_report():
    failed = make_result(outcome="fail", criteria=(LOCKED,), parts={"scenario": STUCK})
    content = make_content(failed)
    (suite,) = run_suites([failed])
    assert f"reason={IN_WORDS}; locked-wheels" in case_line(failed)
    assert any(IN_WORDS in line for each in suite.testcases for line in each.lines)
    assert IN_WORDS in page_html(content)
    assert IN_WORDS in markdown_summary(content).replace("&#58;", ":")
    assert changed_parameters({"scenario": STUCK}) == [IN_WORDS]


def test_a_fault_has_its_value_and_its_end_and_leaves_out_what_a_sweep_varies():
    lost = _faults(at="90 km/h", until="20 s", wheelset="1", part="speed-sensor", kind="factor", value="90 %")
    assert cause_sentences(make_result(parts={"scenario": lost})) == [
        "injected fault: speed sensor of wheelset 1: factor 90 % from 90 km/h until 20 s"
    ]
    varied = ["faults.0.at", "faults.0.until", "faults.0.wheelset"]
    assert changed_parameters({"scenario": lost}, varied) == ["injected fault: speed sensor: factor 90 %"]


@pytest.mark.parametrize(("part", "kind"), FAULT_KINDS)
def test_the_label_of_a_recording_and_the_scenario_say_a_fault_alike(part, kind):
    assert label_words(f"{part}-{kind}-2") == fault_words(part, kind, "2")
    assert label_words(f"{part}-{kind}") == fault_words(part, kind)


def test_a_bypassed_wsp_is_a_cause():
    parts = {"scenario.rig": _part("scenario.rig", **{"rig.wsp": "bypassed"})}
    (cause,) = cause_sentences(make_result(parts=parts))
    assert cause == "WSP bypassed: the controller did not act, the stop says nothing about it"
    assert cause_sentences(make_result()) == []


def _adhesion(**changes):
    own = {"value": 0.124, "upper": 0.08, "lower": None, "unit": "g", "margin": -0.044, "status": "fail"}
    return make_verdict(**{"id": "grip", "measure": "initial_adhesion", **own, **changes})


@pytest.mark.parametrize(
    ("verdict", "told"),
    [
        (_adhesion(), "grip 0.124 g, upper limit 0.08 g"),
        (_adhesion(measure="sliding_share", unit="%", lower=35.0, upper=None, value=0.0),
         "grip 0 % of the time, lower limit 35 %"),
        (_adhesion(measure="braking_distance", unit="m", lower=440.0, upper=490.0, value=400.0),
         "grip 400 m, limits 440 .. 490 m"),
        (_adhesion(value=None), "grip"),
        (_adhesion(layer="rig"), "grip 0.124 g, upper limit 0.08 g"),
        (_adhesion(layer="record"), "grip 0.124 g, upper limit 0.08 g"),
    ],
)  # fmt: skip
def test_an_invalid_stop_says_by_which_number_it_is_no_test_and_not_whose_fault_it_is(verdict, told):
    result = make_result(outcome="invalid", criteria=(verdict,))
    assert cause_sentences(result) == []
    assert explanation(result)[:2] == [
        f"invalid: {told}. Expected: pass",
        "test validity: not valid (grip); requirements: not judged",
    ]


@pytest.mark.parametrize(
    ("missed_by", "text"),
    [
        ((), ""),
        ((3,), "wheelset 3 only"),
        ((1, 4), "wheelsets 1 and 4"),
        ((1, 2, 4), "wheelsets 1, 2 and 4"),
        ((1, 2, 3, 4), "all 4 wheelsets"),
    ],
)
def test_a_finding_says_how_many_wheelsets_miss(missed_by, text):
    verdict = make_verdict(missed_by=missed_by)
    assert missed_by_text(verdict, 4) == text
