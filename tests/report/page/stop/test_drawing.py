import re

import numpy as np
from hypothesis import given, strategies as st

from uictest.report.page.stop.drawing import LEFT, RIGHT, drawing_of, path_over_time
from uictest.report.traces.trace import trace_of

from ...builders import make_recording

NAN = float("nan")


def _points(drawn):
    """Walk along path data of M and l."""
    points = []
    for command, text in re.findall(r"([Ml])([-\d ]+)", drawn):
        x, y = (int(word) for word in text.split())
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
