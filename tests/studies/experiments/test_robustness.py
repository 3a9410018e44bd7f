from __future__ import annotations

import math

import pytest

from uictest.studies.experiments.robustness import _in_order, _ratio


@pytest.mark.parametrize(
    ("caliper", "full", "none", "expected"),
    [
        (11.0, 11.0, 21.0, True),
        (11.0, 8.0, 21.0, True),
        (11.0, 11.0, 12.0, False),
        (11.0, 20.0, 16.0, False),
        (0.0, 0.0, 9.0, False),
    ],
)
def test_the_order_of_caliper_full_and_none(caliper: float, full: float, none: float, expected: bool) -> None:
    assert _in_order({"four-caliper": caliper, "full": full, "none": none}) is expected


def test_a_caliper_that_never_cycles_gives_no_ratio() -> None:
    assert math.isnan(_ratio(0.0, 0.0))
