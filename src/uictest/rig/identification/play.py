"""The hysteresis model applied to a record: equations (4)-(7) with a play between the lines."""

from __future__ import annotations

from collections.abc import Mapping

import numpy as np

from uictest.rig.identification.arrays import Mask, Samples
from uictest.rig.identification.lines import FittedLine


def computed_force(
    pressure: Samples,
    wsp_acting: Mask,
    lines: Mapping[str, FittedLine],
    transition_time: float,
    step: float,
    start: float,
) -> Samples:
    """Clamping force in N that the four lines give along a record.

    Args:
        pressure: gauge pressure, Pa.
        wsp_acting: when the lines of the WSP apply.
        lines: by the name of the phase, ``bc_squeezing`` to ``wsp_releasing``.
        transition_time: time in which one pair of lines turns into the other, s.
        step: sampling time, s.
        start: force before the record, N.
    """
    share = _shares(wsp_acting, step / max(transition_time, step))
    lower = _mixed(pressure, lines["bc_squeezing"], lines["wsp_squeezing"], share)
    upper = np.maximum(_mixed(pressure, lines["bc_releasing"], lines["wsp_releasing"], share), lower)
    force = np.empty_like(pressure)
    held = start
    for n in range(len(pressure)):
        held = min(max(held, lower[n]), upper[n])
        force[n] = held
    return force


def _mixed(pressure: Samples, bc: FittedLine, wsp: FittedLine, share: Samples) -> Samples:
    slope = bc.slope + share * (wsp.slope - bc.slope)
    intercept = bc.intercept + share * (wsp.intercept - bc.intercept)
    return np.asarray(np.maximum(slope * pressure + intercept, 0.0))


def _shares(acting: Mask, largest_change: float) -> Samples:
    shares = np.empty(len(acting))
    share = float(acting[0])
    for n, target in enumerate(acting.astype(float)):
        share += min(max(target - share, -largest_change), largest_change)
        shares[n] = share
    return shares
