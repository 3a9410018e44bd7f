import re

import numpy as np
from hypothesis import given, strategies as st

from uictest.report.page.stop.polyline import dots, path, path_over_time

NAN = float("nan")


def _points(drawn):
    """Walk along path data of M, l, h and v."""
    points = []
    for command, text in re.findall(r"([Mlhv])([-\d ]+)", drawn):
        numbers = [int(word) for word in text.split()]
        x, y = points[-1] if points else (0, 0)
        if command == "M":
            x, y = numbers
        elif command == "l":
            x, y = x + numbers[0], y + numbers[1]
        else:
            x, y = (x + numbers[0], y) if command == "h" else (x, y + numbers[0])
        points.append((x, y))
    return points


@given(st.lists(st.integers(-500, 500), min_size=1, max_size=400))
def test_thinning_out_keeps_every_peak(values):
    y = np.array(values, dtype=float)
    points = _points(path_over_time(np.linspace(0.0, 30.0, len(y)), y))
    heights = [height for _, height in points]
    assert (min(heights), max(heights)) == (min(values), max(values))
    assert [x for x, _ in points] == sorted(x for x, _ in points)


def test_a_path_takes_no_step_of_nothing_and_straight_ones_briefly():
    drawn = path(np.array([0.0, 0.2, 5.0, 5.0, 8.0]), np.array([1.0, 1.0, 1.0, 4.0, 5.0]))
    assert drawn == "M0 1h5v3l3 1"


def test_missing_samples_leave_a_gap():
    assert path(np.arange(5.0), np.array([0.0, 0.0, NAN, 2.0, 2.0])) == "M0 0h1M3 2h1"
    assert path(np.arange(2.0), np.array([NAN, NAN])) == ""
    gap = path_over_time(np.arange(40.0), np.where(np.arange(40) // 10 == 2, NAN, 1.0))
    assert gap.count("M") == 2


def test_dots_are_drawn_once_each():
    assert dots(np.array([1.0, 1.2, 3.0, NAN]), np.array([2.0, 2.1, 4.0, 0.0])) == "M1 2h0M3 4h0"
