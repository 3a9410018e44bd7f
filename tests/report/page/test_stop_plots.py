"""The plots of a stop: paths on paper, and data for the script that come back as they were."""

import base64
import re
import zlib

import numpy as np
import pytest
from hypothesis import given, strategies as st

from uictest.core.recording import Recording
from uictest.report.page.stop_plots import LEFT, RIGHT, drawing_of, packed, path_over_time, script_json
from uictest.report.traces.trace import Curve, trace_of

from ..builders import make_recording

NAN = float("nan")


def _points(drawn):
    """Walk along path data of M and l."""
    points = []
    for command, text in re.findall(r"([Ml])([-\d ]+)", drawn):
        numbers = [int(number) for number in re.findall(r"-?\d+", text)]
        for x, y in zip(numbers[::2], numbers[1::2], strict=True):
            points.append((x, y) if command == "M" else (points[-1][0] + x, points[-1][1] + y))
    return points


@given(st.lists(st.integers(-500, 500), min_size=1, max_size=400))
def test_thinning_out_keeps_every_peak(values):
    y = np.array(values, dtype=float)
    points = _points(path_over_time(np.linspace(0.0, 30.0, len(y)), y))
    heights = [height for _, height in points]
    assert (min(heights), max(heights)) == (min(values), max(values))
    assert [x for x, _ in points] == sorted(x for x, _ in points)


def test_missing_samples_leave_a_gap():
    across = np.arange(0.0, 160.0, 4.0)
    assert path_over_time(across, np.where(np.arange(40) // 10 == 2, NAN, 1.0)).count("M") == 2
    assert path_over_time(across, np.full(40, NAN)) == ""


def test_paper_shows_speeds_valves_and_pressures_within_their_frames():
    drawing = drawing_of(trace_of(make_recording()))
    assert [panel.key for panel in drawing.panels] == ["speed", "valves", "pressure"]
    for panel, below in zip(drawing.panels, [*drawing.panels[1:], None], strict=True):
        assert panel.bottom < (below.top if below else drawing.height)
        for kind, path in panel.paths:
            points = np.array(_points(path)) if kind.startswith("line") else np.zeros((0, 2))
            assert np.all((points[:, 0] >= LEFT) & (points[:, 0] <= RIGHT))
            assert np.all((points[:, 1] >= panel.top - 1) & (points[:, 1] <= panel.bottom + 1))
    assert sum(kind.startswith("magnet vent") for kind, _ in drawing.panels[1].paths) == 4


def test_a_vent_however_short_is_a_pixel_wide_and_a_long_one_as_wide_as_it_lasted():
    time = np.arange(0.0, 100.0, 0.01)
    valve = np.where((time >= 10.0) & (time < 10.01), 2.0, np.where((time >= 50.0) & (time < 60.0), 2.0, 0.0))
    channels = {"time": time, "speed": 50.0 - 0.5 * time, "valve_command_2": valve}
    drawing = drawing_of(trace_of(Recording(channels, {"time": "s", "speed": "m/s", "valve_command_2": "1"})))
    ((_, hold), (_, vent)) = next(panel.paths for panel in drawing.panels if panel.key == "valves")
    for bars in (hold, vent):
        widths = [float(width) for width in re.findall(r"h([\d.]+)", bars)]
        assert widths == pytest.approx([1.0, 10.0 * (RIGHT - LEFT) / time[-1]], abs=0.1)


def test_the_valves_are_shown_where_they_never_moved_since_that_is_why_a_stop_failed():
    time = np.arange(0.0, 10.0, 0.01)
    channels = {"time": time, "speed": 20.0 - 2.0 * time, "valve_command_1": np.zeros(len(time))}
    drawing = drawing_of(trace_of(Recording(channels, {"time": "s", "speed": "m/s", "valve_command_1": "1"})))
    (valves,) = (panel for panel in drawing.panels if panel.key == "valves")
    assert valves.title.endswith("no command in this stop")
    assert not valves.paths
    without = {name: channels[name] for name in ("time", "speed")}
    drawing = drawing_of(trace_of(Recording(without, {"time": "s", "speed": "m/s"})))
    assert [panel.key for panel in drawing.panels] == ["speed"]


def _unpacked(content):
    """Read lines as the page's script does."""
    data = np.frombuffer(zlib.decompress(base64.b64decode(content["data"])), dtype="u1")
    numbers = data.reshape(2, -1).T.copy().view("<i2").ravel().astype(float)
    counts = [grid["count"] for grid in content["grids"]]
    counts += [counts[line["grid"]] for line in content["lines"].values()]
    parts = [np.cumsum(part) for part in np.split(numbers, np.cumsum(counts)[:-1])]
    across = [
        grid["scale"][0] + grid["scale"][1] * part
        for grid, part in zip(content["grids"], parts, strict=False)
    ]
    curves = {}
    for (name, line), part in zip(content["lines"].items(), parts[len(across) :], strict=True):
        offset, step = line["scale"]
        curves[name] = (across[line["grid"]], np.where(part == 32767, np.nan, offset + step * part))
    return curves


_SERIES = st.lists(st.floats(-1e9, 1e9) | st.just(float("nan")), min_size=1, max_size=50)


@given(st.lists(_SERIES, min_size=1, max_size=3))
def test_lines_come_back_within_a_fifty_thousandth_of_their_range(lines):
    curves = {
        str(k): Curve(np.arange(float(len(values))), np.array(values)) for k, values in enumerate(lines)
    }
    for name, (x, y) in _unpacked(packed(curves, interval=1.0)).items():
        series = curves[name].y
        assert np.array_equal(x, curves[name].x)
        known = series[np.isfinite(series)]
        span = float(np.ptp(known)) if len(known) else 0.0
        assert np.array_equal(np.isnan(y), np.isnan(series))
        # Besides half a step there are the arithmetic of large offsets and the gaps between denormal numbers.
        rounding = 1e-12 * float(np.abs(known).max()) if len(known) else 0.0
        rounding += np.finfo(np.float64).tiny
        assert np.all(np.abs(y - series)[np.isfinite(series)] <= 2e-5 * span + rounding)


@given(st.lists(st.floats(-300.0, 300.0) | st.just(float("nan")), min_size=1, max_size=50))
def test_values_with_a_step_come_back_as_multiples_of_it(values):
    series = np.array(values)
    packed_lines = packed({"a": Curve(np.arange(float(len(values))), series)}, steps={"a": 0.02})
    ((_, back),) = _unpacked(packed_lines).values()
    assert np.allclose(back, series, rtol=0.0, atol=0.01 + 1e-9, equal_nan=True)
    known = back[np.isfinite(back)] / 0.02
    assert known == pytest.approx(np.rint(known), abs=1e-6)


def test_lines_over_one_array_of_times_share_it_and_times_far_apart_come_back_as_well():
    time = np.arange(5.0)
    content = packed({"a": Curve(time, time), "b": Curve(time, -time), "c": Curve(time.copy(), time)})
    assert len(content["grids"]) == 2
    assert [line["grid"] for line in content["lines"].values()] == [0, 0, 1]
    times = np.array([0.0, 0.01, 400.0])
    for interval in (0.0, 0.01):  # further apart than two bytes hold
        ((back, _),) = _unpacked(packed({"a": Curve(times, times)}, interval)).values()
        assert back == pytest.approx(times, abs=400.0 / 50_000)


@pytest.mark.parametrize("text", ["</script><script>alert(1)</script>", "<!--", "&amp;", "\u2028"])
def test_json_cannot_end_the_element_it_stands_in(text):
    shown = script_json({"label": text})
    assert not set("<>&\u2028") & set(shown)
