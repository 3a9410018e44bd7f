import numpy as np

from uictest.core.measures.catalogue.slide import maximum_slide_above_cutoff

KMH = 1 / 3.6


def test_slides_below_the_cutoff_do_not_count(stop, wheelsets) -> None:
    records = wheelsets(0.9, 0.9)
    records.maximum_slide_above[:, 4:] = [[0.2], [0.3]]
    assert maximum_slide_above_cutoff(stop(), records, 30 * KMH).values == (0.9, 0.9)
    assert maximum_slide_above_cutoff(stop(), records, 40 * KMH).values == (0.2, 0.3)


def test_a_train_slower_than_the_cutoff_supports_no_slide(stop, wheelsets) -> None:
    reading = maximum_slide_above_cutoff(stop(initial_speed=25 * KMH), wheelsets(0.9), 30 * KMH)
    assert reading.unavailable_reason == "the train never ran faster than the cut-off of 30 km/h"


def test_nor_does_one_without_a_sample_above_it(stop, wheelsets) -> None:
    assert maximum_slide_above_cutoff(stop(), wheelsets(np.nan, np.nan), 30 * KMH).unavailable_reason
