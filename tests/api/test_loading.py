"""Load cases as the commands do, with their messages."""

import math
import subprocess
import sys
from decimal import Decimal
from pathlib import Path

import numpy as np
import pandas as pd
import pytest
from hypothesis import given, strategies as st

import uictest
from uictest.api.arguments import override_texts
from uictest.plans.scenario import parse_overrides
from uictest.plans.scenario.yaml import plain


def test_lists_are_axes_and_the_default_is_the_folder(write):
    write()
    cases = uictest.load(set={"rail.friction": [0.08, 0.1], "brake.command": "90 %"}, seed=3)
    assert [case.id for case in cases] == ["stop[friction=0.08]", "stop[friction=0.1]"]
    assert {case.scenario.seed for case in cases} == {3}
    assert {case.scenario.brake.command.text for case in cases} == {"90 %"}


def test_expressions_and_tags_select(write):
    write("a", "tags: [wet]\n"), write("b", "tags: [wet, long]\n")
    assert [case.id for case in uictest.load("scenarios", tag="long")] == ["b"]
    assert [case.id for case in uictest.load("scenarios", select="not b")] == ["a"]


def test_every_error_of_a_file_and_of_set_is_in_the_message(write):
    path = write(text="seeed: 3\nbrake: {comand: 90 %}\n")
    with pytest.raises(uictest.ScenarioErrors) as raised:
        uictest.load(path)
    assert "scenarios/stop.yaml:6:1: seeed" in str(raised.value)
    assert "did you mean 'command'?" in str(raised.value)
    with pytest.raises(uictest.ScenarioErrors, match=r"(?s)rail\.fricton.*did you mean 'friction'\?"):
        uictest.load(write(), set={"rail.fricton": 0.1})
    with pytest.raises(uictest.ScenarioErrors, match=r"(?s)brake\.command.*100 %"):
        uictest.load(write(), set={"brake.command": 1.0})


@pytest.mark.parametrize(
    ("arguments", "message"),
    [
        ({"select": "nothing"}, "nothing selected among 1 case; their tags: wet"),
        ({"select": "a and"}, "select: at column 6: expected a word, 'not' or '(', found the end in 'a and'"),
        ({"tag": "("}, "tag: at column 2: expected a word, 'not' or '(', found the end in '('"),
        ({"seed": -1}, "seed is -1, expected a whole number from 0 to 4294967295"),
        ({"seed": 1.5}, "seed is 1.5, expected a whole number from 0 to 4294967295"),
        ({"seed": Decimal("1.5")}, "seed is Decimal('1.5'), expected a whole number from 0 to 4294967295"),
        ({"seed": "5"}, "seed is '5', expected a whole number from 0 to 4294967295"),
    ],
)
def test_an_argument_that_cannot_be_used_is_named(write, arguments, message):
    path = write("a", "tags: [wet]\n")
    with pytest.raises(ValueError) as raised:
        uictest.load(path, **arguments)
    assert str(raised.value) == message


def test_without_files_or_with_a_series_the_message_says_what_to_do():
    with pytest.raises(ValueError, match="there is no folder scenarios/ here: name scenario files"):
        uictest.load()
    with pytest.raises(ValueError, match=r"wsp\.series\.yaml is a series: uictest\.run"):
        uictest.load("wsp.series.yaml")


def test_references_outside_need_trust(workplace, monkeypatch):
    head = "schema: uictest/scenario/1\nname: stop\n"
    for name, line in (("beside", "initial_speed: 30 km/h"), ("inside", "extends: ../beside/stop.yaml")):
        (workplace / name).mkdir()
        (workplace / name / "stop.yaml").write_text(f"{head}{line}\n")
    monkeypatch.chdir("inside")
    with pytest.raises(uictest.ScenarioErrors, match="--trust"):
        uictest.load("stop.yaml")
    assert uictest.load("stop.yaml", trust=["../beside"])[0].id == "stop"


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


def test_a_value_that_set_or_repeat_cannot_have_is_named():
    for value in (math.nan, [0.1, math.inf], np.float64("nan")):
        with pytest.raises(ValueError, match=r"set: rail\.friction is (nan|inf), expected a finite number"):
            override_texts({"rail.friction": value})
    nested = []
    for _ in range(5000):
        nested = [nested]
    with pytest.raises(ValueError, match="set: a value is nested too deeply"):
        override_texts({"rail": nested})
    with pytest.raises(TypeError, match="set: rail is a object; write a text, a number or a list of them"):
        override_texts({"rail": object()})
    for repeat in (0, 1001, 1.5, True, "3"):
        with pytest.raises(ValueError, match=r"repeat is .*, expected a whole number from 1 to 1000"):
            override_texts(None, repeat)


HEAVY = ("numpy", "pandas", "pyarrow", "pydantic", "plotly", "scipy", "typer", "uictest.rig")


def test_importing_loads_nothing_heavy():
    program = f"import sys, uictest; print([name for name in {HEAVY!r} if name in sys.modules])"
    done = subprocess.run([sys.executable, "-c", program], capture_output=True, text=True, check=True)
    assert done.stdout.strip() == "[]"


def test_the_public_names_are_these_and_each_has_a_docstring():
    names = "Case CaseResult Recording Results Rig ScenarioErrors SweepResults TrainRig Validation evaluate"
    others = "load read_recording read_results run search simulate sweep validate"
    assert sorted(uictest.__all__) == [*names.split(), *others.split()]
    assert all(getattr(uictest, name).__doc__ for name in uictest.__all__)


@pytest.mark.parametrize(
    "first", ["uictest.running.chunked", "uictest.cli.entry", "uictest.runs", "uictest.searching"]
)
def test_no_room_takes_the_place_of_a_function(first):
    program = f"import {first}, uictest; assert all(callable(getattr(uictest, n)) for n in uictest.__all__)"
    subprocess.run([sys.executable, "-c", program], check=True)
