from __future__ import annotations

from collections.abc import Callable

import numpy as np
import pytest

from studies.neighbourhood import BANDS, PAPER, counts, in_bands, in_order, mean_counts
from uictest import CaseResult

MakeStop = Callable[..., CaseResult]


def array(*values: float) -> np.ndarray[tuple[int, ...], np.dtype[np.float64]]:
    return np.array(values, dtype=float)


def test_the_caliper_is_counted_on_the_rig_with_both_models(stop: MakeStop) -> None:
    stops = {
        "none": [stop(9, 21, 20, 22)],
        "full": [stop(11, 12, 10, 14)],
        "thermal": [stop(8, 13, 10, 14)],
        "four-caliper": [stop(7, 11, 10, 14)],
    }
    counted = {key: values.tolist() for key, values in counts(stops).items()}
    assert counted == {"caliper": [11], "none": [21], "full": [12], "thermal": [13], "reference": [11]}


def test_module_1_has_a_caliper_on_every_rig_and_does_not_count_in_the_mean(stop: MakeStop) -> None:
    assert mean_counts([stop(99, 10, 11, 12), stop(99, 20, 20, 20)]).tolist() == [11.0, 20.0]


@pytest.mark.parametrize(
    ("caliper", "full", "none", "expected"),
    [
        (11.0, 11.0, 21.0, True),
        (11.0, 15.0, 21.0, True),
        (11.0, 16.0, 20.8, False),  # not clearly above full
        (18.0, 15.0, 20.0, False),  # none is nearer
        (0.0, 0.0, 0.0, False),
    ],
)
def test_the_order_is_that_of_the_paper(caliper: float, full: float, none: float, expected: bool) -> None:
    assert in_order(array(caliper), array(full), array(none)).tolist() == [expected]


def test_all_three_counts_must_lie_in_their_bands() -> None:
    counted = {"caliper": array(11, 11, 12), "none": array(21, 21, 23), "full": array(11, 13, 10)}
    assert in_bands(counted).tolist() == [True, False, True]


def test_the_counts_of_the_paper_lie_in_the_bands_about_them() -> None:
    assert PAPER == {"caliper": 11, "none": 21, "full": 11}
    assert in_bands({key: array(PAPER[key]) for key in BANDS}).all()
