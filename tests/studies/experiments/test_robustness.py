import math

import pytest

from studies.experiments.robustness import _in_order, _ratio, _values_of_sweep, draw_sweep, swept_friction
from studies.neighbourhood import Point


@pytest.fixture
def sweep(stop):
    """One friction, two seeds: the paper's counts, then a stop in which both models act like none."""
    four, none = [stop(11, 11, 11, 11)] * 2, [stop(11, 21, 21, 21)] * 2
    modelled = [stop(11, 11, 11, 11), stop(11, 21, 21, 21)]
    nothing = None
    stops = {"none": none, "full": modelled, "thermal": modelled, "four-caliper": four}
    return [swept_friction(Point("0.161", "100 %", nothing, stops))]


@pytest.mark.parametrize(
    ("caliper", "full", "none", "expected"),
    [
        (11.0, 11.0, 21.0, True),
        (11.0, 8.0, 21.0, True),
        (11.0, 11.0, 12.0, False),
        (11.0, 20.0, 16.0, False),
        (0.0, 0.0, 9.0, False),
    ],
)
def test_the_order_of_caliper_full_and_none(caliper, full, none, expected):
    assert _in_order({"four-caliper": caliper, "full": full, "none": none}) is expected
    assert math.isnan(_ratio(0.0, 0.0))  # of a caliper that never cycles


def test_a_swept_friction_is_judged_stop_by_stop(sweep):
    (swept,) = sweep
    assert swept.in_order["full"].tolist() == [True, False]
    assert swept.in_bands.tolist() == [True, False]
    values = _values_of_sweep(sweep)
    assert values["sweep_in_order"].value == pytest.approx(50.0)
    assert values["sweep_in_bands"].value == 1.0


def test_the_sweep_is_drawn_with_the_counts_of_the_paper(sweep):
    figure = pytest.importorskip("matplotlib.figure").Figure()
    draw_sweep(sweep, figure)
    texts = {text.get_text() for text in figure.axes[0].texts}
    assert texts == {"paper: 11", "paper: 21"}
    assert [label.get_text() for label in figure.axes[0].get_xticklabels()] == ["0.161\n1/2"]
