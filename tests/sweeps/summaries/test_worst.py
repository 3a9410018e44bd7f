"""Which cases of a sweep are worth looking at, and that they are the cases of its rows."""

import numpy as np
import pyarrow as pa
import pytest
from hypothesis import given, strategies as st

from uictest import rig
from uictest.analysis.summaries.worst import MOST, WorstCases, full_cases
from uictest.running.campaign import RecordingRequest, RunSettings, run_cases
from uictest.running.chunked.chunk import chunk_runner

from ..conftest import rows as chunk_rows

margins = st.one_of(st.none(), st.floats(-2.0, 2.0))
rows = st.lists(
    st.tuples(st.booleans(), margins, st.sampled_from(["pass", "fail", "error", "skipped"])), max_size=40
)


def table(found, first=0):
    met, margin, outcome = zip(*found, strict=True) if found else ((), (), ())
    columns = {
        "index": pa.array(range(first, first + len(found)), pa.int64()),
        "met": pa.array(met, pa.bool_()),
        "narrowest_margin": pa.array(margin, pa.float64()),
        "outcome": pa.array(outcome, pa.string()),
    }
    return pa.table(columns)


@given(rows, st.integers(0, 40))
def test_those_not_met_come_first_then_the_narrowest(found, cut):
    worst = WorstCases()
    worst.add(table(found[:cut]))
    worst.add(table(found[cut:], min(cut, len(found))))
    seen = [
        (met, 9.0 if margin is None else margin, place)
        for place, (met, margin, outcome) in enumerate(found)
        if outcome not in ("error", "skipped")
    ]
    assert worst.indices() == [place for _, _, place in sorted(seen)][:MOST]


def test_a_case_examined_alone_has_the_figures_of_its_row(load):
    """Bit for bit: the scalar rig and the lanes, with the noise of the same case."""
    plan = load("matrix:\n  rail.friction: [0.06, 0.15]\n  controller.slip_threshold: [0.5 m/s, 0.9 m/s]\n")
    runner = chunk_runner(plan, rig.run_block)
    indices = np.array([3, 0])
    by_lanes, _ = runner.results(indices, plan.settings(indices))
    alone = run_cases(full_cases(plan, indices.tolist()), RunSettings(recording=RecordingRequest("all")))
    for own, result in zip(by_lanes, alone.results, strict=True):
        assert (own.id, own.outcome) == (result.id, result.outcome)
        assert own.measures is not None and result.measures is not None
        for found, expected in zip(
            (own.measures, *own.wheelsets), (result.measures, *result.wheelsets), strict=True
        ):
            assert np.array_equal(list(found.values()), list(expected.values()), equal_nan=True)


@pytest.mark.parametrize("column", ["narrowest_margin", "narrowest_criterion"])
def test_rows_name_the_narrowest_margin(load, column):
    found = chunk_rows(chunk_runner(load(), rig.run_block).run(np.arange(2)))
    assert all(row[column] is not None for row in found)
