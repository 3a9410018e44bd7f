"""The band of the stops of a case, against the samples of each of them."""

import numpy as np
import pytest

from uictest.core.recording import Recording
from uictest.report.traces.band import stop_extremes, with_band
from uictest.report.traces.trace import trace_of

KILOMETRES_PER_HOUR = 3.6


def _stop(seed, samples, every=0.01):
    """A train that slows down, and a wheelset that slides in some other way under every seed."""
    time = every * np.arange(samples)
    time[-1] -= 0.4 * every  # the last sample is that of the standstill, wherever it lies
    speed = 30.0 * (1.0 - time / time[-1]) + 1e-3 * seed
    noise = np.random.default_rng(seed).uniform(0.5, 1.0, samples)
    channels = {"time": time, "speed": speed, "wheel_speed_1": speed * noise}
    return Recording(channels, {"time": "s", "speed": "m/s", "wheel_speed_1": "m/s"})


def _band(stops):
    return with_band(trace_of(stops[0]), [stop_extremes(each) for each in stops])


@pytest.mark.parametrize("every", [0.01, 0.002, 0.03, 0.2])
@pytest.mark.parametrize("samples", [(901, 901, 901), (877, 951, 702), (1001, 803, 40)])
def test_no_sample_of_any_stop_lies_beyond_the_band(every, samples):
    stops = [_stop(seed, count, every) for seed, count in enumerate(samples)]
    trace = _band(stops)
    for name in ("speed", "wheel_speed_1"):
        low, high = trace.band[name]
        assert (low.x[0], low.x[-1]) == (0.0, trace.end)
        for stop in stops:
            seen = stop["time"] <= trace.end
            time, value = stop["time"][seen], KILOMETRES_PER_HOUR * stop[name][seen]
            assert np.all(np.interp(time, low.x, low.y) <= value + 1e-9)
            assert np.all(value - 1e-9 <= np.interp(time, high.x, high.y))


def test_an_edge_is_where_some_stop_was_within_a_part_of_a_second():
    stops = [_stop(seed, count) for seed, count in enumerate((901, 851, 951))]
    low, high = _band(stops).band["wheel_speed_1"]
    for x, lowest, highest in zip(low.x, low.y, high.y, strict=True):
        near = [stop["wheel_speed_1"][np.abs(stop["time"] - x) < 0.051] for stop in stops]
        values = KILOMETRES_PER_HOUR * np.concatenate(near)
        assert np.min(np.abs(values - lowest)) < 1e-9
        assert np.min(np.abs(values - highest)) < 1e-9


def test_beyond_the_end_of_a_shorter_stop_the_band_is_that_of_those_that_still_run():
    long, short = _stop(0, 901), _stop(1, 301)
    alone, both = (
        with_band(trace_of(long), [stop_extremes(each) for each in stops]).band["wheel_speed_1"]
        for stops in ((long, long), (long, short))
    )
    behind = alone[0].x > short["time"][-1] + 0.06
    for own, other in zip(alone, both, strict=True):
        assert np.array_equal(own.y[behind], other.y[behind])
    assert both[0].y[~behind].min() < alone[0].y[~behind].min()


def test_the_band_does_not_depend_on_the_order_in_which_stops_finish():
    trace, stops = trace_of(_stop(0, 901)), [stop_extremes(_stop(seed, 901 - 7 * seed)) for seed in range(4)]
    bands = [with_band(trace, each).band["speed"] for each in (stops, stops[::-1])]
    for own, other in zip(*bands, strict=True):
        assert np.array_equal(own.x, other.x)
        assert np.array_equal(own.y, other.y)


def test_one_stop_spans_nothing():
    trace = trace_of(_stop(0, 901))
    assert with_band(trace, [stop_extremes(_stop(0, 901))]) == trace
    assert (trace.band, trace.band_stops) == ({}, 0)
