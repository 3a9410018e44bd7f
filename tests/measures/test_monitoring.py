"""What a controller reports, against plain numpy over the samples of the stop."""

from types import SimpleNamespace
from typing import get_args

import numpy as np
import pytest

from uictest.core.measures import MeasureDefinition, Replay, reports_wheelset, samples_of
from uictest.core.record import fields_of
from uictest.judging.evaluation import judge
from uictest.plans.faults import FAULT_KINDS, Effects, Report
from uictest.plans.scenario import load
from uictest.recorded.field_data import Preparation, RawChannel, prepare
from uictest.recorded.field_data.judgement import judge_recording
from uictest.rig import pass_samples, simulate

LEVELS = get_args(Report)
DEVIATING = ("speed_valid", "speed_held", "speed_factor", "speed_offset", "vent_at_most", "silent")
"""Effects of faults that can make a wheelset deviate."""

A, B, MOVING, LOCKED = 50.0 / 3.6, 0.3, 10.0 / 3.6, 0.1
DEFINITION = dict.fromkeys(fields_of(MeasureDefinition), 0.05) | {
    "monitored_speed": A,
    "monitored_share": B,
    "moving_speed": MOVING,
    "locked_speed": LOCKED,
}
CYCLE = 0.01
NAN = float("nan")


def runs(mask):
    """First and last-but-one rows of the stretches in which a mask holds."""
    edges = np.flatnonzero(np.diff(np.concatenate(([0], mask.astype(int), [0]))))
    return edges.reshape(-1, 2)


def expected(channels, n, begun, required):
    """The measures of a wheelset: NaN where something never was. Rows are as the rig records them."""
    time, speed = channels["time"], channels["speed"]
    interval, before = np.diff(time), speed[:-1]
    shown, bits = channels[f"measured_speed_{n}"][1:], channels["diagnosis"][1:].astype(np.int64)
    reported = np.isin(bits[:, None] & (1 << np.arange(n - 1, 32, 8)), 0, invert=True).any(axis=1)
    moves = before > MOVING
    deviates = moves & (np.abs(shown - before) > A + B * before)
    locked = (speed[1:] > MOVING) & (channels[f"wheel_speed_{n}"][1:] < LOCKED)

    def waited(first, end):
        answered = np.flatnonzero(reported[first:end] & moves[first:end])
        end = first + answered[0] if len(answered) else end
        return interval[first:end][moves[first:end]].sum()

    def since(fault):
        rows = np.flatnonzero(fault[1:] & moves)
        return waited(rows[0], len(interval)) if len(rows) else NAN

    unfilled = runs(moves & (channels[f"valve_command_{n}"][1:] != 0.0))
    stands_out = np.maximum.accumulate(deviates | locked)
    false = moves & reported & ~begun[1:] & ~stands_out
    return {
        "longest_deviation": max((waited(*run) for run in runs(deviates)), default=NAN),
        "longest_unfilled": max((interval[slice(*run)].sum() for run in unfilled), default=0.0),
        "falsely_reported": float(false.any()),
        "report_delay": since(begun),
        "required_delay": since(required),
    }


def recording(seed, rows=1500):
    """A stop whose sensors, diagnosis and valves do whatever they like for a while at a time."""
    rng = np.random.default_rng(seed)
    time = np.arange(rows) * CYCLE
    speed = np.linspace(rng.uniform(15.0, 60.0), 0.0, rows)

    def for_a_while(values, count):
        edges = np.sort(rng.integers(0, rows, count))
        return np.asarray(values(count + 1))[np.searchsorted(edges, np.arange(rows), side="right")]

    channels = {"time": time, "speed": speed, "distance": np.cumsum(speed) * CYCLE}
    places = np.array([0, 1, 2, 3, 5, 8, 10, 17, 27, 31])
    rare = for_a_while(lambda n: (1 << rng.choice(places, n)) * (rng.random(n) < 0.4), 6)
    channels["diagnosis"] = rare.astype(float)
    for n in (1, 2, 3, 4):
        share = for_a_while(lambda k: rng.choice([0.0, 0.02, 0.3, 0.97, 1.0, 1.9], k), 9)
        channels[f"wheel_speed_{n}"] = share * speed
        off = for_a_while(lambda k: rng.choice([0.0, 0.0, 40.0, -60.0], k), 4)
        channels[f"measured_speed_{n}"] = np.maximum(share * speed + off, 0.0)
        channels[f"valve_command_{n}"] = for_a_while(lambda k: rng.choice([0.0, 1.0, 2.0], k), 20)
    return channels


@pytest.mark.parametrize("seed", range(12))
def test_a_recording_is_observed_as_its_samples_say(seed):
    channels = recording(seed)
    begun = np.zeros((len(channels["time"]), 4))
    begun[np.random.default_rng(seed).integers(0, 900) :, seed % 4] = 1.0
    required = begun * (np.arange(len(begun)) >= 900)[:, None]
    faults = begun.max(axis=1), begun, begun, required
    replay = Replay(samples_of(channels, faults=faults), SimpleNamespace(**DEFINITION), 3.8e5)
    pass_samples(replay)
    for n, wheelset in enumerate(replay.wheelsets, start=1):
        own = begun[:, n - 1] > 0.0, required[:, n - 1] > 0.0
        for name, value in expected(channels, n, *own).items():
            assert getattr(wheelset, name) == pytest.approx(value, abs=1e-9, nan_ok=True), (name, n)


@pytest.mark.parametrize(("wheel_speed", "false"), [(0.0, 0.0), (LOCKED, 1.0), (14.0, 1.0)])
def test_a_report_of_a_locked_wheelset_is_not_false(wheel_speed, false):
    """At 15 m/s it deviates by less than A + B v, locked or not."""
    rows = 50
    channels = {"time": np.arange(rows) * CYCLE, "speed": np.full(rows, 15.0)}
    channels["diagnosis"] = np.where(np.arange(rows) > 20, 2.0, 0.0)
    channels |= {f"wheel_speed_{n}": np.full(rows, wheel_speed) for n in (1, 2, 3, 4)}
    replay = Replay(samples_of(channels), SimpleNamespace(**DEFINITION), 3.8e5)
    pass_samples(replay)
    assert [wheelset.falsely_reported for wheelset in replay.wheelsets] == [0.0, false, 0.0, 0.0]


WSP = """
import random
from uictest.controllers import Outputs

class Wsp:
    def __init__(self, config): pass
    def reset(self):
        self.random, self.bits, self.magnets = random.Random(3), 0, [(0, 0)] * 4
    def step(self, inputs):
        if self.random.random() < 0.02:
            self.bits = 1 << self.random.randrange(32) if self.random.random() < 0.3 else 0
        if self.random.random() < 0.05:
            self.magnets[self.random.randrange(4)] = self.random.choice([(0, 0), (1, 0), (1, 1)])
        return Outputs(*zip(*self.magnets), diagnosis=self.bits)
"""
FAULTS = """
  - {at: 5 s, wheelset: 1, part: speed-sensor, kind: lost}
  - {at: 1 s, wheelset: 1, part: tank, kind: leak, value: 1e-10 m3/(s Pa)}
  - {at: 2 s, wheelset: 2, part: speed-sensor, kind: stuck}
  - {at: 3 s, until: 4 s, wheelset: 3, part: speed-sensor, kind: lost}
"""
BEGINS = {1: 1.0, 2: 2.0, 3: 3.0}
REQUIRED = {3: 3.0, 1: 5.0}


def stop(folder, controller, faults=FAULTS, speed="160 km/h", more=""):
    (folder / "wsp.py").write_text(WSP)
    path = folder / "stop.yaml"
    path.write_text(
        f"schema: uictest/scenario/1\nname: stop\ninitial_speed: {speed}\ncontroller: {controller}\n"
        "rail: {condition: wet, friction: 0.06}\nrig: {topology: four-caliper}\n"
        f"criteria: uictest-wsp-monitoring\n{more}" + (f"faults: {faults}" if faults else "")
    )
    (case,) = load([path])
    return case


def test_a_simulated_stop_is_observed_as_its_recording_says(tmp_path):
    case = stop(tmp_path, "{python: wsp.py, class: Wsp}")
    simulated = simulate(case, record_every=CYCLE)
    channels = simulated.recording.channels
    time = channels["time"]
    assert simulated.measures.has_diagnosis == 1.0
    for n, wheelset in enumerate(simulated.wheelset_measures, start=1):
        # The sample at the end of a cycle shows what began with it.
        begun, required = (time - CYCLE > at.get(n, np.inf) - 0.5 * CYCLE for at in (BEGINS, REQUIRED))
        for name, value in expected(channels, n, begun, required).items():
            assert wheelset[name] == pytest.approx(value, abs=1e-6, nan_ok=True), (name, n)


def verdicts(case):
    simulated = simulate(case)
    judged = judge(case.scenario, simulated.measures, simulated.wheelset_measures)
    return {verdict.id: verdict for verdict in judged if verdict.layer == "requirement"}


LOST = "[{at: %s, wheelset: 2, part: speed-sensor, kind: lost}]"


@pytest.mark.parametrize("at", ["3 s", "3 s, until: 4 s"])
def test_a_controller_without_a_diagnosis_fails_where_a_report_is_due(tmp_path, at):
    """A fault that has passed was there all the same."""
    found = verdicts(stop(tmp_path, "threshold", LOST % at))
    assert found["fault-reported"].status == "fail"
    assert "wheelset 2 not reported: the controller has no diagnosis" in found["fault-reported"].reason
    if "until" not in at:
        assert found["rotation-reported"].missed_by == (2,)
    assert found["no-false-report"].status == "not_applicable"


@pytest.mark.parametrize("kind", ["cut-out", "lost"])
def test_only_some_kinds_of_faults_are_to_be_reported_in_themselves(tmp_path, kind):
    part = "brake" if kind == "cut-out" else "speed-sensor"
    fault = f"[{{at: 1 s, wheelset: 2, part: {part}, kind: {kind}}}]"
    found = verdicts(stop(tmp_path, "threshold", fault, "60 km/h"))["fault-reported"]
    assert (found.status == "not_applicable") == (kind == "cut-out")


def test_a_report_that_standstill_forestalls_is_not_missing_and_a_stop_without_faults_not_watched(tmp_path):
    found = verdicts(stop(tmp_path, "threshold", LOST % "20 km/h", "40 km/h"))["fault-reported"]
    assert (found.status, found.value) == ("inconclusive", None)
    found = verdicts(stop(tmp_path, "threshold", "", "40 km/h"))
    assert {verdict.status for verdict in found.values()} == {"not_applicable"}


def test_a_recorded_stop_is_judged_by_its_diagnosis_where_that_suffices(tmp_path):
    case = stop(tmp_path, "{python: wsp.py, class: Wsp}")
    simulated = simulate(case, record_every=CYCLE)
    channels = simulated.recording.channels
    raw = [RawChannel(name, name, channels["time"], values) for name, values in channels.items()]
    recorded = prepare({each.name: each for each in raw}, simulated.recording.metadata, Preparation())
    result, _ = judge_recording(case, recorded)
    own = {verdict.id: verdict for verdict in result.criteria}
    for name, verdict in verdicts(case).items():
        if name in ("rotation-reported", "safety-timer"):
            assert own[name].status == verdict.status
            assert own[name].value == pytest.approx(verdict.value, abs=2 * CYCLE)
        else:
            assert own[name].status in ("not_applicable", "inconclusive")
            assert own[name].value is None


@pytest.mark.parametrize("diagnosis", [0, 1 << 2, 1 << 13, 1 << 30, 2**32 - 1])
def test_every_bit_of_a_diagnosis_reports_one_wheelset_or_none(diagnosis):
    reported = [reports_wheelset(diagnosis, i) for i in range(4)]
    named = {0: [0, 0, 0, 0], 1 << 2: [0, 0, 1, 0], 1 << 13: [0] * 4, 1 << 30: [0] * 4, 2**32 - 1: [1] * 4}
    assert reported == named[diagnosis]


def test_every_kind_of_fault_says_what_is_to_be_reported():
    by_level = {level: {kind for kind in FAULT_KINDS.values() if kind.report == level} for level in LEVELS}
    assert sum(map(len, by_level.values())) == len(FAULT_KINDS)
    assert all(kind.of_wheelset for kind in by_level["required"])
    # What keeps a brake from being released, or falsifies a speed, can make a wheelset deviate.
    for kind in FAULT_KINDS.values():
        effects = kind.effects(1.0)
        plain = Effects()
        deviates = {name for name in DEVIATING if getattr(effects, name) != getattr(plain, name)}
        assert not (deviates and kind.report == "none"), kind.name
