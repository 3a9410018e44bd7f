"""Records made with known parameters."""

import numpy as np
import pytest

from uictest.rig.identification.lines import FittedLine, computed_force

STEP = 0.0005
LINES = {
    "bc_squeezing": FittedLine(0.0420, -1800.0),
    "bc_releasing": FittedLine(0.0475, -1650.0),
    "wsp_squeezing": FittedLine(0.0412, -1850.0),
    "wsp_releasing": FittedLine(0.0482, -1600.0),
}


@pytest.fixture(scope="session")
def pressures():
    """Time, pressure and WSP phase: two triangles of growing height, then cycles as a WSP makes them."""
    corners = [(0, 0), (4, 2e5), (8, 0), (15, 4e5), (22, 0), (25, 4e5)]
    at = 25.0
    for low in (1.0, 2.0, 1.5, 0.8, 1.2, 2.2, 0.9):
        corners += [(at + 1.0, low * 1e5), (at + 1.3, low * 1e5), (at + 2.5, 3.9e5)]
        at += 2.6
    time = np.arange(round(corners[-1][0] / STEP) + 1) * STEP
    pressure = np.interp(time, *np.array(corners, dtype=float).T)
    return time, pressure, time >= 25.0


@pytest.fixture(scope="session")
def force(pressures):
    """Force of the known lines along these pressures, N."""
    _, pressure, acting = pressures
    return computed_force(pressure, acting, LINES, 0.0, STEP, 0.0)
