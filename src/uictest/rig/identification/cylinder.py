"""Cylinder dynamics from a record: Lee and Kang (2015), equation (8)."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np

from uictest.rig.identification.lines import Mask, Samples
from uictest.rig.identification.output_error import FitSegment, free_weights, refined
from uictest.rig.identification.suitability import (
    UnsuitableRecordError,
    applications,
    held_out,
    required_sampling_time,
)
from uictest.rig.identification.transfer_function import TransferFunction, assembled

_SHORTEST = 5.0
"""s: shortest record; chosen."""
_LONGEST_STEP = 0.01
"""s: longest sampling time; chosen."""
_POOREST_FIT = 50.0
"""%: below it the fit is closer to a constant than to the pressure; chosen."""


@dataclass(frozen=True, slots=True)
class CylinderResult:
    """The transfer function and how well it computes the held-out part of the record.

    Attributes:
        transfer_function: from tank pressure to cylinder pressure.
        fit: 100 % less the root-mean-square error over the standard deviation of the cylinder pressure.
        largest_before: largest difference of the two pressures as they are, share of the largest.
        largest_after: largest error with it.
        largest_pressure: largest cylinder pressure of the record, Pa.
    """

    transfer_function: TransferFunction
    fit: float
    largest_before: float
    largest_after: float
    largest_pressure: float


def identify_cylinder(
    time: Samples,
    tank_pressure: Samples,
    cylinder_pressure: Samples,
    held_out_share: float = 0.25,
) -> CylinderResult:
    """Find the third-order transfer function at the record's sampling time.

    A linear start (ARX, Steiglitz-McBride) and fixed ones are refined for the least output error of the whole
    simulated record, in each of its brake applications. Unity gain at rest and stability hold by
    parametrisation. The response to a step never turns back, since the hysteresis would keep the force of the
    turn.

    Args:
        time: s, evenly sampled, every 10 ms or more often.
        tank_pressure: gauge pressure of a tank without cylinder, Pa.
        cylinder_pressure: gauge pressure of the cylinder under the same valve commands, Pa.
        held_out_share: share of the record that is excluded from the fit and gives the errors.

    Raises:
        UnsuitableRecordError: the record cannot support the fit; the message says why.
    """
    pressures = {"tank": tank_pressure, "cylinder": cylinder_pressure}
    step = required_sampling_time(time, pressures, _SHORTEST, _LONGEST_STEP)
    is_held_out = held_out(len(time), held_out_share)
    brakings = applications(tank_pressure, cylinder_pressure, step)
    if not any(is_held_out[braking].any() and not is_held_out[braking].all() for braking in brakings):
        raise UnsuitableRecordError("no brake application: the pressures must rise from rest and hold")
    segments = [
        _segment(tank_pressure[braking], cylinder_pressure[braking], ~is_held_out[braking])
        for braking in brakings
    ]
    poles, weights = refined(segments, step)
    model = assembled(poles, weights, step)
    computed = [model.output(tank_pressure[braking]) for braking in brakings]
    held = np.concatenate([is_held_out[braking] for braking in brakings])
    tank = np.concatenate([tank_pressure[braking] for braking in brakings])
    cylinder = np.concatenate([cylinder_pressure[braking] for braking in brakings])
    return _assessed(model, tank[held], cylinder[held], np.concatenate(computed)[held])


def fitted_freely(time: Samples, tank_pressure: Samples, cylinder_pressure: Samples) -> TransferFunction:
    """Find the third-order transfer function with the least output error over a whole record.

    Nothing is held out, and only unity gain at rest and stability bound it: what such a filter can reach
    where it was fitted. A rig cannot use it, because a step response that turns back is kept as force.
    Arguments are those of :func:`identify_cylinder`.
    """
    pressures = {"tank": tank_pressure, "cylinder": cylinder_pressure}
    step = required_sampling_time(time, pressures, _SHORTEST, _LONGEST_STEP)
    brakings = applications(tank_pressure, cylinder_pressure, step)
    pairs = [(tank_pressure[braking], cylinder_pressure[braking]) for braking in brakings]
    segments = [_segment(tank, cylinder, np.ones(len(tank), bool)) for tank, cylinder in pairs]
    return assembled(*refined(segments, step, free_weights), step)


def require_fit(result: CylinderResult) -> None:
    """Raise UnsuitableRecordError if the result hardly reproduces the held-out part of its record."""
    if not result.fit >= _POOREST_FIT:
        raise UnsuitableRecordError(
            f"the cylinder pressure does not follow from the tank pressure: the fit of the held-out part is"
            f" {result.fit:.3g} %, at least {_POOREST_FIT:g} % are needed"
        )


def _segment(tank: Samples, cylinder: Samples, fitted: Mask) -> FitSegment:
    return FitSegment(tank - tank[0], cylinder - tank[0], fitted)


def _assessed(model: TransferFunction, tank: Samples, cylinder: Samples, computed: Samples) -> CylinderResult:
    largest = float(cylinder.max())
    spread = float(np.sqrt(np.mean((cylinder - cylinder.mean()) ** 2)))
    return CylinderResult(
        model,
        100.0 * (1.0 - float(np.sqrt(np.mean((computed - cylinder) ** 2))) / spread),
        float(np.abs(tank - cylinder).max()) / largest,
        float(np.abs(computed - cylinder).max()) / largest,
        largest,
    )
