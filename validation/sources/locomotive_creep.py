"""Creep curve of a locomotive on a wet rail, as an open contact program models it."""

from __future__ import annotations

import math
from functools import cache

import numpy as np

from studies.stop_runner import StopRunner
from uictest.core.physics import creep_force
from validation.half_space import Array, HalfSpaceContact
from validation.source import Comparison, Findings, Source

LOAD = 106_700.0
"""Wheel load, N."""
SHEAR_MODULUS, POISSON = 82e9, 0.28
SEMI_AXES = (6.304e-3, 12.61e-3)
"""Of Hertz's ellipse for a curvature of 0.8 1/m and a ratio of 0.5, m."""
LAYER = 1.25e-3 / 8.2e9
"""Thickness of the interfacial layer over its shear modulus, m/Pa."""
KINETIC, FALLING, HALF_SLIP = 0.14, 0.19, 1.25
"""Friction at great slip, what it falls by, and the slip speed in m/s at which half of that is gone."""
FITTED_AT, PREDICTED_AT = 10.0, (5.0, 20.0)
"""Running speeds, m/s."""
CREEPAGES = (0.002, 0.005, 0.01, 0.015, 0.02, 0.03, 0.05, 0.1, 0.25)
_SMALL = 1e-7


def program(speed: float) -> list[float]:
    """Return F/Q at every creepage with the layer and the falling friction of the program's example."""
    contact = HalfSpaceContact(*SEMI_AXES, SHEAR_MODULUS, POISSON, LAYER)
    return [contact.force(creepage, speed, LOAD, _friction) / LOAD for creepage in CREEPAGES]


def _friction(slip: Array) -> Array:
    return KINETIC + FALLING * np.exp2(-slip / HALF_SLIP)


def polach(speed: float, reductions: tuple[float, float]) -> list[float]:
    """Return F/Q at every creepage by the creep law of the rig."""
    most = KINETIC + FALLING
    law = (_stiffness(), most, KINETIC / most, math.log(2.0) / HALF_SLIP, *reductions)
    return [creep_force(each * speed, speed, LOAD, *law)[0] / LOAD for each in CREEPAGES]


@cache
def _stiffness() -> float:
    """Tangential stiffness of the contact without the layer: the slope of the theory, N."""
    contact = HalfSpaceContact(*SEMI_AXES, SHEAR_MODULUS, POISSON)
    return math.pi / 4.0 * contact.force(_SMALL, 1.0, LOAD, np.ones_like) / _SMALL


def run(stop_runner: StopRunner) -> Findings:
    """Fit kA and kS at one speed and compare at all of them."""
    from scipy.optimize import least_squares

    reference = np.array(program(FITTED_AT))
    fit = least_squares(
        lambda x: polach(FITTED_AT, (x[0], x[0] * x[1])) - reference, (0.5, 0.5), bounds=(0.0, 1.0)
    )
    reductions = (float(fit.x[0]), float(fit.x[0] * fit.x[1]))
    return Findings(
        [
            Comparison(
                f"F/Q, {speed:.0f} m/s, creepage {100.0 * creepage:g} %",
                "",
                exact,
                ours,
                speed == FITTED_AT,
                4,
            )
            for speed in (FITTED_AT, *PREDICTED_AT)
            for creepage, exact, ours in zip(
                CREEPAGES, program(speed), polach(speed, reductions), strict=True
            )
        ],
        notes=(f"The fit gives kA = {reductions[0]:.3f} and kS = {reductions[1]:.3f}.",),
    )


SOURCE = Source(
    name="locomotive-creep",
    title="Creep curve of a locomotive with falling friction and a layer",
    place=(
        "Open program CONTACT (github.com/eve70a/CONTACT, revision d431cdbd), inputs of the second series "
        "in examples/tractcurv.inp, which follow Vollebregt, Wear 314 (2014) 87-95, on measurements in "
        "Polach 2005. Only inputs are taken; the curves are computed here in `validation/half_space.py`"
    ),
    kind="computed",
    fitted=(
        f"kA and kS, two numbers, at {FITTED_AT:.0f} m/s. Friction and its fall are the example's inputs, "
        "the stiffness is the theory's"
    ),
    shows=(
        "Whether two reductions can stand for a soft layer on the rail, and whether they carry over to "
        "other speeds."
    ),
    does_not_show=(
        "How near the program is to the locomotive: the measured points are not public in numbers. The wet "
        "set of the library is another rail."
    ),
    run=run,
)
