"""Maximum slide of each wheelset, counted down to a low-speed cut-off."""

from __future__ import annotations

import math

from uictest.evaluation.measure_value import MeasureValue, unsupported
from uictest.evaluation.records import SLIDE_CLASS, StopMeasures, Wheelsets


def maximum_slide_above_cutoff(
    measures: StopMeasures, wheelsets: Wheelsets, low_speed_cutoff: float
) -> MeasureValue:
    """Return the largest slide (share; 1 = locked) of each wheelset above the cut-off.

    Slides count while the train runs faster than `low_speed_cutoff` (m/s), a multiple of 10 km/h, as the
    measures keep one value per such class. There is no value for a train that never ran faster.
    """
    k = round(low_speed_cutoff / SLIDE_CLASS)
    slides = tuple(float(wheelset.maximum_slide_above[k]) for wheelset in wheelsets)
    if not measures.initial_speed > low_speed_cutoff or all(map(math.isnan, slides)):
        return unsupported(f"the train never ran faster than the cut-off of {10 * k} km/h")
    return MeasureValue(slides)
