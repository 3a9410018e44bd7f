"""Couplers between the cars of a train: a spring and a damper side by side, slack-free.

All forces come from the state at the beginning of a step, before any car is advanced, so that the order of
the cars does not matter. Work is that of the force with the mean of the speeds of its point at both ends of
the step. A coupler acts on the body at its height, so that it makes the cars pitch.
"""

from collections.abc import Sequence

from uictest.core.physics import longitudinal, suspension_force
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


def pull_cars(cars: Sequence[Car], parameters: Sequence[Parameters], couplers: Sequence[Coupler]) -> None:
    """Set the coupler forces of all cars for a step; cars and parameters in the order of the train."""
    for j in range(len(cars)):
        cars[j].coupler_force = 0.0
        cars[j].coupler_moment = 0.0
    for j in range(len(couplers)):
        coupler = couplers[j]
        coupler.leading_speed = point_speed(cars[j], parameters[j], coupler)
        coupler.trailing_speed = point_speed(cars[j + 1], parameters[j + 1], coupler)
        stretch = _point_place(cars[j], parameters[j], coupler) - _point_place(
            cars[j + 1], parameters[j + 1], coupler
        )
        rate = coupler.leading_speed - coupler.trailing_speed
        coupler.force = suspension_force(coupler.stiffness, coupler.damping, stretch, rate)
        coupler.largest_pull = max(coupler.largest_pull, coupler.force)
        coupler.largest_push = max(coupler.largest_push, -coupler.force)
        _load(cars[j], parameters[j], coupler, -coupler.force)
        _load(cars[j + 1], parameters[j + 1], coupler, coupler.force)


def account_for_couplers(
    cars: Sequence[Car], parameters: Sequence[Parameters], couplers: Sequence[Coupler]
) -> None:
    """Add the work of the couplers in the step that has just been made."""
    for j in range(len(couplers)):
        coupler = couplers[j]
        leading = 0.5 * (coupler.leading_speed + point_speed(cars[j], parameters[j], coupler))
        trailing = 0.5 * (coupler.trailing_speed + point_speed(cars[j + 1], parameters[j + 1], coupler))
        duration = parameters[j].step
        cars[j].coupler_work -= duration * coupler.force * leading
        cars[j + 1].coupler_work += duration * coupler.force * trailing
        rate = coupler.leading_speed - coupler.trailing_speed
        coupler.loss += duration * coupler.damping * rate * (leading - trailing)


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
