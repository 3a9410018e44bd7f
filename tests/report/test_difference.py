from __future__ import annotations

import math

import pytest
from hypothesis import given, strategies as st

from uictest.report import percent_text, relative_percent
from uictest.report.difference import relative_text


@pytest.mark.parametrize(
    ("first", "second", "unit", "text"),
    [
        (473.1, 478.17, "m", "+1.07"),
        (-2.0, -1.0, "m/s2", "+50"),
        (-2.0, -3.0, "m/s2", "-50"),
        (4.0, 0.0, "bar", "-100"),
        (0.0, 1.0, "bar", "A is 0"),
        (0.0, math.nan, "bar", "A is 0"),
        (1.0, math.nan, "bar", "-"),
        (20.0, 30.0, "degC", "-"),
        ("pass", "fail", "", "-"),
        ("none", 1.0, "", "-"),
        (0.001, 1.0, "km/h", "> 1000"),
        (0.001, -1.0, "km/h", "< -1000"),
    ],
)
def test_a_relative_figure_is_per_cent_of_the_size_of_a(
    first: float | str, second: float | str, unit: str, text: str
) -> None:
    assert relative_text(first, second, unit) == text


@given(st.floats(1e-3, 1e6), st.floats(-1e6, 1e6), st.sampled_from([-1.0, 1.0]))
def test_a_relative_figure_gives_the_second_side_back(size: float, second: float, sign: float) -> None:
    percent = relative_percent(sign * size, second)
    assert percent is not None
    assert sign * size + percent / 100.0 * size == pytest.approx(second, rel=1e-9, abs=1e-6 * size)
    assert math.copysign(1.0, percent) == math.copysign(1.0, second - sign * size)


def test_a_figure_that_says_little_is_not_written_out() -> None:
    assert [percent_text(each) for each in (None, 999.4, 1000.0, -1e9)] == ["-", "+999", "> 1000", "< -1000"]
