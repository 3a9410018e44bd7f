"""Couplers between the cars of a train: a spring and a damper side by side, slack-free.

All forces come from the state at the beginning of a step, before any car is advanced, so that the order of
the cars does not matter. Work is that of the force with the mean of the speeds of its point at both ends of
the step. A coupler acts on the body at its height, so that it makes the cars pitch.
"""

from uictest.core.physics import longitudinal, maximum, suspension_force
from uictest.core.record import Record, layout_of
from uictest.rig.model.parameters import Parameters
from uictest.rig.model.state import Car


class Coupler(Record):
    """A coupler behind a car: its numbers, its state and its ledgers."""

    stiffness: float  # N/m
    damping: float  # N s/m
    height: float  # above the rail, m
    force: float  # with which it pulls both cars together, N
    leading_speed: float  # of its point on the car before it at the beginning of the step, m/s
    trailing_speed: float  # and on the car behind it
    loss: float  # J
    largest_pull: float  # N
    largest_push: float  # N


COUPLER = layout_of(Coupler)
"""Layout of :class:`Coupler`."""


def release_couplers(car: Car) -> None:
    """Clear the coupler forces on a car before they are summed for a step."""
    car.coupler_force = 0.0
    car.coupler_moment = 0.0


def pull_cars(
    coupler: Coupler, leading: Car, leading_p: Parameters, trailing: Car, trailing_p: Parameters
) -> None:
    """Add the force of a coupler to the cars before and behind it, for a step; in lanes, too."""
    coupler.leading_speed = point_speed(leading, leading_p, coupler)
    coupler.trailing_speed = point_speed(trailing, trailing_p, coupler)
    stretch = _point_place(leading, leading_p, coupler) - _point_place(trailing, trailing_p, coupler)
    rate = coupler.leading_speed - coupler.trailing_speed
    coupler.force = suspension_force(coupler.stiffness, coupler.damping, stretch, rate)
    coupler.largest_pull = maximum(coupler.force, coupler.largest_pull)
    coupler.largest_push = maximum(-coupler.force, coupler.largest_push)
    _load(leading, leading_p, coupler, -coupler.force)
    _load(trailing, trailing_p, coupler, coupler.force)


def account_for_coupler(
    coupler: Coupler, leading: Car, leading_p: Parameters, trailing: Car, trailing_p: Parameters
) -> None:
    """Add the work of a coupler in the step that has just been made; in lanes, too."""
    leading_mean = 0.5 * (coupler.leading_speed + point_speed(leading, leading_p, coupler))
    trailing_mean = 0.5 * (coupler.trailing_speed + point_speed(trailing, trailing_p, coupler))
    duration = leading_p.step
    leading.coupler_work -= duration * coupler.force * leading_mean
    trailing.coupler_work += duration * coupler.force * trailing_mean
    rate = coupler.leading_speed - coupler.trailing_speed
    coupler.loss += duration * coupler.damping * rate * (leading_mean - trailing_mean)


def coupler_energy(
    coupler: Coupler, leading: Car, leading_p: Parameters, trailing: Car, trailing_p: Parameters
) -> float:
    """Energy that a coupler's spring has taken, J.

    A force that is constant within a step works with the mean of the speeds at both ends, while places
    advance with the speed at the end: k/2 times the product of the stretch now and a step ago.
    """
    stretch = _point_place(leading, leading_p, coupler) - _point_place(trailing, trailing_p, coupler)
    rate = point_speed(leading, leading_p, coupler) - point_speed(trailing, trailing_p, coupler)
    return 0.5 * float(coupler.stiffness) * stretch * (stretch - float(leading_p.step) * rate)


def point_speed(car: Car, p: Parameters, coupler: Coupler) -> float:
    """Speed of a coupler's point on a car body, m/s."""
    return longitudinal(car.speed, car.pitch_rate, coupler.height - p.body_height)


def _point_place(car: Car, p: Parameters, coupler: Coupler) -> float:
    return longitudinal(car.position, car.pitch, coupler.height - p.body_height)


def _load(car: Car, p: Parameters, coupler: Coupler, force: float) -> None:
    car.coupler_force += force
    car.coupler_moment -= (coupler.height - p.body_height) * force
