"""Quantiles and K_dry of sweeps whose decelerations are a formula: 9.81 m/s2 times the friction."""

import csv
import json
from pathlib import Path

import numpy as np
import pandas as pd
import pytest
import yaml

from uictest import rig
from uictest.plans.sweeps.nominal import drawn_ranges, nominal_plan
from uictest.report import titled_lines, write_sweep_result
from uictest.report.sweep.result import read_sweep_document
from uictest.report.sweep.tail_tables import tail_tables
from uictest.running.chunked import BlockRunner, CaseSelection, select_cases
from uictest.running.chunked.case_blocks import BlockAssembler

from ..conftest import formula, result_of, stored

DRY = (
    "schema: uictest/scenario/1\nname: stop\ninitial_speed: 30 km/h\nrail: {condition: dry, friction: 0.12}\n"
)
SAMPLE = "sample: {size: %d, seed: 3, parameters: {rail.friction: {uniform: [0.10, 0.20]}}}\n"
K_DRY = "k_dry: {nominal: 1.4715 m/s2}\n"
FINENESS = 1e-12


@pytest.fixture
def load_dry(load):
    """The plan of a sweep on dry rail whose file says the given text under `vary`."""
    return lambda text: load(text, stop=DRY)


def slippery_stops_unfinished(parameters, own, rail):
    """Stops of the formula, of which those below a friction of 0.103 do not end."""
    measures, wheelsets = formula(parameters, own, rail)
    running = rail[:, 1, 0] < 0.103
    measures["stopped"] = np.where(running, 0.0, 1.0)
    measures["braking_distance"] = np.where(running, np.nan, measures["braking_distance"])
    return measures, wheelsets


def finish(plan, simulate=formula, only=None):
    selection = select_cases(plan, only) if only else CaseSelection(plan)
    runner = BlockRunner(BlockAssembler(plan), simulate, plan, rig.run_block)
    store = stored(selection, runner, Path("out"))
    result = result_of(selection, store)
    write_sweep_result(store.folder, result, plan.file)
    return result, store.folder


def tail_lines(result):
    return list(titled_lines(tail_tables(result), None))


def draws_of(folder, column):
    return sorted(pd.read_parquet(folder / "summary.parquet")[column].tolist())


def test_bounds_are_draws_of_the_summary(load_dry):
    text = "quantiles: {measure: mean_deceleration, levels: [10 %, 50 %, 90 %]}\n"
    result, folder = finish(load_dry(SAMPLE % 100 + text))
    values = draws_of(folder, "mean_deceleration_mps2")
    (table,) = result.quantiles
    assert (table.measure, table.unit, table.sample.draws) == ("mean_deceleration_mps2", "m/s2", 100)
    low, median, high = table.quantiles
    # Ranks of 100 draws, from tables of the binomial distribution: 5 or fewer of 100 at 10 % have 5.8 %, 4 or
    # fewer 2.4 %; at 50 % the 40th and the 61st hold 95 %.
    assert (low.lower, low.upper) == (values[5 - 1], None)
    assert (median.lower, median.upper) == (values[40 - 1], values[61 - 1])
    assert (high.lower, high.upper) == (None, values[-5])
    assert [each.estimate for each in table.quantiles] == [values[9], values[49], values[89]]
    assert all(each.is_supported for each in table.quantiles)


def test_a_side_may_be_stated(load_dry):
    text = "quantiles: [{measure: braking_distance_m, levels: [50 %], side: upper, confidence: 99 %}]\n"
    result, folder = finish(load_dry(SAMPLE % 100 + text))
    ((quantile,),) = (table.quantiles for table in result.quantiles)
    # 62 or more of 100 tosses are heads with 1.05 %, 63 or more with 0.6 %.
    assert (quantile.lower, quantile.upper) == (None, draws_of(folder, "braking_distance_m")[63 - 1])


def test_what_the_sample_does_not_support_is_refused(load_dry):
    text = "quantiles: {measure: mean_deceleration, levels: [1 %, 5 %]}\n"
    result, folder = finish(load_dry(SAMPLE % 298 + text))
    first, second = result.quantiles[0].quantiles
    assert (first.lower, first.estimate, first.draws_needed) == (None, None, 299)
    assert second.is_supported
    assert "needs 299 draws, has 298" in "\n".join(tail_lines(result))
    with (folder / "quantiles.csv").open(newline="") as file:
        rows = list(csv.DictReader(file))
    assert (rows[0]["lower"], rows[0]["note"]) == ("", "needs 299 draws, has 298")


def test_k_dry_is_the_bound_over_the_nominal_in_a_file_of_its_own(load_dry):
    result, folder = finish(load_dry(SAMPLE % 300 + K_DRY))
    values = draws_of(folder, "developed_deceleration_mps2")
    (table,) = result.k_dry
    supported = [level for level in table.levels if level.deceleration is not None]
    assert [level.ebcl for level in supported] == [0, 1, 2]
    # Of 300 draws the smallest bounds 1 %, the 22nd 10 % and the 136th 50 %, with 95 % confidence.
    assert [level.deceleration for level in supported] == [values[135], values[21], values[0]]
    for level in supported:
        assert level.k_dry == pytest.approx(level.deceleration / 1.4715, rel=FINENESS)
    assert [level.draws_needed for level in table.levels[:5]] == [5, 29, 299, 2_995, 29_956]
    assert [round(1.0 - level.shortfall, 9) for level in table.levels[:4]] == [0.5, 0.9, 0.99, 0.999]
    assert len(table.levels) == 10
    content = yaml.safe_load((folder / "k_dry.yaml").read_text())
    assert (content["schema"], content["kind"]) == ("uictest/result/2", "k-dry")
    (table,) = content["tables"]
    assert (table["nominal_mps2"], table["draws"], table["confidence"]) == (1.4715, 300, "95 %")
    assert table["levels"][2]["k_dry"] == result.k_dry[0].levels[2].k_dry
    last = table["levels"][9]
    assert (last["probability"], last["k_dry"]) == ("99.9999999 %", None)
    assert last["note"] == "needs 2995732273 draws, has 300"


def test_draws_in_which_a_wheelset_slides_are_counted(load_dry):
    """Whatever makes the rail slippery: here its friction, under the name of dry rail."""

    def sliding_below(parameters, own, rail):
        measures, wheelsets = formula(parameters, own, rail)
        wheelsets["sliding_duration"][:, 2] = np.where(rail[:, 1, 0] < 0.12, 1.5, 0.5)
        return measures, wheelsets

    result, folder = finish(load_dry(SAMPLE % 300 + K_DRY), sliding_below)
    below = sum(each < 0.12 * 9.81 for each in draws_of(folder, "mean_deceleration_mps2"))
    assert 0 < below < 300
    (table,) = result.k_dry
    assert table.sliding == below
    assert f"a wheelset slides in {below} of 300 draws, so that this is no K_dry" in "\n".join(
        tail_lines(result)
    )
    (clean,) = finish(load_dry(SAMPLE % 300 + K_DRY))[0].k_dry
    assert clean.sliding == 0


def test_the_result_can_be_read_back(load_dry):
    text = "quantiles: {measure: mean_deceleration, levels: [10 %]}\n"
    result, folder = finish(load_dry(SAMPLE % 300 + K_DRY + text))
    read_back = read_sweep_document(json.loads((folder / "sweep.json").read_text()))
    assert (read_back.quantiles, read_back.k_dry) == (result.quantiles, result.k_dry)


def test_draws_without_a_value_count_as_the_worst(load_dry):
    text = "quantiles: {measure: mean_deceleration, levels: [1 %, 10 %, 50 %, 90 %]}\n"
    result, folder = finish(load_dry(SAMPLE % 400 + K_DRY + text), slippery_stops_unfinished)
    table = result.quantiles[0]
    values = draws_of(folder, "mean_deceleration_mps2")
    known = sorted(value for value in values if np.isfinite(value))
    missing = 400 - len(known)
    assert (table.sample.draws, table.sample.without_value) == (400, missing)
    assert 5 < missing < 30
    below = [-np.inf] * missing + known
    above = known + [np.inf] * missing
    lowest, low, median, high = table.quantiles
    assert not lowest.is_supported
    # Of 400 draws the 30th bounds 10 %, the 180th and the 221st hold 50 %, with 95 % confidence.
    assert low.lower == below[30 - 1]
    assert (median.lower, median.upper) == (below[180 - 1], above[221 - 1])
    # The bound of 90 % is the 30th largest: with those missing above, one that the rest does not reach.
    assert high.upper == above[-30]
    assert table.quantiles[1].estimate is None
    text = "\n".join(tail_lines(result))
    assert f"400 draws; {missing} without a value count as the worst" in text
    assert f"may lie among the {missing} draws without a value" in text
    assert result.k_dry[0].levels[2].k_dry is None


def test_a_stop_that_does_not_end_has_no_value_of_any_measure(load_dry):
    text = "quantiles: {measure: air_consumed, levels: [50 %]}\n"
    result, folder = finish(load_dry(SAMPLE % 400 + text), slippery_stops_unfinished)
    rows = pd.read_parquet(folder / "summary.parquet")
    assert rows["air_consumed_nl"].notna().all()
    assert result.quantiles[0].sample.without_value == rows["braking_distance_m"].isna().sum() > 0


def test_each_combination_of_listed_values_has_its_own(load_dry):
    grid = "matrix: {initial_speed: [20 km/h, 30 km/h]}\n"
    text = "quantiles: {measure: braking_distance, levels: [50 %]}\n"
    result, folder = finish(load_dry(SAMPLE % 100 + grid + K_DRY + text))
    rows = pd.read_parquet(folder / "summary.parquet")
    for table, speed in zip(result.quantiles, ("20 km/h", "30 km/h"), strict=True):
        assert {key: value.text for key, value in table.circumstances.items()} == {"initial_speed": speed}
        own = sorted(rows[rows["parameters.initial_speed"] == speed]["braking_distance_m"])
        assert (table.quantiles[0].lower, table.quantiles[0].upper) == (own[39], own[60])
    # In the formula the deceleration does not depend on the speed.
    assert result.k_dry[0].levels == result.k_dry[1].levels


def test_neither_a_selection_of_draws_is_a_sample_nor_a_shared_value_a_circumstance(load_dry):
    result, _ = finish(load_dry(SAMPLE % 100 + "matrix: {criteria: [uictest-stop]}\n" + K_DRY))
    assert [dict(table.circumstances) for table in result.k_dry] == [{}]
    eleven = " or ".join(f"sample={number}" for number in (1, *range(10, 20)))
    result, _ = finish(load_dry(SAMPLE % 100 + K_DRY), only=eleven)
    assert (result.quantiles, result.k_dry) == ((), ())
    assert "no quantiles and no K_dry: only 11 of 100 cases selected" in result.notes


def test_the_nominal_case_has_the_values_of_the_scenario(load_dry):
    text = SAMPLE % 100 + "matrix: {initial_speed: [20 km/h, 30 km/h]}\nk_dry: {}\n"
    plan = load_dry(text.replace("}}}", "}, vehicle.wheelsets.2.brake_force: {uniform: [90 %, 95 %]}}}"))
    nominal = nominal_plan(plan)
    assert nominal.size == 2
    settings = nominal.settings(np.arange(2))
    assert [value.content for value in settings["rail.friction"]] == [0.12, 0.12]
    assert [value.text for value in settings["initial_speed"]] == ["20 km/h", "30 km/h"]
    assert nominal.ids(np.array([0]))[0].startswith("study[initial_speed=20kmh,friction=nominal")
    inside = {each.key: each.contains_nominal for each in drawn_ranges(plan)}
    # A wheelset without a brake force of its own has the regular one.
    assert inside == {"rail.friction": True, "vehicle.wheelsets.2.brake_force": False}
