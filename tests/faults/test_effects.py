"""What each fault of the catalogue does to the rig: values as users write them, SI in the rig."""

import math

import pytest

from uictest.core.units import KINDS
from uictest.plans.faults import FAULT_KINDS, SPEED_SENSOR, Effects
from uictest.plans.scenario.yaml import parse_quantity

TRUE = ("speed_valid", "speed_factor", "pressure_factor", "train_speed_valid", "train_speed_factor")
NOTHING = {
    **dict.fromkeys(Effects._fields, 0.0),
    **dict.fromkeys((*TRUE, "fill_at_most", "vent_at_most"), 1.0),
    "release_time": math.inf,
}
"""Sensors that read true, valves that open and close as commanded, no leak, a controller that is heard."""
NO_VALUE = ""
ROWS = list(FAULT_KINDS.values())
NAMES = ["-".join(key) for key in FAULT_KINDS]
FAULTS = [
    ("speed-sensor", "lost", "36 km/h", {"speed_valid": 0.0, "speed_factor": 0.0, "speed_offset": 10.0}),
    ("speed-sensor", "lost", NO_VALUE, {"speed_valid": 0.0, "speed_factor": 0.0}),
    ("speed-sensor", "stuck", "36 km/h", {"speed_factor": 0.0, "speed_offset": 10.0}),
    ("speed-sensor", "stuck", NO_VALUE, {"speed_held": 1.0}),
    ("speed-sensor", "factor", "90 %", {"speed_factor": 0.9}),
    ("speed-sensor", "offset", "-36 km/h", {"speed_offset": -10.0}),
    ("speed-sensor", "jumps", "36 km/h", {"speed_jump": 10.0}),
    ("speed-sensor", "drop-out", "25 %", {"drop_out": 0.25}),
    ("speed-sensor", "missing-teeth", "3", {"lost_teeth": 3.0}),
    ("hold-magnet", "open-circuit", NO_VALUE, {"fill_at_least": 1.0}),
    ("hold-magnet", "shorted", NO_VALUE, {"fill_at_most": 0.0}),
    ("vent-magnet", "open-circuit", NO_VALUE, {"vent_at_most": 0.0}),
    ("vent-magnet", "shorted", NO_VALUE, {"vent_at_least": 1.0}),
    ("fill-valve", "stuck-open", NO_VALUE, {"fill_at_least": 1.0}),
    ("fill-valve", "stuck-closed", NO_VALUE, {"fill_at_most": 0.0}),
    ("fill-valve", "blocked", "25 %", {"fill_at_most": 0.75}),
    ("vent-valve", "stuck-open", NO_VALUE, {"vent_at_least": 1.0}),
    ("vent-valve", "stuck-closed", NO_VALUE, {"vent_at_most": 0.0}),
    ("vent-valve", "blocked", "25 %", {"vent_at_most": 0.75}),
    ("wsp-valve", "slow", "250 ms", {"travel_time": 0.25}),
    ("tank", "leak", "2e-9 m3/(s Pa)", {"tank_leak": 2e-9}),
    ("brake-line", "leak", "2e-9 m3/(s Pa)", {"line_leak": 2e-9}),
    ("pressure-sensor", "offset", "-0.5 bar", {"pressure_offset": -0.5e5}),
    ("pressure-sensor", "factor", "90 %", {"pressure_factor": 0.9}),
    ("pressure-sensor", "stuck", "1.5 bar", {"pressure_factor": 0.0, "pressure_offset": 1.5e5}),
    ("pressure-sensor", "stuck", NO_VALUE, {"pressure_held": 1.0}),
    ("brake", "cut-out", NO_VALUE, {"fill_at_most": 0.0, "vent_at_least": 1.0}),
    ("controller", "silent", "2 s", {"silent": 1.0, "release_time": 2.0}),
    ("controller", "silent", NO_VALUE, {"silent": 1.0}),
    ("dynamic-brake", "failed", NO_VALUE, {"dynamic_failed": 1.0}),
    ("track-brake", "failed", NO_VALUE, {"track_failed": 1.0}),
    ("sander", "blocked", NO_VALUE, {"sander_blocked": 1.0}),
    ("train-speed", "lost", NO_VALUE, {"train_speed_valid": 0.0, "train_speed_factor": 0.0}),
    ("train-speed", "stuck", "36 km/h", {"train_speed_factor": 0.0, "train_speed_offset": 10.0}),
    ("train-speed", "stuck", NO_VALUE, {"train_speed_held": 1.0}),
    ("train-speed", "offset", "-36 km/h", {"train_speed_offset": -10.0}),
]


def test_without_a_fault_nothing_is_changed():
    assert Effects()._asdict() == NOTHING


@pytest.mark.parametrize(("part", "name", "value", "changed"), FAULTS)
def test_a_fault_changes_what_its_description_says_and_nothing_else(part, name, value, changed):
    row = FAULT_KINDS[part, name]
    given = float(parse_quantity(value, row.value.kind)) if row.value and value else None
    assert row.effects(given)._asdict() == pytest.approx({**NOTHING, **changed})


def test_every_fault_is_held_to_its_description():
    """With a value where it takes one, and without where it can do without."""
    ways = {
        (*key, given)
        for key, row in FAULT_KINDS.items()
        for given in (True, False)
        if (row.value is not None if given else row.value is None or row.value.without)
    }
    assert {(part, name, value != NO_VALUE) for part, name, value, _ in FAULTS} == ways


@pytest.mark.parametrize("row", ROWS, ids=NAMES)
def test_no_value_in_range_is_beyond_what_equations_hold_for(row):
    """A way is open by 0 to 1, a share of readings is one, air leaks out and not in, time passes."""
    if row.value is None:
        return
    for text in (row.value.at_least, row.value.at_most):
        effects = row.effects(float(parse_quantity(text, row.value.kind)))
        assert 0.0 <= effects.fill_at_least <= effects.fill_at_most <= 1.0
        assert 0.0 <= effects.vent_at_least <= effects.vent_at_most <= 1.0
        assert 0.0 <= effects.drop_out <= 1.0
        not_negative = ("speed_factor", "speed_jump", "lost_teeth", "travel_time", "tank_leak", "line_leak")
        for name in (*not_negative, "pressure_factor", "release_time"):
            assert getattr(effects, name) >= 0.0


@pytest.mark.parametrize("row", ROWS, ids=NAMES)
def test_a_row_explains_its_value_has_a_range_of_its_kind_and_says_whose_it_is(row):
    assert row.description.endswith(".")
    assert ("`value`" in row.description) == (row.value is not None)
    if row.value is not None:
        assert row.value.kind in KINDS
        low, high = (parse_quantity(text, row.value.kind) for text in (row.value.at_least, row.value.at_most))
        assert low < high
    of_train = ("brake-line", "controller", "dynamic-brake", "track-brake", "train-speed")
    assert row.of_wheelset == (row.part not in of_train)


@pytest.mark.parametrize("row", ROWS, ids=NAMES)
def test_every_fault_changes_something_and_a_lost_sensor_alone_reports_itself(row):
    """With its largest value, and without one where it needs none."""
    values = [None] if row.value is None or row.value.without else []
    if row.value is not None:
        values += [float(parse_quantity(row.value.at_most, row.value.kind))]
    effects = [row.effects(value) for value in values]
    assert Effects() not in effects
    assert {each.speed_valid == 0.0 for each in effects} == {(row.part, row.name) == (SPEED_SENSOR, "lost")}
