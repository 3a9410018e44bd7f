"""From a case, as a user wrote it, to the numbers that the rig steps."""

import math
import zlib
from collections.abc import Callable, Iterator
from itertools import pairwise
from typing import Any

import numpy as np
from numpy.typing import NDArray

from uictest.controllers import ALGORITHMS
from uictest.physics import orifice_law, stiffnesses
from uictest.rig.cylinder_sampling import resampled
from uictest.rig.model.records import PARAMETERS
from uictest.scenario import Case, Scenario
from uictest.units import STANDARD_GRAVITY

_ALWAYS = 1.0

Value = tuple[str, float]


def assemble(case: Case) -> tuple[Any, NDArray[np.float64]]:
    """Return the parameter record of a case and the friction laws of its rail.

    Returns:
        A record of :data:`~uictest.rig.model.records.PARAMETERS` and an array of shape (4, n): places in m,
        friction coefficients there, times in s, factors then.
    """
    scenario = case.scenario
    record = np.zeros(1, PARAMETERS)
    rail = friction_laws(scenario)
    values = dict(_values(scenario))
    values["case_key"] = zlib.crc32(case.id.encode())
    missing = set(PARAMETERS.names or ()) ^ set(values)
    if missing:
        raise AssertionError(f"parameters without a value, or unknown: {', '.join(sorted(missing))}")
    for name, value in values.items():
        record[name] = value
    return record[0], rail


def friction_laws(scenario: Scenario) -> NDArray[np.float64]:
    """Friction along the track and its factor over time, as rows of equal length."""
    places = _friction_points(scenario)
    times = _friction_times(scenario)
    rail = np.zeros((4, max(len(places), len(times))))
    rail[0, : len(places)], rail[1, : len(places)] = np.array(places).T
    rail[2, : len(times)], rail[3, : len(times)] = np.array(times).T
    return rail


def _friction_points(scenario: Scenario) -> list[tuple[float, float]]:
    """Points of a piecewise linear law; a step is two points at one place."""
    friction = scenario.rail.friction
    if friction is None:
        return [(0.0, float(scenario.rail.condition.friction))]
    if isinstance(friction, float):
        return [(0.0, float(friction))]
    points = [(float(point.position), float(point.friction)) for point in friction.points]
    if friction.interpolation == "linear":
        return points
    steps = points[:1]
    for (_, before), (place, after) in pairwise(points):
        steps += [(place, before), (place, after)]
    return steps


def _friction_times(scenario: Scenario) -> list[tuple[float, float]]:
    law = scenario.rail.friction_over_time
    return [(0.0, _ALWAYS)] if law is None else [(float(p.time), float(p.factor)) for p in law.points]


def _values(scenario: Scenario) -> Iterator[Value]:
    for section in SECTIONS:
        yield from section(scenario)


def _time(scenario: Scenario) -> Iterator[Value]:
    step = float(scenario.simulation.time_step)
    cycle = float(scenario.controller.cycle_time)
    yield "step", step
    yield "cycle_time", cycle
    yield "steps_per_cycle", round(cycle / step)
    yield "cycles", math.ceil(scenario.simulation.maximum_duration / cycle - 1e-9)
    yield "seed", scenario.seed


def _command(scenario: Scenario) -> Iterator[Value]:
    position = scenario.brake.system.positions[scenario.brake.position]
    rig = scenario.rig
    yield "initial_speed", scenario.initial_speed
    yield "calipers", 4 if rig.topology == "four-caliper" else 1
    yield "uses_cylinder_dynamics", float(rig.compensation in ("cylinder", "full"))
    yield "uses_hysteresis", float(rig.compensation in ("hysteresis", "full"))
    yield "wsp_active", int(rig.wsp == "active")
    yield "algorithm", ALGORITHMS.index(scenario.controller.algorithm)
    yield "demanded_pressure", scenario.brake.command * position.maximum_pressure
    yield "dead_time", position.dead_time
    yield "filling_rate", 1.0 / position.fill_time


def _supply(scenario: Scenario) -> Iterator[Value]:
    system = scenario.brake.system
    atmosphere = system.air.atmospheric_pressure
    yield "relay_conductance", system.relay_valve.conductance
    yield "relay_gain", 1.0 / system.relay_valve.proportional_band
    air = float(system.air.gas_constant) * float(system.air.temperature)
    yield "line_volume", system.brake_line.volume
    yield "line_stiffness", system.tank.polytropic_exponent / system.brake_line.volume
    yield "reservoir_volume", system.reservoir.volume
    yield "reservoir_stiffness", air / system.reservoir.volume
    yield "reservoir_pressure", system.reservoir.initial_pressure + atmosphere
    yield "compressor_cut_in", system.compressor.cut_in_pressure + atmosphere
    yield "compressor_cut_out", system.compressor.cut_out_pressure + atmosphere
    yield "compressor_delivery", system.compressor.delivery
    yield "atmospheric_pressure", atmosphere
    yield "gas_constant", system.air.gas_constant
    yield "air_temperature", system.air.temperature
    yield "air", air
    law = orifice_law(
        float(system.critical_pressure_ratio),
        float(system.laminar_pressure_ratio),
        float(system.air.temperature),
    )
    names = ("flow_density", "critical_ratio", "subsonic_scale", "laminar_slope")
    yield from zip(names, law, strict=True)


def _modules(scenario: Scenario) -> Iterator[Value]:
    system = scenario.brake.system
    step = float(scenario.simulation.time_step)
    delay_cycles, delay_steps = _delay(scenario)
    yield "fill_conductance", system.wsp_valve.fill_conductance
    yield "vent_conductance", system.wsp_valve.vent_conductance
    yield "valve_travel_per_step", min(step / max(float(system.wsp_valve.travel_time), step), 1.0)
    yield "valve_delay_cycles", delay_cycles
    yield "valve_delay_steps", delay_steps
    yield "polytropic_exponent", system.tank.polytropic_exponent
    yield "tank_volume", system.tank.volume
    dead = system.caliper_tank.hose_and_dead_volume - system.caliper_tank.ball_volume
    yield "caliper_tank_volume", system.tank.volume + dead


def _delay(scenario: Scenario) -> tuple[int, int]:
    """Switching delay in whole controller cycles and the steps that remain."""
    step = float(scenario.simulation.time_step)
    steps_per_cycle = round(float(scenario.controller.cycle_time) / step)
    cycles, steps = divmod(
        round(float(scenario.brake.system.wsp_valve.switching_delay) / step), steps_per_cycle
    )
    return cycles, steps


_CALIPER_STIFFNESSES = (
    "piston_damping",
    "squeezing_stiffness",
    "releasing_stiffness",
    "free_compliance",
    "squeezing_compliance",
    "releasing_compliance",
)


def _caliper(scenario: Scenario) -> Iterator[Value]:
    caliper = scenario.rig.caliper
    yield "piston_area", caliper.piston_area
    yield "preload", caliper.preload
    yield "coulomb_friction", caliper.coulomb_friction
    yield "clearance", caliper.clearance
    derived = stiffnesses(
        float(caliper.spring_rate),
        float(caliper.load_friction),
        float(caliper.viscous_friction),
        float(caliper.contact_stiffness),
        float(scenario.simulation.time_step),
    )
    yield from zip(_CALIPER_STIFFNESSES, derived, strict=True)
    yield "contact_stiffness", caliper.contact_stiffness
    yield "lever_ratio", caliper.lever_ratio


def _compensation(scenario: Scenario) -> Iterator[Value]:
    model = scenario.rig.compensation_model
    step = float(scenario.simulation.time_step)
    numerator, denominator = resampled(
        [float(b) for b in model.cylinder.numerator],
        [float(a) for a in model.cylinder.denominator],
        float(model.sampling_time),
        step,
    )
    yield from zip(("b0", "b1", "b2", "b3"), numerator, strict=True)
    yield from zip(("a1", "a2", "a3"), denominator, strict=True)
    yield "linear_slope", model.linear.slope
    yield "linear_intercept", model.linear.intercept
    for phase in ("bc_squeezing", "bc_releasing", "wsp_squeezing", "wsp_releasing"):
        line = getattr(model.hysteresis, phase)
        yield f"{phase}_slope", line.slope
        yield f"{phase}_intercept", line.intercept
    yield "phase_change_per_step", min(step / max(float(model.hysteresis.transition_time), step), 1.0)
    yield "wsp_acting_cycles", round(model.hysteresis.wsp_acting_time / scenario.controller.cycle_time)


def _disc_brake(scenario: Scenario) -> Iterator[Value]:
    disc = scenario.brake.system.disc
    yield "calipers_per_wheelset", disc.calipers_per_wheelset
    yield "pads_per_caliper", disc.pads_per_caliper
    yield "pad_friction", disc.pad_friction
    yield "disc_radius", disc.mean_radius


def _vehicle(scenario: Scenario) -> Iterator[Value]:
    vehicle = scenario.vehicle
    yield "body_mass", vehicle.body.mass
    yield "body_inertia", vehicle.body.pitch_inertia
    yield "body_height", vehicle.body.height
    yield "bogie_mass", vehicle.bogie.mass
    yield "bogie_inertia", vehicle.bogie.pitch_inertia
    yield "bogie_height", vehicle.bogie.height
    yield "half_wheelbase", vehicle.bogie.half_wheelbase
    yield "half_pivot_distance", vehicle.half_pivot_distance
    yield "wheelset_mass", vehicle.wheelset.mass
    yield "wheelset_inertia", vehicle.wheelset.rotational_inertia
    yield "wheel_radius", vehicle.wheelset.radius
    yield from _responses(scenario)
    yield "resistance_constant", vehicle.running_resistance.constant
    yield "resistance_linear", vehicle.running_resistance.linear
    yield "resistance_quadratic", vehicle.running_resistance.quadratic
    yield "gravity", STANDARD_GRAVITY
    wheels = 8.0
    yield "static_wheel_load", vehicle.total_mass * STANDARD_GRAVITY / wheels


def _responses(scenario: Scenario) -> Iterator[Value]:
    """What a force or moment changes within one step, and for wheelsets the inverses."""
    wheelset = scenario.vehicle.wheelset
    step = float(scenario.simulation.time_step)
    for name, frame in (("body", scenario.vehicle.body), ("bogie", scenario.vehicle.bogie)):
        yield f"{name}_mass_response", step / frame.mass
        yield f"{name}_pitch_response", step / frame.pitch_inertia
    by_mass = step / wheelset.mass
    by_inertia = step / wheelset.rotational_inertia
    slip_response = by_mass + wheelset.radius * wheelset.radius * by_inertia
    yield "mass_response", by_mass
    yield "inertia_response", by_inertia
    yield "inertia_stiffness", 1.0 / by_inertia
    yield "slip_response", slip_response
    yield "slip_stiffness", 1.0 / slip_response


def _suspension(scenario: Scenario) -> Iterator[Value]:
    """Suspension of a wheelset (two axle boxes) and of a bogie (two sides)."""
    vehicle = scenario.vehicle
    pair = 2.0
    for name, suspension in (("primary", vehicle.primary), ("secondary", vehicle.secondary)):
        yield f"{name}_longitudinal_stiffness", pair * suspension.longitudinal_stiffness
        yield f"{name}_longitudinal_damping", pair * suspension.longitudinal_damping
        yield f"{name}_vertical_stiffness", pair * suspension.vertical_stiffness
        yield f"{name}_vertical_damping", pair * suspension.vertical_damping
    yield "secondary_height", vehicle.secondary.height
    yield "link_stiffness", vehicle.traction_link.stiffness
    yield "link_damping", vehicle.traction_link.damping
    yield "link_height", vehicle.traction_link.height


def _rail(scenario: Scenario) -> Iterator[Value]:
    condition = scenario.rail.condition
    contact = condition.contact
    yield "gradient", scenario.rail.gradient
    yield "friction_ratio", condition.friction_ratio
    yield "friction_decay", condition.friction_decay
    yield "reduction_adhesion", condition.reduction_adhesion
    yield "reduction_slip", condition.reduction_slip
    area = math.pi * contact.semi_axis_longitudinal * contact.semi_axis_lateral
    yield "creep_stiffness", 0.25 * contact.shear_modulus * area * contact.kalker_coefficient
    yield "reference_load", contact.reference_wheel_load
    yield "load_scale", 1.0 / contact.reference_wheel_load
    yield "friction_points", len(_friction_points(scenario))
    yield "friction_times", len(_friction_times(scenario))


def _sensors(scenario: Scenario) -> Iterator[Value]:
    sensors = scenario.rig.sensors
    yield "tooth_pitch", 2.0 * math.pi * scenario.vehicle.wheelset.radius / sensors.speed.teeth
    yield "timer_resolution", sensors.speed.timer_resolution
    yield "slowest_measured_speed", sensors.speed.minimum_speed
    yield "speed_noise", sensors.speed.noise
    yield "pressure_range", sensors.pressure.range
    yield "pressure_gain_error", sensors.pressure.gain_error
    yield "pressure_offset", sensors.pressure.offset
    yield "pressure_noise", sensors.pressure.noise
    yield "pressure_resolution", sensors.pressure.resolution
    yield "pressure_steps", 1.0 / sensors.pressure.resolution
    yield "loadcell_range", sensors.loadcell.range
    yield "loadcell_gain_error", sensors.loadcell.gain_error
    yield "loadcell_offset", sensors.loadcell.offset
    yield "loadcell_noise", sensors.loadcell.noise
    yield "loadcell_resolution", sensors.loadcell.resolution
    yield "loadcell_steps", 1.0 / sensors.loadcell.resolution


_CONTROLLER_FIELDS = {
    "threshold": {
        name: name
        for name in (
            "slip_threshold",
            "slide_threshold",
            "deep_slide",
            "vent_deceleration",
            "hold_deceleration",
            "reacceleration_threshold",
            "acceleration_filter_time",
            "reference_deceleration",
            "holding_deceleration",
            "rolling_time",
            "sounding_interval",
            "sounding_time",
            "minimum_speed",
            "vent_watchdog",
            "hold_limit",
            "recovery_share",
            "fill_pulse_on",
            "fill_pulse_off",
            "refill_time",
        )
    },
    "slip-band": {
        "lower_slide": "lower_slide",
        "upper_slide": "upper_slide",
        "reference_deceleration": "band_reference_deceleration",
        "minimum_speed": "band_minimum_speed",
    },
}
"""Parameters of each controller's model and their fields in the record."""


def _controller(scenario: Scenario) -> Iterator[Value]:
    """Parameters of the controller in use; those of the others are zero and never read."""
    for fields in _CONTROLLER_FIELDS.values():
        for field in fields.values():
            yield field, 0.0
    for name, field in _CONTROLLER_FIELDS[scenario.controller.algorithm].items():
        yield field, getattr(scenario.controller, name)


def _measures(scenario: Scenario) -> Iterator[Value]:
    yield from ((name, float(value)) for name, value in scenario.measures if isinstance(value, float))


SECTIONS: dict[Callable[[Scenario], Iterator[Value]], tuple[str, ...]] = {
    _time: ("simulation", "controller.cycle_time", "seed"),
    _command: (
        "brake.command",
        "brake.position",
        "brake.system.positions",
        "rig.topology",
        "rig.compensation",
        "rig.wsp",
        "initial_speed",
        "controller.algorithm",
    ),
    _supply: ("brake.system",),
    _modules: ("brake.system", "simulation.time_step", "controller.cycle_time"),
    _caliper: ("rig.caliper", "simulation.time_step"),
    _compensation: ("rig.compensation_model", "simulation.time_step", "controller.cycle_time"),
    _disc_brake: ("brake.system",),
    _vehicle: ("vehicle", "simulation.time_step"),
    _suspension: ("vehicle", "simulation.time_step"),
    _rail: ("rail",),
    _sensors: ("rig.sensors", "vehicle.wheelset"),
    _controller: ("controller",),
    _measures: ("measures",),
}
"""Sections of the record and the keys of a scenario at or below which a section reads: where none of them
differs between two cases, neither does the section."""
FRICTION_KEYS = ("rail",)
"""The same for :func:`friction_laws`."""
