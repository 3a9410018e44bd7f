"""The disc brake once per controller cycle: temperature of the discs, friction of the pads.

Both change slowly: the friction that the pads have at the beginning of a cycle holds until its end, and the
work that they did within it then warms the discs at a constant rate.
"""

from collections.abc import Sequence

from uictest.core.physics import bulk_change, cooled_heat, interpolated, mode_after, quotient_factor
from uictest.rig.model.parameters import Parameters
from uictest.rig.model.state import Wheelset


def start_disc(wheelset: Wheelset, p: Parameters) -> None:
    """Set the discs of a wheelset to one temperature throughout, and the friction of its pads."""
    wheelset.pad_friction = wheelset.reference_pad_friction
    wheelset.disc_temperature = p.initial_disc_temperature
    wheelset.disc_surface_temperature = p.initial_disc_temperature


def set_pad_friction(wheelsets: Sequence[Wheelset], p: Parameters) -> None:
    """Set the friction of the pads for this cycle: that of the reference point times three factors.

    The temperature is that of the friction surface, in which the pad's friction arises and which rubbing
    thermocouples measure on a test bench.
    """
    if p.varies_pad_friction > 0.0:
        for i in range(4):
            wheelset = wheelsets[i]
            at_speed = _speed_factor(p.disc_radius * abs(wheelset.rotation), p)
            under_force = _force_factor(wheelset.clamping_force, p)
            hot = interpolated(
                wheelset.disc_surface_temperature,
                p.pad_temperatures,
                p.pad_temperature_factors,
                p.pad_temperature_points,
            )
            wheelset.pad_friction = wheelset.reference_pad_friction * at_speed * under_force * hot


def _speed_factor(speed: float, p: Parameters) -> float:
    """Factor at a speed of the friction surface in m/s; a pad has a table or a quotient, the other is 1."""
    of_table = interpolated(speed, p.pad_speeds, p.pad_speed_factors, p.pad_speed_points)
    return of_table * quotient_factor(
        speed, p.pad_speed_numerator, p.pad_speed_denominator, p.pad_speed_scale
    )


def _force_factor(force: float, p: Parameters) -> float:
    """Factor under a clamping force of one pad in N; a pad has a table or a quotient, the other is 1."""
    of_table = interpolated(force, p.pad_forces, p.pad_force_factors, p.pad_force_points)
    return of_table * quotient_factor(
        force, p.pad_force_numerator, p.pad_force_denominator, p.pad_force_scale
    )


def warm_discs(wheelsets: Sequence[Wheelset], p: Parameters) -> None:
    """Warm the discs of all wheelsets by what their pads gave off in this cycle, and cool them.

    Where the temperature is not modelled the coefficients are zero: it stays as it is.
    """
    for i in range(4):
        warm_disc(wheelsets[i], p)


def warm_disc(wheelset: Wheelset, p: Parameters) -> None:
    """Advance the temperatures of one wheelset's discs to the end of a controller cycle."""
    heat = wheelset.brake_heat - wheelset.disc_heat
    change = bulk_change(
        wheelset.disc_temperature, p.air_temperature, heat, p.disc_warming, p.disc_relaxation
    )
    wheelset.disc_heat = wheelset.brake_heat
    wheelset.disc_cooling += cooled_heat(
        wheelset.disc_temperature,
        p.air_temperature,
        heat,
        p.disc_heat_capacity,
        p.disc_warming,
        p.disc_relaxation,
    )
    wheelset.disc_temperature += change
    _follow_modes(wheelset, heat, p)
    modes = (wheelset.disc_mode_1 + wheelset.disc_mode_2) + (wheelset.disc_mode_3 + wheelset.disc_mode_4)
    modes += wheelset.disc_mode_5 + wheelset.disc_mode_6
    wheelset.disc_surface_temperature = wheelset.disc_temperature + (modes + p.disc_held_rise * heat)


def _follow_modes(wheelset: Wheelset, heat: float, p: Parameters) -> None:
    wheelset.disc_mode_1 = mode_after(wheelset.disc_mode_1, heat, p.disc_rise_1, p.disc_relaxation_1)
    wheelset.disc_mode_2 = mode_after(wheelset.disc_mode_2, heat, p.disc_rise_2, p.disc_relaxation_2)
    wheelset.disc_mode_3 = mode_after(wheelset.disc_mode_3, heat, p.disc_rise_3, p.disc_relaxation_3)
    wheelset.disc_mode_4 = mode_after(wheelset.disc_mode_4, heat, p.disc_rise_4, p.disc_relaxation_4)
    wheelset.disc_mode_5 = mode_after(wheelset.disc_mode_5, heat, p.disc_rise_5, p.disc_relaxation_5)
    wheelset.disc_mode_6 = mode_after(wheelset.disc_mode_6, heat, p.disc_rise_6, p.disc_relaxation_6)
