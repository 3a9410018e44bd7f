"""Flow laws and rates of the second module: equations of its own, compiled without those of the rig."""

from __future__ import annotations

import math
from typing import Any

from numba import njit

from studies.hardware.parameters import AMBIENT, ATMOSPHERE, CP, CV, GAS, REFERENCE_DENSITY, VISCOSITY

_LINEAR = 0.999
"""Pressure ratio above which the flow is linear in the difference: its slope is infinite at 1."""


def _reduced(ratio: float, b: float, m: float) -> float:
    """Return the flow over the choked one at p2 / p1 = `ratio`, ISO 6358-1:2013."""
    if ratio <= b:
        return 1.0
    if ratio > _LINEAR:
        return float((1.0 - ((_LINEAR - b) / (1.0 - b)) ** 2) ** m * (1.0 - ratio) / (1.0 - _LINEAR))
    return float((1.0 - ((ratio - b) / (1.0 - b)) ** 2) ** m)


reduced: Any = njit(_reduced, nogil=True)


def _orifice(p1: float, t1: float, p2: float, t2: float, conductance: float, b: float, m: float) -> float:
    """Return the mass flow from side 1 to side 2, kg/s; negative where side 2 has the higher pressure."""
    if p1 >= p2:
        choked = conductance * REFERENCE_DENSITY * p1 * math.sqrt(AMBIENT / t1)
        return float(choked * reduced(p2 / p1, b, m))
    choked = conductance * REFERENCE_DENSITY * p2 * math.sqrt(AMBIENT / t2)
    return float(-choked * reduced(p1 / p2, b, m))


orifice: Any = njit(_orifice, nogil=True)


def _hose_drop(flow: float, pressure: float, bore: float, length: float, losses: float) -> float:
    """Return the loss of pressure along a hose, Pa, of the sign of the flow (kg/s), air at ambient.

    The larger of laminar (Hagen-Poiseuille) and turbulent friction (Blasius, smooth wall), and the fittings.
    """
    density = pressure / (GAS * AMBIENT)
    speed = abs(flow) / (density * 0.25 * math.pi * bore * bore)
    laminar = 32.0 * VISCOSITY * length * speed / bore**2
    turbulent = 0.1582 * VISCOSITY**0.25 * density**0.75 * length * speed**1.75 / bore**1.25
    drop = max(laminar, turbulent) + losses * 0.5 * density * speed * speed
    return float(drop if flow > 0.0 else -drop)


hose_drop: Any = njit(_hose_drop, nogil=True)


def _contact(
    compression: float, speed: float, stiffness: float, stiffening: float, damping: float
) -> tuple[float, float]:
    """Return the elastic force of the pads at the piston and that with their damping, N; they never pull."""
    if compression <= 0.0:
        return 0.0, 0.0
    elastic = (stiffness + stiffening * compression) * compression
    return elastic, max(elastic + damping * speed, 0.0)


contact: Any = njit(_contact, nogil=True)


def _friction_after(friction: float, speed: float, limit: float, presliding: float, step: float) -> float:
    """Return the friction after a step, N: Dahl, F' = s (v - |v| F / limit), solved for constant v."""
    end = limit if speed > 0.0 else -limit
    return float(end + (friction - end) * math.exp(-presliding * abs(speed) * step / limit))


friction_after: Any = njit(_friction_after, nogil=True)


def _through_valve(
    source: float, pressure: float, temperature: float, fill: float, vent: float, h: Any
) -> tuple[float, float, float]:
    """Return what a WSP valve lets in from the line and out, kg/s, and the enthalpy of both, W.

    `fill` and `vent` are its openings, 0 to 1. Each flow carries the enthalpy of the side it comes from.
    """
    inward = orifice(
        source, AMBIENT, pressure, temperature, fill * h.fill_conductance, h.fill_ratio, h.exponent
    )
    outward = orifice(
        pressure, temperature, ATMOSPHERE, AMBIENT, vent * h.vent_conductance, h.vent_ratio, h.exponent
    )
    enthalpy = CP * inward * (AMBIENT if inward > 0.0 else temperature)
    return inward, outward, enthalpy - CP * outward * (temperature if outward > 0.0 else AMBIENT)


through_valve: Any = njit(_through_valve, nogil=True)


def _vessel_after(
    mass: float, temperature: float, gained: float, power: float, dt: float
) -> tuple[float, float]:
    """Return mass and temperature of the air of a vessel after a step.

    `gained`: air that flows in, kg/s. `power`: enthalpy flow and heat of the wall less the work on a
    piston, W.
    """
    warming = (power - CV * temperature * gained) / (CV * mass)
    return mass + dt * gained, temperature + dt * warming


vessel_after: Any = njit(_vessel_after, nogil=True)


def _piston_after(
    stroke: float, speed: float, friction: float, gauge: float, h: Any, dt: float
) -> tuple[float, float, float, float]:
    """Return stroke, speed and friction of the piston after a step, and the elastic force of the pads, N."""
    elastic, pads = contact(stroke - h.clearance, speed, h.stiffness, h.stiffening, h.contact_damping)
    stop = 0.0
    if stroke < 0.0:
        stop = max(-h.stop_stiffness * stroke - h.stop_damping * speed, 0.0)
    load = gauge * h.area - h.preload - h.spring_rate * stroke - pads + stop
    speed += dt * (load - friction - h.viscous * speed) / h.mass
    limit = h.coulomb + h.load_friction * elastic
    friction = friction_after(friction, speed, limit, h.presliding, dt)
    return stroke + dt * speed, speed, friction, elastic


piston_after: Any = njit(_piston_after, nogil=True)
