from __future__ import annotations

import base64

import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st

from uictest.report.page.packing import packed
from uictest.report.page.script_json import script_json


def _unpacked(content: dict[str, object]) -> np.ndarray:
    numbers = np.frombuffer(base64.b64decode(str(content["data"])), dtype="<u2").astype(float)
    values = float(str(content["offset"])) + float(str(content["step"])) * numbers
    return np.where(numbers == 65535, np.nan, values)


@given(st.lists(st.floats(-1e9, 1e9) | st.just(float("nan")), min_size=1, max_size=50))
def test_a_series_comes_back_within_a_hundred_thousandth_of_its_range(values: list[float]) -> None:
    series = np.array(values)
    back = _unpacked(packed(series))
    known = series[np.isfinite(series)]
    span = float(np.ptp(known)) if len(known) else 0.0
    assert np.array_equal(np.isnan(back), np.isnan(series))
    # What is left beside half a step is the arithmetic of large offsets.
    rounding = 1e-12 * float(np.abs(known).max()) if len(known) else 0.0
    assert np.all(np.abs(back - series)[np.isfinite(series)] <= 1e-5 * span + rounding)


@pytest.mark.parametrize("text", ["</script><script>alert(1)</script>", "<!--", "&amp;", "\u2028"])
def test_json_cannot_end_the_element_it_stands_in(text: str) -> None:
    shown = script_json({"label": text})
    assert not set("<>&\u2028") & set(shown)
