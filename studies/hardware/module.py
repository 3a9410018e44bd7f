"""The second module in time: a record's line pressure and valve commands in, pressures and force out."""

from __future__ import annotations

from collections.abc import Mapping
from typing import Any, Final, NamedTuple

import numpy as np
from numpy.typing import NDArray

from studies.hardware.compiled import compiled_walk
from studies.hardware.equations import hose_drop, maximum, minimum, piston_after, through_valve, vessel_after
from studies.hardware.parameters import (
    AMBIENT,
    ATMOSPHERE,
    CP,
    GAS,
    Hardware,
    hose_area,
    hose_volume,
    leak_conductance,
)

Samples = NDArray[np.float64]
_SUBSTEP: Final = 5e-5
"""s: longest step of the integration."""
OUTPUTS: Final = ("tank_1", "cylinder", "tank_2", "stroke", "force", "air", "drawn", "vented", "leaked")
"""Absolute pressures, Pa; stroke, m; force of a pad, N; air of module 1 and what entered and left it, kg."""
_FILL: Final = 0
_VENT: Final = 2


def run(line: Samples, commands: Samples, step: float, h: Hardware, refine: int = 1) -> Mapping[str, Samples]:
    """Return :data:`OUTPUTS` at the instants of a record, released at the first of them.

    Args:
        line: gauge pressure of the brake line, Pa, straight between samples.
        commands: of the valves, 0 fill, 1 hold, 2 vent; a sample holds that in force since the one before.
        step: sampling time, s.
        h: the module.
        refine: factor by which the steps of the integration are shortened.
    """
    substeps = int(np.ceil(step / _SUBSTEP - 1e-9)) * refine
    late = np.concatenate([np.zeros(round(h.delay / step)), commands])[: len(commands)].astype(np.int64)
    rows = np.empty((len(OUTPUTS), len(line)))
    settings = np.array([(*h, *_constants(h), step / substeps)], _SETTINGS)
    compiled_walk(_SETTINGS, len(OUTPUTS))(line + ATMOSPHERE, late, settings, substeps, rows)
    return dict(zip(OUTPUTS, rows, strict=True))


class _Constants(NamedTuple):
    """Volume, m3, and heat conductance, W/K, of vessels 1 and 2, released; of the hose and the leak.

    Vessel 1 is the tank with its balls and half of the hose, vessel 2 the other half and the cylinder.
    Without a hose all is vessel 2.
    """

    volume_1: float
    heat_1: float
    volume_2: float
    heat_2: float
    slenderness: float
    """Area of the hose over its length, m."""
    leak: float
    """kg/(s Pa2)."""


def _constants(h: Hardware) -> _Constants:
    volume, heat = 0.5 * hose_volume(h), 0.5 * h.hose_heat
    volume_1, heat_1 = h.tank_volume - h.ball_volume + volume, h.bare_heat + h.ball_heat + heat
    volume_2, heat_2 = h.dead_volume + volume, h.cylinder_heat + heat
    others = hose_area(h) / h.hose_length, leak_conductance(h)
    if h.hose_bore > 0.0:
        return _Constants(volume_1, heat_1, volume_2, heat_2, *others)
    return _Constants(0.0, 0.0, volume_1 + volume_2, heat_1 + heat_2, *others)


_SETTINGS: Final = np.dtype([(name, "f8") for name in (*Hardware._fields, *_Constants._fields, "dt")])


def walk(line: Any, commands: Any, settings: Any, substeps: int, out: Any) -> None:
    """Step both modules (Euler; the piston's place and friction follow its new speed) and fill `out`."""
    h = settings[0]
    volume_1, volume_2, dt = h.volume_1, h.volume_2, h.dt
    hosed = volume_1 > 0.0
    stroke, speed, friction, flow, force = -h.preload / h.stop_stiffness, 0.0, 0.0, 0.0, 0.0
    density = ATMOSPHERE / (GAS * AMBIENT)
    mass_1, mass_2 = density * volume_1, density * (volume_2 + h.area * stroke)
    mass_b, drawn, vented, leaked = density * h.tank_volume, 0.0, 0.0, 0.0
    t_1 = t_2 = t_b = AMBIENT
    p_1 = p_2 = p_b = ATMOSPHERE
    fill, vent, inward, outward, gained = 1.0, 0.0, 0.0, 0.0, 0.0
    for n in range(len(line)):
        for k in range(substeps if n > 0 else 0):
            source = line[n - 1] + (line[n] - line[n - 1]) * k / substeps
            change = dt / h.travel
            fill += minimum(maximum((1.0 if commands[n] == _FILL else 0.0) - fill, -change), change)
            vent += minimum(maximum((1.0 if commands[n] == _VENT else 0.0) - vent, -change), change)
            lost = h.leak * (p_2 * p_2 - ATMOSPHERE * ATMOSPHERE)
            power_2 = h.heat_2 * (AMBIENT - t_2) - CP * lost * t_2
            if hosed:
                inward, outward, power_1 = through_valve(source, p_1, t_1, fill, vent, h)
                drop = hose_drop(flow, 0.5 * (p_1 + p_2), h.hose_bore, h.hose_length, h.hose_losses)
                flow += dt * h.slenderness * (p_1 - p_2 - drop)
                carried = CP * flow * (t_1 if flow > 0.0 else t_2)
                power_1 += h.heat_1 * (AMBIENT - t_1) - carried
                mass_1, t_1 = vessel_after(mass_1, t_1, inward - outward - flow, power_1, dt)
                p_1 = mass_1 * GAS * t_1 / volume_1
                gained, power_2 = flow - lost, power_2 + carried
            else:
                inward, outward, carried = through_valve(source, p_2, t_2, fill, vent, h)
                gained, power_2 = inward - outward - lost, power_2 + carried
            stroke, speed, friction, force = piston_after(stroke, speed, friction, p_2 - ATMOSPHERE, h, dt)
            mass_2, t_2 = vessel_after(mass_2, t_2, gained, power_2 - p_2 * h.area * speed, dt)
            p_2 = mass_2 * GAS * t_2 / (volume_2 + h.area * stroke)
            in_b, out_b, power_b = through_valve(source, p_b, t_b, fill, vent, h)
            power_b += h.bare_heat * (AMBIENT - t_b)
            mass_b, t_b = vessel_after(mass_b, t_b, in_b - out_b, power_b, dt)
            p_b = mass_b * GAS * t_b / h.tank_volume
            drawn += dt * inward
            vented += dt * outward
            leaked += dt * lost
        out[0, n], out[1, n], out[2, n] = p_1 if hosed else p_2, p_2, p_b
        out[3, n], out[4, n], out[5, n] = stroke, h.lever_ratio * force, mass_1 + mass_2
        out[6, n], out[7, n], out[8, n] = drawn, vented, leaked
