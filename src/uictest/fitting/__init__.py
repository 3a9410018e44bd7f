"""Fitting a scenario to a recorded stop: the friction of its rail, and of its brake pads.

The speed of a train under WSP depends chaotically on friction: a cycle more or less moves everything after
it. So no simulated stop is compared here. Balances of momentum are drawn over short windows with the
*recorded* slip speeds in the creep law, which leaves a smooth problem of a few unknowns; the simulation only
confirms the result.
"""

from __future__ import annotations

from collections.abc import Sequence
from typing import TYPE_CHECKING

from uictest.fitting.balances import Balances, windows_of
from uictest.fitting.document import fit_document
from uictest.fitting.drawing import overlay_svg
from uictest.fitting.estimate import Estimate, Fit, fit
from uictest.fitting.fitted_scenario import fitted_yaml
from uictest.fitting.overlay import Agreement, agreement, overlay
from uictest.fitting.samples import FitError, samples_of

if TYPE_CHECKING:
    from uictest.measured import MeasuredStop
    from uictest.scenario import Scenario


def fit_stop(
    stop: MeasuredStop, scenario: Scenario, breaks: Sequence[float] = (), *, with_pads: bool = False
) -> Fit:
    """Return the friction of the rail on which a recorded stop of a scenario's vehicle was made.

    Args:
        stop: the recorded stop; train and wheel speeds, and clamping forces or torques where there are any.
        scenario: vehicle, brake, gradient and the other parameters of the creep law.
        breaks: places between stretches of constant friction, m from the brake command, rising.
        with_pads: find a factor on the scenario's pad friction, too; needs clamping forces.

    Raises:
        FitError: the record lacks what is needed.

    """
    samples = samples_of(stop, scenario)
    balances = Balances(samples, windows_of(samples), scenario)
    if with_pads and samples.torque is None:
        raise FitError("pad friction cannot be found: the clamping forces of all wheelsets are not recorded")
    return fit(balances, breaks, with_pads=with_pads)


__all__ = [
    "Agreement",
    "Estimate",
    "Fit",
    "FitError",
    "agreement",
    "fit_document",
    "fit_stop",
    "fitted_yaml",
    "overlay",
    "overlay_svg",
]
