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


def test_a_layout_has_the_fields_of_its_class_as_attributes_those_of_its_bases_first():
    layout = layout_of(Car)
    assert list(layout.names) == list(fields_of(Car)) == ["speed", "cycle", "speeds"]
    assert [layout[name].base for name in layout.names] == [np.float64, np.int64, np.float64]
    assert layout["speeds"].shape == (3,)
    car = np.zeros(1, layout_of(Car))[0]
    car.speed = 3.0
    car.speeds[1] = 4.0
    assert (car["speed"], car["speeds"].tolist()) == (3.0, [0.0, 4.0, 0.0])
    assert {name: value.key for name, value in scenario_values(Car).items()} == {"speed": "initial_speed"}


class Another(Record):
    mode: int


class Cousin(Frame):
    mode: int


class Thief(Record):
    cycle: int


class Other(Record):
    mode: float


def test_additions_share_their_fields_and_one_of_the_record_only_when_both_inherit_it():
    assert layout_of(Frame, Addition, Another).names == ("speed", "cycle", "mode")
    assert layout_of(Car, Cousin).names == ("speed", "cycle", "speeds", "mode")


@pytest.mark.parametrize(
    ("additions", "named"), [([Thief], "Thief: 'cycle'"), ([Addition, Other], "Other: 'mode'")]
)
def test_additions_that_take_a_field_or_disagree_are_rejected(additions, named):
    with pytest.raises(TypeError, match=f"{named} is a field of the rig or of another module already"):
        layout_of(Car, *additions)


@pytest.mark.parametrize("kind", [str, bool, list[float], Annotated[float, 3]])
def test_a_field_of_another_kind_is_rejected(kind):
    class Wrong(Record):
        field: kind

    with pytest.raises(TypeError, match="a field is a float, an int or a table"):
        layout_of(Wrong)


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
