"""A train with other values of its numbers: the bits of a scenario that states them, one run for all cars."""

import shutil
from pathlib import Path

import numpy as np
import pytest

from uictest import rig
from uictest.analysis.firmness import Effort
from uictest.plans import sweeps
from uictest.plans.scenario import load
from uictest.plans.sweeps import ParameterValue, listed_column, ranged_numbers
from uictest.running.campaign import RecordingRequest, RunSettings, run_cases
from uictest.running.chunked import VariedTrain
from uictest.runs.firmness import FirmnessRun

SLIP_BAND = Path(__file__).parents[1] / "sweeps" / "controllers" / "slip_band.py"
VENT = "brake.system.wsp_valve.vent_conductance"
RADIUS = "vehicle.wheelset.radius"
SMALL = Effort(blocks=2, block=4, seeds=2, seeds_at_ends=1)
TRAIN = """
schema: uictest/scenario/1
name: pair
initial_speed: 15 km/h
rail: {condition: wet, friction: 0.06}
rig: {topology: four-caliper}
criteria: uictest-stop
train: [{vehicle: intercity-180}, {vehicle: intercity-180, brake: {command: 90 %}}]
"""


@pytest.fixture
def train(tmp_path):
    path = tmp_path / "pair.yaml"
    path.write_text(TRAIN)
    return lambda *changes: load([path], changes)


def settings(cars, count, places):
    """The numbers of each car in some stops: nominal, but for those at a place of their range."""
    seeds = listed_column([ParameterValue(str(k), k) for k in range(count)])
    return [
        {
            each.key: each.at(np.full(count, places.get((number, each.key), np.nan)))
            for each in ranged_numbers(car.scenario)
        }
        | {"seed": seeds}
        for number, car in enumerate(cars)
    ]


def figures(results):
    return [f"{each.outcome} {each.measures} {each.wheelsets}" for each in results]


def run(cases):
    return run_cases(cases, RunSettings(recording=RecordingRequest("none"))).whole()


def test_nominal_values_give_the_train_itself_under_each_seed(train):
    varied = VariedTrain(train()[0]).results(settings(train(), 2, {}))
    assert [figures(each) for each in varied] == [figures(run(train(f"seed={seed}"))) for seed in range(2)]


def test_drawn_numbers_are_those_of_a_train_that_states_them(train):
    chosen = settings(train(), 1, {(0, VENT): 0.3, (1, VENT): 0.3})
    [text] = chosen[1][VENT].texts
    varied = VariedTrain(train()[0])
    [both], [one] = varied.results(chosen), varied.results(settings(train(), 1, {(1, VENT): 0.3}))
    assert figures(both) == figures(run(train(f"{VENT}={text}")))
    assert figures(one)[1] != figures(both)[1]


def test_a_controller_from_outside_meets_the_same_values(train, tmp_path, monkeypatch):
    """In child processes or here; where it fails, in the stops in which it does."""
    monkeypatch.chdir(tmp_path)
    shutil.copy(SLIP_BAND, tmp_path)
    outside = "train.1.controller={python: slip_band.py, class: SlipBand, parameters: {fails_at: %d}}"
    chosen = settings(train(), 2, {(1, VENT): 0.3})
    built_in = VariedTrain(train("train.1.controller=slip-band")[0]).results(chosen)
    with rig.Workers() as workers:
        isolated = VariedTrain(train(outside % -1)[0], 1, workers.run_train).results(chosen)
        failed = VariedTrain(train(outside % 7)[0], 1, workers.run_train).results(chosen)
    here = VariedTrain(train(outside % -1)[0], 2, rig.run_train_in_process).results(chosen)
    assert [figures(each) for each in here] == [figures(each) for each in isolated]
    distances = [[each.measures["braking_distance_m"] for each in cars] for cars in built_in]
    assert [[each.measures["braking_distance_m"] for each in cars] for cars in here] == distances
    why = "step failed: ValueError: told to (slip_band.py, line 20) (cycle 7)"
    assert [each.reason for cars in failed for each in cars] == [
        f"controller: car 2 (slip_band.py): {why}"
    ] * 4


def test_a_number_that_would_change_the_noise_meets_that_of_the_train(train):
    chosen = settings(train(), 1, {(1, RADIUS): 0.3})
    cars = train(f"train.1.{RADIUS}={chosen[1][RADIUS].texts[0]}")
    [varied] = VariedTrain(train()[0]).results(chosen)
    [own], [of_nominal] = rig.simulate_trains([cars]), rig.simulate_trains([cars], train()[1])
    residuals = [each.measures["energy_residual"] for each in varied]
    assert residuals == [float(each.measures["energy_residual"]) for each in of_nominal]
    assert residuals != [float(each.measures["energy_residual"]) for each in own]


def test_the_cars_of_a_train_share_their_stops(train, monkeypatch):
    ran = []
    simulate = rig.simulate_trains

    def noted(trains, noise_of=None, run=None):
        ran.append(len(trains))
        return simulate(trains, noise_of, run)

    def of_valves(stated):
        return [each for each in ranged_numbers(stated) if each.key.startswith("brake.system.wsp_valve.")]

    monkeypatch.setattr(rig, "simulate_trains", noted)
    monkeypatch.setattr(sweeps, "ranged_numbers", of_valves)
    first, second = train()
    of_run = FirmnessRun(2, effort=SMALL)
    one, simulated = of_run.of_case(first), sum(ran)
    other = of_run.of_case(second)
    numbers = {each.key for each in one.numbers}
    assert VENT in numbers and numbers == {each.key for each in other.numbers}
    assert simulated >= SMALL.stops(len(one.numbers)) > sum(ran) - simulated
    assert one.draws == SMALL.draws and "coupler.stiffness" in one.without_range
    assert FirmnessRun(1, effort=SMALL).of_case(second) == other
