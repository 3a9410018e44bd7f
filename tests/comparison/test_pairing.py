"""Which stops of two runs, or of two variants, are pairs, and by how much these differ."""

import json
import math
from dataclasses import replace

import numpy as np
import pytest
from hypothesis import given, strategies as st
from scipy import stats

from uictest.analysis.comparison import (
    Tolerances,
    compare_variants,
    comparison_document,
    comparison_html,
    comparison_json,
    variants_json,
)
from uictest.analysis.comparison.paired_stops import Draw, drawn_stops, paired_group
from uictest.analysis.comparison.runs import compare_runs
from uictest.judging.evaluation import EffectivePart, Parameter, effective_parts
from uictest.plans.scenario import load
from uictest.report import RunContent, document_lines
from uictest.running.campaign import run_cases

from .conftest import make_repeated

BEFORE = {1: 500.0, 2: 510.0, 3: 520.0}
AFTER = {1: 490.0, 2: 501.0, 3: 508.0}


def _compared(first, second):
    return compare_runs(RunContent("one", first), RunContent("other", second), Tolerances())


def _single(case, seed, distance, parameters):
    """The case of one stop, as a matrix over `seed` makes it."""
    seed_parameter = Parameter("seed", seed, "", str(seed), "user")
    own = {"id": f"slip[{','.join(parameters.values())},seed={seed}]", "repeats": None}
    own |= {"parameters": {**parameters, "seed": str(seed)}}
    own |= {"parts": {"scenario": EffectivePart("scenario", "", "", None, (seed_parameter,))}}
    return replace(case, **own, measures={**(case.measures or {}), "braking_distance_m": distance})


def test_the_stops_of_a_repeated_case_pair_between_two_runs():
    found = _compared([make_repeated(BEFORE)], [make_repeated(AFTER)])
    (group,) = found.paired.groups
    by_name = {each.quantity: each for each in group.differences}
    distance = by_name["braking_distance_m"]
    assert (group.name, group.seeds, distance.pairs) == ("slip", (1, 2, 3), 3)
    # Of -10, -9, -12 the mean is -31/3, the deviation sqrt(7/3), and t of 2 degrees of freedom 4.30265.
    assert distance.mean.value == pytest.approx(-31 / 3)
    assert distance.mean.high - distance.mean.value == pytest.approx(4.30265 * (7 / 9) ** 0.5, rel=1e-5)
    assert by_name["largest_valve_actuations"].is_zero
    assert "energy_residual" not in by_name


def test_the_largest_wheelset_of_each_stop_is_compared():
    def with_slides(*slides):
        case, stops = make_repeated(BEFORE), []
        for stop, pair in zip(case.repeats.stops, slides, strict=True):
            wheelsets = tuple({**stop.wheelsets[0], "maximum_slide": slide} for slide in pair)
            stops.append(replace(stop, wheelsets=wheelsets))
        return replace(case, repeats=replace(case.repeats, stops=tuple(stops)))

    before = with_slides((0.1, 0.4), (0.5, 0.2), (0.3, 0.3))
    after = with_slides((0.5, 0.1), (0.2, 0.7), (0.6, 0.0))
    found = _compared([before], [after]).paired
    slide = next(each for each in found.groups[0].differences if each.quantity == "largest_maximum_slide")
    # 0.5 - 0.4, 0.7 - 0.5, 0.6 - 0.3: wheelset by wheelset it would be another number.
    assert slide.mean.value == pytest.approx(0.2)


def test_cases_that_differ_in_their_seed_alone_are_one_group():
    def run(distances):
        return [
            _single(make_repeated({1: 0.0}), seed, distance + shift, {"rail.friction": friction})
            for friction, shift in (("0.07", 0.0), ("0.09", 100.0))
            for seed, distance in distances.items()
        ]

    found = _compared(run(BEFORE), run(AFTER)).paired
    names = [group.name for group in found.groups]
    assert names == ["slip[rail.friction=0.07]", "slip[rail.friction=0.09]"]
    assert [group.pairs for group in found.groups] == [3, 3]


def test_what_does_not_pair_is_named_with_its_reason():
    first = [make_repeated(BEFORE), make_repeated(BEFORE, "alone")]
    second = [make_repeated(AFTER, noise_key="00000001")]
    found = _compared(first, second)
    assert found.paired.groups == ()
    assert [each.name for each in found.paired.not_paired] == ["slip", "alone"]
    other_noise, alone = found.answer.conditions
    assert (alone.standing, alone.remark) == ("not comparable", "only one has it")
    assert other_noise.remark.startswith("the stops met other noise: ")


def test_single_stops_are_compared_without_an_interval_and_shown_to_differ_by_more_than_a_percent():
    def standing(distance):
        sides = ([_single(make_repeated({1: 0.0}), 1, each, {})] for each in (500.0, distance))
        found = _compared(*sides)
        (group,) = found.paired.groups
        assert (group.pairs, math.isnan(group.differences[0].mean.low)) == (1, True)
        assert "no intervals" in found.answer.basis
        return found.answer.standing

    assert [standing(each) for each in (490.0, 496.0, 510.0)] == ["better", "no difference shown", "worse"]
    same = [make_repeated(BEFORE)]
    lines = list(document_lines(comparison_document(_compared(same, same)), None))
    assert lines[0] == "other against one: no difference shown."
    assert lines[1] == "No verdict turned."


def test_terminal_json_and_page_have_the_method_and_the_numbers():
    found = _compared([make_repeated(BEFORE)], [make_repeated({**AFTER, 4: 500.0})])
    lines = list(document_lines(comparison_document(found, every=True), None))
    assert lines[0] == "other against one: better, braking distance 10.33 m shorter (±3.8 m, 3 pairs)."
    assert any("Student's t" in line for line in lines)
    paired = lines.index("slip: 3 pairs, seeds 1..3; without a partner: 0 of one, 1 of other")
    row = next(line for line in lines[paired:] if line.startswith("braking_distance_m")).split("  ")
    assert [cell.strip() for cell in row if cell.strip()] == [
        *("braking_distance_m", "510", "499.7", "-10.33", "-2.03", "-14.13 .. -6.539"),
        *("-10", "-", "0 of 3", "m"),
    ]
    document = json.loads(comparison_json(found))
    assert (document["kind"], document["agrees"]) == ("comparison", False)
    form = document["paired"]["groups"][0]
    assert (form["name"], form["pairs"], form["unpaired"]) == ("slip", 3, [0, 1])
    distance = next(each for each in form["differences"] if each["quantity"] == "braking_distance_m")
    assert distance["median"]["low"] is None
    assert distance["mean"]["method"] == "mean"
    html = comparison_html(found)
    assert "-14.13 .. -6.539" in html
    assert "Student" in html


def test_variants_of_a_run_are_compared_with_the_first():
    def case(controller, friction, distances):
        parameters = {"rail.friction": friction, "controller": controller}
        case_id = f"slip[friction={friction},controller={controller}]"
        return make_repeated(distances, case_id, f"000000{friction[-2:]}", parameters=parameters)

    cases = [case("a", "0.07", BEFORE), case("a", "0.09", BEFORE), case("b", "0.07", AFTER)]
    cases += [case("c", "0.09", AFTER), make_repeated(BEFORE, "plain")]
    found = compare_variants(RunContent("run", cases), ["controller"], Tolerances())
    assert [(each.first, each.second) for each in found] == [
        ("controller=a", "controller=b"),
        ("controller=a", "controller=c"),
    ]
    groups = [group.name for each in found for group in each.paired.groups]
    assert groups == ["slip[rail.friction=0.07]", "slip[rail.friction=0.09]"]
    assert [each.answer.standing for each in found] == ["better", "better"]
    assert found[0].paired.not_paired[0].reason == "only controller=a has it"
    lines = list(document_lines(comparison_document(*found), None))
    assert sum(line.startswith("controller=b against controller=a: better") for line in lines) == 1
    document = json.loads(variants_json("run", found))
    assert (document["kind"], len(document["variants"])) == ("variants", 2)
    assert "slip[rail.friction=0.07]" in comparison_html(*found, run="run")


def test_keys_that_tell_no_variants_apart_are_refused():
    run = RunContent("run", [make_repeated(BEFORE, parameters={"controller": "a"})])
    with pytest.raises(ValueError, match="did you mean 'controller'"):
        compare_variants(run, ["controler"], Tolerances())
    with pytest.raises(ValueError, match="one variant only, controller=a"):
        compare_variants(run, ["controller"], Tolerances())


NUMBERS = st.floats(-1e6, 1e6, allow_nan=False)


def _stops(values, first_seed=0, key="ab"):
    return {Draw("", key, first_seed + n): {"locked_time_s": value} for n, value in enumerate(values)}


def _difference(first, second):
    (difference,) = paired_group("x", _stops(first), _stops(second)).differences
    return difference


def test_the_interval_of_the_mean_is_that_of_the_paired_t_test():
    draws = np.random.default_rng(1).normal(size=(2, 12))
    difference = _difference(draws[0].tolist(), (draws[1] + 3.0).tolist())
    test = stats.ttest_rel(draws[1] + 3.0, draws[0]).confidence_interval(0.95)
    assert (difference.mean.low, difference.mean.high) == pytest.approx((test.low, test.high))
    assert difference.mean.value == pytest.approx(np.mean(draws[1] + 3.0 - draws[0]))


def test_the_median_of_ten_lies_between_the_second_and_the_ninth_difference():
    differences = [5.0, -1.0, 2.0, 8.0, 3.0, 13.0, 21.0, 34.0, 0.5, 1.5]
    difference = _difference([100.0] * 10, [100.0 + each for each in differences])
    ranked = sorted(differences)
    assert (difference.median.low, difference.median.high) == (ranked[1], ranked[8])
    assert difference.median.value == 4.0
    assert (difference.first, difference.second) == (100.0, 100.0 + difference.mean.value)
    assert (difference.larger, difference.smaller, difference.unit) == (9, 1, "s")


def test_both_intervals_contain_the_true_difference_as_often_as_they_say():
    generator, trials = np.random.default_rng(7), 400
    inside = np.zeros(2)
    for _ in range(trials):
        noise = generator.normal(size=20)
        own = generator.normal(scale=0.3, size=(2, 20))
        difference = _difference((noise + own[0]).tolist(), (noise + own[1] + 1.0).tolist())
        inside += [each.low <= 1.0 <= each.high for each in (difference.mean, difference.median)]
    assert (inside / trials > 0.92).all()
    assert inside[0] / trials < 0.98


@given(st.lists(st.tuples(NUMBERS, NUMBERS), min_size=2, max_size=20))
def test_sides_exchanged_the_difference_changes_its_sign(pairs):
    first, second = ([pair[place] for pair in pairs] for place in (0, 1))
    there, back = _difference(first, second), _difference(second, first)
    assert there.mean.value == -back.mean.value
    assert there.median.value == -back.median.value
    assert (there.larger, there.smaller) == (back.smaller, back.larger)
    assert there.mean.low == pytest.approx(-back.mean.high, nan_ok=True)


def test_differences_that_are_all_alike_have_no_interval_of_their_mean():
    difference = _difference([1.0] * 8, [1.5] * 8)
    assert math.isnan(difference.mean.low)
    assert (difference.median.low, difference.median.high) == (0.5, 0.5)
    same = _difference([2.0, 3.0], [2.0, 3.0])
    assert same.is_zero
    assert not difference.is_zero


def test_stops_pair_by_seed_and_not_by_place():
    first = {Draw("", "ab", seed): {"locked_time_s": float(seed)} for seed in (1, 2, 3)}
    second = {Draw("", "ab", seed): {"locked_time_s": 10.0 + seed} for seed in (4, 3, 2)}
    group = paired_group("x", first, second)
    (difference,) = group.differences
    assert (difference.mean.value, difference.mean.smallest) == (10.0, 10.0)
    assert (group.seeds, group.pairs, group.unpaired) == ((2, 3), 2, (1, 1))


def test_a_pair_without_a_number_is_left_out_and_counted():
    difference = _difference([1.0, math.nan, 3.0, 4.0], [2.0, 3.0, 5.0, math.nan])
    assert (difference.pairs, difference.missing, difference.mean.value) == (2, 2, 1.5)
    assert paired_group("x", _stops([1.0, math.nan]), _stops([2.0, 2.0])).differences == ()


def test_stops_under_other_conditions_that_met_the_same_noise_count_as_one_draw():
    draws = [Draw(name, "ab", seed) for name in ("wet", "cleaning") for seed in (1, 2, 3)]
    sides = ({draw: {"locked_time_s": shift + draw.seed} for draw in draws} for shift in (0.0, 1.0))
    group = paired_group("x", *sides)
    assert (group.pairs, group.draws) == (6, 3)


@pytest.mark.parametrize(("random_rail", "draws"), [(False, 6), (True, 3)])
def test_stops_on_random_rails_are_one_draw_for_each_seed(random_rail, draws):
    """Seed and place alone decide the rail, so that it is the same one under other sensor noise."""
    keys = [(key, seed) for key in ("ab", "cd") for seed in (1, 2, 3)]
    sides = (
        {Draw("", key, seed, varies): {"locked_time_s": shift + seed} for key, seed in keys}
        for shift, varies in ((0.0, False), (1.0, random_rail))
    )
    group = paired_group("x", *sides)
    assert (group.pairs, group.draws) == (6, draws)


@pytest.mark.parametrize(
    ("rail", "varies"),
    [
        ("rail.condition=wet", False),
        ("rail.condition=wet-varied", True),
        ("rail.variation={spread: 9 %, correlation_length: 9 m, left_right_correlation: 0}", True),
        ("rail.variation={spread: 0 %, correlation_length: 9 m, left_right_correlation: 0}", False),
    ],
)
def test_a_result_tells_whether_its_rail_varies_at_random(tmp_path, rail, varies):
    path = tmp_path / "stop.yaml"
    path.write_text("schema: uictest/scenario/1\nname: stop\ninitial_speed: 9 km/h\n", "utf-8")
    [case] = load([path], [rail])
    [(draw, _)] = drawn_stops(replace(run_cases([case]).results[0], parts=effective_parts(case.scenario)))
    assert draw.random_rail == varies


FIRST, SECOND = (f"the noise of the {side} side is not known" for side in ("first", "second"))


@pytest.mark.parametrize(
    ("first", "second", "reason"),
    [
        (_stops([1.0, 2.0]), _stops([1.0, 2.0], key="cd"), "other noise"),
        (_stops([1.0, 2.0]), _stops([1.0, 2.0], 10), "no seed is on both sides: seeds 0, 1; seeds 10, 11"),
        (_stops([1.0, 2.0]), _stops([1.0, 2.0], 1), "1 pair, 2 are needed"),
        (_stops([1.0, 2.0], key=""), _stops([1.0, 2.0]), f"{FIRST}: its stops are recorded"),
        (_stops([1.0, 2.0]), _stops([1.0, 2.0], key=""), SECOND),
        (_stops([1.0, 2.0], key=""), _stops([1.0, 2.0], key=""), FIRST.removeprefix("the ")),
        ({Draw("", "ab", None): {}}, {Draw("", "ab", None): {}, **_stops([1.0])}, "no known seed; seed 0"),
        (_stops([]), _stops([1.0, 2.0]), "no stop of the first side has measures"),
    ],
)
def test_stops_that_did_not_meet_the_same_noise_are_refused(first, second, reason):
    with pytest.raises(ValueError, match=reason):
        paired_group("x", first, second)
