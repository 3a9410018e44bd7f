from uictest.judging.evaluation import Sensitivity, VerdictInterval
from uictest.report.terminal.verdict_table import case_line, criterion_lines, definition_lines

from ..builders import HOSTILE, make_result, make_verdict


def test_the_line_of_a_case_that_is_met():
    assert case_line(make_result()) == (
        "pass dry-120[command=90] outcome=pass expect=pass test_validity=valid requirements=not_judged "
        "braking_distance_m=465.25 corrected_distance_m=465.25 braking_time_s=27.5 "
        "mean_deceleration_mps2=1.195 reference_distance_m=- initial_adhesion_g=- slide_above=moving_speed "
        "maximum_slide=0.02/0.04/0.06/0.08 valve_actuations=1/2/3/4"
    )


def test_a_missed_case_gives_its_reason_on_the_same_line():
    broken = make_verdict(id="locked", status="fail", margin=None, reason="locked for 3 s")
    line = case_line(make_result(outcome="fail", criteria=(broken,)))
    assert line.startswith(
        "fail dry-120[command=90] outcome=fail expect=pass test_validity=not_valid requirements=not_judged "
    )
    assert line.endswith("reason=locked (validity) fail: locked for 3 s")
    assert case_line(make_result(expect="fail")).endswith("reason=pass. Expected: fail")


def test_a_crash_stands_first_on_its_line_and_every_line_is_one_line_whatever_is_in_it():
    crashed = make_result(outcome="error", reason="ValueError: x", measures=None, wheelsets=(), criteria=())
    assert case_line(crashed) == "error dry-120[command=90] outcome=error expect=pass reason=ValueError: x"
    result = make_result(id=HOSTILE, outcome="error", reason=HOSTILE, criteria=())
    assert case_line(result).isprintable()


def test_criterion_lines_can_be_found_by_the_case():
    steady = Sensitivity("low_speed_cutoff", "km/h", 10.0, 60.0, (VerdictInterval(10.0, 60.0, "pass"),))
    lines = list(criterion_lines(make_result(criteria=(make_verdict(sensitivity=(steady,)),))))
    assert lines[0] == (
        "criterion dry-120[command=90] braking-distance (validity) pass: 465.25 m, limits 440 .. 490 m, "
        "margin 24.75 m"
    )
    assert all(line.startswith("criterion dry-120[command=90] ") for line in lines)
    assert len(lines) == 2


def test_what_criteria_mean_is_said_once_for_all_cases():
    assert list(definition_lines([make_result(criteria=(make_verdict(definition={}),))])) == []
    results = [make_result(id=name) for name in ("a", "b")]
    assert list(definition_lines(results)) == ["definition braking-distance: low_speed_cutoff = 30 km/h"]
    others = [make_result(id=name, criteria=(make_verdict(definition={"bound": "< 1"}),)) for name in "cdefg"]
    assert list(definition_lines([*results, *others])) == [
        "definition braking-distance (in a, b): low_speed_cutoff = 30 km/h",
        "definition braking-distance (in c, d, e and 2 more): bound = < 1",
    ]


def test_a_failure_that_is_expected_names_what_failed_with_value_and_limit():
    locked = make_verdict(
        id="locked-wheels",
        layer="requirement",
        lower=None,
        value=61.8,
        upper=1.0,
        margin=-60.8,
        unit="s",
        status="fail",
    )
    line = case_line(make_result(outcome="fail", expect="fail", criteria=(locked,)))
    assert line.startswith("expected-fail ")
    assert "reason=locked-wheels (requirement) fail: 61.8 s, upper limit 1 s" in line
