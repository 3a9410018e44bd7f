"""Tables of the discs and of the faults of a stop, from its scenario."""

import math
from collections.abc import Iterator

from uictest.core.physics import (
    MODES,
    MOST_PAD_POINTS,
    held_mode,
    held_rest,
    mode_relaxation,
    quotient_scale,
    relaxed_share,
)
from uictest.core.units import KINDS
from uictest.plans.fault_effects import Effects
from uictest.plans.faults import FAULT_KINDS, MOST_FAULTS, SPEED_SENSOR
from uictest.plans.scenario import DiscRing, Fault, PadLaw, Quantity, Scenario
from uictest.rig.derived_parameters import Assignment
from uictest.rig.model.parameters import Parameters


def _pad(p: Parameters, scenario: Scenario) -> None:
    pad = scenario.brake.pad
    speed, force, temperature = (law or PadLaw() for law in (pad.speed, pad.force, pad.temperature))
    p.varies_pad_friction = float(pad.varies)
    p.pad_speed_points, p.pad_speeds, p.pad_speed_factors = _table(speed)
    p.pad_force_points, p.pad_forces, p.pad_force_factors = _table(force)
    p.pad_temperature_points, p.pad_temperatures, p.pad_temperature_factors = _table(temperature)
    p.pad_speed_scale = quotient_scale(*speed.quotient)
    p.pad_force_scale = quotient_scale(*force.quotient)
    _, p.pad_speed_numerator, p.pad_speed_denominator = speed.quotient
    _, p.pad_force_numerator, p.pad_force_denominator = force.quotient


def _table(law: PadLaw) -> tuple[int, list[float], list[float]]:
    """Return number, places and factors of the points of a table, as long as the record's tables."""
    places, factors = zip(*law.table, strict=True)
    blank = [0.0] * (MOST_PAD_POINTS - len(places))
    return len(places), [*places, *blank], [*factors, *blank]


def _disc(p: Parameters, scenario: Scenario) -> None:
    """Coefficients of a controller cycle; all zero where the temperature stays as it is."""
    brake = scenario.brake
    initial = brake.initial_disc_temperature
    p.initial_disc_temperature = brake.system.air.temperature if initial is None else initial
    p.models_disc_temperature = float(brake.models_disc_temperature)
    p.disc_heat_capacity = p.disc_warming = p.disc_relaxation = p.disc_held_rise = 0.0
    for number in range(1, MODES + 1):
        _set_mode(p, number, 0.0, 0.0)
    disc = brake.system.disc
    if brake.models_disc_temperature and disc.thermal is not None:
        faces = float(disc.calipers_per_wheelset * disc.pads_per_caliper)
        _set_bulk(p, disc.thermal, faces, float(scenario.controller.cycle_time))
        _set_modes(p, disc.thermal, faces, float(scenario.controller.cycle_time))


def _set_bulk(p: Parameters, ring: DiscRing, faces: float, cycle: float) -> None:
    capacity = faces * ring.density * ring.specific_heat * ring.area * ring.thickness
    time_constants = cycle * faces * ring.film_coefficient * ring.area / capacity
    p.disc_heat_capacity = capacity
    p.disc_relaxation = relaxed_share(time_constants)
    p.disc_warming = (p.disc_relaxation / time_constants if time_constants > 0.0 else 1.0) / capacity


def _set_modes(p: Parameters, ring: DiscRing, faces: float, cycle: float) -> None:
    held = ring.thickness / ring.conductivity / (faces * ring.area * cycle)  # q L / k of 1 J in a cycle
    fourier = ring.conductivity * cycle / (ring.density * ring.specific_heat * ring.thickness**2)
    p.disc_held_rise = held * held_rest()
    for number in range(1, MODES + 1):
        relaxation = mode_relaxation(number, fourier)
        _set_mode(p, number, held * held_mode(number) * relaxation, relaxation)


def _set_mode(p: Parameters, number: int, rise: float, relaxation: float) -> None:
    setattr(p, f"disc_rise_{number}", rise)
    setattr(p, f"disc_relaxation_{number}", relaxation)


DISC_BRAKE: tuple[Assignment, ...] = (
    Assignment(_pad, ("brake.pad",)),
    Assignment(_disc, ("brake", "controller.cycle_time")),
)
"""What sets the parameters of pads and discs."""


_CONVERTED = frozenset({"travel_time", "release_time"})
"""Effects whose tables hold something else: shares of a step, controller cycles."""
_TIME, _SPEED, _DISTANCE = (KINDS[name].canonical for name in ("time", "speed", "length"))


def _set_faults(p: Parameters, scenario: Scenario) -> None:
    faults, step = scenario.faults, float(scenario.simulation.time_step)
    p.fault_count = len(faults)
    p.has_leaks = float(any(fault.effects.tank_leak + fault.effects.line_leak > 0.0 for fault in faults))
    _set_windows(p, faults, step)
    _set_owners(p, faults)
    effects = [fault.effects for fault in faults] + [Effects()] * (MOST_FAULTS - len(faults))
    for name in Effects._fields:
        if name not in _CONVERTED:
            setattr(p, f"fault_{name}", [float(getattr(each, name)) for each in effects])
    p.fault_travel_per_step = [min(step / max(each.travel_time, step), 1.0) for each in effects]
    cycle = float(scenario.controller.cycle_time)
    p.fault_release_cycles = [_cycles(each.release_time, cycle) for each in effects]


def _cycles(time: float, cycle: float) -> float:
    return math.ceil(time / cycle - 1e-9) if math.isfinite(time) else math.inf


def _set_windows(p: Parameters, faults: tuple[Fault, ...], step: float) -> None:
    begins = [tuple(_reached(fault.at, step)) for fault in faults]
    ends = [tuple(_reached(fault.until, step)) for fault in faults]
    never = [tuple(_reached(None, step))] * (MOST_FAULTS - len(faults))
    p.fault_begin_time, p.fault_begin_speed, p.fault_begin_distance = map(
        list, zip(*begins, *never, strict=True)
    )
    p.fault_end_time, p.fault_end_speed, p.fault_end_distance = map(list, zip(*ends, *never, strict=True))


def _reached(instant: Quantity | None, step: float) -> Iterator[float]:
    """Yield the time, speed and distance that are reached together at an instant; never without one.

    Times are half a step early: what they are compared with is a whole number of steps.
    """
    unit = "" if instant is None else instant.unit
    value = 0.0 if instant is None else float(instant)
    yield math.inf if instant is None else value - 0.5 * step if unit == _TIME else -math.inf
    yield value if unit == _SPEED else math.inf
    yield value if unit == _DISTANCE else -math.inf


def _set_owners(p: Parameters, faults: tuple[Fault, ...]) -> None:
    none = [0.0] * (MOST_FAULTS - len(faults))
    p.fault_wheelset = [*(float((fault.wheelset or 1) - 1) for fault in faults), *none]
    p.fault_of_wheelset = [*(float(fault.wheelset is not None) for fault in faults), *none]
    p.fault_of_speed_sensor = [*(float(fault.part == SPEED_SENSOR) for fault in faults), *none]
    kinds = [FAULT_KINDS[fault.part, fault.kind] for fault in faults]
    p.fault_report_required = [*(float(kind.report == "required") for kind in kinds), *none]


FAULTS: tuple[Assignment, ...] = (
    Assignment(_set_faults, ("faults", "simulation.time_step", "controller.cycle_time")),
)
"""What sets the tables of the faults."""
