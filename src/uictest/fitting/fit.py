"""Fit the friction of rail and brake pads to a recorded stop."""

from __future__ import annotations

from collections.abc import Sequence
from typing import TYPE_CHECKING

from uictest import field_data
from uictest.fitting.balances import Balances, windows_of
from uictest.fitting.estimate import Fit, fit
from uictest.fitting.samples import FitError, samples_of

if TYPE_CHECKING:
    from uictest.scenario import Scenario


def fit_stop(
    stop: field_data.RecordedStop,
    scenario: Scenario,
    breaks: Sequence[float] = (),
    *,
    with_pads: bool = False,
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
