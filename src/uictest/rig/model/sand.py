"""Sanders and the sand on the rail: a line density that is a function of place.

A nozzle lays rate over speed, kg/m, at the points of a grid that it passes, on what already lies there. Its
wheelset meets that sum and leaves a share of it, point by point, to the wheelset behind. Rings of points as
those of :mod:`uictest.rig.model.rail`: ring i holds what lies before wheelset i. What is laid is divided by
the part of each point's cell that the nozzle has passed, so that no sand is lost or made. Friction goes a
share of the way, by a table over density, from that of the rail as it is, cleaned or not, to that of a rail
with enough sand; it never falls.

A demand for sand reaches the rail after a delay, and so does its end; a demand shorter than the delay lays
none. Scalar code, once per controller cycle, only in stops with sanders.
"""

from collections.abc import Sequence
from typing import Final

from uictest.core.physics import FILL, cleaned_friction, floor, interpolated, maximum, minimum
from uictest.rig.model.parameters import Parameters
from uictest.rig.model.rail import POINTS, SAND_SLOTS, RailMemory, in_ring, value_at
from uictest.rig.model.state import Car, Wheelset

SAND_WINDOW: Final = 30.0
"""s: over which the CCS TSI limits the sand of a device."""
_SLOTS_PER_SECOND: Final = SAND_SLOTS / SAND_WINDOW


def forget_sand(memory: RailMemory) -> None:
    """Set the memory to a rail without sand, at the instant of the brake command."""
    memory.sand_position = 0.0
    memory.sand_passed = 0.0
    memory.sand_slot = 0
    for k in range(4 * POINTS):
        memory.sand[k] = 0.0
    for k in range(4 * SAND_SLOTS):
        memory.sand_before[k] = 0.0


def command_sanders(car: Car, wheelsets: Sequence[Wheelset], p: Parameters) -> None:
    """Decide for the coming cycle which sanders lay sand, once the valves are commanded."""
    acts = False
    for i in range(4):
        acts = acts or wheelsets[i].valve_command != FILL
    car.wsp_acting_cycles = car.wsp_acting_cycles + 1 if acts else 0
    car.wsp_resting_cycles = 0 if acts else car.wsp_resting_cycles + 1
    for i in range(4):
        _follow_demand(wheelsets[i], i, car, p)


def _follow_demand(wheelset: Wheelset, i: int, car: Car, p: Parameters) -> None:
    if car.wsp_acting_cycles > 0 and car.wsp_acting_cycles >= p.sander_slide_cycles[i]:
        wheelset.slides_by_wsp = 1.0
    elif car.wsp_resting_cycles > p.sander_run_on_cycles[i]:
        wheelset.slides_by_wsp = 0.0
    # What lays sand in every brake does so once its car is told to brake.
    commanded = car.time + 0.5 * p.step >= p.command_given[0]
    always = p.sanders_always[i] if commanded else 0.0
    demanded = maximum(always, p.sanders_on_slide[i] * wheelset.slides_by_wsp)
    if wheelset.sand_request == 1:
        demanded = maximum(demanded, p.sanders_on_request[i])
    if car.speed < p.sander_off_speeds[i]:
        demanded = 0.0
    if demanded == wheelset.sander_open:
        wheelset.sander_lag = 0
    elif wheelset.sander_lag >= p.sander_delays[i]:
        wheelset.sander_open = demanded
        wheelset.sander_lag = 0
    else:
        wheelset.sander_lag += 1


def spread_sand(car: Car, wheelsets: Sequence[Wheelset], p: Parameters, memory: RailMemory) -> None:
    """Lay the sand of the cycle before and raise the friction under each wheelset by what it meets.

    Args:
        car: car record.
        wheelsets: four wheelset records, whose friction is that of the rail without sand.
        p: parameter record.
        memory: of the rail; it is written up to the present place of each wheelset and nozzle.
    """
    _begin_slots(car.time, wheelsets, memory)
    for i in range(4):
        wheelset = wheelsets[i]
        start = (memory.sand_position - wheelset.behind) * p.sand_points_per_metre
        end = (car.position - wheelset.behind) * p.sand_points_per_metre
        flows = wheelset.sander_open * (1.0 - wheelset.sander_blocked)
        if flows > 0.0 and end > start:
            _lay(wheelset, i, start, end, p, memory)
        wheelset.sanding_time = wheelset.sanding_time + p.cycle_time if flows > 0.0 else 0.0
        wheelset.longest_sanding = maximum(wheelset.longest_sanding, wheelset.sanding_time)
        wheelset.sand_density = value_at(end, memory.sand, i)
        share = interpolated(wheelset.sand_density, p.sand_densities, p.sand_shares, p.sand_points)
        wheelset.friction = cleaned_friction(wheelset.friction, share, p.sand_friction)
        if i < 3:
            _leave(memory, memory, i, i + 1, start, end, p.sand_kept)
    # Nobody writes anew what lies before the first wheelset of a train.
    start = (memory.sand_position - wheelsets[0].behind) * p.sand_points_per_metre
    end = (car.position - wheelsets[0].behind) * p.sand_points_per_metre
    for point in range(int(floor(start)), int(floor(end))):
        memory.sand[in_ring(point, 0)] = 0.0
    memory.sand_passed = memory.sand_position
    memory.sand_position = car.position


def hand_sand_on(last: Wheelset, p: Parameters, memory: RailMemory, behind: RailMemory) -> None:
    """Leave to the next car the sand that the last wheelset of a car has passed since the cycle before.

    Args:
        last: the last wheelset.
        p: parameter record of its car.
        memory: of the rail under that car, after :func:`spread_sand`.
        behind: of the rail under the next car.
    """
    start = (memory.sand_passed - last.behind) * p.sand_points_per_metre
    end = (memory.sand_position - last.behind) * p.sand_points_per_metre
    _leave(memory, behind, 3, 0, start, end, p.sand_kept)


def _lay(wheelset: Wheelset, i: int, start: float, end: float, p: Parameters, memory: RailMemory) -> None:
    """Lay sand between two places of a nozzle, given by those of its wheelset, in points of the grid."""
    distance = (end - start) / p.sand_points_per_metre
    mass = minimum(p.sander_rates[i] * p.cycle_time, p.sander_densities[i] * distance)
    density = mass / distance
    ahead = p.sander_distances[i] * p.sand_points_per_metre
    first, last = start + ahead, end + ahead
    for point in range(int(floor(first + 0.5)), int(floor(last + 0.5)) + 1):
        covered = minimum(last, point + 0.5) - maximum(first, point - 0.5)
        memory.sand[in_ring(point, i)] += density * maximum(covered, 0.0)
    wheelset.sand_laid += mass
    before = memory.sand_before[i * SAND_SLOTS + (memory.sand_slot + 1) % SAND_SLOTS]
    wheelset.sand_in_window = maximum(wheelset.sand_in_window, wheelset.sand_laid - before)


def _begin_slots(time: float, wheelsets: Sequence[Wheelset], memory: RailMemory) -> None:
    """Keep how much each sander has laid when a slot of time begins; the oldest is forgotten."""
    present = int(floor(time * _SLOTS_PER_SECOND))
    while memory.sand_slot < present:
        memory.sand_slot += 1
        for i in range(4):
            memory.sand_before[i * SAND_SLOTS + memory.sand_slot % SAND_SLOTS] = wheelsets[i].sand_laid


def _leave(
    ahead: RailMemory, behind: RailMemory, ring: int, next_ring: int, start: float, end: float, share: float
) -> None:
    """Leave a share of the sand at the points that a wheelset has passed since the last cycle."""
    for point in range(int(floor(start)) + 1, int(floor(end)) + 1):
        behind.sand[in_ring(point, next_ring)] = share * ahead.sand[in_ring(point, ring)]
