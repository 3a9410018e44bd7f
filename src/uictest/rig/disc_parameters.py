"""Parameters of the disc brake: the friction law of its pads and the temperature of its discs."""

from uictest.core.physics import (
    MODES,
    MOST_PAD_POINTS,
    held_mode,
    held_rest,
    mode_relaxation,
    quotient_scale,
    relaxed_share,
)
from uictest.plans.scenario import DiscRing, PadLaw, Scenario
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
