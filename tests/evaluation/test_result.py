from __future__ import annotations

import dataclasses

import pytest

from uictest.evaluation import CaseMeasures, CaseWheelsetMeasures
from uictest.evaluation.result import unit_of


@pytest.mark.parametrize(
    ("figure", "unit"),
    [
        ("braking_distance_m", "m"),
        ("mean_deceleration_mps2", "m/s2"),
        ("reservoir_minimum_bar", "bar"),
        ("energy_residual", "1"),
        ("maximum_slide_4", "1"),
        ("locked_time_s_2", "s"),
        ("maximum_clamping_force_n_1", "N"),
    ],
)
def test_the_name_of_a_figure_says_its_unit(figure: str, unit: str) -> None:
    assert unit_of(figure) == unit


def test_only_pure_numbers_have_no_unit() -> None:
    names = [
        field.name
        for figures in (CaseMeasures, CaseWheelsetMeasures)
        for field in dataclasses.fields(figures)
    ]
    pure = {name for name in names if unit_of(name) == "1"}
    assert pure == {"energy_residual", "air_residual", "maximum_slide", "valve_actuations"}
