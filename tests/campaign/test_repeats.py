"""Cases that repeat their stop: the same stops as one by one, whatever runs them in which order."""

import threading
from dataclasses import replace

import numpy as np
import pytest

from uictest import rig
from uictest.judging.evaluation import json_form, result_document, to_json
from uictest.plans import scenario
from uictest.running.campaign import RecordingRequest, RunSettings, Stop, run_cases, run_stop

STOP = """
schema: uictest/scenario/1
name: {name}
initial_speed: 30 km/h
rail: {{condition: wet, friction: 0.05}}
criteria: uictest-stop
{more}
"""
NOTHING = RecordingRequest("none")


@pytest.fixture
def cases(tmp_path):
    """Write a scenario that repeats its stop, and return its cases."""

    def write(name="stop", more="repeat: 4", *overrides):
        path = tmp_path / f"{name}.yaml"
        path.write_text(STOP.format(name=name, more=more), "utf-8")
        return scenario.load([path], overrides)

    return write


def without_names(result):
    return replace(result, id="", scenario="", parameters={}, duration=0.0)


def document(results):
    return to_json(result_document(results))


def test_each_stop_is_the_one_with_its_seed_alone_and_measures_are_medians(cases):
    finished = []
    written = cases(more="repeat: 3\nseed: 5")
    settings = RunSettings(recording=NOTHING)
    (result,) = run_cases(written, settings, on_stop=lambda: finished.append(None)).results
    assert len(finished) == 3
    for stop, seed in zip(result.repeats.stops, (5, 6, 7), strict=True):
        (alone,) = cases(more=f"seed: {seed}")
        single = run_stop(Stop(alone), NOTHING).case_run.result
        assert (stop.seed, stop.outcome) == (seed, single.outcome)
        assert json_form([stop.measures, stop.wheelsets]) == json_form([single.measures, single.wheelsets])
        assert [verdict.value for verdict in stop.criteria] == [verdict.value for verdict in single.criteria]
    distances = result.repeats.values("braking_distance_m")
    assert len(set(distances)) == 3
    assert result.measures["braking_distance_m"] == sorted(distances)[1]


def test_neither_threads_nor_order_nor_name_change_a_digit(cases):
    more = "repeat: 3\nmatrix: {brake.command: [80 %, 100 %]}"
    here = cases(more=more)
    results = run_cases(here, RunSettings(jobs=1, recording=NOTHING)).results
    for jobs in (2, 5):
        again = run_cases(here, RunSettings(jobs=jobs, recording=NOTHING)).results
        assert document(again) == document(results)
    backwards = run_cases(here[::-1], RunSettings(jobs=2, recording=NOTHING)).results
    assert document(backwards[::-1]) == document(results)
    renamed = run_cases(cases("another", more), RunSettings(jobs=2, recording=NOTHING)).results
    assert [document([without_names(each)]) for each in renamed] == [
        document([without_names(each)]) for each in results
    ]


def test_two_controllers_meet_the_same_noise_until_one_of_them_acts(cases):
    """With every seed; what they estimate differs from the first cycle on."""
    (first,), (second,) = (
        cases("stop", "repeat: 2", f"controller={name}") for name in ("threshold", "slip-band")
    )
    for seed in (0, 1):
        one, other = (rig.simulate(_with_seed(case, seed), 0.01).recording for case in (first, second))
        acting = [np.flatnonzero(_commands(each).any(axis=0)) for each in (one, other)]
        until = min(int(cycles[0]) for cycles in acting if len(cycles))
        assert until > 20
        for name in set(one.channels) - {"reference_speed"}:
            samples = one.channels[name]
            assert np.array_equal(samples[:until], other.channels[name][:until], equal_nan=True), name


def _with_seed(case, seed):
    return replace(case, scenario=case.scenario.model_copy(update={"seed": seed}))


def _commands(recording):
    return np.array([recording.channels[f"valve_command_{n}"] for n in (1, 2, 3, 4)])


def test_only_the_first_stop_is_recorded_and_says_so(cases, monkeypatch):
    runs = []
    simulate, recorded = rig.simulate, []

    def asked(case, record_every, *arguments):
        recorded.append((case.scenario.seed, record_every is not None))
        return simulate(case, record_every, *arguments)

    monkeypatch.setattr(rig, "simulate", asked)
    run_cases(cases(more="repeat: 3"), RunSettings(recording=RecordingRequest("all")), on_case=runs.append)
    (run,) = runs
    assert recorded == [(0, True), (1, False), (2, False)]
    assert run.extremes == ()
    assert run.recording.metadata["seed"] == "0, the first of 3 stops"
    stop = run.result.drawn_stop
    assert run.recording["distance"][-1] == pytest.approx(stop.measures["braking_distance_m"], abs=0.5)


def test_what_a_band_needs_changes_no_result(cases):
    written = cases(more="repeat: 3\nseed: 5")
    asked, unasked = [], []
    for band_stops, heard in ((2, asked), (0, unasked)):
        request = RecordingRequest("all", band_stops=band_stops)
        run_cases(written, RunSettings(jobs=2, recording=request), on_case=heard.append)
    assert [len(run.extremes) for run in (*asked, *unasked)] == [2, 0]
    assert [document([without_names(run.result)]) for run in asked] == [
        document([without_names(run.result)]) for run in unasked
    ]


@pytest.mark.parametrize(("expect", "recorded"), [("pass", False), ("fail", True)])
def test_a_case_is_recorded_for_what_all_its_stops_come_to(cases, expect, recorded):
    runs = []
    written = cases(more=f"repeat: 2\nexpect: {expect}")
    run_cases(written, RunSettings(recording=RecordingRequest("failed")), on_case=runs.append)
    assert [run.recording is not None for run in runs] == [recorded]


@pytest.fixture
def fails_with(monkeypatch):
    """Let the stop of one seed end in an exception."""
    simulate = rig.simulate

    def let_fail(seed):
        def failing(case, *arguments):
            if case.scenario.seed == seed:
                raise ZeroDivisionError("no wheel load")
            return simulate(case, *arguments)

        monkeypatch.setattr(rig, "simulate", failing)

    return let_fail


def test_a_result_names_the_noise_that_its_stops_met(cases, fails_with):
    keys = set()
    for controller in ("threshold", "slip-band"):
        written = cases("stop", "repeat: 2", f"controller={controller}")
        (result,) = run_cases(written, RunSettings(recording=NOTHING)).results
        (case,) = written
        assert result.noise_key == f"{int(rig.assemble(case).parameters.noise_key):08x}"
        keys |= {result.noise_key, run_stop(Stop(case), NOTHING).case_run.result.noise_key}
    assert len(keys) == 1
    fails_with(0)
    (result,) = run_cases(cases(more="repeat: 3"), RunSettings(recording=NOTHING)).results
    assert {result.noise_key} == keys


@pytest.mark.parametrize("rule", ["all", "median", "{at_least: 50 %}"])
def test_an_error_with_one_seed_never_vanishes(cases, fails_with, rule):
    fails_with(2)
    runs, written = [], cases(more=f"repeat: 4\noutcome_of_repeats: {rule}")
    run_cases(written, RunSettings(recording=NOTHING), on_case=runs.append)
    (run,) = runs
    told = "error in 1 of 4 stops (seed 2), with seed 2: ZeroDivisionError: no wheel load"
    assert (run.result.outcome, run.result.reason) == ("error", told)
    assert "ZeroDivisionError: no wheel load" in run.traceback
    assert [stop.outcome for stop in run.result.repeats.stops] == ["pass", "pass", "error", "pass"]


def test_an_interrupt_keeps_cases_all_of_whose_stops_are_finished(cases, monkeypatch):
    released, simulate = threading.Event(), rig.simulate

    def slow(case, *arguments):
        if case.scenario.brake.first_command < 0.95 and case.scenario.seed == 1:
            released.wait(60.0)
        return simulate(case, *arguments)

    def interrupt(run):
        raise KeyboardInterrupt

    monkeypatch.setattr(rig, "simulate", slow)
    written = cases(more="repeat: 2\nmatrix: {brake.command: [100 %, 90 %]}")
    try:
        batch = run_cases(written, RunSettings(jobs=1, recording=NOTHING), on_case=interrupt)
    finally:
        released.set()
    assert batch.interrupted
    assert [result.id for result in batch.results] == ["stop[command=100]"]
    assert len(batch.results[0].repeats.stops) == 2


WSP = """
from uictest.controllers import Outputs


class Wsp:
    def __init__(self, config): pass
    def reset(self): pass
    def step(self, inputs):
        return Outputs([0, 0, 0, 0], [0, 0, 0, 0])
"""


@pytest.mark.parametrize("in_process", [False, True])
def test_controllers_from_outside_repeat_their_stops_as_well(cases, tmp_path, in_process):
    (tmp_path / "wsp.py").write_text(WSP, "utf-8")
    controller = "controller: {python: wsp.py, class: Wsp, version: 1.2.0, time_limit: 600 s}"
    written = cases("outside", f"repeat: 3\n{controller}")
    (result,) = run_cases(written, RunSettings(jobs=2, recording=NOTHING, in_process=in_process)).results
    ends = [(stop.outcome, stop.reason.partition("; distance")[0]) for stop in result.repeats.stops]
    assert ends == ends[:1] * 3
    without = cases("inside", "repeat: 3\nrig: {wsp: bypassed}")
    (bypassed,) = run_cases(without, RunSettings(recording=NOTHING)).results
    distances = result.repeats.values("braking_distance_m")
    assert distances == bypassed.repeats.values("braking_distance_m")
