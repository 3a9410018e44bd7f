"""Trains in batches: run once, whatever is asked of them, and a car alone where there is one."""

from dataclasses import replace
from itertools import chain

import pytest

from uictest import rig
from uictest.judging.evaluation import json_form, result_document, to_json
from uictest.plans import scenario
from uictest.running import campaign
from uictest.running.campaign import RecordingRequest, RunSettings, run_cases, stop as stop_module

STOP = """
schema: uictest/scenario/1
name: {name}
initial_speed: 14 km/h
until: 12 km/h
rail: {{condition: wet, friction: 0.05}}
criteria: uictest-stop
expect: skipped
{more}
"""
TRAIN = "train: [{}, {vehicle: crh380a, count: 2, brake: {command: 50 %}}]"
RECORDED = RecordingRequest("all", every=0.01)


@pytest.fixture
def cases(tmp_path):
    """Write a scenario and return its cases."""

    def write(more, name="stop"):
        path = tmp_path / f"{name}.yaml"
        path.write_text(STOP.format(name=name, more=more), "utf-8")
        return scenario.load([path])

    return write


def run(cases, jobs=1, recording=RECORDED):
    runs = []
    settings = RunSettings(jobs=jobs, recording=recording)
    results = run_cases(cases, settings, on_case=runs.append).whole()
    recordings = {
        each.result.id: None if each.recording is None else each.recording.channels["speed"].tobytes()
        for each in runs
    }
    return to_json(result_document(results)), recordings


def test_a_train_of_one_car_is_the_scenario_without_train(cases):
    def figures(more):
        (result,) = run_cases(cases(more), RunSettings(recording=RecordingRequest("none"))).whole()
        return json_form([result.measures, result.wheelsets, result.outcome, result.noise_key])

    assert figures("train: [{vehicle: crh380a}]") == figures("vehicle: crh380a")


def test_results_depend_neither_on_workers_nor_on_what_runs_beside(cases):
    loaded = [*cases(TRAIN), *cases("vehicle: crh380a", "alone"), *cases("train: [{count: 2}]", "pair")]
    assert run(loaded, jobs=1) == run(loaded, jobs=3)
    _, recordings = run(loaded)
    for subset in (loaded[1:2], [loaded[2], loaded[0]], loaded[3:5]):
        assert run(subset)[1] == {case.id: recordings[case.id] for case in subset}


def test_a_train_is_simulated_once_for_all_of_its_cars(cases, monkeypatch):
    simulated = []
    whole = rig.simulate_cars

    def noted(cars, every=None, run=None):
        simulated.append([case.id for case in cars])
        return whole(cars, every, run)

    monkeypatch.setattr(rig, "simulate_cars", noted)
    loaded = cases(f"{TRAIN}\nrepeat: 2")
    run(loaded)
    assert simulated == [[case.id for case in loaded]] * 2
    list(campaign.replay([case.with_values(repeat=1) for case in loaded], every=0.01, jobs=1))
    assert simulated[2:] == [[case.id for case in loaded]]


@pytest.fixture
def queues(monkeypatch):
    """How many trains ran in each queue of lanes."""
    queues, queued = [], rig.simulate_trains

    def noted(trains):
        queues.append(len(trains))
        return queued(trains)

    monkeypatch.setattr(rig, "simulate_trains", noted)
    return queues


REPEATED = f"{TRAIN}\nrepeat: 6\nbrake: {{transmission: {{pipe: 250 m/s}}}}"


@pytest.mark.parametrize(
    ("cases_to_record", "jobs", "expected"), [("none", 1, [13]), ("none", 2, [6, 7]), ("failed", 1, [5, 6])]
)
def test_trains_in_lanes_give_the_results_of_trains_one_by_one(
    cases, queues, monkeypatch, cases_to_record, jobs, expected
):
    loaded = [*cases(REPEATED), *cases("train: [{count: 2}]", "pair"), *cases(REPEATED, "again")]
    recording = RecordingRequest(cases_to_record, every=0.01)
    in_lanes = run(loaded, jobs, recording)
    assert sorted(queues) == expected
    monkeypatch.setattr(stop_module, "_MOST_TOGETHER", 1)
    assert run(loaded, 1, recording) == in_lanes
    assert sorted(queues) == expected


@pytest.mark.parametrize(("trains", "jobs", "expected"), [(1, 1, []), (2, 1, [2]), (2, 2, []), (3, 2, [2])])
def test_trains_run_in_lanes_where_a_thread_has_more_than_one(cases, queues, trains, jobs, expected):
    run(cases(f"train: [{{count: 2}}]\nrepeat: {trains}"), jobs, RecordingRequest("none"))
    assert queues == expected


def test_a_train_that_fails_leaves_those_beside_it(cases, monkeypatch):
    loaded = cases("train: [{count: 2}]\nrepeat: 3")
    queued, coupled = rig.simulate_trains, rig.simulate_cars

    def refusing(simulate, of_cases):
        def simulated(given, *arguments):
            if any(case.scenario.seed == 1 for case in of_cases(given)):
                raise ValueError("no such seed")
            return simulate(given, *arguments)

        return simulated

    monkeypatch.setattr(rig, "simulate_trains", refusing(queued, chain.from_iterable))
    monkeypatch.setattr(rig, "simulate_cars", refusing(coupled, iter))
    for result in run_cases(loaded, RunSettings(recording=RecordingRequest("none"))).whole():
        assert [stop.outcome for stop in result.repeats.stops] == ["pass", "error", "pass"]


def test_a_result_says_where_its_car_runs_and_what_pulled_and_an_error_is_one_of_every_car(
    cases, monkeypatch
):
    first, second, third = run_cases(cases(TRAIN), RunSettings()).whole()
    assert [each.train.label for each in (first, second, third)] == ["car 1 of 3", "car 2 of 3", "car 3 of 3"]
    assert (first.train.ahead, third.train.behind) == (None, None)
    assert first.train.behind == second.train.ahead
    assert second.train.behind == third.train.ahead
    assert first.train.behind.largest_push_n > 1000.0  # the leading car brakes twice as hard
    monkeypatch.setattr(rig, "simulate_cars", lambda *arguments: 1 / 0)
    results = run_cases(cases(TRAIN), RunSettings()).whole()
    assert [(each.outcome, each.train.car) for each in results] == [("error", 1), ("error", 2), ("error", 3)]


def test_repeats_keep_the_largest_forces_of_all_stops(cases):
    loaded = cases("train: [{count: 2}]\nrepeat: 3")
    (repeated, _) = run_cases(loaded, RunSettings()).whole()
    single = [
        run_cases([loaded[0].with_values(seed=seed, repeat=1)], RunSettings()).whole()[0].train.behind
        for seed in range(3)
    ]
    assert repeated.train.behind.largest_pull_n == max(each.largest_pull_n for each in single)
    assert repeated.train.behind.largest_push_n == max(each.largest_push_n for each in single)


def test_the_command_travels_along_a_pipe(cases):
    lines = ("wire", "{pipe: 100 m/s}")
    wire, pipe = (
        rig.simulate_cars(cases(f"train: [{{count: 3}}]\nbrake: {{transmission: {line}}}"), 0.01)
        for line in lines
    )
    for car, stops in enumerate(zip(wire, pipe, strict=True)):
        channels = [stop.recording.channels for stop in stops]
        one, other = (float(each["time"][each["brake_line_pressure"] > 1e4][0]) for each in channels)
        assert other - one == pytest.approx(car * 26.4 / 100.0, abs=0.011)


def test_what_runs_a_car_alone_refuses_one_of_a_train(cases):
    loaded = cases(TRAIN)
    with pytest.raises(ValueError, match=r"stop\[car=2\] is car 2 of 3: here a car runs alone"):
        rig.assemble(loaded[1])
    rig.assemble(replace(loaded[1], train=None))
