"""Measures of the reaction to faults, fed sample by sample."""

import math
from types import SimpleNamespace

import pytest

from uictest.core.measures import observe_reaction, observe_reference

CYCLE = 0.01
DEFINITION = SimpleNamespace(moving_speed=2.8, developed_time=2.0, released_share=0.2)


def train(cycle, speed=20.0):
    """The measures of a stop after the sample of a cycle."""
    return SimpleNamespace(
        previous_time=(cycle - 1) * CYCLE,
        end_time=cycle * CYCLE,
        previous_speed=speed,
        end_speed=speed,
        fault_time=math.nan,
        reference_excess=math.nan,
    )


def released(forces, faulty, first=300):
    """The longest release of a wheelset with these forces, beside one of 10 kN."""
    wheelset = SimpleNamespace(faulty=0.0, release=0.0, longest_release=math.nan)
    for cycle, (force, fault) in enumerate(zip(forces, faulty, strict=True), start=first):
        observe_reaction(wheelset, train(cycle), DEFINITION, fault, fault, force, 10e3)
    return wheelset.longest_release


def test_the_longest_stretch_without_force_counts_while_the_sensor_is_faulty_and_the_brake_developed():
    forces = [1e3] * 50 + [3e3] * 10 + [1e3] * 120 + [3e3] * 10
    assert released(forces, [1.0] * len(forces)) == pytest.approx(1.2)
    faulty = [0.0] * 50 + [1.0] * 30 + [0.0] * 40
    assert released([0.0] * len(faulty), faulty) == pytest.approx(0.3)
    assert math.isnan(released([0.0] * 50, [0.0] * 50))
    assert released([0.0] * 210, [1.0] * 210, first=0) == pytest.approx(0.1, abs=0.011)


def test_the_largest_excess_counts_of_a_train_that_moves_and_a_controller_with_an_estimate():
    measures = train(1)
    for excess in (-3.0, 0.5, 2.0, math.nan, 1.0):
        observe_reference(measures, DEFINITION, measures.previous_speed + excess)
    assert measures.reference_excess == 2.0
    slow = train(1, speed=2.0)
    observe_reference(slow, DEFINITION, 30.0)
    assert math.isnan(slow.reference_excess)
    assert math.isnan(slow.fault_time)
    measures = train(5)
    observe_reference(measures, DEFINITION, math.nan)
    assert math.isnan(measures.reference_excess)
    assert measures.fault_time == pytest.approx(4 * CYCLE)
