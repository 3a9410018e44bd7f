"""How firm a verdict is, on toys with known answers: a limit on a function of numbers, with noise by seed."""

import numpy as np
import pytest

from uictest.analysis.firmness import Drawn, Effort, FirmnessStudy, drawn
from uictest.judging.evaluation import CalibratedDraws, CaseResult, Verdict
from uictest.plans.scenario import PASS
from uictest.plans.scenario.yaml import Quantity, parse_quantity
from uictest.plans.sweeps import RangedNumber
from uictest.report.robustness import firmness_sentences

SMALL = Effort(blocks=4, block=64, seeds=16, seeds_at_ends=4)


def number(key, value, low, high):
    """A force with a range."""
    ends = parse_quantity(low, "force"), parse_quantity(high, "force")
    nominal = parse_quantity(value, "force")
    return RangedNumber(key, Quantity(float(nominal), value, "N", "chosen", ends), "chosen", "for the test")


# The square of side 10 around 0; no prior is stated, so that draws are even.
A, B = number("a", "100 N", "95 N", "105 N"), number("b", "100 N", "95 N", "105 N")


def study(
    numbers,
    margin,
    *,
    effort=SMALL,
    noise=0.0,
    validity=None,
    outcome_of_no_test="invalid",
    feasible=lambda *values: True,
    **others,
):
    """Study a stop whose one requirement holds while `margin` of the numbers is not negative.

    `validity` is the margin of a criterion of validity, `outcome_of_no_test` what a stop that misses it comes
    to; `others` are further arguments of the study.
    """

    def judge(columns, seeds):
        if not columns:
            return [one((), seed) for seed in seeds]
        rows = zip(*((column.numbers - 100.0).tolist() for column in columns), strict=True)
        return [one(values, seed) for values, seed in zip(rows, seeds, strict=True)]

    def one(values, seed):
        if not feasible(*values):
            return Drawn("error")
        drawn = np.random.default_rng(seed).uniform(-noise, noise)
        margins = {"limit": margin(*values) + drawn}
        if validity is not None:
            margins = {"counts": validity(*values), **margins}
        statuses = {name: "pass" if value >= 0.0 else "fail" for name, value in margins.items()}
        if statuses.get("counts") == "fail":
            return Drawn(outcome_of_no_test, statuses, margins, is_test=False)
        return Drawn(statuses["limit"], statuses, margins)

    return FirmnessStudy(numbers, judge, validity=frozenset({"counts"}), effort=effort, **others).run()


def test_what_no_number_touches_is_firm_if_the_draws_suffice_also_in_being_no_test():
    full = study([A, B], lambda a, b: 1.0, effort=Effort(8, 128, 16, 4))
    assert (full.status, full.counted, full.turned, full.share, full.turned_by) == ("firm", 1024, 0, 1.0, ())
    # Of n independent draws none turned: a larger share of turning ones than 1 - 0.05^(1/n) is ruled out.
    assert full.share_at_least == pytest.approx(0.05 ** (1 / 1024))
    few = study([A, B], lambda a, b: 1.0)
    assert few.status == "not_shown"
    assert few.share_at_least == pytest.approx(0.05 ** (1 / 256))
    outcome = study([A], lambda a: 1.0, validity=lambda a: -1.0, effort=Effort(8, 128, 16, 4))
    assert (outcome.nominal, outcome.status, outcome.counted) == ("invalid", "firm", 1024)


def test_a_monotone_number_turns_it_at_its_limit():
    firmness = study([A, B], lambda a, b: 0.3 * (2.0 - a))
    [turn] = firmness.turned_by
    told = turn.key, turn.side, turn.criterion, turn.to, turn.end
    assert told == ("a", "above", "limit", "fail", "105 N")
    assert float(turn.value.removesuffix(" N")) == pytest.approx(102.0, abs=0.1)
    # Three tenths of the range lie beyond 102 N.
    assert firmness.share == pytest.approx(0.7, abs=0.03)
    assert firmness.lowest_block <= firmness.share <= firmness.highest_block
    assert firmness.status == "turns"
    [turn] = study([A], lambda a: 2.0 - a, noise=1.0).turned_by
    stands_to, value, turned_from = (
        float(text.removesuffix(" N")) for text in (turn.stands_to, turn.value, turn.turned_from)
    )
    assert 101.0 - 0.7 <= stands_to <= value <= turned_from <= 103.0 + 0.7


def test_a_place_is_not_rounded_past_the_nominal_value():
    fine = number("fine", "100.004 N", "95 N", "105 N")
    near = fine.nominal_place
    assert fine.rounded_text(near - 1e-5, up=True) == "100.004 N"
    assert fine.rounded_text(near + 1e-5, up=False) == "100.004 N"


def test_an_interaction_turns_in_draws_and_by_no_number_alone():
    firmness = study([A, B], lambda a, b: 7.0 - a - b)
    assert firmness.turned_by == ()
    assert firmness.turned > 0
    assert firmness.status == "turns"
    # The corner a + b > 7 of the square is a triangle with legs of 3.
    assert firmness.share == pytest.approx(1.0 - 0.5 * 9.0 / 100.0, abs=0.02)


def test_what_turns_twice_on_the_way_to_an_end_has_no_turning_value():
    [turn] = study([A], lambda a: min(abs(a - 2.0) - 0.8, 4.5 - a)).turned_by
    assert (turn.key, turn.value) == ("a", "")


def test_no_stop_is_run_twice_and_a_search_is_announced():
    """Outcome and limit turn at the same place, so that one search serves both."""
    stops, expected = [], []

    def judge(columns, seeds):
        forces = columns[0].numbers.tolist()
        stops.append(list(zip(forces, seeds, strict=True)))
        return [one("pass" if force < 102.0 else "fail") for force in forces]

    def one(status):
        return Drawn(status, {"limit": status})

    FirmnessStudy([A], judge, effort=SMALL, expect=expected.append).run()
    first, draws, *searched = stops
    assert (len(first), len(draws)) == (16 + 2 * 4, 256)
    alone = [stop for queue in (first, *searched) for stop in queue]
    assert len(alone) == len(set(alone))
    # The other twelve seeds at the end, seven places before it, then the interval is halved four times.
    assert expected == list(map(len, searched)) == [12, 7 * 16, 16, 16, 16, 16]


def test_where_the_end_turns_few_seeds_there_is_no_turning_value_to_search():
    expected = []
    # At 105 N the margin is 0.5, less than the noise under a quarter of the seeds.
    found = study([A], lambda a: max(3.0 - a, 0.5), noise=1.0, expect=expected.append)
    [turn] = found.turned_by
    assert (turn.value, turn.stands_to, turn.turned_from, turn.end) == ("", "100 N", "", "105 N")
    assert expected == [12]


def test_what_turns_within_and_not_at_the_ends_turns_in_draws():
    firmness = study([A], lambda a: abs(a - 2.0) - 0.5)
    result = CaseResult("stop", "stop.yaml", {}, PASS, "pass", firmness=firmness)
    assert any("or by one between the ends of its range" in line for line in firmness_sentences(result))
    assert firmness.turned_by == ()
    assert firmness.status == "turns"
    assert firmness.share == pytest.approx(0.9, abs=0.02)


def test_a_verdict_that_turns_over_the_seeds_is_noise_whatever_the_numbers_do():
    outcome = study([A], lambda a: 0.1, noise=1.0)
    assert outcome.status == "noise"
    assert outcome.turned_by == ()


def test_every_draw_meets_a_random_rail_of_its_own():
    """Draws on one rail, here that of seed 0, do not tell that every hundredth rail turns the verdict."""

    def judge(columns, seeds):
        statuses = ["fail" if seed and seed % 100 == 99 else "pass" for seed in seeds]
        return [Drawn(each, {"limit": each}) for each in statuses]

    fixed, varied = (FirmnessStudy([A], judge, random_rail=each).run() for each in (False, True))
    assert (fixed.status, fixed.turned) == ("firm", 0)
    assert (varied.status, varied.turned, varied.counted) == ("turns", 10, 1024)


@pytest.mark.parametrize("outcome_of_no_test", ["invalid", "fail", "pass"])
def test_draws_that_are_no_test_do_not_count_but_turn_the_criterion_of_validity(outcome_of_no_test):
    """Whatever such a stop comes to: its validity is asked, and not the outcome."""
    firmness = study(
        [A, B], lambda a, b: 1.0, validity=lambda a, b: 3.0 - b, outcome_of_no_test=outcome_of_no_test
    )
    outcome, counts, limit = firmness, *firmness.criteria
    # A fifth of the range lies above 3.
    assert outcome.counted == pytest.approx(0.8 * firmness.draws, abs=3)
    assert (outcome.turned, limit.turned, limit.turned_by) == (0, 0, ())
    [turn] = counts.turned_by
    assert (turn.key, turn.side, turn.to) == ("b", "above", "fail")
    assert counts.counted == firmness.draws
    result = CaseResult("stop", "stop.yaml", {}, "pass", "pass", firmness=firmness)
    told = f"of {firmness.draws} draws {firmness.draws - outcome.counted} are no test: they do not count"
    assert told in list(firmness_sentences(result))


@pytest.mark.parametrize(
    ("statuses", "is_test"),
    [
        ({}, True),
        ({"requirement": "fail"}, True),
        ({"requirement": "inconclusive", "validity": "pass"}, True),
        ({"validity": "not_applicable", "rig": "pass"}, True),
        ({"validity": "fail", "requirement": "fail"}, False),
        ({"rig": "fail", "validity": "pass"}, False),
        ({"rig": "fail", "validity": "inconclusive"}, False),
        ({"validity": "inconclusive"}, False),
    ],
)
def test_what_is_required_of_a_stop_does_not_say_whether_it_is_a_test(statuses, is_test):
    verdicts = [
        Verdict(layer, layer, None, "1", None, None, None, status, "") for layer, status in statuses.items()
    ]
    for outcome in ("pass", "fail", "invalid", "inconclusive"):
        assert drawn(outcome, verdicts).is_test == is_test


def test_values_that_do_not_fit_together_are_counted_apart_and_at_an_end_nothing_is_firm():
    firmness = study([A, B], lambda a, b: 1.0, feasible=lambda a, b: a + b < 5.0)
    assert firmness.outcomes["error"] == firmness.draws - firmness.counted > 0
    assert firmness.turned == 0
    full = Effort(8, 128, 16, 4)
    firmness = study([A, B], lambda a, b: 1.0, feasible=lambda a, b: a < 5.0, effort=full)
    assert (firmness.turned, firmness.not_run, firmness.status) == (0, ("a",), "not_shown")
    firmness = study([], lambda: 1.0)
    assert (firmness.status, firmness.draws) == ("not_shown", 0)


def test_margins_at_the_ends_are_medians_over_the_seeds():
    firmness = study([A, B], lambda a, b: 10.0 - a, noise=0.5)
    effect_a, effect_b = firmness.numbers
    low, high = effect_a.margins["limit"]
    assert (low, high) == (pytest.approx(15.0, abs=0.5), pytest.approx(5.0, abs=0.5))
    nominal = firmness.criteria[0].margin
    assert effect_a.effect("limit", nominal) > 4.0 > effect_b.effect("limit", nominal)


@pytest.mark.parametrize("limit", np.linspace(-4.5, 4.5, 7))
def test_firm_is_never_said_where_the_sample_contradicts_it(limit):
    outcome = study([A, B], lambda a, b: (limit - a) * (1.0 if limit >= 0.0 else -1.0))
    assert outcome.turned > 0
    assert outcome.status != "firm"


def several(first, second):
    """Study a stop that both margins of one number decide."""

    def judge(columns, seeds):
        rows = (columns[0].numbers - 100.0).tolist()
        return [one(value) for value in rows]

    def one(value):
        margins = {"first": first(value), "second": second(value)}
        statuses = {name: "pass" if margin >= 0.0 else "fail" for name, margin in margins.items()}
        return Drawn("fail" if "fail" in statuses.values() else "pass", statuses, margins)

    return FirmnessStudy([A], judge, effort=SMALL).run()


def test_an_outcome_turns_where_it_does_and_not_where_its_first_criterion_changes():
    # Both fail at the nominal value; from 101 N on one of them passes, the outcome only from 103 N on.
    [turn] = several(lambda a: a - 1.0, lambda a: a - 3.0).turned_by
    assert (turn.key, turn.side, turn.to) == ("a", "above", "pass")
    assert float(turn.stands_to.removesuffix(" N")) <= 103.0 <= float(turn.value.removesuffix(" N"))
    # The one that changes to pass decides nothing where the other one fails.
    [turn] = several(lambda a: 10.0, lambda a: 2.0 - a).turned_by
    assert (turn.criterion, turn.to) == ("second", "fail")


def test_a_part_of_the_range_without_a_test_is_no_place_where_a_verdict_turns():
    firmness = study([A], lambda a: 4.0 - a, validity=lambda a: abs(a - 2.0) - 0.9)
    [turn] = firmness.turned_by
    assert (turn.to, turn.criterion) == ("fail", "limit")
    assert float(turn.value.removesuffix(" N")) == pytest.approx(104.0, abs=0.15)


def test_the_share_of_calibrated_draws_is_that_of_the_draws_under_which_the_calibrating_stops_hold():
    def hold(columns):
        return (columns[0].numbers >= 100.0).tolist()

    # The stop passes for a >= 98: in all of the upper half of the range, in three fifths of the lower one.
    found = study([A, B], lambda a, b: a + 2.0, hold=hold)
    assert found.share == pytest.approx(0.7, abs=0.03)
    assert found.calibrated == CalibratedDraws(found.counted // 2, 1.0)
    opposed = study([A, B], lambda a, b: a + 2.0, hold=lambda columns: (columns[0].numbers < 100.0).tolist())
    assert opposed.calibrated.share == pytest.approx(0.4, abs=0.03)
    assert {each.calibrated for each in opposed.criteria} == {opposed.calibrated}
    never = study([A, B], lambda a, b: 1.0, hold=lambda columns: [False] * len(columns[0]))
    assert (never.calibrated, never.counted) == (CalibratedDraws(0, None), 256)
    assert study([A, B], lambda a, b: 1.0).calibrated is None


def of_readings(status, statuses, readings, validity=frozenset()):
    """Study what a stop is called, and its criteria and readings, at each value of one number."""

    def judge(columns, seeds):
        values = (columns[0].numbers - 100.0).tolist()
        return [
            Drawn(status(a), statuses(a), readings=readings, is_test=status(a) != "invalid") for a in values
        ]

    return FirmnessStudy([A], judge, validity=validity, effort=SMALL).run()


def passes(holds, otherwise="fail"):
    return "pass" if holds else otherwise


def test_another_reading_is_as_firm_as_itself_and_decides_no_outcome():
    """The reading comes first, and fails before the criterion does."""
    found = of_readings(
        lambda a: passes(a < 4.0),
        lambda a: {"slide read as depth": passes(a < 2.0), "slide": passes(a < 4.0)},
        {"slide read as depth": "slide"},
    )
    assert found.turned_by[0].criterion == "slide"
    shares = {each.criterion: each.share for each in found.criteria}
    assert shares["slide"] == pytest.approx(0.9, abs=0.02)
    assert shares["slide read as depth"] == pytest.approx(0.7, abs=0.02)


def test_a_reading_of_a_criterion_of_validity_counts_where_the_stop_is_no_test():
    found = of_readings(
        lambda a: passes(a < 0.5, "invalid"),
        lambda a: {"counts": passes(a < 0.5), "counts read as other": "pass"},
        {"counts read as other": "counts"},
        frozenset({"counts"}),
    )
    of_each = {each.criterion: (each.counted, each.turned) for each in found.criteria}
    assert of_each["counts read as other"] == (256, 0)
