"""Values of many stops against their bounds: what the bounds say of each."""

from __future__ import annotations

import math

import numpy as np
import pytest
from hypothesis import assume, given, strategies as st

from uictest.judging.evaluation.block_verdicts import BoundedValues
from uictest.judging.evaluation.bounds import Bounds, deciding
from uictest.judging.evaluation.decision import why_decided
from uictest.judging.evaluation.verdict import Verdict, relative_margin

bound = st.none() | st.sampled_from([0.0, -1.0, 2.5]) | st.floats(-1e6, 1e6)
value = st.sampled_from([0.0, -0.0, -1.0, 2.5, math.nan, math.inf, -math.inf]) | st.floats(-1e7, 1e7)


@pytest.mark.parametrize("count", [1, 4])
@given(bound, bound, st.booleans(), st.data())
def test_each_stop_is_decided_as_alone(
    count: int, lower: float | None, upper: float | None, strict: bool, data: st.DataObject
) -> None:
    assume((lower, upper) != (None, None) and (lower is None or upper is None or lower <= upper))
    bounds, needed = Bounds(lower, upper, strict), data.draw(st.integers(1, count))
    stops = data.draw(st.lists(st.lists(value, min_size=count, max_size=count), min_size=1, max_size=6))
    together = BoundedValues(np.array(stops), bounds, needed)
    margins, has_margin = together.relative_margins
    for place, values in enumerate(stops):
        decided = deciding(values, bounds, needed)
        holds = bounds.hold(decided)
        assert together.hold[place] == holds
        assert repr(float(together.deciding[place])) == repr(decided)
        verdict = Verdict(
            id="tested",
            layer="validity",
            value=None if math.isnan(decided) else decided,
            unit="m",
            lower=lower,
            upper=upper,
            margin=None if math.isnan(decided) else bounds.margin(decided),
            status="pass" if holds else "fail",
            reason="",
        )
        expected = relative_margin(verdict)
        assert has_margin[place] == (expected is not None)
        assert expected is None or repr(float(margins[place])) == repr(expected)
        assert together.reason(place, "m") == why_decided(values, decided, bounds, needed, "m")
