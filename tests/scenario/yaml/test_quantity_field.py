"""Fields that are quantities."""

from typing import Annotated

import pytest
from pydantic import BaseModel, ValidationError

from uictest.plans.scenario.yaml.quantities import Quantity
from uictest.plans.scenario.yaml.quantity_field import of_kind


class Sample(BaseModel):
    pressure: Annotated[Quantity, of_kind("pressure", above="0 bar", at_most="8 bar")]


def message(value):
    with pytest.raises(ValidationError) as caught:
        Sample.model_validate({"pressure": value})
    return caught.value.errors()[0]["msg"]


def test_bounds_are_told_as_written():
    assert message("0 bar") == "0 bar is out of range: it must be above 0 bar"
    assert message("900 kPa") == "900 kPa is out of range: it must be at most 8 bar"
    assert Sample.model_validate({"pressure": "800 kPa"}).pressure == 8e5


def test_a_value_with_its_source_keeps_it():
    sample = Sample.model_validate({"pressure": {"value": "3 bar", "source": "maker"}})
    assert (sample.pressure, sample.pressure.source) == (3e5, "maker")


@pytest.mark.parametrize(
    "value", [{"value": "3 bar"}, {"value": "3 bar", "source": 1}, {"x": 1}, True, None, ()]
)
def test_anything_else_is_refused(value):
    assert message(value).startswith("expected a pressure")


def test_a_quantity_of_another_kind_is_refused():
    assert message(Quantity(3.0, "3 m", "m")) == "'3 m' is not a pressure"


def test_a_model_written_out_reads_back():
    sample = Sample.model_validate({"pressure": {"value": "3 bar", "source": "maker"}})
    again = Sample.model_validate(sample.model_dump())
    assert (again.pressure, again.pressure.text, again.pressure.source) == (3e5, "3 bar", "maker")
