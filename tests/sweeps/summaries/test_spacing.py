"""Which parameters are spaced or drawn logarithmically."""

from itertools import pairwise

import pytest
from hypothesis import given, strategies as st

from uictest.analysis.summaries.tally import bins_of_plan, logarithmic_keys, spaced_logarithmically
from uictest.report import DrawnInterval

TEXT = """\
matrix:
  seed: [1, 10, 100]
  rail.gradient: [1 permille, 2 permille, 3 permille, 4 permille]
sample:
  size: 8
  parameters:
    rail.friction: {uniform: [0.01, 0.15]}
    brake.system.wsp_valve.vent_conductance: {log-uniform: [1e-8 m3/(s Pa), 4e-8 m3/(s Pa)]}
"""


def test_drawn_and_listed_parameters_of_one_unit_are_logarithmic(load):
    assert logarithmic_keys(load(TEXT)) == ("seed", "brake.system.wsp_valve.vent_conductance")
    assert not spaced_logarithmically(["1 m/s", "10 m/s", "100 km/h"])


@pytest.mark.parametrize(
    "texts", ["1 2 5 10 20 50", "0.01 0.1 1", "8 4 2 1", "0.5e-8 1e-8 2e-8 4e-8", "10 20 50 100", "1 3 10"]
)
def test_like_ratios_are_logarithmic(texts):
    assert spaced_logarithmically([f"{text} km/h" for text in texts.split()])


@pytest.mark.parametrize(
    "texts",
    [
        "60 80 100 120",
        "60 80 120 160",
        "0 1 10",
        "-1 -10 -100",
        "1 100",
        "1 10 5",
        "1 4 16 4.5",
        "one two three",
        "1 1 1",
    ],
)
def test_others_are_not(texts):
    assert not spaced_logarithmically(texts.split())


@given(st.floats(0.001, 1e3), st.floats(2.0, 20.0), st.integers(3, 8))
def test_a_geometric_sequence_is_and_an_arithmetic_one_is_not(first, factor, count):
    assert spaced_logarithmically([repr(first * factor**k) for k in range(count)])
    assert not spaced_logarithmically([repr(first + factor * k) for k in range(1, count + 1)])


def test_intervals_of_a_log_uniform_parameter_have_like_ratios(load):
    values = bins_of_plan(load(TEXT))["brake.system.wsp_valve.vent_conductance"].values
    edges = [value.low for value in values if isinstance(value, DrawnInterval)]
    assert len(edges) == 10
    assert edges[0] == 1e-8
    for before, after in pairwise(edges):
        assert after / before == pytest.approx(4.0**0.1, rel=0.01)
    assert values[5].label == "2e-08 .. 2.3e-08 m3/(s Pa)"
