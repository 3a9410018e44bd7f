"""The order in which a sample feeds the measures: of stops in the rig, in lanes too, and of recordings."""

from collections.abc import Sequence
from typing import NamedTuple

from uictest.core.measures.contact import observe_contact
from uictest.core.measures.records import MeasureDefinition, StopMeasures, WheelsetMeasures
from uictest.core.measures.train import (
    keep_window,
    observe_build_up,
    observe_reservoir_margin,
    observe_train,
)
from uictest.core.measures.wheelset import keep_slide, keep_slow_times, observe_wheelset


class TrainState(NamedTuple):
    """What is observed of the train, SI; pressures are gauge."""

    time: float
    distance: float
    speed: float
    reservoir_pressure: float
    line_pressure: float
    cylinder_pressure: float  # the highest


class WheelsetState(NamedTuple):
    """What is observed of a wheelset, as :func:`observe_wheelset` and :func:`observe_contact` say."""

    wheel_speed: float
    venting: float
    clamping_force: float
    disc_temperature: float
    tank_pressure: float
    rail_work: float
    contact_loss: float
    highest_force: float


FourStates = tuple[WheelsetState, WheelsetState, WheelsetState, WheelsetState]


def observe_sample(
    measures: StopMeasures,
    wheelset_measures: Sequence[WheelsetMeasures],
    definition: MeasureDefinition,
    train: TrainState,
    wheelsets: FourStates,
) -> None:
    """Feed a sample to all measures that are one number."""
    _observe(wheelset_measures[0], measures, definition, 1, train, wheelsets[0])
    _observe(wheelset_measures[1], measures, definition, 2, train, wheelsets[1])
    _observe(wheelset_measures[2], measures, definition, 3, train, wheelsets[2])
    _observe(wheelset_measures[3], measures, definition, 4, train, wheelsets[3])
    observe_reservoir_margin(measures, train.reservoir_pressure, train.cylinder_pressure)
    observe_build_up(measures, definition, train.time, train.distance, train.speed, train.line_pressure)
    observe_train(measures, definition, train.time, train.distance, train.speed, train.reservoir_pressure)


def _observe(
    measures: WheelsetMeasures,
    of_train: StopMeasures,
    definition: MeasureDefinition,
    number: int,
    train: TrainState,
    state: WheelsetState,
) -> None:
    observe_wheelset(
        *(measures, of_train, definition, number, train.time, train.speed),
        *(state.wheel_speed, state.venting, state.clamping_force, state.disc_temperature),
    )
    observe_contact(
        *(measures, of_train, definition, train.time, train.speed, state.tank_pressure),
        *(train.line_pressure, state.rail_work, state.contact_loss, state.highest_force),
    )


def keep_tables(
    measures: StopMeasures,
    wheelset_measures: Sequence[WheelsetMeasures],
    samples: StopMeasures,
    wheelset_samples: Sequence[WheelsetMeasures],
    definition: MeasureDefinition,
) -> None:
    """Keep the tables from what :func:`observe_sample` has put into ``samples``, which may be the same."""
    keep_window(measures, samples)
    keep_slow_times(measures, wheelset_measures, samples, wheelset_samples)
    for i in range(4):
        keep_slide(wheelset_measures[i], wheelset_samples[i], definition, samples.end_speed)
