"""What each check reads from answers that are written down: no controller, only what one might answer."""

from types import SimpleNamespace
from typing import cast

import numpy as np
import pytest

from uictest.controllers import OUTPUTS
from uictest.rig import Driven
from uictest.selftest import conformance
from uictest.selftest.conformance import bench as situations
from uictest.selftest.conformance.bench import ROLLS_AGAIN, SLIDE_BEGINS, Answers, Bench

CYCLE = 0.05
NEVER = float("inf")


def nothing(outputs, time):
    """Fill, always: no magnet is energised."""


SITUATIONS = {
    "motor_slides": ("motor", situations.motor_slides),
    "good_rail": ("rolls", situations.good_rail),
    "one_slides": ("slides", situations.one_slides),
    "sensor_lost": ("lost", situations.sensor_lost),
}


def vents(wheelset, begin, end):
    """Vent one wheelset from one time to another."""

    def write(outputs, time):
        for magnet in ("hold", "vent"):
            outputs[magnet][(time > begin - 1e-6) & (time < end - 1e-6), wheelset] = 1

    return write


def reduces(wheelset, begin, end):
    """Take the dynamic brake off one wheelset from one time to another."""

    def write(outputs, time):
        outputs["dynamic_reduction"][(time > begin - 1e-6) & (time < end - 1e-6), wheelset] = 0.5

    return write


def gives(field, index, value):
    """Give one value of an output."""

    def write(outputs, time):
        outputs[field][index] = value

    return write


def observed(check_id, write, only="", wheelset=0):
    """Observe answers that are `write` in one situation, for one wheelset, and to fill in all others."""

    def answers(kind, situation, which=0):
        outputs = np.zeros(len(situation.time), OUTPUTS)
        outputs["reference_speed"] = situation.train_speed
        (write if (kind, which) == (only, wheelset) else nothing)(outputs, situation.time)
        return Answers(situation, (Driven(outputs, np.full(len(outputs), 0.2 * CYCLE)),))

    def asked(kind, situation):
        return lambda *which: answers(kind, situation(CYCLE, *which), *which)

    def locked(*which):
        return answers("locked", situations.locked(CYCLE, which), which[0] if len(which) == 1 else -1)

    bench = SimpleNamespace(
        contract=2,
        subject=SimpleNamespace(config=SimpleNamespace(cycle_time=CYCLE)),
        locked=locked,
        **{name: asked(*of) for name, of in SITUATIONS.items()},
    )
    bench.every_situation = lambda: [bench.good_rail(), bench.one_slides(0)]
    check = next(each for each in conformance.CHECKS if each.id == check_id)
    return check.observe(cast(Bench, bench))


@pytest.mark.parametrize(
    ("hold", "vent", "illegal"),
    [(0, 0, 0), (1, 0, 0), (1, 1, 0), (0, 1, 1), (2, 0, 1), (-1, 0, 1), (2, 2, 1), (1, -1, 1)],
)
def test_a_valve_has_three_commands(hold, vent, illegal):
    """Fill, hold and vent; each other pair counts once."""

    def write(outputs, time):
        outputs["hold"][7, 2], outputs["vent"][7, 2] = hold, vent

    assert observed("legal-commands", write, "rolls").value == illegal


@pytest.mark.parametrize(
    ("field", "index", "value", "illegal"),
    [
        ("dynamic_reduction", (7, 2), 1.0, 0),
        ("dynamic_reduction", (7, 2), 1.01, 1),
        ("dynamic_reduction", (7, 2), float("nan"), 1),
        ("sand_request", (7, 2), 1, 0),
        ("sand_request", (7, 2), 2, 1),
        ("track_brake_request", 7, -1, 1),
    ],
)
def test_reductions_and_requests_have_their_range(field, index, value, illegal):
    assert observed("legal-commands", gives(field, index, value), "rolls").value == illegal


def test_cycles_in_which_any_wheelset_is_held_on_a_good_rail_are_counted():
    def write(outputs, time):
        outputs["hold"][20:23, 1] = 1
        outputs["hold"][22:24, 3] = 1

    found = observed("keeps-brake", write, "rolls")
    assert found.value == 4
    assert found.words.endswith("; first at 1.00 s")


@pytest.mark.parametrize(
    ("begin", "end", "value"),
    [
        (SLIDE_BEGINS, 3.0, 0.0),
        (SLIDE_BEGINS + 0.4, 3.0, 0.4),
        (ROLLS_AGAIN - CYCLE, 7.0, ROLLS_AGAIN - CYCLE - SLIDE_BEGINS),
        (1.0, SLIDE_BEGINS, NEVER),
        (ROLLS_AGAIN, 8.0, NEVER),
    ],
)
def test_a_slide_is_answered_by_the_first_vent_while_it_lasts(begin, end, value):
    """Wheelset 3 is asked alone: the others never vent, which is longer than any time."""
    found = observed("vents-sliding", vents(2, begin, end), "slides", 2)
    third = "never" if value == NEVER else f"{value:.2f} s"
    assert found.words.endswith(f"wheelsets 1 to 4: never, never, {third}, never")
    assert found.value == NEVER


@pytest.mark.parametrize(("vented", "found"), [(3.2, "0.50 s"), (2.5, "never"), (2.2, "never")])
def test_a_motor_is_reduced_before_its_valve_vents(vented, found):
    """Wheelset 2 is asked alone; what happens at once does not come first."""

    def write(outputs, time):
        reduces(1, SLIDE_BEGINS + 0.5, 7.0)(outputs, time)
        vents(1, vented, 7.0)(outputs, time)

    observation = observed("motor-first", write, "motor", 1)
    assert observation.words.endswith(f"wheelsets 1 to 4: never, {found}, never, never")
    assert observation.value == NEVER


def test_motors_of_the_other_bogie_and_valves_of_other_wheelsets_are_left_alone():
    assert observed("spares-motors", reduces(1, 3.0, 3.5), "motor", 0).value == 0
    assert observed("spares-motors", reduces(1, 3.0, 3.5), "motor", 2).value == 10

    def vents_all(outputs, time):
        for wheelset in range(4):
            vents(wheelset, SLIDE_BEGINS + 1.0, SLIDE_BEGINS + 1.5)(outputs, time)

    assert observed("spares-rolling", vents_all, "slides", 1).value == 10
    assert observed("spares-rolling", vents(1, 3.0, 3.5), "slides", 1).value == 0


def test_a_motor_is_given_back_with_the_last_reduction_after_the_wheelset_rolls():
    last, later = (observed("motor-back", reduces(0, 3.0, end), "motor").value for end in (9.0, 12.0))
    assert last is not None
    assert later == pytest.approx(last + 3.0)
    assert 1.0 < last < 2.0
    assert observed("motor-back", reduces(0, 3.0, 99.0), "motor").value == NEVER
    assert observed("motor-back", nothing).value == 0.0


def test_the_brake_is_given_back_with_the_last_command_after_the_wheelset_rolls():
    """It rolls at the train's speed again some 1.6 s after its slide ends."""
    situation = situations.one_slides(CYCLE, 0)
    speed, time = situation.inputs["wheel_speed"][:, 0], situation.time
    rolls = time[(time > ROLLS_AGAIN) & (speed > 0.99 * situation.train_speed)][0]
    assert rolls == pytest.approx(7.6, abs=0.2)
    for last in (9.0, 12.0):
        found = observed("gives-back", vents(0, 3.0, last), "slides")
        assert found.value == pytest.approx(last - CYCLE - rolls)
    assert observed("gives-back", vents(0, 3.0, 5.0), "slides").value == 0.0
    assert observed("gives-back", nothing).value == 0.0
    assert observed("gives-back", vents(0, 3.0, 99.0), "slides").value == NEVER


@pytest.mark.parametrize(("check_id", "situation"), [("ends-vents", "locked"), ("lost-sensor", "lost")])
def test_the_longest_vent_without_a_pause_counts(check_id, situation):
    def write(outputs, time):
        vents(1, 2.0, 5.0)(outputs, time)
        vents(1, 6.0, 8.0)(outputs, time)
        vents(2, 8.0, 9.0)(outputs, time)

    assert observed(check_id, write, situation, 3).value == pytest.approx(3.0)


def test_vents_of_a_train_that_is_locked_altogether_count_as_well():
    found = observed("ends-vents", vents(1, 2.0, 5.0), "locked", -1)
    assert found.value == pytest.approx(3.0)
    assert found.words.endswith("all together: 3.00 s")


@pytest.mark.parametrize("error", [-2.5, 2.5])
def test_the_largest_error_of_the_reference_speed_counts_where_there_is_one(error):
    def write(outputs, time):
        outputs["reference_speed"][30] += error
        outputs["reference_speed"][40] = np.nan

    assert observed("reference-speed", write, "slides", 3).value == pytest.approx(2.5)


def test_the_time_of_an_answer_is_a_share_of_the_cycle():
    found = observed("in-time", nothing)
    assert found.value == pytest.approx(20.0)
    assert "answers within 10.0 ms, the longest 10.0 ms" in found.words
