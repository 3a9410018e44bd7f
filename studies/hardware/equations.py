"""Flow laws and rates of the second module: equations of its own, none of the rig's."""

from __future__ import annotations

from math import exp, pi, pow as power, sqrt
from typing import Any

from studies.hardware.parameters import AMBIENT, ATMOSPHERE, CP, CV, GAS, REFERENCE_DENSITY, VISCOSITY

_LINEAR = 0.999
"""Pressure ratio above which the flow is linear in the difference: its slope is infinite at 1."""


def minimum(a: float, b: float) -> float:
    """Return the smaller of two numbers."""
    return a if a < b else b


def maximum(a: float, b: float) -> float:
    """Return the larger of two numbers."""
    return a if a > b else b


def reduced(ratio: float, b: float, m: float) -> float:
    """Return the flow over the choked one at p2 / p1 = `ratio`, ISO 6358-1:2013."""
    if ratio <= b:
        return 1.0
    within = (minimum(ratio, _LINEAR) - b) / (1.0 - b)
    flow = power(1.0 - within * within, m)
    return flow * (1.0 - ratio) / (1.0 - _LINEAR) if ratio > _LINEAR else flow


def orifice(p1: float, t1: float, p2: float, t2: float, conductance: float, b: float, m: float) -> float:
    """Return the mass flow from side 1 to side 2, kg/s; negative where side 2 has the higher pressure."""
    if p1 >= p2:
        choked = conductance * REFERENCE_DENSITY * p1 * sqrt(AMBIENT / t1)
        return choked * reduced(p2 / p1, b, m)
    choked = conductance * REFERENCE_DENSITY * p2 * sqrt(AMBIENT / t2)
    return -choked * reduced(p1 / p2, b, m)


def hose_drop(flow: float, pressure: float, bore: float, length: float, losses: float) -> float:
    """Return the loss of pressure along a hose, Pa, of the sign of the flow (kg/s), air at ambient.

    The larger of laminar (Hagen-Poiseuille) and turbulent friction (Blasius, smooth wall), and the fittings.
    """
    density = pressure / (GAS * AMBIENT)
    speed = abs(flow) / (density * 0.25 * pi * bore * bore)
    laminar = 32.0 * VISCOSITY * length * speed / (bore * bore)
    blasius = 0.1582 * power(VISCOSITY, 0.25) * power(density, 0.75)
    turbulent = blasius * length * power(speed, 1.75) / power(bore, 1.25)
    drop = maximum(laminar, turbulent) + losses * 0.5 * density * speed * speed
    return drop if flow > 0.0 else -drop


def contact(
    compression: float, speed: float, stiffness: float, stiffening: float, damping: float
) -> tuple[float, float]:
    """Return the elastic force of the pads at the piston and that with their damping, N; they never pull."""
    if compression <= 0.0:
        return 0.0, 0.0
    elastic = (stiffness + stiffening * compression) * compression
    return elastic, maximum(elastic + damping * speed, 0.0)


def friction_after(friction: float, speed: float, limit: float, presliding: float, step: float) -> float:
    """Return the friction after a step, N: Dahl, F' = s (v - |v| F / limit), solved for constant v."""
    end = limit if speed > 0.0 else -limit
    return end + (friction - end) * exp(-presliding * abs(speed) * step / limit)


def through_valve(
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


def vessel_after(
    mass: float, temperature: float, gained: float, power: float, dt: float
) -> tuple[float, float]:
    """Return mass and temperature of the air of a vessel after a step.

    `gained`: air that flows in, kg/s. `power`: enthalpy flow and heat of the wall less the work on a
    piston, W.
    """
    warming = (power - CV * temperature * gained) / (CV * mass)
    return mass + dt * gained, temperature + dt * warming


def piston_after(
    stroke: float, speed: float, friction: float, gauge: float, h: Any, dt: float
) -> tuple[float, float, float, float]:
    """Return stroke, speed and friction of the piston after a step, and the elastic force of the pads, N."""
    elastic, pads = contact(stroke - h.clearance, speed, h.stiffness, h.stiffening, h.contact_damping)
    stop = 0.0
    if stroke < 0.0:
        stop = maximum(-h.stop_stiffness * stroke - h.stop_damping * speed, 0.0)
    load = gauge * h.area - h.preload - h.spring_rate * stroke - pads + stop
    speed += dt * (load - friction - h.viscous * speed) / h.mass
    limit = h.coulomb + h.load_friction * elastic
    friction = friction_after(friction, speed, limit, h.presliding, dt)
    return stroke + dt * speed, speed, friction, elastic
