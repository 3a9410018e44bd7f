"""What a wheelset does to its tread and what it makes of the rail: slid distance, energy, utilisation."""

from collections.abc import Sequence

from uictest.core.measures.records import MeasureDefinition, StopMeasures, WheelsetMeasures
from uictest.core.physics import select

NAN = float("nan")


def begin_contact(measures: WheelsetMeasures) -> None:
    """Start the measures of a wheelset's contacts."""
    measures.slid_distance = 0.0
    measures.contact_energy = 0.0
    measures.contact_loss = 0.0
    measures.rail_work = 0.0
    measures.exploited_work = 0.0
    measures.available_work = 0.0
    measures.adhesion_utilisation = NAN


def begin_utilisation(measures: StopMeasures) -> None:
    """Start what the train makes of the rail."""
    measures.exploited_work = 0.0
    measures.available_work = 0.0
    measures.adhesion_utilisation = NAN
    measures.deceleration_bogie_1 = NAN
    measures.deceleration_bogie_2 = NAN


def observe_contact(
    measures: WheelsetMeasures,
    train: StopMeasures,
    definition: MeasureDefinition,
    time: float,
    speed: float,
    pressure: float,
    line_pressure: float,
    rail_work: float,
    contact_loss: float,
    highest_force: float,
) -> None:
    """Observe the next sample of a wheelset's contacts, after its slide and before the train's sample.

    What the rail gives counts against what it could give while the brake demands more: while the wheelset
    slides and, once it has slid, while the WSP holds its pressure below that of the brake line.

    Args:
        measures: measures of the wheelset.
        train: measures of the stop; its last sample gives the distance run.
        definition: how samples become measures.
        time: since the brake command, s.
        speed: of the train, m/s.
        pressure: in the wheelset's tank, gauge, Pa.
        line_pressure: of the brake line, gauge, Pa.
        rail_work: of the rail on the wheelset since the brake command, against its motion, J.
        contact_loss: energy turned into heat in its contacts since then, J.
        highest_force: that both contacts could transmit, N.
    """
    slides = measures.sliding > 0.0
    # Unknown, as NaN, where the last sample of a recording lies in a gap.
    before = select(train.end_speed >= 0.0, train.end_speed, speed)
    run = 0.5 * (before + speed) * (time - train.end_time)
    measures.slid_distance += select(slides, run, 0.0)
    measures.contact_energy += select(slides, contact_loss - measures.contact_loss, 0.0)
    has_slid = (measures.first_sliding_time <= time) & (speed > definition.moving_speed)
    limited = slides | (has_slid & (pressure < definition.reduced_share * line_pressure))
    exploited = select(limited, rail_work - measures.rail_work, 0.0)
    available = select(limited, highest_force * run, 0.0)
    measures.exploited_work += exploited
    measures.available_work += available
    train.exploited_work += exploited
    train.available_work += available
    measures.rail_work = rail_work
    measures.contact_loss = contact_loss


def close_contacts(
    measures: StopMeasures, wheelset_measures: Sequence[WheelsetMeasures], mass: float
) -> None:
    """Relate the work of the rail to what it could have done, and to the mass of the train in kg.

    Deceleration of a bogie: work of the rail on its two wheelsets over mass and distance of the train.
    """
    measures.adhesion_utilisation = _share(measures.exploited_work, measures.available_work)
    for i in range(4):
        wheelset = wheelset_measures[i]
        wheelset.adhesion_utilisation = _share(wheelset.exploited_work, wheelset.available_work)
    leading = wheelset_measures[0].rail_work + wheelset_measures[1].rail_work
    trailing = wheelset_measures[2].rail_work + wheelset_measures[3].rail_work
    inertia = mass * measures.end_distance
    measures.deceleration_bogie_1 = _share(leading, inertia)
    measures.deceleration_bogie_2 = _share(trailing, inertia)


def _share(part: float, whole: float) -> float:
    return part / whole if whole > 0.0 else NAN
