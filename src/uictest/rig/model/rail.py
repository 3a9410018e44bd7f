"""The rail: its friction as found and at random, and what it remembers of the wheelsets that have passed.

The friction coefficient as found is linear between places, its factor is linear between times; both lie in
an array whose rows are used up to their number of points.

What the rail remembers is the share of it that wheelsets have cleaned, a function of place. Each wheelset
writes the share that it leaves at the points of a grid that it passes; the next one reads it when it gets
there, later by their distance over the speed. Points are reused once the next wheelset has passed them: a
ring of them before each wheelset suffices. Before the first wheelset of a train the rail is as earlier stops
left it. What a share means for friction and creep curve a law says, :mod:`uictest.core.rail_laws`:
`cleaned_share` of a wheelset is how far they have gone. Scalar code, called once per controller cycle; for a
record of a real train it runs along its samples, with the sliding that the creep law gives.
"""

from collections.abc import MutableSequence, Sequence
from typing import Annotated, Any, Final

from uictest.core.physics import (
    bell,
    cleaned_friction,
    contact_stiffness,
    creep_force,
    floor,
    log_normal_factor,
    maximum,
    share_left_behind,
    threefry,
)
from uictest.core.rail_laws import clean_part, own_share
from uictest.core.record import Record, layout_of
from uictest.rig.model.parameters import Parameters
from uictest.rig.model.state import Car, Wheelset

PLACES = 0
"""Places along the track, m from the position of the leading wheelset at the brake command."""
FRICTIONS = 1
"""Friction coefficients at these places."""
TIMES = 2
"""Times since the brake command, s."""
FACTORS = 3
"""Factors of the friction coefficient at these times."""
ROWS = 4
POINTS: Final = 256
"""Points of the grid behind one wheelset; chosen: 6 cm apart under the default car."""
MARGIN: Final = 2
"""Points that a ring holds beyond the largest distance between two neighbours."""
SAND_SLOTS: Final = 120
"""Slots of time for which it is kept how much each sander had laid."""
_WHEELSETS: Final = 4
_RINGS: Final = _WHEELSETS * POINTS
_WHEELS = 2.0


class RailMemory(Record):
    """The rail between the wheelsets, and each wheelset's work on it so far."""

    position: float  # of the car when the rail was last written, m
    passed: float  # of the car when it was written before that, m
    loss: Annotated[MutableSequence[float], _WHEELSETS]  # of each wheelset's contacts until then, J
    cleaned: Annotated[MutableSequence[float], _WHEELSETS]  # share that each wheelset itself has cleaned
    left: Annotated[MutableSequence[float], _WHEELSETS]  # share behind each wheelset then
    passed_left: float  # share behind the last wheelset at ``passed``
    magnet_work: float  # of the magnets of the car until ``position``, J
    magnet_cleaned: float  # share that the magnets of a bogie clean there
    points: Annotated[MutableSequence[float], _RINGS]  # cleaned share before each wheelset, in rings
    # sand: rig.model.sand
    sand_position: float  # of the car when sand was last laid, m
    sand_passed: float  # of the car when it was laid before that, m
    sand: Annotated[MutableSequence[float], _RINGS]  # before each wheelset, in rings, kg/m
    sand_slot: int  # of time, the present one
    sand_before: Annotated[MutableSequence[float], _WHEELSETS * SAND_SLOTS]  # laid when each slot began, kg


RAIL_MEMORY = layout_of(RailMemory)
"""Layout of :class:`RailMemory`."""


def forget_rail(memory: RailMemory, p: Parameters) -> None:
    """Set the memory to a rail that only earlier stops have cleaned, at the instant of the brake command."""
    memory.position = 0.0
    memory.magnet_work = 0.0
    memory.magnet_cleaned = 0.0
    for i in range(_WHEELSETS):
        memory.loss[i] = 0.0
        memory.cleaned[i] = 0.0
        memory.left[i] = 0.0
    for k in range(_RINGS):
        memory.points[k] = p.spent_share


def clean_rail(car: Car, wheelsets: Sequence[Wheelset], p: Parameters, memory: RailMemory) -> None:
    """Account for the sliding since the last cycle and raise the friction under each wheelset.

    Args:
        car: car record.
        wheelsets: four wheelset records, whose friction is that of the rail as it was found.
        p: parameter record.
        memory: of the rail; it is written up to the present place of each wheelset.
    """
    distance = car.position - memory.position
    memory.passed = memory.position
    memory.passed_left = memory.left[_WHEELSETS - 1]
    for i in range(_WHEELSETS):
        wheelset = wheelsets[i]
        if distance > 0.0:
            loss = wheelset.contact_loss - memory.loss[i]
            memory.cleaned[i] = own_share(memory.cleaned[i], loss, distance, p)
            memory.loss[i] = wheelset.contact_loss
        end = (car.position - wheelset.behind) * p.rail_points_per_metre
        left = share_left_behind(memory.cleaned[i], value_at(end, memory.points, i), p.carry_over)
        if i < _WHEELSETS - 1:
            start = (memory.position - wheelset.behind) * p.rail_points_per_metre
            write_passed(memory, i + 1, start, end, memory.left[i], left)
        memory.left[i] = left
        wheelset.cleaned_share = clean_part(left, p)
        wheelset.friction = cleaned_friction(wheelset.friction, wheelset.cleaned_share, p.recovered_friction)
        set_creep_curve(wheelset, p)
    memory.position = car.position


def hand_rail_on(last: Wheelset, p: Parameters, memory: RailMemory, behind: RailMemory) -> None:
    """Write for the next car what the last wheelset of a car has left since the cycle before.

    Args:
        last: the last wheelset.
        p: parameter record of its car.
        memory: of the rail under that car, after :func:`clean_rail`.
        behind: of the rail under the next car.
    """
    start = (memory.passed - last.behind) * p.rail_points_per_metre
    end = (memory.position - last.behind) * p.rail_points_per_metre
    write_passed(behind, 0, start, end, memory.passed_left, memory.left[_WHEELSETS - 1])


def set_creep_curve(wheelset: Wheelset, p: Parameters) -> None:
    """Set the shape of the creep curve: that of the rail as found goes over to that of a clean one."""
    share = wheelset.cleaned_share
    wheelset.friction_ratio = p.friction_ratio + share * (p.clean_friction_ratio - p.friction_ratio)
    wheelset.friction_decay = p.friction_decay + share * (p.clean_friction_decay - p.friction_decay)
    wheelset.reduction_adhesion = p.reduction_adhesion + share * (
        p.clean_reduction_adhesion - p.reduction_adhesion
    )
    wheelset.reduction_slip = p.reduction_slip + share * (p.clean_reduction_slip - p.reduction_slip)


def value_at(position: float, points: Sequence[float], ring: int) -> float:
    """Return the value before a wheelset at a position in grid units, linear between points."""
    point = floor(position)
    at_point = points[in_ring(int(point), ring)]
    return at_point + (position - point) * (points[in_ring(int(point) + 1, ring)] - at_point)


def write_passed(
    memory: RailMemory, ring: int, start: float, end: float, share_before: float, share: float
) -> None:
    """Write the points that a wheelset has passed since the last cycle, linear between both shares."""
    for point in range(int(floor(start)) + 1, int(floor(end)) + 1):
        part = (point - start) / (end - start)
        memory.points[in_ring(point, ring)] = share_before + part * (share - share_before)


def clean_passed(
    memory: RailMemory, ring: int, start: float, end: float, share_before: float, share: float
) -> None:
    """Add at the points that magnets have passed what they clean, linear between both shares."""
    for point in range(int(floor(start)) + 1, int(floor(end)) + 1):
        part = (point - start) / (end - start)
        cleaned = share_before + part * (share - share_before)
        slot = in_ring(point, ring)
        memory.points[slot] = share_left_behind(cleaned, memory.points[slot], 1.0)


def in_ring(point: int, ring: int) -> int:
    """Return the index, among all stored points, of a point of the track counted from the brake command."""
    return ring * POINTS + point % POINTS


class RecordedMotion(Record):
    """Motion and load of one wheelset since the sample before, and the friction of the rail as found."""

    position: float  # of the car, m
    duration: float  # since the sample before, s
    speed: float  # of the car, m/s, > 0
    slip: float  # mean slip speed since the sample before, m/s, positive while braking
    load: float  # of one wheel, N
    found: float  # initial friction coefficient of the rail that nothing has cleaned


class MetRail(Record):
    """The rail under one wheelset at one sample."""

    friction: float  # initial friction coefficient
    cleaned_share: float


RECORDED_MOTION = layout_of(RecordedMotion)
"""Layout of :class:`RecordedMotion`."""
MET_RAIL = layout_of(MetRail)
"""Layout of :class:`MetRail`."""


def follow_record(
    car: Car, wheelsets: Sequence[Wheelset], p: Parameters, memory: RailMemory, motion: Any, met: Any
) -> None:
    """Run four wheelsets over the rail along a record.

    Args:
        car: car record, zeroed.
        wheelsets: four wheelset records, zeroed but for `behind`.
        p: parameter record.
        memory: of the rail, zeroed.
        motion: records of :data:`RECORDED_MOTION`, shape (n, 4).
        met: records of :data:`MET_RAIL`, shape (n, 4): set to the rail under the wheelsets.
    """
    for k in range(len(motion)):
        car.position = motion[k, 0].position
        for i in range(_WHEELSETS):
            slide_by_creep_law(wheelsets[i], motion[k, i], p)
        clean_rail(car, wheelsets, p, memory)
        keep(wheelsets, met, k)


def slide_by_creep_law(wheelset: Wheelset, motion: RecordedMotion, p: Parameters) -> None:
    """Add the loss of both contacts since the sample before; then put the wheelset on the rail as found."""
    slip = maximum(motion.slip, 0.0)
    force, _ = creep_force(
        slip,
        motion.speed,
        motion.load,
        contact_stiffness(p.creep_stiffness, motion.load * p.load_scale),
        wheelset.friction,
        wheelset.friction_ratio,
        wheelset.friction_decay,
        wheelset.reduction_adhesion,
        wheelset.reduction_slip,
    )
    wheelset.contact_loss += _WHEELS * force * slip * motion.duration
    wheelset.friction = motion.found


def keep(wheelsets: Sequence[Wheelset], met: Any, k: int) -> None:
    """Set row ``k`` of what the wheelsets met."""
    for i in range(_WHEELSETS):
        met[k, i].friction = wheelsets[i].friction
        met[k, i].cleaned_share = wheelsets[i].cleaned_share


FAR_BEHIND = 1000.0
"""Distance from the first point to the first wheelset at the brake command, m; chosen: no train is longer."""
RAIL_KEY = 0x7261696C
"""Key that stands where sensors have that of their case."""
_CHANNEL = 1 << 31
"""Noise channel above those of all sensors."""


def vary_friction(car: Car, wheelsets: Sequence[Wheelset], p: Parameters) -> None:
    """Multiply the friction under each wheelset, that of the rail as found, by its random factor.

    At points D apart, counted from a fixed place far behind, a deviation follows

        z[k+1] = rho z[k] + sqrt(1 - rho^2) xi[k+1],    rho = exp(-D / l)

    and the factor there is exp(s z - s^2 / 2), log-normal with mean 1 and linear between points. xi[k]
    depends on the seed and on k alone: whoever comes to a place under a seed meets the same friction there,
    whatever its train, command, controller and sensors. A wheelset has one slip, so it meets the mean of both
    rails. Each has the spread sigma, so that of the mean is sigma sqrt((1 + correlation) / 2), and
    s^2 = ln(1 + that^2). A wheelset draws only where it passes a point.
    """
    for i in range(4):
        wheelset = wheelsets[i]
        position = maximum(car.position - wheelset.behind + FAR_BEHIND, 0.0) * p.variation_points_per_metre
        follow_rail(wheelset, position, car.cycle == 0, p)
        change = wheelset.next_rail_factor - wheelset.rail_factor
        wheelset.friction *= wheelset.rail_factor + (position - wheelset.rail_point) * change


def follow_rail(wheelset: Wheelset, position: float, begins: bool, p: Parameters) -> None:
    """Let a wheelset pass all points up to a place, counted in points; at the start, from the first one."""
    passed = floor(position)
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
