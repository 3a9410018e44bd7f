"""matrix, zip, include, exclude."""

from math import prod
from pathlib import Path

import pytest
from hypothesis import given, strategies as st

from uictest.plans.scenario import ScenarioErrors, expansion
from uictest.plans.scenario.case import case_id, short_keys
from uictest.plans.scenario.expansion import expand
from uictest.plans.scenario.yaml.diagnostics import Document
from uictest.plans.scenario.yaml.tree import Map, as_written, parse


def ids(cases):
    return [case.id for case in cases]


COMMANDS = "brake.command: [80 %, 90 %]"
FRICTIONS = "rail.friction: [0.10, 0.2]"
ANOTHER = "include: [{seed: 9, initial_speed: 80 km/h}]"


@pytest.mark.parametrize(
    ("sections", "expected"),
    [
        ("include: [{seed: 1}, {seed: 2}]", ["seed=1", "seed=2"]),
        (
            f"matrix: {{{COMMANDS}, {FRICTIONS}}}",
            [f"command={command},friction={mu}" for command in (80, 90) for mu in ("0.10", "0.2")],
        ),
        (
            f"matrix: {{seed: [1, 2]}}\nzip: {{{COMMANDS}, expect: [pass, fail]}}",
            [f"seed={n},command={each}" for n in (1, 2) for each in (80, 90)],
        ),
        (
            f"matrix: {{seed: [1, 2], {COMMANDS}}}\nexclude: [{{seed: 1, brake.command: 80%}}]\n{ANOTHER}",
            ["seed=1,command=90", "seed=2,command=80", "seed=2,command=90", "seed=9,initial_speed=80kmh"],
        ),
    ],
)
def test_the_first_key_is_the_slowest_zip_goes_within_the_matrix_and_include_comes_last(
    loaded, head, sections, expected
):
    assert ids(loaded(f"{head}{sections}\n")) == [f"stop[{each}]" for each in expected]


def test_a_case_has_the_values_of_its_id(loaded, head):
    _, case, *_ = loaded(head + "matrix: {rail.friction: [0.10, 0.2], brake.command: [80 %, 100 %]}\n")
    assert case.parameters == {"rail.friction": "0.10", "brake.command": "100 %"}
    assert (case.scenario.rail.friction, case.scenario.brake.command) == (0.1, 1.0)


def test_a_key_below_a_reference_changes_the_part_and_mappings_are_counted_or_named(loaded, head):
    cases = loaded(head + "matrix:\n  vehicle.body.mass: [30 t, 40 t]\n  vehicle: [crh380a, intercity-180]\n")
    assert ids(cases)[1] == "stop[mass=30t,vehicle=intercity-180]"
    assert [(case.scenario.vehicle.name, case.scenario.vehicle.body.mass) for case in cases] == [
        ("crh380a", 30_000.0),
        ("intercity-180", 30_000.0),
        ("crh380a", 40_000.0),
        ("intercity-180", 40_000.0),
    ]
    cases = loaded(
        head + "matrix:\n  rail.friction: [0.1, {points: [{position: 0 m, friction: 0.2}]}]\n"
        "  vehicle: [{extends: crh380a, body: {mass: 40 t}}]\n"
    )
    assert ids(cases) == ["stop[friction=0.1,vehicle=crh380a]", "stop[friction=value2,vehicle=crh380a]"]
    assert cases[1].parameters["rail.friction"] == "{points: [{position: 0 m, friction: 0.2}]}"


def test_short_keys_are_as_long_as_they_must_be_and_name_the_entry_of_a_train():
    assert short_keys(["vehicle.body.mass", "vehicle.bogie.mass", "mass.x", "seed"]) == {
        "vehicle.body.mass": "body.mass",
        "vehicle.bogie.mass": "bogie.mass",
        "mass.x": "x",
        "seed": "seed",
    }
    # Every car's id has it: `controller` alone would say that of all cars.
    assert short_keys(["train.1.controller", "train.1.brake.command", "train.10.controller", "seed"]) == {
        "train.1.controller": "train.1.controller",
        "train.1.brake.command": "train.1.command",
        "train.10.controller": "train.10.controller",
        "seed": "seed",
    }


AXES = st.dictionaries(
    st.text("abcdefgh", min_size=1, max_size=3),
    st.lists(st.integers(0, 99), min_size=1, max_size=4, unique=True),
    min_size=1,
    max_size=4,
)


def tree(text):
    node = parse(Document("text", Path(), text))
    assert isinstance(node, Map)
    return node


def values(variant):
    return tuple(as_written(setting.value.node) for setting in variant)


@given(AXES)
def test_a_matrix_makes_every_combination_once(axes):
    written = ", ".join(f"'x.{key}': {numbers}" for key, numbers in axes.items())
    variants = expand(tree(f"matrix: {{{written}}}"))
    short = short_keys([f"x.{key}" for key in axes])
    assert len(variants) == prod(map(len, axes.values()))
    assert len({case_id("stop", variant, short) for variant in variants}) == len(variants)
    assert len({values(variant) for variant in variants}) == len(variants)


@given(AXES, st.data())
def test_exclude_and_include_count(axes, data):
    written = ", ".join(f"'x.{key}': {numbers}" for key, numbers in axes.items())
    chosen = {key: data.draw(st.sampled_from(numbers)) for key, numbers in axes.items()}
    entry = ", ".join(f"'x.{key}': {number}" for key, number in chosen.items())
    variants = expand(tree(f"matrix: {{{written}}}\nexclude: [{{{entry}}}]\ninclude: [{{{entry}}}]"))
    assert len(variants) == prod(map(len, axes.values()))
    assert values(variants[-1]) == tuple(map(str, chosen.values()))


@pytest.mark.parametrize("count", [100, 400])
def test_excluding_looks_at_each_value_a_fixed_number_of_times(count, monkeypatch):
    looked_at = []
    compared = expansion._comparable
    monkeypatch.setattr(expansion, "_comparable", lambda node: (looked_at.append(1), compared(node))[1])
    values = ", ".join(map(str, range(count)))
    items = ", ".join(f"{{'x.a': {number}}}" for number in range(1, count))
    variants = expand(tree(f"matrix: {{'x.a': [{values}]}}\nexclude: [{items}]"))
    assert len(variants) == 1
    assert len(looked_at) <= 2 * count


def test_a_second_exclusion_of_the_same_cases_is_refused():
    matrix = "matrix: {'x.a': [1, 2], 'x.b': [1, 2, 3]}\n"
    assert len(expand(tree(matrix + "exclude: [{'x.a': 1, 'x.b': 1}, {'x.a': 1}]"))) == 3
    with pytest.raises(ScenarioErrors, match="no case has these values"):
        expand(tree(matrix + "exclude: [{'x.a': 1}, {'x.a': 1, 'x.b': 1}]"))


@given(st.integers(1, 6), st.integers(1, 6))
def test_zip_makes_as_many_cases_as_its_lists_are_long(length, count):
    written = ", ".join(f"k{number}: {list(range(length))}" for number in range(count))
    variants = expand(tree(f"zip: {{{written}}}"))
    assert len(variants) == length
    assert all(len(set(values(variant))) == 1 for variant in variants)
