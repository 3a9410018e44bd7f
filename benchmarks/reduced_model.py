"""A reduced rig as a right-hand side for scipy's solve_ivp, made of the rig's own physics.

Train speed; for each wheelset the tank's pressure and temperature, the cylinder pressure (a first-order lag)
and the rotation: seventeen states. Left out: suspensions, brake line and reservoir, piston, hysteresis,
sensors and controller. LSODA, relative tolerance 1e-6.
"""

from collections.abc import Callable
from functools import cache
from types import SimpleNamespace
from typing import Any

import numpy as np
from numpy.typing import NDArray
from open_records import opened, rounded_twice
from stops import Stop

from uictest.core.physics import arithmetic
from uictest.core.physics.air import air_changes, coldness, enthalpy, mass_flow
from uictest.core.physics.brakes import torque
from uictest.core.physics.caliper import line
from uictest.core.physics.rail import creep_force
from uictest.core.physics.vehicle import SLOWEST_CREEP
from uictest.core.translation import translate
from uictest.rig.model.rail import FRICTIONS

_CYLINDER_LAG = 0.02
"""Time constant of the cylinder, s."""


def integrated_seconds(stop: Stop, duration: float) -> float:
    """Integrate the beginning of a stop; return the simulated time, s."""
    from scipy.integrate import solve_ivp

    rates = _rates()
    p = SimpleNamespace(**vars(opened(stop.parameters)), **vars(opened(stop.wheelset_parameters[0])))
    friction = float(stop.rail[FRICTIONS, 0])
    module = [p.atmospheric_pressure, p.air_temperature, p.atmospheric_pressure]
    wheelset = [*module, p.initial_speed / p.wheel_radius]
    start = np.array([p.initial_speed, *wheelset * 4])
    solution = solve_ivp(
        lambda _, x: rates(x, p, friction), (0.0, duration), start, method="LSODA", rtol=1e-6, atol=1e-6
    )
    return float(solution.t[-1])


@cache
def _rates() -> Callable[..., list[float]]:
    """Return the right-hand side, its products and sums rounded twice."""
    rates: Callable[..., list[float]] = translate(
        right_hand_side, lambda function: function, {arithmetic.fma: rounded_twice}
    )
    return rates


def right_hand_side(x: NDArray[np.float64], p: Any, friction: float) -> list[float]:
    """Rates of train speed; for each wheelset, of tank pressure and temperature, cylinder and rotation."""
    speed = max(float(x[0]), SLOWEST_CREEP)
    rates, braking = [0.0], 0.0
    for i in range(4):
        tank, temperature, cylinder, rotation = (float(value) for value in x[1 + 4 * i : 5 + 4 * i])
        slip = speed - p.wheel_radius * rotation
        force, _ = creep_force(
            abs(slip),
            speed,
            p.static_wheel_load,
            p.creep_stiffness,
            friction,
            p.friction_ratio,
            p.friction_decay,
            p.reduction_adhesion,
            p.reduction_slip,
        )
        creep = 2.0 * force if slip > 0.0 else -2.0 * force
        rates += [*_tank_rates(tank, temperature, p), (tank - cylinder) / _CYLINDER_LAG]
        rates += [(p.wheel_radius * creep - _brake(cylinder, p)) / p.rotational_inertia]
        braking += creep
    rates[0] = -braking / (8.0 * p.static_wheel_load / p.gravity)
    return rates


def _tank_rates(pressure: float, temperature: float, p: Any) -> tuple[float, float]:
    """Rates of pressure and temperature: the changes of a step whose heat is known beforehand."""
    supply = p.atmospheric_pressure + p.commanded_pressure
    inflow = mass_flow(
        supply,
        pressure,
        p.air_coldness,
        coldness(temperature),
        p.fill_conductance,
        p.critical_ratio,
        p.subsonic_scale,
        p.laminar_slope,
    )
    carried = enthalpy(inflow, p.air_temperature, temperature, p.heat_capacity_pressure)
    heat = p.tank_exchange / p.step * (p.air_temperature - temperature)
    warming, rise = air_changes(
        pressure,
        temperature,
        pressure * p.tank_volume / (p.gas_constant * temperature),
        inflow,
        carried + heat,
        p.tank_volume,
        0.0,
        p.air_temperature,
        0.0,
        p.gas_constant,
        p.heat_capacity_volume,
    )
    return rise, warming


def _brake(cylinder: float, p: Any) -> float:
    force = line(cylinder - p.atmospheric_pressure, p.linear_slope, p.linear_intercept)
    return torque(force, p.calipers_per_wheelset, p.pads_per_caliper, p.reference_pad_friction, p.disc_radius)
