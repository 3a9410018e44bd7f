"""`set`: a value in Python is the value that the text of `--set` is."""

import math
from decimal import Decimal
from pathlib import Path

import numpy as np
import pandas as pd
import pytest
from hypothesis import given, strategies as st

from uictest.api.arguments import override_texts
from uictest.plans.scenario import parse_overrides
from uictest.plans.scenario.yaml import plain


def read(assignments):
    """Return the values as the parser of `--set` reads them: one, or a tuple of several."""
    overrides = parse_overrides(override_texts(assignments), None)
    values = {each.key: tuple(map(plain, each.values)) for each in overrides}
    return {key: each[0] if len(each) == 1 else each for key, each in values.items()}


@pytest.mark.parametrize(
    ("value", "meant"),
    [
        (0.1, 0.1),
        (np.float64(0.1), 0.1),
        (np.int64(3), 3),
        (Decimal("0.10"), 0.1),
        (True, True),
        (None, None),
        ("90 %", "90 %"),
        ([0.08, 0.1], (0.08, 0.1)),
        ((1, 2), (1, 2)),
        (range(3), (0, 1, 2)),
        (np.array([0.08, 0.1]), (0.08, 0.1)),
        (pd.Series(["80 %", "90 %"]), ("80 %", "90 %")),
        ("80 %,90 %", ("80 %", "90 %")),
        ("range(1,3,1)", (1, 2, 3)),
        (["range(1,3,1)", 7], (1, 2, 3, 7)),
        (["a, b", "c"], ("a, b", "c")),
        (["[a, b]", "c"], (("a", "b"), "c")),
        ([["a", "b"], "c"], (("a", "b"), "c")),
        ({"extends": "wet", "friction": 0.1}, {"extends": "wet", "friction": 0.1}),
        ([{"kind": "stuck", "at": "3 s"}], {"kind": "stuck", "at": "3 s"}),
        (Path("parts/my.yaml"), "parts/my.yaml"),
    ],
)
def test_a_value_is_read_as_it_is_meant(value, meant):
    assert read({"a.b": value}) == {"a.b": meant}


@given(st.lists(st.floats(allow_nan=False, allow_infinity=False), min_size=2))
def test_numbers_keep_every_digit(numbers):
    assert read({"key": numbers})["key"] == tuple(numbers)


@pytest.mark.parametrize("value", [math.nan, [0.1, math.inf], np.float64("nan")])
def test_numbers_are_finite(value):
    with pytest.raises(ValueError, match=r"set: rail\.friction is (nan|inf), expected a finite number"):
        override_texts({"rail.friction": value})


def test_a_value_that_is_nested_too_deeply_is_refused():
    value = []
    for _ in range(5000):
        value = [value]
    with pytest.raises(ValueError, match="set: a value is nested too deeply"):
        override_texts({"rail": value})


def test_another_type_is_named():
    with pytest.raises(TypeError, match="set: rail is a object; write a text, a number or a list of them"):
        override_texts({"rail": object()})


@pytest.mark.parametrize("repeat", [0, 1001, 1.5, True, "3"])
def test_repeat_is_a_count(repeat):
    with pytest.raises(ValueError, match=r"repeat is .*, expected a whole number from 1 to 1000"):
        override_texts(None, repeat)
