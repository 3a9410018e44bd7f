"""How a verdict, a stop and a run are put into words: limits, reasons, causes, statements, counts."""

from dataclasses import replace

import pytest

from uictest.judging.evaluation import EffectivePart, Parameter, ReadVerdict, Sensitivity, VerdictInterval
from uictest.plans.faults import FAULT_KINDS
from uictest.report.verdict_sentences import (
    cause_sentences,
    check_sentence,
    criterion_sentences,
    explanation,
    fault_words,
    label_words,
    limits,
    missed_by_text,
    reading_sources,
    tally,
    value_with_limit,
    verdict_sentence,
    without_checks_that_hold,
)
from uictest.report.words import result_word, tone

from .builders import make_result, make_verdict

SHARE = {"value": 0.0, "unit": "%", "lower": 35.0, "upper": None}


@pytest.mark.parametrize(
    ("verdict", "said"),
    [
        (limits(make_verdict()), "440 .. 490 m"),
        (limits(make_verdict(upper=None)), "lower limit 440 m"),
        (limits(make_verdict(lower=None, upper=0.08)), "upper limit 0.08 m"),
        (limits(make_verdict(lower=None, upper=None)), "no limit"),
        (value_with_limit(make_verdict(measure="sliding_share", **SHARE)), "0 % of the time (35 % needed)"),
        (value_with_limit(make_verdict(measure="maximum_slide_above_cutoff", **SHARE)), "0 % (35 % needed)"),
        (verdict_sentence(make_verdict()),
         "braking-distance (validity) pass: 465.2 m (440 to 490 m)",),
        (verdict_sentence(make_verdict(value=100.0, unit="%", lower=90.0, upper=None, margin=10.0)),
         "braking-distance (validity) pass: 100 % (90 % needed)",),
        (verdict_sentence(make_verdict(status="not_applicable", reason="the rail is dry")),
         "braking-distance (validity) not applicable: the rail is dry",),
        (missed_by_text(make_verdict(missed_by=()), 4), ""),
        (missed_by_text(make_verdict(missed_by=(3,)), 4), "wheelset 3 only"),
        (missed_by_text(make_verdict(missed_by=(1, 4)), 4), "wheelsets 1 and 4"),
        (missed_by_text(make_verdict(missed_by=(1, 2, 4)), 4), "wheelsets 1, 2 and 4"),
        (missed_by_text(make_verdict(missed_by=(1, 2, 3, 4)), 4), "all 4 wheelsets"),
        (missed_by_text(make_verdict(missed_by=(1,)), 1), ""),
    ],
)  # fmt: skip
def test_a_verdict_says_value_and_limit(verdict, said):
    assert verdict == said


@pytest.mark.parametrize(
    ("layer", "statuses", "said", "shown"),
    [
        ("rig", ("pass", "pass"), "checks of the rig: all hold", 0),
        ("rig", ("pass", "fail", "not_applicable"), "checks of the rig: 1 of 2 hold", 1),
        ("record", ("pass", "not_applicable"), "checks of the record: all hold, 1 not made", 0),
        ("validity", ("pass", "fail"), "", 2),
        ("rig", ("not_applicable",), "", 0),
    ],
)
def test_checks_that_hold_are_said_in_one_sentence(layer, statuses, said, shown):
    verdicts = [make_verdict(layer=layer, status=status) for status in statuses]
    assert (check_sentence(verdicts), len(without_checks_that_hold(verdicts))) == (said, shown)


NOTHING = {"value": None, "margin": None}
TURNING = Sensitivity(
    *("low_speed_cutoff", "km/h", 10.0, 60.0),
    (VerdictInterval(10.0, 30.0, "pass"), VerdictInterval(40.0, 60.0, "fail")),
)
TOO_LONG = make_verdict(
    id="x", layer="requirement", status="fail", value=3.0, unit="s", lower=None, upper=1.0, reason="3 s"
)
CHECK = make_verdict(
    id="balance", layer="rig", status="fail", value=3.0, unit="%", lower=None, upper=0.1, reason="3 %"
)


@pytest.mark.parametrize(
    ("changes", "lines"),
    [
        ({"outcome": "skipped", "criteria": (make_verdict(status="not_applicable", **NOTHING,
         reason="dry rail"),),}, ["skipped. Expected: pass",
         "test validity: not judged; requirements: not judged",
         "braking-distance (validity) not applicable: dry rail",]),
        ({"outcome": "inconclusive", "criteria": (make_verdict(), make_verdict(status="inconclusive",
         **NOTHING, reason="ends after 2 s"),),}, ["inconclusive: braking-distance. Expected: pass",
         "test validity: not judged; requirements: not judged",
         "braking-distance (validity) inconclusive: ends after 2 s",]),
        ({"outcome": "fail", "criteria": (make_verdict(), TOO_LONG)},
         ["fail: x 3 s (limit 1 s). Expected: pass", "test validity: valid; requirements: missed (x)",
         "x (requirement) fail: 3 s",]),
        # A failed check comes first: the figures of the stop are not those of the test.
        ({"outcome": "invalid", "criteria": (TOO_LONG, CHECK)},
         ["invalid: balance 3 % (limit 0.1 %). Expected: pass",
         "test validity: not valid (balance); requirements: missed (x)", "balance (rig) fail: 3 %",
         "x (requirement) fail: 3 s",]),
        ({"outcome": "error", "criteria": (), "reason": "ValueError: x"},
         ["error: ValueError: x. Expected: pass"]),
        ({"strict": True, "criteria": (make_verdict(id="minimum-slide", sensitivity=(TURNING,)),)},
         ["pass, unsettled. Expected: pass", "test validity: valid; requirements: not judged",
         "minimum-slide (validity) turns: low_speed_cutoff 10 .. 60 km/h: pass 10 .. 30, fail 40 .. 60"]),
    ],
)  # fmt: skip
def test_a_stop_says_why_it_came_out_so(changes, lines):
    assert explanation(make_result(**changes)) == lines


def test_a_strict_case_that_is_not_settled_is_bad_and_a_drawn_stop_says_when_a_value_was_taken():
    strict = make_result(strict=True, criteria=(make_verdict(sensitivity=(TURNING,)),))
    assert (result_word(strict), tone("unsettled")) == ("unsettled", "bad")
    outcome, _, line = explanation(make_result(outcome="fail", criteria=(TOO_LONG,)), {"x": "12 s"})
    assert outcome == "fail: x 3 s (limit 1 s), at 12 s. Expected: pass"
    assert line == "x (requirement) fail: 3 s (taken at 12 s)"


def part(kind, **values):
    own = tuple(Parameter(key, text, "", text, "user", differs=True) for key, text in values.items())
    return {kind: EffectivePart(kind, kind.removeprefix("scenario").removeprefix("."), "", None, own)}


def faults(**values):
    return part("scenario", **{f"faults.0.{name}": text for name, text in values.items()})


@pytest.mark.parametrize(
    ("parts", "causes"),
    [
        ({}, []),
        (faults(at="6 s", wheelset="3", part="vent-valve", kind="stuck-closed"),
         ["injected fault: vent valve of wheelset 3: stuck closed from 6 s"]),
        (faults(at="90 km/h", until="20 s", wheelset="1", part="speed-sensor", kind="factor", value="90 %"),
         ["injected fault: speed sensor of wheelset 1: factor 90 % from 90 km/h until 20 s"]),
        (part("scenario.rig", **{"rig.wsp": "bypassed"}),
         ["WSP bypassed: the controller did not act, the stop says nothing about it"]),
        (part("scenario.rig", **{"rig.wsp": "active"}), []),
    ],
)  # fmt: skip
def test_what_was_done_to_a_stop_is_a_cause(parts, causes):
    assert cause_sentences(make_result(parts=parts)) == causes


@pytest.mark.parametrize(("of", "kind"), FAULT_KINDS)
def test_the_label_of_a_recording_and_the_scenario_say_a_fault_alike(of, kind):
    assert label_words(f"{of}-{kind}-2") == fault_words(of, kind, "2")
    assert label_words(f"{of}-{kind}") == fault_words(of, kind)
    assert label_words("unknown-label") == "unknown-label"


ADHESION = {"measure": "initial_adhesion", "value": 0.124, "unit": "g", "lower": None, "upper": 0.08}
GRIP = make_verdict(id="grip", **ADHESION, margin=-0.044, status="fail")


@pytest.mark.parametrize(
    ("verdict", "told"),
    [
        (GRIP, "grip 0.124 g (limit 0.08 g)"),
        (replace(GRIP, measure="sliding_share", **SHARE), "grip 0 % of the time (35 % needed)"),
        (replace(GRIP, unit="m", lower=440.0, upper=490.0, value=400.0), "grip 400 m (440 to 490 m)"),
        (replace(GRIP, value=None), "grip"),
        (replace(GRIP, layer="rig"), "grip 0.124 g (limit 0.08 g)"),
        (replace(GRIP, layer="record"), "grip 0.124 g (limit 0.08 g)"),
    ],
)
def test_an_invalid_stop_says_by_which_number_it_is_no_test_and_not_whose_fault_it_is(verdict, told):
    result = make_result(outcome="invalid", criteria=(verdict,))
    assert cause_sentences(result) == []
    assert explanation(result)[:2] == [
        f"invalid: {told}. Expected: pass",
        "test validity: not valid (grip); requirements: not judged",
    ]


SHARE_OF_TIME = "sliding_share", 42.0, "%", 35.0, None, 7.0, "42 % keeps > 35 %"
AT_ONCE = ReadVerdict("at-once", True, "pass", *SHARE_OF_TIME)
LARGEST = "maximum_slide_above_cutoff", 14.9, "%", 35.0, None, -20.1, "0 of 4 wheelsets keep"
OURS = {"mark": "chosen", "source": "ours alone", "definition": {"low_speed_cutoff": "30 km/h (chosen)"}}
DEPTH = ReadVerdict("depth", False, "fail", *LARGEST, **OURS, sensitivity=(TURNING,))
READ = make_verdict(id="minimum-slide", readings=(AT_ONCE, DEPTH))


def test_every_criterion_is_said_failing_ones_first_with_its_readings_and_what_turns_it():
    steady = Sensitivity("low_speed_cutoff", "km/h", 10.0, 60.0, (VerdictInterval(10.0, 60.0, "pass"),))
    result = make_result(
        criteria=(make_verdict(sensitivity=(steady,)), READ, TOO_LONG, replace(CHECK, status="pass"))
    )
    assert list(criterion_sentences(result)) == [
        "x (requirement) fail: 3 s",
        "braking-distance (validity) pass: 465.2 m (440 to 490 m)",
        f"braking-distance: {steady}",
        "minimum-slide (validity) pass: 465.2 m (440 to 490 m)",
        "minimum-slide read as at-once (decides) pass: 42 % keeps > 35 %",
        "minimum-slide read as depth fail: 0 of 4 wheelsets keep",
        f"minimum-slide read as depth: {TURNING}",
        "checks of the rig: all hold",
    ]
    assert reading_sources(READ) == {"depth": "chosen: ours alone, low_speed_cutoff = 30 km/h (chosen)"}


PASSED, FAILED, KNOWN = make_result(), make_result(outcome="fail"), make_result(outcome="fail", expect="fail")


@pytest.mark.parametrize(
    ("results", "differing", "text"),
    [
        ([], (), "no case"),
        ([PASSED], (), "1 case: 1 pass"),
        ([PASSED, FAILED, make_result(outcome="error"), PASSED], (),
         "4 cases: 2 pass, 1 fail, 1 error; 2 not as expected",),
        ([KNOWN, make_result(outcome="inconclusive")], (),
         "2 cases: 1 expected fail, 1 inconclusive; 1 not as expected",),
        ([PASSED, KNOWN], [KNOWN.id], "2 cases: 2 different from the baseline"),
    ],
)  # fmt: skip
def test_the_tally_counts_only_what_there_is(results, differing, text):
    assert tally(results, differing) == text
