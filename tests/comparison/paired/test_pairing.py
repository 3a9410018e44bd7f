"""Which stops of two runs, or of two variants, are pairs."""

import dataclasses
import json

import pytest

from uictest.analysis.comparison import (
    Tolerances,
    compare_runs,
    compare_variants,
    comparison_document,
    comparison_html,
    comparison_json,
    variants_document,
    variants_html,
    variants_json,
)
from uictest.judging.evaluation import EffectivePart, Parameter
from uictest.report import RunContent, document_lines

from ..conftest import make_repeated

BEFORE = {1: 500.0, 2: 510.0, 3: 520.0}
AFTER = {1: 490.0, 2: 501.0, 3: 508.0}


def _compared(first, second):
    return compare_runs(RunContent("one", first), RunContent("other", second), Tolerances())


def _single(case, seed, distance, parameters):
    """The case of one stop, as a matrix over `seed` makes it."""
    seed_parameter = Parameter("seed", seed, "", str(seed), "user")
    part = EffectivePart("scenario", "", "", None, (seed_parameter,))
    return dataclasses.replace(
        case,
        id=f"slip[{','.join(parameters.values())},seed={seed}]",
        parameters={**parameters, "seed": str(seed)},
        measures={**(case.measures or {}), "braking_distance_m": distance},
        repeats=None,
        parts={"scenario": part},
    )


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
            stops.append(dataclasses.replace(stop, wheelsets=wheelsets))
        return dataclasses.replace(case, repeats=dataclasses.replace(case.repeats, stops=tuple(stops)))

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
    assert [each.name for each in found.paired.not_paired] == ["alone", "slip"]
    lines = document_lines(comparison_document(found), None)
    alone, other_noise = (line for line in lines if line.startswith("not paired"))
    assert alone == "not paired: alone: only one has it"
    assert other_noise.startswith("not paired: slip: the stops met other noise: ")


def test_single_stops_and_runs_that_are_the_same_say_nothing_of_pairs():
    alone = _single(make_repeated({1: 0.0}), 1, 500.0, {})
    found = _compared([alone], [_single(make_repeated({1: 0.0}), 1, 490.0, {})])
    assert (found.paired.groups, found.paired.not_paired) == ((), ())
    same = [make_repeated(BEFORE)]
    assert list(document_lines(comparison_document(_compared(same, same)), None)) == []


def test_terminal_json_and_page_have_the_method_and_the_numbers():
    found = _compared([make_repeated(BEFORE)], [make_repeated({**AFTER, 4: 500.0})])
    lines = list(document_lines(comparison_document(found), None))
    paired = lines.index("paired: slip: 3 pairs, seeds 1..3; without a partner: 0 of one, 1 of other")
    assert "Student's t" in lines[paired - 1]
    assert "order statistics" in lines[paired - 1]
    row = lines[paired + 2].split("  ")
    assert [cell.strip() for cell in row if cell.strip()] == [
        *("braking_distance_m", "510", "501", "-10.333", "-2.03", "-14.128 .. -6.5388"),
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
    assert "-14.128 .. -6.5388" in html
    assert "Student" in html


def test_variants_of_a_run_are_compared_with_the_first():
    def case(controller, friction, distances):
        parameters = {"rail.friction": friction, "controller": controller}
        case_id = f"slip[friction={friction},controller={controller}]"
        return make_repeated(distances, case_id, f"000000{friction[-2:]}", parameters=parameters)

    cases = [case("a", "0.07", BEFORE), case("a", "0.09", BEFORE), case("b", "0.07", AFTER)]
    cases += [case("c", "0.09", AFTER), make_repeated(BEFORE, "plain")]
    found = compare_variants(RunContent("run", cases), ["controller"])
    assert [(each.first, each.second) for each in found] == [
        ("controller=a", "controller=b"),
        ("controller=a", "controller=c"),
    ]
    groups = [group.name for each in found for group in each.groups]
    assert groups == ["slip[rail.friction=0.07]", "slip[rail.friction=0.09]"]
    assert found[0].not_paired[0].reason == "only controller=a has it"
    assert "controller=b against controller=a" in list(document_lines(variants_document(found), None))
    document = json.loads(variants_json("run", found))
    assert (document["kind"], len(document["variants"])) == ("variants", 2)
    assert "slip[rail.friction=0.07]" in variants_html("run", found)


def test_keys_that_tell_no_variants_apart_are_refused():
    run = RunContent("run", [make_repeated(BEFORE, parameters={"controller": "a"})])
    with pytest.raises(ValueError, match="did you mean 'controller'"):
        compare_variants(run, ["controler"])
    with pytest.raises(ValueError, match="one variant only, controller=a"):
        compare_variants(run, ["controller"])
