import base64
import zlib

import numpy as np
import pytest
from hypothesis import given, strategies as st

from uictest.report.page.stop.overlay_view import packed, script_json
from uictest.report.traces.trace import Curve


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


def test_lines_over_one_array_of_times_share_it():
    time = np.arange(5.0)
    content = packed({"a": Curve(time, time), "b": Curve(time, -time), "c": Curve(time.copy(), time)})
    assert len(content["grids"]) == 2
    assert [line["grid"] for line in content["lines"].values()] == [0, 0, 1]


@pytest.mark.parametrize("interval", [0.0, 0.01])
def test_times_further_apart_than_two_bytes_hold_come_back_as_well(interval):
    times = np.array([0.0, 0.01, 400.0])
    ((back, _),) = _unpacked(packed({"a": Curve(times, times)}, interval)).values()
    assert back == pytest.approx(times, abs=400.0 / 50_000)


@pytest.mark.parametrize("text", ["</script><script>alert(1)</script>", "<!--", "&amp;", "\u2028"])
def test_json_cannot_end_the_element_it_stands_in(text):
    shown = script_json({"label": text})
    assert not set("<>&\u2028") & set(shown)
