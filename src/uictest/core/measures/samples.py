"""The order in which a sample feeds the measures: of stops in the rig, in lanes too, and of recordings.

Beside them the layouts in memory of the records, for compiled code and for files of measures.
"""

from collections.abc import Sequence
from typing import NamedTuple

import numpy as np
from numpy.typing import NDArray

from uictest.core.measures.records import MeasureDefinition, StopMeasures, WheelsetMeasures
from uictest.core.measures.train import keep_window, observe_build_up, observe_reservoir_margin, observe_train
from uictest.core.measures.wheelset import (
    keep_slide,
    keep_slow_times,
    observe_contact,
    observe_monitoring,
    observe_reaction,
    observe_reference,
    observe_wheelset,
    reports_wheelset,
)
from uictest.core.record import layout_of

Array = NDArray[np.float64]

STOP_MEASURES = layout_of(StopMeasures)
"""Layout of :class:`~uictest.core.measures.StopMeasures`."""
WHEELSET_MEASURES = layout_of(WheelsetMeasures)
"""Layout of :class:`~uictest.core.measures.WheelsetMeasures`."""


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


def note_samples(
    measures: StopMeasures,
    wheelset_measures: Sequence[WheelsetMeasures],
    definition: MeasureDefinition,
    samples: Array,
    wheelset_samples: Array,
    faults: Array,
    numbers: Array,
    indices: NDArray[np.int64],
    noted: Array,
) -> int:
    """Feed all samples but the first, which has begun the records.

    Args:
        measures: record of the stop.
        wheelset_measures: records of its wheelsets.
        definition: how samples become measures.
        samples: of the train, as :class:`.Samples` holds them.
        wheelset_samples: of the wheelsets likewise.
        faults: likewise.
        numbers: the records again, as numbers one after the other.
        indices: of the numbers to note.
        noted: takes them, a row for each sample fed.
    """
    for k in range(1, len(samples)):
        four = wheelset_samples[k]
        train = TrainState(
            *(samples[k, 0], samples[k, 1], samples[k, 2], samples[k, 3], samples[k, 4], samples[k, 5])
        )
        wheelsets = _state(four[0]), _state(four[1]), _state(four[2]), _state(four[3])
        observe_sample(measures, wheelset_measures, definition, train, wheelsets)
        keep_tables(measures, wheelset_measures, measures, wheelset_measures, definition)
        if len(faults) > 0 and faults[k, 0] > 0.0:
            _observe_faults(
                measures, wheelset_measures, definition, samples[k, 6], wheelset_samples[k], faults[k]
            )
        bits = 0 if samples[k, 7] != samples[k, 7] else int(samples[k, 7])
        for i in range(4):
            wheelset, sample = wheelset_measures[i], wheelset_samples[k, i]
            required = faults[k, 9 + i] if len(faults) > 0 else 0.0
            reported = reports_wheelset(bits, i)
            observe_monitoring(
                wheelset, measures, definition, reported, wheelset.faulty, required, sample[8], sample[9]
            )
        for j in range(len(indices)):
            noted[k - 1, j] = numbers[indices[j]]
    return len(samples)


def _state(sample: Array) -> WheelsetState:
    return WheelsetState(
        *(sample[0], sample[1], sample[2], sample[3], sample[4], sample[5], sample[6], sample[7])
    )


def _observe_faults(
    measures: StopMeasures,
    wheelset_measures: Sequence[WheelsetMeasures],
    definition: MeasureDefinition,
    reference_speed: float,
    wheelset_samples: Array,
    faults: Array,
) -> None:
    observe_reference(measures, definition, reference_speed)
    largest = wheelset_samples[0, 2]
    for i in range(1, 4):
        if wheelset_samples[i, 2] > largest:
            largest = wheelset_samples[i, 2]
    for i in range(4):
        observe_reaction(
            wheelset_measures[i],
            measures,
            definition,
            faults[1 + i],
            faults[5 + i],
            wheelset_samples[i, 2],
            largest,
        )
