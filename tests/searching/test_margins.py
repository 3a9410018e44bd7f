"""The margin that guides a search: its sign is the verdict's, and it falls on the way to a lock."""

import itertools
import math
from dataclasses import replace

import pytest
from hypothesis import given, strategies as st

from uictest import rig
from uictest.core.measures import MEASURES, WHEELSET_COLUMNS
from uictest.judging.evaluation import Bounds, CaseResult, Verdict, guiding_margin
from uictest.plans import library, scenario
from uictest.plans.scenario.yaml import parse_quantity
from uictest.plans.sweeps import with_values
from uictest.report.content import worst_first
from uictest.running.chunked import ManyStops, PlannedCase


def result(
    value, *, slide=0.4, measure="longest_lock", upper=1.0, lower=None, layer="requirement", **changes
):
    bounds = Bounds(lower, upper, unit=MEASURES[measure].unit)
    status = "pass" if bounds.hold(value) else "fail"
    verdict = Verdict(
        "c", layer, value, bounds.unit, lower, upper, bounds.margin(value), status, "", measure=measure
    )
    wheelset = dict.fromkeys(WHEELSET_COLUMNS, 0.0) | {"maximum_slide": slide}
    others = changes.pop("others", ())
    return CaseResult(
        id="x",
        scenario="x.yaml",
        parameters={},
        expect=scenario.PASS,
        outcome=status,
        reason="",
        criteria=(verdict, *others),
        measures={},
        wheelsets=(wheelset,),
    )


times = st.floats(0.0, 20.0)
slides = st.floats(0.0, 1.2)


@given(times, slides)
def test_its_sign_is_the_status(value, slide):
    assert (guiding_margin(result(value, slide=slide), "c") < 0.0) == (value > 1.0)


@given(times, times, slides)
def test_more_is_never_better(one, other, slide):
    less, more = sorted((one, other))
    margins = [guiding_margin(result(value, slide=slide), "c") for value in (less, more)]
    assert margins[0] >= margins[1]


@given(slides, slides)
def test_before_a_lock_a_deeper_slide_is_nearer(one, other):
    less, more = sorted((min(one, 1.0), min(other, 1.0)))
    margins = [guiding_margin(result(0.0, slide=slide), "c") for slide in (less, more)]
    assert 2.0 >= margins[0] >= margins[1] >= 1.0
    assert less == more or margins[0] > margins[1] or more - less < 1e-15


@pytest.mark.parametrize(
    ("value", "changes", "margin"),
    [
        (0.0, {"slide": 1.0}, 1.0),  # a lock begins
        (0.25, {"slide": 1.0}, 0.75),
        (1.0, {"slide": 1.0}, 0.0),  # at its limit it passes
        (3.0, {"slide": 1.0}, -2.0),
        (300.0, {"measure": "contact_energy", "upper": 1500.0}, 0.8),
        (0.5, {"measure": "sliding_share", "upper": None, "lower": 1.0}, -0.5),
        (3.0, {"measure": "false_reports", "upper": 0.0}, -3.0),  # no limit to scale by
        (0.0, {"measure": "false_reports", "upper": 0.0, "slide": 0.75}, 0.25),  # nearer the deeper it is
        (math.inf, {"measure": "braking_distance", "upper": 800.0}, -math.inf),
    ],
)
def test_margins(value, changes, margin):
    assert guiding_margin(result(value, **changes), "c") == pytest.approx(margin)


def test_nothing_that_was_not_judged_guides():
    assert math.isnan(guiding_margin(result(0.0), "other"))
    check = Verdict("balance", "rig", 1.0, "1", None, 0.1, -0.9, "fail", "")
    assert math.isnan(guiding_margin(result(0.0, others=(check,)), "c"))


def test_a_strict_bound_that_is_met_exactly_fails():
    verdict = Verdict("c", "requirement", 1.0, "s", None, 1.0, 0.0, "fail", "", measure="longest_lock")
    assert guiding_margin(replace(result(1.0), criteria=(verdict,)), "c") < 0.0


def test_it_has_no_plateau_where_friction_falls_until_a_wheel_locks():
    [case] = scenario.load([library.scenarios()["slip-120"]], ["rig.wsp=bypassed"])
    frictions = [f"{0.30 - 0.01 * k:.2f}" for k in range(16)]
    stops = [
        PlannedCase(
            case.changed(
                lambda own, text=text: with_values(own, {"rail.friction": parse_quantity(text, "number")})
            )
        )
        for text in frictions
    ]
    results, _ = ManyStops((), rig.run_block, noise_of=case).results(stops)
    margins = [guiding_margin(each, "locked-wheels") for each in results]
    assert margins[0] > 1.0 > 0.0 > margins[-1]
    falling = [before > after for before, after in itertools.pairwise(margins)]
    assert all(falling), margins


def test_of_stops_without_a_lock_the_one_with_the_largest_slide_is_nearest_to_failing():
    made = {slide: replace(result(0.0, slide=slide), id=str(slide)) for slide in (0.1, 0.9, 0.5)}
    assert [each.id for each in worst_first(made.values())] == ["0.9", "0.5", "0.1"]
