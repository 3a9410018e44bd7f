"""Points of sampled sweeps: which they are, and what is said of those that are not shown."""

import numpy as np
import pytest
from hypothesis import given, strategies as st
from scipy.stats import qmc

from uictest.report.page.sweep.scatter import MOST_POINTS, chosen_rows, is_sampled, scatter
from uictest.report.sweep.cases import SummaryRows

from ..sweep_rows import DRAWN, drawn_rows, sweep_result, write_rows


def points(folder, cases, failing=range(0), wanted=()):
    write_rows(folder, drawn_rows(cases, failing))
    result = sweep_result({**DRAWN, "topology": ["one", "four"]}, cases, logarithmic=["gain"])
    assert is_sampled(result)
    return scatter(result, SummaryRows(folder), wanted)


def test_a_small_sample_is_shown_whole(tmp_path):
    found = points(tmp_path, 300)
    rows = drawn_rows(300)
    assert (found.cases, found.added) == (300, 0)
    assert list(found.ids) == [each["id"] for each in rows]
    friction, gain = found.parameters
    assert friction.numbers.tolist() == [float(each["parameters.rail.friction"]) for each in rows]
    assert (gain.name, gain.unit, gain.logarithmic, friction.logarithmic) == ("gain", "1/s", True, False)
    assert [each.name for each in found.measures] == ["braking distance", "largest slide"]
    assert list(found.left_out) == ["topology"]


def test_of_ten_thousand_cases_a_thousand_are_chosen_and_those_asked_for(tmp_path):
    chosen = chosen_rows(10_000).tolist()
    other = next(k for k in range(10_000) if k not in chosen)
    found = points(
        tmp_path, 10_000, range(3, 10_000, 100), (f"study[sample={other}]", f"study[sample={chosen[-1]}]")
    )
    shown = [int(text[13:-1]) for text in found.ids]
    assert (found.cases, found.added) == (10_000, 1)
    assert shown == sorted([*chosen, other])
    assert found.words.count("fail") == sum(k % 100 == 3 for k in shown)
    # The verdicts of those that are not shown are counted.
    assert found.all_words == {"pass": 9900, "fail": 100}
    frictions = [float(each["parameters.rail.friction"]) for each in drawn_rows(10_000)]
    assert found.parameters[0].numbers.tolist() == [frictions[k] for k in shown]


@given(st.integers(0, 20_000_000))
def test_all_rows_are_chosen_or_as_many_as_a_page_shows(cases):
    rows = chosen_rows(cases)
    assert len(rows) == min(cases, MOST_POINTS)
    assert np.all(np.diff(rows) > 0)
    assert not len(rows) or (rows[0] >= 0 and rows[-1] < cases)
    assert rows.tolist() == chosen_rows(cases).tolist()


@pytest.mark.parametrize("power", [12, 13, 14])
def test_a_thinned_sobol_sequence_still_fills_its_space(power):
    """Every fifth of 8192 points has 60 to 400 of its 1639 in the eighths of a coordinate."""
    sequence = qmc.Sobol(4, scramble=True, rng=np.random.default_rng(1)).random_base2(power)
    chosen = sequence[chosen_rows(len(sequence))]
    for coordinate in chosen.T:
        counts, _ = np.histogram(coordinate, 8, (0.0, 1.0))
        assert counts.min() > 0.7 * len(chosen) / 8
