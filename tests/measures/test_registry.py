"""Every measure: found in the catalogue, read from the records of a stop, reported in its column."""

import importlib
import subprocess
import sys
from pathlib import Path

import numpy as np
import pytest
import yaml

import uictest
from uictest.core.measures import (
    MEASURES,
    STOP_COLUMNS,
    WHEELSET_COLUMNS,
    MeasureDefinition,
    WheelsetColumn,
    column_unit,
    stop_column_values,
    wheelset_column_values,
    without_wheelset,
)
from uictest.core.measures.catalogue import measures_in
from uictest.core.record import fields_of
from uictest.core.units import KINDS

from .catalogue.conftest import sliding_stop, stop, wheelsets

DEFINED = {
    "first_phase_duration": 3.0,
    "low_speed_cutoff": 30 / 3.6,
    "sliding_below": 0.9,
    "end_speed": 60.0 / 3.6,
    "nominal_speed": 120.0 / 3.6,
    "gradient": 0.0,
}
NEW = """
from uictest.core.measures import Measure, MeasureValue, StopColumn

MEASURES = (
    Measure(
        name={name!r},
        kind="speed",
        unit="km/h",
        course="grows",
        meaning="train speed at the brake command",
        read=lambda stop, wheelsets, definition: MeasureValue((stop.initial_speed,)),
        column=StopColumn({column!r}, "km/h", read=lambda stop, definition: stop.initial_speed),
    ),
)
"""


@pytest.fixture
def package(tmp_path, monkeypatch):
    """An empty package of measures."""
    (tmp_path / "more_measures").mkdir()
    (tmp_path / "more_measures" / "__init__.py").touch()
    monkeypatch.syspath_prepend(tmp_path)
    yield importlib.import_module("more_measures")
    for name in [name for name in sys.modules if name.partition(".")[0] == "more_measures"]:
        del sys.modules[name]


def add(package, module, name, column):
    Path(package.__path__[0], f"{module}.py").write_text(NEW.format(name=name, column=column))


def test_a_new_module_is_found_without_a_further_edit(package):
    add(package, "speeds", "speed_at_command", "speed_at_command_kmh")
    (measure,) = measures_in(package).values()
    assert measure.name == "speed_at_command"
    assert measure.read(stop(), (), {}).values == (120 / 3.6,)


@pytest.mark.parametrize(
    ("name", "column", "message"),
    [
        ("speed", "other_kmh", "two measures are called 'speed'"),
        ("other", "speed_kmh", "two columns are called 'speed_kmh'"),
    ],
)
def test_two_measures_of_one_name_or_column_are_rejected(package, name, column, message):
    add(package, "speeds", "speed", "speed_kmh")
    add(package, "more_speeds", name, column)
    with pytest.raises(ValueError, match=message):
        measures_in(package)


@pytest.mark.parametrize("name", MEASURES)
def test_each_measure_fits_its_declaration_and_gives_one_value_or_one_per_wheelset(name):
    measure = MEASURES[name]
    assert measure.name == name
    assert measure.kind in KINDS
    assert (measure.recorded is None) == measure.of_simulation
    if measure.column is not None:
        assert isinstance(measure.column, WheelsetColumn) == measure.of_wheelsets
    if measure.finite_field:
        assert hasattr(wheelsets(0.1)[0] if measure.of_wheelsets else stop(), measure.finite_field)
    value = MEASURES[name].read(sliding_stop(), wheelsets(0.1, 0.2, 0.3, 0.4), DEFINED)
    assert not value.unavailable_reason
    assert len(value.values) == (4 if MEASURES[name].of_wheelsets else 1)


def test_what_decides_an_observation_is_a_definition_of_the_measures():
    deciding = {name for measure in MEASURES.values() for name in measure.observed_by}
    assert deciding == fields_of(MeasureDefinition).keys()


def test_residuals_count_by_magnitude_air_as_normal_volume_and_actuations_in_whole_numbers():
    residual = MEASURES["energy_residual"].read(stop(energy_residual=-0.5), wheelsets(0.1), {})
    assert residual.values == (0.5,)
    assert stop_column_values(stop(energy_residual=-0.5), DEFINED)["energy_residual"] == -0.5
    (volume,) = MEASURES["air_consumed"].read(stop(air_consumed=0.1185), wheelsets(0.1), {}).values
    assert volume == pytest.approx(0.1)
    counted, unknown = wheelsets(0.1, 0.1, valve_actuations=[11.0, np.nan])
    assert type(wheelset_column_values(counted)["valve_actuations"]) is int
    assert np.isnan(wheelset_column_values(unknown)["valve_actuations"])


def test_what_did_not_come_about_has_no_value():
    value = MEASURES["minimum_deceleration"].read(stop(minimum_deceleration=np.nan), wheelsets(0.1), {})
    assert value.unavailable_reason == "the brake was never fully developed while the train ran"
    running = stop(stopped=0.0, braking_distance=np.nan, braking_time=np.nan, end_distance=2500.0)
    columns = stop_column_values(running, DEFINED)
    final = ("braking_distance_m", "braking_time_s", "mean_deceleration_mps2", "developed_deceleration_mps2")
    assert all(np.isnan(columns[name]) for name in final)


@pytest.mark.parametrize(
    ("column", "unit"),
    [
        ("braking_distance_m", "m"),
        ("mean_deceleration_mps2", "m/s2"),
        ("reservoir_minimum_bar", "bar"),
        ("energy_residual", "1"),
        ("maximum_slide_4", "1"),
        ("locked_time_s_2", "s"),
        ("maximum_clamping_force_n_1", "N"),
        ("met", "1"),
    ],
)
def test_a_column_has_the_unit_it_is_reported_in(column, unit):
    assert column_unit(column) == unit


def test_the_number_of_a_wheelset_stands_behind_columns_of_wheelsets_only():
    assert without_wheelset("locked_time_s_2") == ("locked_time_s", "2")
    for name in ("locked_time_s", "braking_distance_m_2", "speed_2", "outcome", ""):
        assert without_wheelset(name) == (name, "")


def test_the_name_of_a_column_ends_with_its_unit_unless_it_is_a_pure_number():
    endings = {"m/s2": "mps2"}
    columns = [*STOP_COLUMNS.values(), *WHEELSET_COLUMNS.values()]
    for column in columns:
        assert column.unit == "1" or column.name.endswith(f"_{endings.get(column.unit, column.unit.lower())}")
    pure = {column.name for column in columns if column.unit == "1"}
    balances = {"energy_residual", "air_residual", "air_energy_residual"}
    shares = {"adhesion_utilisation", "distance_over_reference", "maximum_slide", "sliding_share"}
    assert pure == {*balances, *shares, "valve_actuations"}


def test_importing_the_catalogue_imports_no_numpy():
    code = "import sys; from uictest.core.measures import MEASURES; print('numpy' in sys.modules)"
    done = subprocess.run([sys.executable, "-c", code], check=True, capture_output=True, text=True)
    assert done.stdout.strip() == "False"


def test_the_better_values_of_a_measure_lie_where_the_requirements_that_ship_want_them():
    """A requirement with an upper bound alone wants small values, one with a lower bound alone large ones."""
    folder = Path(uictest.__file__).parent / "plans/library/criteria"
    criteria = [
        each for path in folder.glob("*.yaml") for each in yaml.safe_load(path.read_text())["criteria"]
    ]
    wanted = {
        each["measure"]: "smaller" if "upper" in each else "larger"
        for each in criteria
        if each.get("layer") == "requirement" and ("upper" in each) != ("lower" in each)
    }
    assert len(wanted) > 5
    shipped = {name: MEASURES[name].better for name in wanted if name in MEASURES}
    assert shipped == {name: better for name, better in wanted.items() if name in MEASURES}
