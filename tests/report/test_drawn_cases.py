from uictest.judging.evaluation import Sensitivity, VerdictInterval
from uictest.report.content import DRAWN, MOST_DRAWN, drawn_cases, worst_first

from .builders import make_result, make_verdict


def test_cases_not_met_come_first_then_narrow_margins_and_verdicts_that_flip():
    intervals = (VerdictInterval(0.0, 0.5, "pass"), VerdictInterval(0.6, 1.0, "fail"))
    flips = Sensitivity("d", "s", 0.0, 1.0, intervals)
    results = [
        make_result(id="wide", criteria=(make_verdict(margin=200.0),)),
        make_result(id="narrow", criteria=(make_verdict(margin=2.0),)),
        make_result(id="flips", criteria=(make_verdict(margin=200.0, sensitivity=(flips,)),)),
        make_result(id="nothing", criteria=()),
        make_result(id="expected", outcome="fail", expect="fail"),
        make_result(id="missed", outcome="invalid"),
    ]
    order = ["missed", "expected", "flips", "narrow", "wide", "nothing"]
    assert [result.id for result in worst_first(results)] == order


def test_a_missed_requirement_is_worse_than_a_stop_that_is_no_test_at_all():
    missed = make_verdict(status="fail", margin=-0.1, layer="requirement")
    no_test = make_verdict(status="fail", margin=-90.0, layer="validity")
    results = [
        make_result(id="no-test", outcome="invalid", criteria=(no_test,)),
        make_result(id="missed", outcome="fail", criteria=(missed,)),
    ]
    assert [result.id for result in worst_first(results)] == ["missed", "no-test"]


def test_a_page_draws_from_every_scenario_in_turn():
    """A hundred narrow cases of one scenario leave room for the only one of another."""
    margins = [(make_verdict(margin=1.0 + n),) for n in range(100)]
    narrow = [make_result(id=f"a{n}", scenario="a.yaml", criteria=own) for n, own in enumerate(margins)]
    wide = make_result(id="b", scenario="b.yaml", criteria=(make_verdict(margin=200.0),))
    missed = [make_result(id=f"c{n}", scenario="c.yaml", outcome="fail") for n in range(2)]
    drawn = [result.id for result in drawn_cases([*narrow, wide, *missed])]
    assert len(drawn) == DRAWN
    assert drawn[:5] == ["c0", "c1", "a0", "b", "a1"]


def test_chosen_cases_are_drawn_before_all_others_more_if_more_are_chosen_and_not_without_end():
    results = [make_result(id=f"case-{n}", outcome="fail" if n < 50 else "pass") for n in range(100)]
    drawn = drawn_cases(results, {"case-98", "case-99"})
    assert [result.id for result in drawn[:2]] == ["case-98", "case-99"]
    assert len(drawn) == DRAWN
    assert len(drawn_cases(results, {f"case-{n}" for n in range(30)})) == 30
    assert len(drawn_cases(results, {result.id for result in results})) == MOST_DRAWN
