"""The magnetic track brake: when it acts, its force on the bogies, what it cleans of the rail.

Half of the magnets hang from each bogie and drag it at the height of the traction link. The force follows
from the state before a step, and its work, with the mean of the speeds of that point before and after it, is
added after the step, so that energy closes. All but scalar code works for one stop and for many stops side by
side in SIMD lanes.
"""

from collections.abc import Sequence

from uictest.core.physics import clamp, longitudinal, track_brake_force
from uictest.core.rail_laws import own_share
from uictest.rig.model.parameters import Parameters
from uictest.rig.model.rail import RailMemory, clean_passed
from uictest.rig.model.state import Bogie, Car, Wheelset

_BOGIES = 2.0


def command_track_brake(car: Car, p: Parameters) -> None:
    """Decide for the coming cycle whether the magnets are drawn to the rail; scalar code."""
    now = car.time + 0.5 * p.step
    demanded = p.track_brake_commands[0] if now >= p.track_brake_first else 0.0
    for k in range(1, p.command_count):
        if now >= p.command_given[k]:
            demanded = p.track_brake_commands[k]
    if p.track_brake_requested > 0.0:
        demanded *= car.track_brake_request * p.wsp_active
    if car.speed <= p.track_brake_off_speed:
        demanded = 0.0
    if demanded > 0.0 and car.track_brake_asked == 0.0:
        car.track_brake_due = car.time + p.track_brake_delay
    car.track_brake_asked = demanded
    acts = demanded > 0.0 and now >= car.track_brake_due and car.track_brake_failed == 0.0
    share = car.magnet_share + clamp(
        (1.0 if acts else 0.0) - car.magnet_share, -p.magnet_change, p.magnet_change
    )
    car.magnet_share = share
    car.track_brake_time += p.cycle_time if share > 0.0 else 0.0


def drag_magnets(car: Car, bogies: Sequence[Bogie], p: Parameters) -> None:
    """Set force and moment of the magnets on each bogie for the coming step, and the sum of the forces."""
    _drag(bogies[0], car, p)
    _drag(bogies[1], car, p)
    car.track_brake_force = 0.0 - (bogies[0].magnet_force + bogies[1].magnet_force)


def _drag(bogie: Bogie, car: Car, p: Parameters) -> None:
    bogie.magnet_speed = _magnet_speed(bogie, p)
    bogie.magnet_force = track_brake_force(
        bogie.magnet_speed,
        car.magnet_share * p.magnet_attraction,
        p.magnet_friction,
        p.magnet_numerator,
        p.magnet_denominator,
        p.magnet_slowest,
    )
    bogie.magnet_moment = 0.0 - (p.link_height - p.bogie_height) * bogie.magnet_force


def account_for_magnets(car: Car, bogies: Sequence[Bogie], p: Parameters) -> None:
    """Add the energy that the magnets took in the last step.

    Each bogie's force is constant within a step; its work is that force times the mean of the magnets' speeds
    before and after the step. To be called after the step, with ``magnet_speed`` still that of before.
    """
    leading = bogies[0].magnet_force * (bogies[0].magnet_speed + _magnet_speed(bogies[0], p))
    trailing = bogies[1].magnet_force * (bogies[1].magnet_speed + _magnet_speed(bogies[1], p))
    car.track_brake_energy -= 0.5 * p.step * (leading + trailing)


def _magnet_speed(bogie: Bogie, p: Parameters) -> float:
    return longitudinal(bogie.speed, bogie.pitch_rate, p.link_height - p.bogie_height)


def clean_by_magnets(car: Car, wheelsets: Sequence[Wheelset], p: Parameters, memory: RailMemory) -> None:
    """Clean the rail between the wheelsets of each bogie; scalar code, once per controller cycle.

    A share of the work of a bogie's magnets counts like the contact loss of a wheelset at the bogie's centre.
    The trailing wheelset of the bogie finds the rail as they have left it.

    Args:
        car: car record.
        wheelsets: four wheelset records.
        p: parameter record.
        memory: of the rail, after :func:`.clean_rail`.
    """
    distance = memory.position - memory.passed
    if distance > 0.0:
        before = memory.magnet_cleaned
        work = p.magnet_cleaning * (car.track_brake_energy - memory.magnet_work) / _BOGIES
        share = own_share(before, work, distance, p)
        for ring in (1, 3):
            behind = 0.5 * (wheelsets[ring - 1].behind + wheelsets[ring].behind)
            start = (memory.passed - behind) * p.rail_points_per_metre
            end = (memory.position - behind) * p.rail_points_per_metre
            clean_passed(memory, ring, start, end, before, share)
        memory.magnet_cleaned = share
    memory.magnet_work = car.track_brake_energy
