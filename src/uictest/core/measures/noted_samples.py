"""A recording fed to all accumulators, in a form that can be compiled: numbers of the records are noted."""

from collections.abc import Sequence

import numpy as np
from numpy.typing import NDArray

from uictest.core.measures.contact import observe_contact
from uictest.core.measures.monitoring import observe_monitoring, reports_wheelset
from uictest.core.measures.records import MeasureDefinition, StopMeasures, WheelsetMeasures
from uictest.core.measures.train import (
    keep_window,
    observe_build_up,
    observe_reservoir_margin,
    observe_train,
)
from uictest.core.measures.wheelset import (
    keep_slide,
    keep_slow_times,
    observe_reaction,
    observe_reference,
    observe_wheelset,
)

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
    """Feed all samples but the first, which has begun the records, as :class:`.Replay` does.

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
        time, distance, speed = samples[k, 0], samples[k, 1], samples[k, 2]
        reservoir_pressure, line_pressure = samples[k, 3], samples[k, 4]
        for i in range(4):
            wheelset, own = wheelset_measures[i], wheelset_samples[k, i]
            observe_wheelset(
                wheelset, measures, definition, i + 1, time, speed, own[0], own[1], own[2], own[3]
            )
            observe_contact(
                wheelset, measures, definition, time, speed, own[4], line_pressure, own[5], own[6], own[7]
            )
            slip = speed - own[0]
            if slip != slip:  # a gap
                wheelset.lock = 0.0
            else:
                keep_slide(wheelset, wheelset, definition, speed)
        observe_reservoir_margin(measures, reservoir_pressure, samples[k, 5])
        observe_build_up(measures, definition, time, distance, speed, line_pressure)
        observe_train(measures, definition, time, distance, speed, reservoir_pressure)
        keep_window(measures, measures)
        keep_slow_times(measures, wheelset_measures, measures, wheelset_measures)
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
