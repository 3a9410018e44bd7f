"""Friction that varies at random along the track.

At points D apart, counted from a fixed place far behind, a deviation follows

    z[k+1] = rho z[k] + sqrt(1 - rho^2) xi[k+1],    rho = exp(-D / l)

and the friction there is that of the rail as found times exp(s z - s^2 / 2), which is log-normal with mean 1
and linear between points. xi[k] depends on the seed and on k alone: whoever comes to a place under a seed
meets the same friction there, whatever its train, command, controller and sensors.

A wheelset has one slip, so it meets the mean of both rails. Each has the spread sigma, so that of the mean is
sigma sqrt((1 + correlation) / 2), and s^2 = ln(1 + that^2). Scalar code, called once per controller cycle; a
wheelset draws only where it passes a point.
"""

from collections.abc import Sequence

from uictest.core.physics import bell, floor, log_normal_factor, maximum, threefry
from uictest.rig.model.parameters import Parameters
from uictest.rig.model.state import Car, Wheelset

FAR_BEHIND = 1000.0
"""Distance from the first point to the first wheelset at the brake command, m; chosen: no train is longer."""
RAIL_KEY = 0x7261696C
"""Key that stands where sensors have that of their case."""
_CHANNEL = 1 << 31
"""Noise channel above those of all sensors."""


def vary_friction(car: Car, wheelsets: Sequence[Wheelset], p: Parameters) -> None:
    """Multiply the friction under each wheelset, that of the rail as found, by the factor at its place."""
    for i in range(4):
        wheelset = wheelsets[i]
        place = maximum(car.position - wheelset.behind + FAR_BEHIND, 0.0) * p.variation_points_per_metre
        follow_rail(wheelset, place, car.cycle == 0, p)
        change = wheelset.next_rail_factor - wheelset.rail_factor
        wheelset.friction *= wheelset.rail_factor + (place - wheelset.rail_point) * change


def follow_rail(wheelset: Wheelset, place: float, begins: bool, p: Parameters) -> None:
    """Let a wheelset pass all points up to a place, counted in points; at the start, from the first one."""
    passed = floor(place)
    if begins:
        wheelset.rail_point = -1.0
        wheelset.rail_deviation = innovation(p, 0)
        while wheelset.rail_point < passed - 1.0:  # nothing is needed of the points so far behind
            _pass_point(wheelset, p)
        wheelset.next_rail_factor = log_normal_factor(wheelset.rail_deviation, p.variation_log_spread)
    while wheelset.rail_point < passed:
        _pass_point(wheelset, p)
        wheelset.rail_factor = wheelset.next_rail_factor
        wheelset.next_rail_factor = log_normal_factor(wheelset.rail_deviation, p.variation_log_spread)


def _pass_point(wheelset: Wheelset, p: Parameters) -> None:
    wheelset.rail_point += 1.0
    drawn = innovation(p, int(wheelset.rail_point) + 1)
    wheelset.rail_deviation = p.variation_persistence * wheelset.rail_deviation + p.variation_renewal * drawn


def innovation(p: Parameters, point: int) -> float:
    """Return xi, of mean 0 and variance 1, for a point of the track under a seed."""
    word_0, word_1 = threefry(p.seed, RAIL_KEY, point, _CHANNEL)
    return bell(word_0, word_1)
