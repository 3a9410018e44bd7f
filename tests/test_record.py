"""Records are declared once: the class that mypy reads and the layout that the rig steps are the same."""

from collections.abc import MutableSequence
from typing import Annotated

import numpy as np
import pytest

from uictest.core.record import Record, fields_of, from_scenario, layout_of, scenario_values


class Frame(Record):
    speed: float = from_scenario("initial_speed")  # m/s
    cycle: int


class Car(Frame):
    speeds: Annotated[MutableSequence[float], 3]


class Addition(Record):
    mode: int


def test_a_layout_has_the_fields_of_its_class_those_of_its_bases_first():
    layout = layout_of(Car)
    assert list(layout.names) == list(fields_of(Car)) == ["speed", "cycle", "speeds"]
    assert [layout[name].base for name in layout.names] == [np.float64, np.int64, np.float64]
    assert layout["speeds"].shape == (3,)


def test_fields_are_attributes():
    car = np.zeros(1, layout_of(Car))[0]
    car.speed = 3.0
    car.speeds[1] = 4.0
    assert (car["speed"], car["speeds"].tolist()) == (3.0, [0.0, 4.0, 0.0])


def test_additions_share_their_fields():
    class Another(Record):
        mode: int

    assert layout_of(Frame, Addition, Another).names == ("speed", "cycle", "mode")


def test_an_addition_shares_a_field_of_the_record_only_when_both_inherit_it():
    class Cousin(Frame):
        mode: int

    class Thief(Record):
        cycle: int

    assert layout_of(Car, Cousin).names == ("speed", "cycle", "speeds", "mode")
    with pytest.raises(TypeError, match="Thief: 'cycle' is a field of the rig or of another module already"):
        layout_of(Car, Thief)


def test_additions_that_disagree_are_rejected():
    class Other(Record):
        mode: float

    with pytest.raises(TypeError, match="Other: 'mode' is a field of the rig or of another module already"):
        layout_of(Car, Addition, Other)


@pytest.mark.parametrize("kind", [str, bool, list[float], Annotated[float, 3]])
def test_a_field_of_another_kind_is_rejected(kind):
    class Wrong(Record):
        field: kind

    with pytest.raises(TypeError, match="a field is a float, an int or a table"):
        layout_of(Wrong)


def test_the_keys_of_fields_are_those_declared():
    assert {name: value.key for name, value in scenario_values(Car).items()} == {"speed": "initial_speed"}


@pytest.mark.slow
def test_a_misspelt_field_is_an_error_of_the_type_checker(tmp_path):
    api = pytest.importorskip("mypy.api")
    snippet = tmp_path / "snippet.py"
    snippet.write_text(
        "from uictest.rig.model.state import Wheelset\n"
        "def clamp(wheelset: Wheelset) -> float:\n    return wheelset.clamping_forc\n"
    )
    found, _, status = api.run(["--strict", "--cache-dir", str(tmp_path), str(snippet)])
    assert status == 1
    assert '"Wheelset" has no attribute "clamping_forc"; maybe "clamping_force"?' in found
