"""`--set key=value` and `--seed`."""

import pytest
from hypothesis import given, strategies as st

from uictest.plans.scenario import ScenarioErrors
from uictest.plans.scenario.overrides import parse_overrides
from uictest.plans.scenario.yaml.tree import as_written

SWEPT = "rail: {condition: wet}\nmatrix: {rail.friction: [0.1, 0.2], seed: [1, 2]}\n"


def texts(argument):
    return [as_written(value) for value in parse_overrides([argument], None)[0].values]


def test_one_value_replaces_the_axis_of_its_key_several_become_one_and_the_seed_option_replaces_every_seed(
    loaded, head
):
    cases = loaded(head + SWEPT, "rail.friction=0.15")
    assert [case.id for case in cases] == ["stop[seed=1]", "stop[seed=2]"]
    assert {case.scenario.rail.friction for case in cases} == {0.15}
    cases = loaded(head, "rail.friction=0.09,0.10", "brake.command=80 %, 100 %")
    assert [case.id for case in cases] == [
        "stop[friction=0.09,command=80]",
        "stop[friction=0.09,command=100]",
        "stop[friction=0.10,command=80]",
        "stop[friction=0.10,command=100]",
    ]
    cases = loaded(head + "matrix: {seed: [1, 2]}\n", seed=5)
    assert [(case.id, case.scenario.seed) for case in cases] == [("stop", 5)]
    (case,) = loaded(head, "vehicle.body.mass=40 t", "brake.system.tank.volume=3 L")
    assert case.scenario.vehicle.body.mass == 40_000.0
    assert case.scenario.brake.system.tank.volume == pytest.approx(0.003)


def test_an_override_outranks_every_section(loaded, head):
    commands = "brake.command: [80 %, 90 %]", "brake.command: 80 %"
    sections = "zip: {{seed: [1, 2], {}}}\ninclude: [{{seed: 3}}, {{seed: 4, {}}}]\n".format(*commands)
    cases = loaded(head + sections + "exclude: [{seed: 1}]\n", "seed=7")
    assert [case.id for case in cases] == ["stop[command=80]", "stop[command=90]"]
    assert {case.scenario.seed for case in cases} == {7}


@pytest.mark.parametrize(
    ("argument", "values"),
    [
        ("a=range(0.09,0.12,0.01)", ["0.09", "0.10", "0.11", "0.12"]),
        ("a=range(80 %, 100 %, 10 %)", ["80 %", "90 %", "100 %"]),
        ("a=range(3,1,-1)", ["3", "2", "1"]),
        ("a=range(0,1,0.4)", ["0.0", "0.4", "0.8"]),
        ("a=0.03,range(1,2,1)", ["0.03", "1", "2"]),
        ("a={points: [{position: 0 m, friction: 0.1}]}", ["{points: [{position: 0 m, friction: 0.1}]}"]),
        ("a='x,y',z", ["x,y", "z"]),
        ("a=b=c", ["b=c"]),
    ],
)
def test_values_are_split_at_commas_outside_brackets(argument, values):
    assert texts(argument) == values


@given(st.integers(-1000, 1000), st.integers(0, 50), st.integers(1, 100))
def test_a_range_is_exact_and_includes_its_end(first, steps, step):
    values = texts(f"a=range({first / 100:.2f},{(first + steps * step) / 100:.2f},{step / 100:.2f})")
    assert values == [f"{(first + number * step) / 100:.2f}" for number in range(steps + 1)]


@pytest.mark.parametrize(
    ("argument", "column", "message"),
    [
        ("rail.friction", 1, "not a key and a value"),
        ("=1", 1, "not a key and a value"),
        ("a=", 3, "an empty value"),
        ("a=1,,2", 5, "an empty value"),
        ("a=range(1,2)", 3, "not a range"),
        ("a=range(1,2,0)", 3, "never leads"),
        ("a=range(1,2,-1)", 3, "never leads"),
        ("a=range(1 m,2 s,1 m)", 3, "same unit"),
        ("a=range(0,1,0.000001)", 3, "1000001 values"),
        ("a=*x", 3, "alias"),
        ("a=\x1b[2J", 3, "not allowed"),
        ("a=\udcff", 3, "not allowed"),
    ],
)
def test_a_malformed_option_is_refused_at_its_place(argument, column, message):
    with pytest.raises(ScenarioErrors) as caught:
        parse_overrides([argument], None)
    (diagnostic,) = caught.value.diagnostics
    assert (diagnostic.file, diagnostic.line, diagnostic.column) == ("--set", 1, column)
    assert message in diagnostic.message
    assert str(diagnostic).replace("\n", "").isprintable()


def test_a_value_that_a_later_option_replaces_with_its_whole_part_is_refused():
    with pytest.raises(ScenarioErrors, match=r"write --set controller=\.\.\. first"):
        parse_overrides(["controller.hold_limit=1 s", "controller=slip-band"], None)
    assert len(parse_overrides(["controller=slip-band", "controller.cycle_time=10 ms", "seed=1"], None)) == 3


@pytest.mark.parametrize(
    ("argument", "key", "hint"),
    [
        ("rail.frction=0.1", "rail.frction", "'friction'"),
        ("brake.comand=90 %,80 %", "brake.comand", "'command'"),
        ("vehicle.body.mas=1 t", "vehicle.body.mas", "'mass'"),
        ("matrix=1", "matrix", ""),
    ],
)
def test_an_unknown_key_is_told_as_an_error_of_the_option(argument, key, hint, refused, head):
    (diagnostic,) = refused(head, argument)
    assert (diagnostic.file, diagnostic.key) == ("--set", key)
    assert hint in diagnostic.hint


@pytest.mark.parametrize("names", [21, 100, 490])
def test_a_key_has_as_many_names_as_a_file_has_levels(names, refused, loaded, head):
    key = ".".join(["controller.parameters", *"a" * (names - 2)])
    controller = "controller: {connect: 'tcp://rig:5025', free_parameters: true}\n"
    (diagnostic,) = refused(head + controller, f"{key}=1")
    assert f"a key of {names} names; at most 20 are accepted" in diagnostic.message
    (diagnostic,) = refused(f"{head}{controller}matrix: {{{key}: [1, 2]}}\n")
    assert f"a key of {names} names" in diagnostic.message
    assert loaded(head + controller, f"{key[:41]}=1")


@given(st.text(max_size=30))
def test_any_option_is_read_or_refused(argument):
    try:
        parse_overrides([argument], None)
    except ScenarioErrors as errors:
        assert errors.diagnostics


WET = "rail: {condition: wet, friction: 0.09}\n"
WET_SWEPT = "rail: {condition: wet}\nmatrix: {rail.friction: [0.09, 0.1]}\n"


@pytest.mark.parametrize("more", [WET, WET_SWEPT])
@pytest.mark.parametrize(
    "override", ["rail.condition=dry", "rail.condition=wet,dry", "rail.condition.friction=0.2"]
)
def test_another_rail_condition_does_not_keep_the_friction_of_the_file(refused, head, more, override):
    over_time = "rail.friction_over_time={points: [{time: 0 s, factor: 1}]}"
    (diagnostic,) = refused(head + more, override, over_time)
    assert (diagnostic.file, diagnostic.key) == ("--set", "rail.condition")
    assert "rail.friction stays '0.09'" in diagnostic.message or "stays '[0.09, 0.1]'" in diagnostic.message


def test_a_matrix_of_rail_conditions_keeps_no_friction_and_other_numbers_may_change_alone(
    refused, head, loaded
):
    (diagnostic,) = refused(head + WET + "matrix: {rail.condition: [wet, dry]}\n")
    assert (diagnostic.line, diagnostic.column, diagnostic.key) == (5, 32, "rail.condition")
    rail = loaded(head + WET, "rail.condition=wet", "rail.condition.friction_decay=0.3 s/m")[0].scenario.rail
    assert (rail.friction, rail.condition.friction_decay) == (0.09, 0.3)


@pytest.mark.parametrize("more", [WET, WET_SWEPT, WET + "matrix: {rail.condition: [wet, dry]}\n"])
def test_another_rail_condition_is_accepted_with_a_friction_or_without_any(loaded, head, more):
    own = loaded(head + more, "rail.condition=dry", "rail.friction=null")
    given = loaded(head + more, "rail.condition=dry,wet", "rail.friction=0.2")
    assert [case.scenario.rail.highest_friction for case in own] == [0.55]
    assert [case.scenario.rail.friction for case in given] == [0.2, 0.2]


def test_the_cleaning_of_a_condition_is_changed_key_by_key_that_of_the_rail_as_a_whole(loaded, refused, head):
    cleaned = "rail: {condition: wet-cleaning, friction: 0.09}\n"
    swept = loaded(head + cleaned, "rail.condition.cleaning.energy=4 kJ/m,8 kJ/m")
    own = "{energy: 8 kJ/m, recovered_friction: 0.3, reach: 1 m, carry_over: 0}"
    (whole,) = loaded(head + cleaned, f"rail.cleaning={own}", "rail.cleaning.reach=2 m")
    of_sweep = [case.scenario.rail.cleaning_in_force for case in swept]
    of_rail = whole.scenario.rail.cleaning_in_force
    assert [cleaning and (cleaning.energy, cleaning.reach) for cleaning in of_sweep] == [
        (4000.0, 0.5),
        (8000.0, 0.5),
    ]
    assert of_rail is not None
    assert (of_rail.energy, of_rail.reach, of_rail.carry_over) == (8000.0, 2.0, 0.0)
    missing = refused(head + cleaned, "rail.cleaning.energy=4 kJ/m")
    assert [diagnostic.key for diagnostic in missing] == [
        f"rail.cleaning.{key}" for key in ("recovered_friction", "reach", "carry_over")
    ]


def test_a_rail_that_cleaning_or_chance_improves_is_long_enough_for_a_stop(loaded, refused, head):
    """Whether a stop can end is asked of the best friction that a wheelset may meet."""
    slippery = "rail: {condition: wet, friction: 0.002}\nsimulation: {maximum_duration: 100 s}\n"
    own = "{energy: 8 kJ/m, recovered_friction: 0.3, reach: 1 m, carry_over: 0}"
    assert any("cannot end" in diagnostic.message for diagnostic in refused(head + slippery))
    assert loaded(head + slippery, f"rail.cleaning={own}")
    varied = "rail.variation={spread: %d %%, correlation_length: 1 km, left_right_correlation: 1}"
    assert loaded(head + slippery, varied % 100)
    assert any("cannot end" in each.message for each in refused(head + slippery, varied % 0))
