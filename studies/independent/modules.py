"""What the independent rig has for each module: its valve over time, and the force that is computed."""

from __future__ import annotations

from collections.abc import Callable, Iterable
from functools import lru_cache
from typing import Any, Final

import numpy as np
from numpy.typing import NDArray

from uictest import Recording

Array = NDArray[np.float64]

FILL, VENT = 0, 2
_PLAY: Final = 2e-5
"""Time in which a play follows its line, s; chosen, short beside all else."""


class Openings:
    """Openings of one WSP valve, and the share of the WSP's hysteresis lines, under recorded commands.

    Args:
        stop: a sample per controller cycle; a sample has the command of the cycle that ends with it.
        number: of the wheelset, 1..4.
        scenario: of the case.
    """

    def __init__(self, stop: Recording, number: int, scenario: Any) -> None:
        valve, lines = scenario.brake.system.wsp_valve, scenario.rig.compensation_model.hysteresis
        cycle = float(scenario.controller.cycle_time)
        commands = stop[f"valve_command_{number}"][1:]
        times = cycle * np.arange(len(commands))
        delay, travel = float(valve.switching_delay), float(valve.travel_time)
        self.fill = _followed(times + delay, commands == FILL, 1.0, travel)
        self.vent = _followed(times + delay, commands == VENT, 0.0, travel)
        longest, filled, acting = round(float(lines.wsp_acting_time) / cycle), 10**6, []
        for command in commands:
            filled = filled + 1 if command == FILL else 0
            acting.append(filled < longest)
        self.acting = _followed(times, acting, 0.0, float(lines.transition_time))

    def at(self, time: float) -> tuple[float, float, float]:
        """Return the openings of fill and vent and the share of the WSP's lines at a time."""
        fill, vent, acting = (float(np.interp(time, *each)) for each in (self.fill, self.vent, self.acting))
        return fill, vent, acting


def openings_of_car(stop: Recording, scenario: Any) -> Callable[[float], Array]:
    """Return what gives those of all modules at a time, shape (3, 4): fill, vent, share of the lines."""
    valves = [Openings(stop, number, scenario) for number in range(1, 5)]
    # A Jacobian asks for all columns at one time.
    return lru_cache(maxsize=1)(lambda time: np.array([each.at(time) for each in valves]).T)


def _followed(
    times: NDArray[Any], targets: Iterable[Any], first: float, travel: float
) -> tuple[Array, Array]:
    """Return times and values of what moves to each target, 0 or 1, by 1 in `travel`."""
    knots, value, target, since = [(-1.0, first)], first, first, 0.0
    for time, wanted in zip(times, map(float, targets), strict=True):
        if wanted == target:
            continue
        arrives = since + abs(target - value) * travel
        if arrives < time:
            knots.append((arrives, target))
            value = target
        else:
            value += (time - since) / travel * (1.0 if target > value else -1.0)
        knots.append((float(time), value))
        target, since = wanted, float(time)
    knots.append((since + abs(target - value) * travel, target))
    ends, values = np.array(knots).T
    return ends, values


class ModelledAir:
    """The compensation `thermal`: the air that a caliper's module would hold, and the force by its lines."""

    def __init__(self, scenario: Any) -> None:
        self.brake, model = scenario.brake.system, scenario.rig.compensation_model
        self.model, self.lines = model.air, model.hysteresis
        air, volume = self.brake.air, float(self.brake.tank.volume)
        self.ambient, self.ratio = float(air.temperature), float(air.heat_capacity_ratio)
        self.atmosphere = float(air.atmospheric_pressure)
        self.heating = (self.ratio - 1.0) * self.ambient / volume
        self.per_flow = float(air.gas_constant) * self.ambient / volume
        self.swept = float(self.model.swept_volume) / volume

    def rates(self, state: Any, valve: tuple[Array, Array, Array], orifice: Any) -> dict[str, Array]:
        """Return the rates of both amounts, of pressure times volume, of piston travel and of the force.

        Args:
            state: present values by name; amounts are pressures at the temperature of the walls.
            valve: openings of fill and vent, and share of the WSP's lines, of each module.
            orifice: mass flow of two pressures, two temperatures and a conductance.
        """
        fill, vent, acting = valve
        volume = 1.0 + self.swept * (state.travel - 1.0)
        pressure = state.pressure_volume / volume
        warmth, tank_warmth = state.pressure_volume / state.amount, state.tank / state.tank_amount
        heated = state.rise - self.heating * self.model.tank_heat_conductance * (1.0 - tank_warmth)
        gained = heated / (self.ratio * np.where(heated < 0.0, tank_warmth, 1.0))

        def let_in(own: Array, own_warmth: Array) -> Array:
            vents = vent > fill
            conductance = np.where(
                vents,
                self.brake.wsp_valve.vent_conductance * vent,
                self.brake.wsp_valve.fill_conductance * fill,
            )
            other = np.where(vents, self.atmosphere, state.line)
            flow: Array = orifice(other, own, self.ambient, own_warmth * self.ambient, conductance)
            return self.per_flow * flow

        amount = gained + let_in(pressure, warmth) - let_in(state.tank, tank_warmth)
        out = self._travel(state.pressure_volume, self.model.closing_pressure)
        back = self._travel(state.pressure_volume, self.model.opening_pressure)
        travel = _drawn(state.travel, np.clip(out, 0.0, 1.0), np.clip(back, 0.0, 1.0))
        energy = self.ratio * amount * np.where(amount < 0.0, warmth, 1.0)
        energy += self.heating * self.model.caliper_heat_conductance * (1.0 - warmth)
        energy -= (self.ratio - 1.0) * pressure * self.swept * travel
        gauge = pressure - self.atmosphere
        squeezing = self._line(gauge, acting, self.lines.bc_squeezing, self.lines.wsp_squeezing)
        releasing = self._line(gauge, acting, self.lines.bc_releasing, self.lines.wsp_releasing)
        force = _drawn(state.force, squeezing, np.maximum(squeezing, releasing))
        return {
            "tank_amount": gained,
            "amount": amount,
            "pressure_volume": energy,
            "travel": travel,
            "force": force,
        }

    def _travel(self, pressure_volume: Array, gauge: Any) -> Array:
        travel: Array = (pressure_volume / (gauge + self.atmosphere) - (1.0 - self.swept)) / self.swept
        return travel

    def _line(self, gauge: Array, share: Array, braking: Any, wsp: Any) -> Array:
        slope = braking.slope + share * (wsp.slope - braking.slope)
        intercept = braking.intercept + share * (wsp.intercept - braking.intercept)
        force: Array = np.maximum(slope * gauge + intercept, 0.0)
        return force


def _drawn(value: Array, low: Array, high: Array) -> Array:
    """Return the rate of what stays between two lines and is drawn to them from beyond."""
    return (np.maximum(low - value, 0.0) - np.maximum(value - high, 0.0)) / _PLAY
