"""The rail under a recorded stop: what the wheelsets clean where places and slips are known beforehand.

Nothing moves here. The rail remembers as in a simulated stop, and the contact losses follow from the recorded
slip speeds by the creep law, at the friction that the rail has come to have.
"""

from collections.abc import Sequence
from typing import Any

from uictest.core.physics import contact_stiffness, creep_force, maximum
from uictest.core.record import Record, layout_of
from uictest.rig.model.parameters import Parameters
from uictest.rig.model.rail_memory import RailMemory, clean_rail
from uictest.rig.model.state import Car, Wheelset

_WHEELS = 2.0
_WHEELSETS = 4


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
        p.friction_ratio,
        p.friction_decay,
        p.reduction_adhesion,
        p.reduction_slip,
    )
    wheelset.contact_loss += _WHEELS * force * slip * motion.duration
    wheelset.friction = motion.found


def keep(wheelsets: Sequence[Wheelset], met: Any, k: int) -> None:
    """Set row ``k`` of what the wheelsets met."""
    for i in range(_WHEELSETS):
        met[k, i].friction = wheelsets[i].friction
        met[k, i].cleaned_share = wheelsets[i].cleaned_share
