"""What a running program says of its parameters, as text from outside."""

import json
import math

import pytest
from hypothesis import given, strategies as st

from uictest.controllers import ControllerError, stated_declarations

JSON = st.recursive(
    st.none() | st.booleans() | st.floats() | st.integers() | st.text(max_size=3),
    lambda inner: st.lists(inner, max_size=3) | st.dictionaries(st.sampled_from("abc"), inner, max_size=3),
)


@pytest.mark.parametrize(
    ("text", "reason"),
    [
        ("[" * 100_000 + "]" * 100_000, "nested too deeply"),
        ('{{"gain": {{"default": {}1{}}}}}'.format("[" * 100_000, "]" * 100_000), "nested too deeply"),
        ('{"gain": {"default": NaN}}', "the default of gain: nan is no finite number"),
        ('{"gain": {"default": -Infinity, "unit": "s"}}', "the default of gain: -inf is no finite number"),
        ('{"gain": {"default": 1e999}}', "the default of gain: inf is no finite number"),
        ('{"gain": {"default": [1, NaN]}}', "the default of gain: nan is no finite number"),
        ('{"gain": {"default": 1, "range": [NaN, 2]}}', "the range of gain is nan to 2"),
        ('{"gain": {"default": 1, "range": [0, NaN]}}', "the range of gain is 0 to nan"),
        ('{"gain": {"default": 1, "range": [2, 0]}}', "the range of gain is 2 to 0"),
        ('{"gain": {"range": [2, 0]}}', "the range of gain is 2 to 0"),
        ('{"gain": {"default": 3, "range": [0, 2]}}', "gain: 3 is out of range; accepted: 0 to 2"),
        ('{"gain": {"default": 1, "range": [0, 1, 2]}}', "its parameters are not of the form"),
        ('{"gain": {"default": 1, "range": "ab"}}', "its parameters are not of the form"),
        ('{"gain": {"default": 1, "rnage": [0, 1]}}', "rnage"),
    ],
)
def test_what_is_no_declaration_is_told_with_the_form_and_the_parameter(text, reason):
    with pytest.raises(ControllerError) as caught:
        stated_declarations(text)
    assert reason in str(caught.value)
    assert '{"NAME": {"default": 1.0' in str(caught.value)


def test_a_range_may_be_open_and_a_default_of_any_kind():
    text = '{"a": {"default": 1, "range": [0, Infinity]}, "b": {"default": "x"}, "c": {"default": true}}'
    stated = stated_declarations(text)
    assert [each.default for each in stated.values()] == [1, "x", True]
    assert stated["a"].range == [0, math.inf]


@given(
    st.dictionaries(
        st.text(max_size=3),
        st.fixed_dictionaries({}, optional=dict.fromkeys(("default", "unit", "range", "description"), JSON)),
    )
    | JSON
)
def test_any_json_is_read_or_refused(value):
    try:
        stated_declarations(json.dumps(value))
    except ControllerError as error:
        assert "its parameters are not of the form" in str(error)
