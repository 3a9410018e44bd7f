import math

import numpy as np
import pytest

from uictest.core.measures.catalogue.deceleration import initial_adhesion

G = 9.80665


def test_an_even_deceleration_is_found_whatever_the_first_phase_and_speed_is_linear_between_seconds(
    sliding_stop, stop
):
    for duration in (0.3, 1.0, 2.75, 10.0):
        (value,) = initial_adhesion(sliding_stop(0.07 * G), duration).values
        assert value == pytest.approx(0.07 * G, rel=1e-12)
    speed = [30.0, 29.0, 27.0] + [20.0] * 8
    (value,) = initial_adhesion(sliding_stop(speed_after_sliding=speed), 1.5).values
    assert value == pytest.approx((30.0 - 28.0) / 1.5)
    assert "no wheelset slid" in initial_adhesion(stop(), 3.0).unavailable_reason


@pytest.mark.parametrize("end", [math.nan, 0.0])
def test_a_stop_over_within_the_first_phase_supports_none(sliding_stop, end):
    # Counting the time after standstill would make a short last slide look like a slippery rail.
    speed = np.array([2.0, 1.0, end, *[end] * 8])
    measures = sliding_stop(speed_after_sliding=speed)
    assert initial_adhesion(measures, 1.0).values == (1.0,)
    assert "ended within 1.5 s" in initial_adhesion(measures, 1.5).unavailable_reason
    assert "ended within 3 s" in initial_adhesion(measures, 3.0).unavailable_reason
