"""What every row of the catalogue of faults promises."""

import pytest

from uictest.core.units import KINDS
from uictest.plans.faults import FAULT_KINDS, SPEED_SENSOR, Effects
from uictest.plans.scenario.yaml import parse_quantity

ROWS = list(FAULT_KINDS.values())
NAMES = ["-".join(key) for key in FAULT_KINDS]


@pytest.mark.parametrize("row", ROWS, ids=NAMES)
def test_every_value_has_a_range_of_its_kind(row):
    if row.value is not None:
        assert row.value.kind in KINDS
        low, high = (parse_quantity(text, row.value.kind) for text in (row.value.at_least, row.value.at_most))
        assert low < high


@pytest.mark.parametrize("row", ROWS, ids=NAMES)
def test_every_fault_changes_something_and_a_lost_sensor_alone_reports_itself(row):
    """With its largest value, and without one where it needs none."""
    values = [None] if row.value is None or row.value.without else []
    if row.value is not None:
        values += [float(parse_quantity(row.value.at_most, row.value.kind))]
    effects = [row.effects(value) for value in values]
    assert Effects() not in effects
    assert {each.speed_valid == 0.0 for each in effects} == {(row.part, row.name) == (SPEED_SENSOR, "lost")}


@pytest.mark.parametrize("row", ROWS, ids=NAMES)
def test_only_what_the_train_has_once_belongs_to_no_wheelset(row):
    of_train = ("brake-line", "controller", "dynamic-brake", "track-brake", "train-speed")
    assert row.of_wheelset == (row.part not in of_train)


@pytest.mark.parametrize("row", ROWS, ids=NAMES)
def test_descriptions_are_sentences_that_explain_the_value(row):
    assert row.description.endswith(".")
    assert ("`value`" in row.description) == (row.value is not None)
