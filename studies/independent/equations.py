"""The whole rig as ordinary differential equations, written a second time from its description.

It shares with the rig what a scenario says, read by the package and in SI units, and nothing of how the rig
computes: no function of `uictest.core.physics` or `uictest.rig`. What differs on purpose:

- the vehicle is M q'' + C q' + K q = f, assembled from a list of springs and dampers;
- friction acts at the place and time of each wheelset, not from cycle to cycle;
- air is mass and temperature of each vessel, pressure follows from them;
- the piston of a caliper moves by its viscous friction, p A - F0 - k y - N -+ (Fc + alpha N) = (c + cN) y';
- a play (four-phase hysteresis, piston of the modelled air) follows its lines within a short time.

Valves are told what the rig's own stop commanded, at the same instants. Left out: errors of the sensors, pads
whose friction varies, wheelsets that differ, faults, the cylinder filter of the paper.
"""

from __future__ import annotations

from types import SimpleNamespace
from typing import Final

import numpy as np
from numpy.typing import NDArray

from studies.independent.car import Car
from studies.independent.modules import ModelledAir, openings_of_car
from studies.independent.orifice import Orifice
from uictest import Case, Recording

Array = NDArray[np.float64]

_SLOWEST: Final = 0.01
"""Running speed below which creepage is taken at this speed, m/s: a definition of the model."""
_WHEELSETS: Final = np.arange(4)

PLACES = {
    "q": slice(0, 13),
    "rate": slice(13, 26),
    "rotation": slice(26, 30),
    "stroke": slice(30, 34),
    "mass": slice(34, 38),
    "temperature": slice(38, 42),
    "line": slice(42, 44),
    "reservoir": slice(44, 45),
    "contact_loss": slice(45, 49),
    "losses": slice(49, 52),
    "consumed": slice(52, 53),
    "cleaned": slice(53, 57),
    "tank_amount": slice(57, 61),
    "amount": slice(61, 65),
    "pressure_volume": slice(65, 69),
    "travel": slice(69, 73),
    "force": slice(73, 77),
}
"""Where each part of the state stands: coordinates are x, z, pitch of body and bogies, x of wheelsets."""
SIZE: Final = 77
SIZE_WITHOUT_COMPUTED_FORCE: Final = 57
TOLERANCES: Final = np.repeat(
    [1e-8, 1e-8, 1e-8, 1e-10, 1e-11, 1e-6, 1e-8, 1e-9, 1e-2, 1e-2, 1e-9, 1e-8, 1e-1, 1e-1, 1e-1, 1e-8, 1e-3],
    [13, 13, 4, 4, 4, 4, 2, 1, 4, 3, 1, 4, 4, 4, 4, 4, 4],
)
"""Absolute, beside a relative one of 1e-8, in SI units."""


class Equations:
    """The rates of the state of one case under the valve commands of its recorded stop."""

    def __init__(self, case: Case, stop: Recording) -> None:
        scenario = case.scenario
        self.s, self.brake, self.caliper = scenario, scenario.brake.system, scenario.rig.caliper
        self.air, self.rail = self.brake.air, scenario.rail
        self.atmosphere, self.ambient = float(self.air.atmospheric_pressure), float(self.air.temperature)
        self.gas, self.ratio = float(self.air.gas_constant), float(self.air.heat_capacity_ratio)
        self.cv = self.gas / (self.ratio - 1.0)
        self.has_caliper = np.array([1.0, *[float(scenario.rig.topology == "four-caliper")] * 3])
        self.radius = float(scenario.vehicle.wheelset.radius)
        self.locked = np.zeros(4, dtype=bool)
        self.compressor = False
        self.trail: list[tuple[list[float], list[float]]] = [([], []) for _ in _WHEELSETS]
        self.car = Car(scenario.vehicle)
        self.weight_along_rail = self.car.weight * float(self.rail.gradient)
        self._read_brake()
        self.valves = openings_of_car(stop, scenario)
        computes = scenario.rig.topology == "one-caliper"
        self.modelled_air = ModelledAir(scenario) if computes else None

    def _read_brake(self) -> None:
        tank, balls, disc = self.brake.tank, self.brake.caliper_tank, self.brake.disc
        position = self.brake.positions[self.s.brake.position]
        self.demand = float(self.s.brake.first_command * position.maximum_pressure)
        self.dead, self.fill_time = float(position.dead_time), float(position.fill_time)
        filled = tank.volume + balls.hose_and_dead_volume - balls.ball_volume
        self.volume = np.where(self.has_caliper > 0.0, filled, tank.volume)
        wall = tank.film_coefficient * tank.surface
        warm = wall + balls.film_coefficient * balls.ball_surface
        self.wall = np.where(self.has_caliper > 0.0, warm, wall)
        self.area = self.has_caliper * float(self.caliper.piston_area)
        faces = disc.calipers_per_wheelset * disc.pads_per_caliper
        self.lever_arm = float(faces * disc.pad_friction * disc.mean_radius)
        self.orifice = Orifice(
            float(self.brake.critical_pressure_ratio), float(self.brake.laminar_pressure_ratio)
        )

    def start(self) -> Array:
        """Return the state at the brake command: rolling, all vessels but the reservoir empty."""
        size = SIZE_WITHOUT_COMPUTED_FORCE if self.modelled_air is None else SIZE
        y, speed = np.zeros(size), float(self.s.initial_speed)
        y[PLACES["rate"]][[0, 3, 6, 9, 10, 11, 12]] = speed
        y[PLACES["rotation"]] = speed / self.radius
        per_kg = self.gas * self.ambient
        y[PLACES["mass"]] = self.atmosphere * self.volume / per_kg
        y[PLACES["temperature"]] = self.ambient
        y[PLACES["line"]] = self.atmosphere * self.brake.brake_line.volume / per_kg, self.ambient
        pressure = self.brake.reservoir.initial_pressure + self.atmosphere
        y[PLACES["reservoir"]] = pressure * self.brake.reservoir.volume / per_kg
        if self.modelled_air is not None:
            y[PLACES["tank_amount"]] = self.atmosphere
            rest = self.atmosphere * (1.0 - self.modelled_air.swept)
            y[PLACES["amount"]] = y[PLACES["pressure_volume"]] = rest
        return y

    def friction(self, time: float, y: Array) -> Array:
        """Return the initial friction coefficient under each wheelset."""
        place = y[9:13] - self.car.behind
        law = self.rail.friction
        if law is None or isinstance(law, float):
            found = np.full(4, float(self.rail.condition.friction if law is None else law))
        else:
            places = [float(each.position) for each in law.points]
            values = [float(each.friction) for each in law.points]
            after = np.clip(np.searchsorted(places, place, side="right") - 1, 0, None)
            found = np.interp(place, places, values)
            found = found if law.interpolation == "linear" else np.array(values)[after]
        return found + self.cleaned(y) * np.maximum(self._recovered - found, 0.0)

    @property
    def _recovered(self) -> float:
        cleaning = self.rail.cleaning_in_force
        return 0.0 if cleaning is None else float(cleaning.recovered_friction)

    def cleaned(self, y: Array) -> Array:
        """Return the share of the rail that is clean behind each wheelset; the trail is up to date."""
        own, cleaning = y[PLACES["cleaned"]], self.rail.cleaning_in_force
        if cleaning is None:
            return own
        behind, place = np.zeros(4), y[9:13] - self.car.behind
        for i in _WHEELSETS:
            trail = self.trail[i - 1]
            left = np.interp(place[i], *trail, left=0.0) if i > 0 and trail[0] else 0.0
            behind[i] = 1.0 - (1.0 - own[i]) * (1.0 - cleaning.carry_over * left)
        return behind

    def creep_force(self, y: Array, friction: Array, load: Array) -> tuple[Array, Array]:
        """Return the force of the rail on both wheels of each wheelset against its motion, and the slip."""
        law, speed = self.rail.condition, y[22:26]
        slip = speed - self.radius * y[PLACES["rotation"]]
        size = np.abs(slip)
        mu = friction * ((1.0 - law.friction_ratio) * np.exp(-law.friction_decay * size) + law.friction_ratio)
        contact = law.contact
        area = np.pi * contact.semi_axis_longitudinal * contact.semi_axis_lateral
        ellipse: Array = area * (load / contact.reference_wheel_load) ** (2.0 / 3.0)
        creepage = size / np.maximum(np.abs(speed), _SLOWEST)
        gradient = (
            0.25 * contact.shear_modulus * ellipse * contact.kalker_coefficient * creepage / (load * mu)
        )
        adhesion, sliding = law.reduction_adhesion * gradient, law.reduction_slip * gradient
        share = (2.0 / np.pi) * (adhesion / (1.0 + adhesion**2) + np.arctan(sliding))
        return 2.0 * load * mu * share * np.sign(slip), slip

    def clamping_force(self, y: Array) -> Array:
        """Return the force of one pad of each wheelset: of its caliper, or computed."""
        caliper = self.caliper
        gap = np.maximum(y[PLACES["stroke"]] - caliper.clearance, 0.0)
        real = float(caliper.lever_ratio * caliper.contact_stiffness) * gap
        return (
            real if self.modelled_air is None else np.where(self.has_caliper > 0.0, real, y[PLACES["force"]])
        )

    def suspension(self, y: Array) -> tuple[Array, Array]:
        """Return the force of each spring with its damper, and the loads of one wheel of each wheelset."""
        forces = self.car.stiffness * (self.car.rows @ y[:13]) + self.car.damping * (self.car.rows @ y[13:26])
        return forces, self.car.static_load - 0.5 * forces[10:14]

    def pressures(self, y: Array) -> Array:
        """Return the absolute pressure in each tank."""
        volume = self.volume + self.area * y[PLACES["stroke"]]
        pressures: Array = y[PLACES["mass"]] * self.gas * y[PLACES["temperature"]] / volume
        return pressures

    def switch_compressor(self, y: Array) -> None:
        """Let the compressor start or rest by the pressure in the reservoir."""
        compressor = self.brake.compressor
        pressure = float(y[44]) * self.gas * self.ambient / self.brake.reservoir.volume - self.atmosphere
        if not compressor.cut_in_pressure <= pressure <= compressor.cut_out_pressure:
            self.compressor = pressure < compressor.cut_in_pressure

    def remember(self, y: Array) -> None:
        """Note what each wheelset leaves of the rail at its place."""
        for (places, shares), place, share in zip(
            self.trail, y[9:13] - self.car.behind, self.cleaned(y), strict=True
        ):
            places.append(float(place))
            shares.append(float(share))

    def rail_torque_beyond_brake(self, time: float, y: Array) -> Array:
        """Return by how much the torque of the rail on each wheelset exceeds that of its brake, N m."""
        creep, _ = self.creep_force(y, self.friction(time, y), self.suspension(y)[1])
        return self.radius * creep - self.lever_arm * self.clamping_force(y)

    def rates(self, time: float, y: Array) -> Array:
        """Return the derivative of the state."""
        dy = np.zeros(len(y))
        self._move(time, y, dy)
        self._flow(time, y, dy)
        return dy

    def _move(self, time: float, y: Array, dy: Array) -> None:
        rate, rotation = y[13:26], y[PLACES["rotation"]]
        forces, load = self.suspension(y)
        creep, slip = self.creep_force(y, self.friction(time, y), load)
        applied = -self.car.rows.T @ forces
        davis = self.s.vehicle.running_resistance
        drag = davis.constant + davis.linear * rate[0] + davis.quadratic * rate[0] ** 2
        applied[0] -= drag
        applied -= self.weight_along_rail
        applied[9:13] -= creep
        full = self.lever_arm * self.clamping_force(y)
        torque = np.where(self.locked, self.radius * creep, full)
        applied[[5, 8]] -= torque[0] + torque[1], torque[2] + torque[3]
        dy[:13], dy[13:26] = rate, applied / self.car.masses
        dy[PLACES["rotation"]] = np.where(self.locked, 0.0, (self.radius * creep - torque) / self.car.inertia)
        loss = creep * slip
        pitching = rate[[5, 5, 8, 8]]
        damped = float(self.car.damping @ (self.car.rows @ rate) ** 2)
        dy[PLACES["contact_loss"]] = loss
        dy[PLACES["losses"]] = float(torque @ (rotation + pitching)), damped, drag * rate[0]
        cleaning = self.rail.cleaning_in_force
        if cleaning is not None:
            per_metre = np.maximum(loss / max(float(rate[0]), _SLOWEST), 0.0)
            settled = 1.0 - np.exp(-per_metre / cleaning.energy)
            dy[PLACES["cleaned"]] = (settled - y[PLACES["cleaned"]]) * rate[0] / cleaning.reach

    def _flow(self, time: float, y: Array, dy: Array) -> None:
        brake, mass, warmth = self.brake, y[PLACES["mass"]], y[PLACES["temperature"]]
        fill, vent, acting = self.valves(time)
        volume = self.volume + self.area * y[PLACES["stroke"]]
        pressure = mass * self.gas * warmth / volume
        line_mass, line_warmth = y[PLACES["line"]]
        line = line_mass * self.gas * line_warmth / brake.brake_line.volume
        valve = brake.wsp_valve
        drawn = self.orifice(line, pressure, line_warmth, warmth, valve.fill_conductance * fill)
        vented = self.orifice(pressure, self.atmosphere, warmth, self.ambient, valve.vent_conductance * vent)
        self._move_pistons(y, dy, pressure - self.atmosphere)
        work = pressure * self.area * dy[PLACES["stroke"]]
        carried = drawn * np.where(drawn > 0.0, line_warmth, warmth)
        heat = self.wall * (self.ambient - warmth)
        let_out = vented * np.where(vented > 0.0, warmth, self.ambient)
        cp = self.ratio * self.cv
        gained = drawn - vented
        warming = (cp * (carried - let_out) + heat - work - self.cv * warmth * gained) / (self.cv * mass)
        dy[PLACES["mass"]], dy[PLACES["temperature"]] = gained, warming
        self._supply(time, y, dy, line, float(drawn.sum()), cp * float(carried.sum()))
        if self.modelled_air is not None:
            names = ("tank_amount", "amount", "pressure_volume", "travel", "force")
            state = SimpleNamespace(**{name: y[PLACES[name]] for name in names}, tank=pressure, line=line)
            state.rise = self.gas * (gained * warmth + mass * warming) / volume
            modelled = self.modelled_air.rates(state, (fill, vent, acting), self.orifice)
            for name, rate in modelled.items():
                dy[PLACES[name]] = rate

    def _move_pistons(self, y: Array, dy: Array, gauge: Array) -> None:
        caliper, stroke = self.caliper, y[PLACES["stroke"]]
        touches = np.maximum(stroke - caliper.clearance, 0.0)
        contact = caliper.contact_stiffness * touches
        driven = gauge * caliper.piston_area - caliper.preload - caliper.spring_rate * stroke - contact
        friction = caliper.coulomb_friction + caliper.load_friction * contact
        moved = np.maximum(driven - friction, 0.0) - np.maximum(-driven - friction, 0.0)
        viscous = caliper.viscous_friction + np.where(touches > 0.0, float(caliper.contact_friction), 0.0)
        at_rest = (stroke <= 0.0) & (moved < 0.0)
        dy[PLACES["stroke"]] = np.where(at_rest, 0.0, moved / viscous)

    def _supply(self, time: float, y: Array, dy: Array, line: float, drawn: float, carried: float) -> None:
        brake, cp = self.brake, self.ratio * self.cv
        mass, warmth = y[PLACES["line"]]
        reservoir = float(y[44]) * self.gas * self.ambient / brake.reservoir.volume
        demand = self.demand * min(max((time - self.dead) / self.fill_time, 0.0), 1.0)
        missing = (demand - (line - self.atmosphere)) / brake.relay_valve.proportional_band
        conductance = brake.relay_valve.conductance * min(abs(missing), 1.0)
        if missing > 0.0:
            flow = float(self.orifice(reservoir, line, self.ambient, warmth, conductance))
            filled, gained = flow, flow * (self.ambient if flow > 0.0 else warmth)
        else:
            flow = float(self.orifice(line, self.atmosphere, warmth, self.ambient, conductance))
            filled, gained = 0.0, -flow * warmth
        change = (filled if missing > 0.0 else -flow) - drawn
        heat = brake.brake_line.film_coefficient * brake.brake_line.surface * (self.ambient - warmth)
        energy = cp * gained - carried + heat
        dy[PLACES["line"]] = change, (energy - self.cv * warmth * change) / (self.cv * mass)
        dy[44] = self.compressor * brake.compressor.delivery - filled
        dy[52] = filled
