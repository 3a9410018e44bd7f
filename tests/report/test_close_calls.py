"""What passes and is close to its limit, or not certain."""

from dataclasses import replace

from uictest.core.series_measures import Estimate, SeriesValue
from uictest.judging.evaluation import AppliedDefinition, Sensitivity, VerdictInterval
from uictest.judging.series import SeriesVerdict
from uictest.report.close_calls import MOST_CLOSE, close_calls, close_lines, turns_text
from uictest.report.formats.md import markdown_summary
from uictest.report.page.series_view import series_view
from uictest.report.series.series_sentences import series_tally
from uictest.report.series.tables import judged_criteria

from .builders import make_content, make_result, make_verdict
from .series.made_up import make_series


def _turning(now, *intervals, **changes):
    range_of = Sensitivity("sliding_below", "%", 85.0, 95.0, intervals)
    stated = AppliedDefinition("sliding_below", now / 100.0, "1", "stated", 0.85, 0.95)
    return make_verdict(id="minimum-slide", sensitivity=(range_of,), definitions=(stated,), **changes)


STEPS = VerdictInterval(85.0, 85.0, "fail"), VerdictInterval(90.0, 95.0, "pass")


def test_a_verdict_that_turns_says_by_which_value_of_what_and_to_what():
    sliding = "sliding counted below {} instead of 90 % of the train's speed"
    assert turns_text(_turning(90.0, *STEPS)) == f"would fail if {sliding.format('85 %')}"
    closely = VerdictInterval(85.0, 87.1234561, "inconclusive"), VerdictInterval(87.1234562, 95.0, "pass")
    assert turns_text(_turning(90.0, *closely)) == f"would be inconclusive if {sliding.format('87.123 %')}"
    both = [VerdictInterval(at, at, "pass" if at == 90.0 else "fail") for at in (85.0, 90.0, 95.0)]
    of_both = [f"would fail if {sliding.format(at)}" for at in ("85 %", "95 %")]
    assert turns_text(_turning(90.0, *both)) == " or ".join(of_both)
    readings = (VerdictInterval(1, 1, "pass", "half-at-once"), VerdictInterval(2, 2, "fail", "depth"))
    own = make_verdict(sensitivity=(Sensitivity("readings", "", 1, 2, readings),))
    assert turns_text(own) == "turns with its reading (half-at-once pass, depth fail)"
    assert turns_text(make_verdict()) == ""


def test_what_turns_comes_before_narrow_margins_and_what_failed_is_not_close():
    narrow, narrower = make_verdict(value=445.0, margin=5.0), make_verdict(value=441.0, margin=1.0)
    failed = make_verdict(id="missed", value=430.0, margin=-10.0, status="fail")
    results = [
        make_result(id="a", criteria=(narrow, replace(narrow, layer="rig"))),
        make_result(id="b", criteria=(narrower,)),
        make_result(id="c", criteria=(_turning(90.0, *STEPS, margin=200.0),)),
        make_result(id="d", criteria=(failed, _turning(90.0, *STEPS, status="fail")), outcome="fail"),
        make_result(id="wide", criteria=(make_verdict(margin=49.5),)),
    ]
    assert [(each.of, each.kind) for each in close_calls(results)] == [
        ("c", "turns"), ("b", "narrow"), ("a", "narrow")
    ]  # fmt: skip


def test_many_are_counted():
    narrow = make_verdict(value=441.0, margin=1.0)
    lines = close_lines([make_result(id=f"case-{n}", criteria=(narrow,)) for n in range(MOST_CLOSE + 3)])
    assert len(lines.sentences) == MOST_CLOSE + 1
    assert lines.sentences[-1].startswith("3 more")


def test_an_uncertain_share_names_the_limit_inside_its_interval_and_the_stops_that_would_settle_it():
    share = Estimate(100.0, 73.54, 100.0, 0.95, "share", 12, 0.0, 1.0)
    verdict = make_verdict(id="passing-stops", value=100.0, unit="%", lower=90.0, upper=None, margin=10.0)

    def text(**changes):
        uncertain = SeriesVerdict(replace(verdict, **changes), share, confident=False)
        (call,) = close_calls((), [make_series(criteria=(uncertain,))])
        return call.text

    inside = "lies inside the 95 % interval 73.54 .. 100 % (12 stops)"
    assert text() == (
        f"100 %: not certain, the lower limit of 90 % {inside}; 36 stops, all passing, would settle it"
    )
    assert text(lower=100.0).endswith(f"limit of 100 % {inside}; no number of stops settles it")
    assert text(lower=None, upper=95.0).endswith(f"the upper limit of 95 % {inside}")


def test_a_series_that_passes_by_chance_or_worse_than_without_wsp_says_so_everywhere():
    series = make_series()
    (k_wet,) = series.criteria
    assert k_wet.estimate is not None
    better = replace(k_wet.estimate, value=k_wet.estimate.value + 0.05)
    bypassed = SeriesValue(better)
    doubtful = replace(series, criteria=(replace(k_wet, confident=False),), bypassed_k_wet=bypassed)
    calls = close_calls((), [doubtful])
    assert [(each.of, each.criterion, each.of_series) for each in calls] == [
        ("acceptance", "", True), ("acceptance", "k-wet", True)
    ]  # fmt: skip
    assert "K_wet is better with the WSP bypassed" in str(calls[0])
    assert "locked" not in str(calls[0])  # the results hold no stop with the WSP bypassed
    assert "not certain, a limit lies inside the interval at another speed or rail" in calls[1].text
    assert series_tally([doubtful]) == "1 series: 1 pass; 1 of 1 criteria of series not certain"
    (judged,) = judged_criteria(doubtful)
    assert (judged.status, judged.tone) == ("pass, not certain", "odd")
    badge = series_view(doubtful)
    assert (badge.badge, badge.tone) == ("pass, not certain", "odd")
    assert (series_view(series).badge, series_view(series).tone) == ("pass", "good")
    assert "### Close or uncertain" in markdown_summary(make_content(series=[doubtful]))
