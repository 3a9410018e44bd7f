"""Which controller is better under a rail law, and what a rail keeps from stop to stop."""

import pytest

import uictest
from studies.experiments.rail_laws import Condition, turned
from studies.used_rail import loss_per_metre, used_rail
from uictest import CaseResult
from uictest.plans.scenario import PASS

LAYER = {
    "rig.compensation": "thermal",
    "rail.condition": "leaf-layer",
    "rail.friction": "0.05",
    "initial_speed": "40 km/h",
}


def condition(law, threshold, slip_band):
    def stops(distances):
        return [
            CaseResult("stop", "", {}, PASS, "pass", measures={"braking_distance_m": each}, wheelsets=())
            for each in distances
        ]

    return Condition(law, 0.06, 100, {"threshold": stops(threshold), "slip-band": stops(slip_band)})


def test_a_controller_is_better_where_all_seeds_agree():
    rows = [((99.0, 100.0), "slip-band"), ((102.0, 102.0), "threshold"), ((99.0, 102.0), "")]
    for slip_band, better in rows:
        assert condition("wet", (100.0, 101.0), slip_band).better("braking_distance_m") == better
    assert condition("wet", (100.0,), (float("nan"),)).better("braking_distance_m") == ""


def test_a_law_turns_a_condition_only_if_both_rails_decide_it():
    wet = condition("wet", (100.0,), (110.0,))
    other, same = condition("other", (100.0,), (90.0,)), condition("same", (100.0,), (105.0,))
    open_ = condition("open", (100.0, 100.0), (90.0, 110.0))
    rails = [wet, other, same, open_]
    assert [len(turned(rails, law)) for law in ("other", "same", "open")] == [1, 0, 0]


@pytest.mark.parametrize("law", ["leaf-layer", "wet-cleaning"])
def test_each_stop_finds_the_rail_that_the_losses_of_all_before_have_left(stop_runner, law):
    """The friction that is reported is the one that the first wheelset of the simulated stop meets."""
    changes = {**LAYER, "rail.condition": law}
    used = used_rail(stop_runner, "slip-120", changes, seed=3)
    assert used.found[0] == 0.05
    assert list(used.distances) == sorted(used.distances, reverse=True)
    losses = [loss_per_metre(stop) for stop in used.stops]
    assert list(used.spent) == pytest.approx([sum(losses[:k]) for k in range(len(losses))])
    spent = {"rail.condition.cleaning.spent": f"{used.spent[2]} J/m"}
    (case,) = stop_runner.cases("slip-120", {**changes, **spent})
    assert uictest.simulate(case)["friction_1"][0] == pytest.approx(used.found[2], rel=1e-6)
