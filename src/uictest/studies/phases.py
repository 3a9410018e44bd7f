"""The four lines of force against pressure in a bench recording, and the samples that lie on them."""

from __future__ import annotations

import numpy as np
from numpy.typing import NDArray

from uictest.core.recording import Recording
from uictest.rig import identification

TITLES = {
    "bc_squeezing": "BC squeezing",
    "bc_releasing": "BC releasing",
    "wsp_squeezing": "WSP squeezing",
    "wsp_releasing": "WSP releasing",
}
"""The phases of the paper's hysteresis model, in its order."""


def identified_lines(recording: Recording) -> identification.HysteresisResult:
    """Return the lines of the caliper's force, identified as by `uictest identify hysteresis`."""
    return identification.identify_hysteresis(
        recording["time"],
        recording["measured_pressure_1"],
        recording["clamping_force_1"],
        recording["wsp_acting"] > 0.0,
    )


def on_phases(recording: Recording) -> dict[str, NDArray[np.bool_]]:
    """Return which samples lie on the line of each phase; those inside the loop lie on none."""
    step = float(recording["time"][1] - recording["time"][0])
    squeezing, releasing = identification.on_lines(
        recording["measured_pressure_1"], recording["clamping_force_1"], step
    )
    acting = recording["wsp_acting"] > 0.0
    return {
        "bc_squeezing": squeezing & ~acting,
        "bc_releasing": releasing & ~acting,
        "wsp_squeezing": squeezing & acting,
        "wsp_releasing": releasing & acting,
    }
