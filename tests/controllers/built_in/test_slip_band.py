"""The slip-band controller."""

import pytest

from uictest.core.physics.valves import FILL, HOLD, VENT


@pytest.mark.parametrize(("slide", "command"), [(0.05, FILL), (0.10, HOLD), (0.19, HOLD), (0.25, VENT)])
def test_slide_chooses_the_command(slip_band_bench, slide, command):
    controller = slip_band_bench(20.0)
    assert controller.commands(20.0, 20.0, 20.0 * (1.0 - slide), 20.0) == [FILL, FILL, command, FILL]


def test_reference_sinks_with_wheelsets_that_slide_together(slip_band_bench):
    """What this controller cannot do: the estimate falls at its bound although the train hardly slows."""
    controller = slip_band_bench(20.0)
    for _ in range(500):
        controller.commands(0.0, 0.0, 0.0, 0.0)
    assert controller.reference == pytest.approx(20.0 - 1.8 * 5.0)
