import numpy as np

from uictest.core.measures.catalogue.sliding import maximum_slide_above_cutoff

KMH = 1 / 3.6


def test_slides_below_the_cutoff_do_not_count_and_none_above_it_is_none(stop, wheelsets):
    records = wheelsets(0.9, 0.9)
    records.maximum_slide_above[:, 4:] = [[0.2], [0.3]]
    assert maximum_slide_above_cutoff(stop(), records, 30 * KMH).values == (0.9, 0.9)
    assert maximum_slide_above_cutoff(stop(), records, 40 * KMH).values == (0.2, 0.3)
    reading = maximum_slide_above_cutoff(stop(initial_speed=25 * KMH), wheelsets(0.9), 30 * KMH)
    assert reading.unavailable_reason == "the train never ran faster than the cut-off of 30 km/h"
    assert maximum_slide_above_cutoff(stop(), wheelsets(np.nan, np.nan), 30 * KMH).unavailable_reason
