"""A recording fed to all accumulators, in a form that can be compiled: numbers of the records are noted."""

from collections.abc import Sequence

import numpy as np
from numpy.typing import NDArray

from uictest.core.measures.monitoring import observe_monitoring, reports_wheelset
from uictest.core.measures.records import MeasureDefinition, StopMeasures, WheelsetMeasures
from uictest.core.measures.samples import TrainState, WheelsetState, keep_tables, observe_sample
from uictest.core.measures.wheelset import observe_reaction, observe_reference

Array = NDArray[np.float64]


def note_samples(
    measures: StopMeasures,
    wheelset_measures: Sequence[WheelsetMeasures],
    definition: MeasureDefinition,
    samples: Array,
    wheelset_samples: Array,
    faults: Array,
    numbers: Array,
    places: NDArray[np.int64],
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
        places: of the numbers to note.
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
            wheelset, own = wheelset_measures[i], wheelset_samples[k, i]
            required = faults[k, 9 + i] if len(faults) > 0 else 0.0
            reported = reports_wheelset(bits, i)
            observe_monitoring(
                wheelset, measures, definition, reported, wheelset.faulty, required, own[8], own[9]
            )
        for j in range(len(places)):
            noted[k - 1, j] = numbers[places[j]]
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
