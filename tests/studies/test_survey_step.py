"""The table of what the survey step does, and the script that makes it."""

import csv
import runpy
from pathlib import Path

import pytest

from uictest.plans import library
from uictest.running.chunked import SURVEY_TABLE

SCRIPT = Path(__file__).parents[2] / "studies" / "survey_step.py"
FEW = 8


@pytest.fixture(scope="module")
def study():
    return runpy.run_path(str(SCRIPT))


def shipped():
    return list(csv.DictReader(library.table(SURVEY_TABLE).splitlines()))


def test_a_dry_stop_comes_out_as_the_table_says(study):
    [dry] = [each for each in study["variants"]() if each.path.stem == "dry-120"]
    found = {row["measure"]: row for row in csv.DictReader(study["table"]([dry], FEW).splitlines())}
    expected = {row["measure"]: row for row in shipped() if row["case"] == "dry-120"}
    assert found.keys() == expected.keys()
    for name in ("braking_distance", "braking_time", "mean_deceleration"):
        mean, low, high = (float(expected[name][key]) for key in ("mean", "low", "high"))
        assert float(found[name]["mean"]) == pytest.approx(mean, rel=0.1)
        assert low < mean < high
    assert float(found["braking_distance"]["mean"]) == pytest.approx(-0.0133, abs=0.001)  # m


def test_every_case_that_is_run_stands_in_the_table_and_no_other(study):
    cases = [
        f"{case.id}{variant.name}"
        for variant in study["variants"]()
        for case in study["cases_of"](variant, "1 ms")
    ]
    assert list(dict.fromkeys(row["case"] for row in shipped())) == cases


def test_a_bias_is_the_farther_end_of_the_interval_over_the_mean_size(study):
    import numpy as np

    regular, survey = np.array([10.0, 10.0, 10.0, np.nan]), np.array([10.1, 9.9, 10.3, 1.0])
    count, size, mean, low, high, single = study["_compared"](regular, survey)
    assert (count, size, mean) == (3, pytest.approx(10.05), pytest.approx(0.1))
    assert low < 0.0 < 0.1 < high
    assert single == pytest.approx(0.28)
    assert study["_bias"]((count, size, mean, low, high, single)) == high / size


@pytest.mark.slow
def test_the_table_is_the_one_that_the_study_makes(study):
    assert study["table"](study["variants"](), study["STOPS"]) == library.table(SURVEY_TABLE)
