import math

import pytest

from studies.experiments.levels import Loop, slope_spread, slopes_table
from uictest.rig.identification import HysteresisResult
from uictest.rig.identification.lines import FittedLine


def loop(level, **slopes):
    """A loop of which nothing is known but the slopes of some phases, in kN/bar."""
    lines = {phase: FittedLine(slope * 1e-2, -1500.0) for phase, slope in slopes.items()}
    nothing = None
    return Loop(level, nothing, HysteresisResult(lines, lines, FittedLine(0.0, 0.0), {}, 9e3, 0.0, 0.0, 1e4))


def test_the_phase_that_changes_most_decides_and_what_is_not_common_does_not_count():
    loops = [
        loop("80 %", bc_squeezing=4.0, bc_releasing=5.0),
        loop("100 %", bc_squeezing=4.1, bc_releasing=5.0),
    ]
    assert slope_spread(loops) == pytest.approx(0.1 / 4.05)
    loops = [loop("80 %", bc_squeezing=4.0), loop("100 %", bc_squeezing=4.0, wsp_squeezing=9.0)]
    assert slope_spread(loops) == 0.0
    assert math.isnan(slope_spread([loop("80 %", bc_squeezing=4.0), loop("100 %", bc_releasing=4.0)]))


def test_every_phase_of_every_stop_has_its_row():
    table = slopes_table([loop("80 %", bc_squeezing=4.0), loop("100 %")], "command")
    assert table["command"] == ["80 %"] * 4 + ["100 %"] * 4
    assert table["slope_kn_per_bar"][0] == pytest.approx(4.0)
    assert all(math.isnan(slope) for slope in table["slope_kn_per_bar"][1:])
