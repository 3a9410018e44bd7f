"""What the rail remembers of the wheelsets that have passed: the share of it that they have cleaned.

It is a function of place. Each of the first three wheelsets writes the share that it leaves at the points
of a grid that it passes; the next one reads it when it gets there, later by their distance over the speed.
Points are reused once the next wheelset has passed them, so that a ring of them suffices.

Scalar code, called once per controller cycle.
"""

from collections.abc import MutableSequence, Sequence
from typing import Annotated, Final

from uictest.core.physics import cleaned_friction, cleaned_share, floor, share_left_behind
from uictest.core.record import Record, layout_of
from uictest.rig.model.parameters import Parameters
from uictest.rig.model.state import Car, Wheelset

POINTS: Final = 256
"""Points of the grid behind one wheelset; chosen: 6 cm apart under the default car."""
MARGIN: Final = 2
"""Points that a ring holds beyond the largest distance between two neighbours."""
_RINGS: Final = 3 * POINTS
_WHEELSETS: Final = 4


class RailMemory(Record):
    """The rail between the wheelsets, and each wheelset's work on it so far."""

    position: float  # of the car when the rail was last written, m
    loss: Annotated[MutableSequence[float], _WHEELSETS]  # of each wheelset's contacts until then, J
    cleaned: Annotated[MutableSequence[float], _WHEELSETS]  # share that each wheelset itself has cleaned
    points: Annotated[MutableSequence[float], _RINGS]  # cleaned share behind wheelsets 1, 2 and 3, in rings


RAIL_MEMORY = layout_of(RailMemory)
"""Layout of :class:`RailMemory`."""


def forget_rail(memory: RailMemory) -> None:
    """Set the memory to a rail that no wheelset has cleaned, at the instant of the brake command."""
    memory.position = 0.0
    for i in range(_WHEELSETS):
        memory.loss[i] = 0.0
        memory.cleaned[i] = 0.0
    for k in range(_RINGS):
        memory.points[k] = 0.0


def clean_rail(car: Car, wheelsets: Sequence[Wheelset], p: Parameters, memory: RailMemory) -> None:
    """Account for the sliding since the last cycle and raise the friction under each wheelset.

    Args:
        car: car record.
        wheelsets: four wheelset records, whose friction is that of the rail as it was found.
        p: parameter record.
        memory: of the rail; it is written up to the present place of each wheelset.
    """
    distance = car.position - memory.position
    arrived = 0.0
    for i in range(_WHEELSETS):
        wheelset = wheelsets[i]
        if distance > 0.0:
            _slide_on(wheelset, distance, p, memory, i)
        place = (car.position - wheelset.behind) * p.rail_points_per_metre
        if i > 0:
            arrived = share_at(place, memory, i - 1)
        left = share_left_behind(memory.cleaned[i], arrived, p.carry_over)
        if i < _WHEELSETS - 1:
            start = (memory.position - wheelset.behind) * p.rail_points_per_metre
            write_passed(memory, i, start, place, wheelset.cleaned_share, left)
        wheelset.cleaned_share = left
        wheelset.friction = cleaned_friction(wheelset.friction, left, p.recovered_friction)
    memory.position = car.position


def _slide_on(wheelset: Wheelset, distance: float, p: Parameters, memory: RailMemory, i: int) -> None:
    """Let wheelset ``i`` itself clean the stretch of track that it has passed since the last cycle."""
    loss = wheelset.contact_loss - memory.loss[i]
    own = cleaned_share(memory.cleaned[i], loss, distance, p.cleaning_response, p.cleaning_decay)
    memory.cleaned[i] = own
    memory.loss[i] = wheelset.contact_loss


def share_at(place: float, memory: RailMemory, ring: int) -> float:
    """Return what the wheelset before has left at a place, in units of the grid; linear between points."""
    point = floor(place)
    here = memory.points[_in_ring(int(point), ring)]
    return here + (place - point) * (memory.points[_in_ring(int(point) + 1, ring)] - here)


def write_passed(
    memory: RailMemory, ring: int, start: float, end: float, share_before: float, share: float
) -> None:
    """Write the points that a wheelset has passed since the last cycle, linear between both shares."""
    for point in range(int(floor(start)) + 1, int(floor(end)) + 1):
        part = (point - start) / (end - start)
        memory.points[_in_ring(point, ring)] = share_before + part * (share - share_before)


def _in_ring(point: int, ring: int) -> int:
    """Return where a point of the track, counted from the brake command, lies among all points."""
    return ring * POINTS + point % POINTS
