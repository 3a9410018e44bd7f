"""The series of examples/wsp: four ways to protect a train, in the order that docs/series.md states."""

import os
import shutil
from dataclasses import replace
from pathlib import Path

import pytest
import yaml

from uictest.controllers import CONTROLLERS, DEFAULT
from uictest.judging import series
from uictest.plans import scenario, series as series_plans
from uictest.running import campaign

ROOT = Path(__file__).parents[2]
WSPS = ("controller=threshold", "controller=threshold-c", "controller=slip-band", "wsp=bypassed")


@pytest.fixture
def load(threshold_library, tmp_path, monkeypatch):
    """The four series of a file in examples/wsp, by what protects the train."""
    shutil.copytree(ROOT / "examples/wsp", tmp_path / "wsp")
    shutil.copytree(threshold_library.parent, tmp_path / "threshold-c")
    monkeypatch.chdir(tmp_path)

    def read(name):
        return dict(zip(WSPS, series_plans.load_series(Path("wsp", name)), strict=True))

    return read


def judged(planned):
    done = campaign.run_cases(planned.cases, campaign.RunSettings(len(os.sched_getaffinity(0))))
    cases = [
        series.SeriesCase(stop.role, round(stop.speed * 3.6, 6), result)
        for stop, result in zip(planned.stops, done.results, strict=True)
    ]
    return series.judge_series(planned, cases)


def missed(result):
    return {each.verdict.id for each in result.criteria if each.verdict.status == "fail"}


def values(results, measure):
    estimates = [result.measures[measure].estimate for result in results]
    return [(each.value, each.low, each.high) for each in estimates if each is not None]


def test_each_series_has_five_frictions_two_speeds_and_ten_seeds(load):
    for name in ("four-wsps.series.yaml", "four-wsps-uncleaned.series.yaml"):
        for what, planned in load(name).items():
            assert planned.id.endswith(f"[{what}]")
            wet = [stop.case.scenario for stop in planned.stops if stop.role == "wet"]
            assert len({(each.initial_speed, each.rail.friction) for each in wet}) == len(wet) == 10
            assert {(each.repeat, each.seed) for each in wet} == {(10, 1701)}


def test_no_friction_and_no_seed_was_used_to_calibrate_or_to_judge_the_compensation(load):
    used = [
        yaml.safe_load((ROOT / name).read_text())
        for name in ("calibration/conditions.yaml", "studies/conditions/judgement.yaml")
    ]
    frictions = {friction for each in used for friction in each["frictions"]}
    seeds = {seed for each in used for seed in each.get("seeds", ())}
    planned = load("four-wsps.series.yaml")["controller=threshold"]
    wet = [stop.case.scenario for stop in planned.stops if stop.role == "wet"]
    assert not frictions & {float(each.rail.friction or 0.0) for each in wet}
    assert not seeds & set(range(1701, 1711))


def test_the_twin_states_the_parameters_of_the_controller_that_it_is_a_twin_of():
    own = yaml.safe_load((ROOT / "examples/wsp/threshold-c.yaml").read_text())["declared_parameters"]
    built_in = scenario.load_part("controllers/threshold")
    declared = set(CONTROLLERS[DEFAULT].declared_parameters()) - {"cycle_time"}
    stated = {name: each["default"] for name, each in own.items()}
    assert stated == {name: float(getattr(built_in, name)) for name in declared}


def test_the_order_on_a_few_stops(load):
    """80 km/h on friction 0.084 that nothing cleans, six seeds."""
    series_of = load("four-wsps-uncleaned.series.yaml")
    results = [judged(_small(series_of[what])) for what in WSPS]
    threshold, twin, slip_band, bypassed = results
    assert values([threshold], "k_wet") == values([twin], "k_wet")
    k_wet = values([threshold, slip_band, bypassed], "k_wet")
    assert k_wet == sorted(k_wet, reverse=True)
    energy = values([threshold, slip_band, bypassed], "worst_contact_energy")
    assert [value for value, _, _ in energy] == sorted(value for value, _, _ in energy)
    assert "locked-time" not in missed(threshold)
    assert {"locked-time", "contact-energy", "passing-stops"} <= missed(bypassed)
    assert "adhesion-utilisation" not in missed(bypassed)  # judged on a rail that sliding cleans


def _small(planned):
    stops = [
        stop
        for stop in planned.stops
        if round(stop.speed * 3.6) == 80 and stop.case.scenario.rail.friction in (None, 0.084)
    ]
    fewer = {"dry": {"repeat": 1}, "wet": {"repeat": 6}}
    scenarios = [stop.case.scenario.model_copy(update=fewer[stop.role]) for stop in stops]
    cases = [replace(stop.case, scenario=each) for stop, each in zip(stops, scenarios, strict=True)]
    return replace(planned, stops=tuple(map(lambda stop, case: replace(stop, case=case), stops, cases)))


@pytest.mark.slow
def test_the_order_on_a_rail_that_sliding_cleans(load):
    results = [judged(planned) for planned in load("four-wsps.series.yaml").values()]
    threshold, twin, slip_band, bypassed = map(missed, results)
    assert threshold == twin == set()
    assert slip_band == {"contact-energy", "adhesion-utilisation", "passing-stops"}
    assert bypassed == {"contact-energy", "adhesion-utilisation", "locked-time", "passing-stops"}


@pytest.mark.slow
def test_the_order_on_a_rail_that_stays_slippery(load):
    results = [judged(planned) for planned in load("four-wsps-uncleaned.series.yaml").values()]
    threshold, _, slip_band, bypassed = results
    for measure in ("median_adhesion_utilisation", "k_wet"):
        best, middle, worst = values([threshold, slip_band, bypassed], measure)
        assert best[1] > middle[2]  # the intervals lie apart
        assert middle[0] > worst[0]
    middle, worst = values([slip_band, bypassed], "median_adhesion_utilisation")
    assert middle[1] > worst[2]
