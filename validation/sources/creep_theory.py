"""The creep law of the rig without its reductions against the theory of the elastic half-space."""

from __future__ import annotations

from collections.abc import Iterator

import numpy as np

from studies.stop_runner import StopRunner
from uictest.core.physics import creep_force
from validation.half_space import Array, HalfSpaceContact
from validation.source import Comparison, Findings, Source

POISSON = 0.28
SPEEDS = (10.0, 33.0)
"""Running speeds, m/s."""
CREEPAGES = (0.0005, 0.001, 0.002, 0.004, 0.01, 0.05)
_SMALL = 1e-7
"""A creepage at which nothing slips."""
_LOW_FRICTION = 0.10


def run(stop_runner: StopRunner) -> Findings:
    """Compare forces, in friction units of the load, on the rails and the contact of the library."""
    dry, wet = (stop_runner.cases(name)[0].scenario.rail.condition for name in ("dry-120", "slip-120"))
    contact = dry.contact
    axes = (contact.semi_axis_longitudinal, contact.semi_axis_lateral)
    load, modulus = contact.reference_wheel_load, contact.shear_modulus
    theory = HalfSpaceContact(*axes, modulus, POISSON)
    stiffness = modulus * np.pi / 4.0 * axes[0] * axes[1] * contact.kalker_coefficient
    emerging = theory.force(_SMALL, 1.0, load, np.ones_like) / (_SMALL * modulus * axes[0] * axes[1])

    def forces() -> Iterator[Comparison]:
        for title, friction, rail in (
            (f"dry, μ0 {dry.friction:.2f}", dry.friction, dry),
            (f"wet, μ0 {wet.friction:.2f}", wet.friction, wet),
            (f"wet, μ0 {_LOW_FRICTION:.2f}", _LOW_FRICTION, wet),
        ):
            law = (friction, rail.friction_ratio, rail.friction_decay)

            def falling(slip: Array, law: tuple[float, float, float] = law) -> Array:
                return law[0] * ((1.0 - law[1]) * np.exp(-law[2] * slip) + law[1])

            for speed in SPEEDS:
                for creepage in CREEPAGES:
                    ours, _ = creep_force(creepage * speed, speed, load, stiffness, *law, 1.0, 1.0)
                    exact = theory.force(creepage, speed, load, falling)
                    quantity = f"F/Q, {title}, {speed:.0f} m/s, creepage {100.0 * creepage:g} %"
                    yield Comparison(quantity, "", exact / load, ours / load, digits=4)

    slope = Comparison(
        "Kalker's c11, slope at zero creepage", "", emerging, contact.kalker_coefficient, digits=2
    )
    shares = [
        f"{name} {50.0 * (rail.reduction_adhesion + rail.reduction_slip):.0f} %"
        for name, rail in (("dry", dry), ("wet", wet))
    ]
    return Findings(
        [slope, *forces()],
        notes=(
            (
                "Compared at kA = kS = 1, which is theory. The reductions of the library are Polach's "
                f"fit to measured curves; they leave of the theory's slope at zero "
                f"creepage: {', '.join(shares)}."
            ),
        ),
    )


SOURCE = Source(
    name="creep-theory",
    title="Creep force of a clean elliptic contact",
    place=(
        "Kalker, Three-Dimensional Elastic Bodies in Rolling Contact, Kluwer 1990: elastic half-space with "
        "the influence of Cerruti, solved here in `validation/half_space.py`"
    ),
    kind="computed",
    fitted="Nothing. Contact and friction are those of the library; Poisson's ratio is 0.28",
    shows=(
        "How far the closed form of Polach lies from the theory that it shortens, and that friction may be "
        "taken at the slip of the wheel instead of each place's own."
    ),
    does_not_show="Anything about a real rail, whose roughness and layers make creep curves flatter.",
    run=run,
)
