"""What the measures of faults say of a stop, and when they have no value."""

import math
from types import SimpleNamespace

from uictest.core.measures import MEASURES


def value(name, stop, wheelsets):
    records = [SimpleNamespace(**each) for each in wheelsets]
    return MEASURES[name].read(SimpleNamespace(**stop), records, {})


FAULT = {"fault_time": 3.0, "reference_excess": 1.5}
NO_FAULT = {"fault_time": math.nan, "reference_excess": math.nan}
LOCKS = [
    {"faulty": 0.0, "longest_lock": 0.4, "longest_release": math.nan},
    {"faulty": 1.0, "longest_lock": 9.0, "longest_release": 2.5},
]


def test_the_locks_of_sound_wheelsets_the_longest_release_and_the_excess_of_a_faulty_stop():
    assert value("longest_lock_of_sound_wheelsets", FAULT, LOCKS).values == (0.4,)
    assert value("longest_lock_of_sound_wheelsets", FAULT, LOCKS[1:]).unavailable_reason
    assert value("longest_lock_of_sound_wheelsets", NO_FAULT, LOCKS).unavailable_reason
    assert value("longest_release", FAULT, LOCKS).values == (2.5,)
    assert value("longest_release", FAULT, LOCKS[:1]).unavailable_reason
    assert value("reference_excess", FAULT, LOCKS).values == (1.5,)
    assert "no fault" in value("reference_excess", NO_FAULT, LOCKS).unavailable_reason
    without = {"fault_time": 3.0, "reference_excess": math.nan}
    assert "no reference speed" in value("reference_excess", without, LOCKS).unavailable_reason
