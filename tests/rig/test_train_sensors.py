"""What a controller of version 2 is told of the train: a second source of speed, an accelerometer."""

import re
from itertools import product

import numpy as np
import pytest

import uictest
from uictest import rig as simulation
from uictest.controllers import Outputs
from uictest.plans.scenario import ScenarioErrors, load
from uictest.rig.assembly import assemble
from uictest.rig.external.in_process import BlockInputs, run_block, run_in_process
from uictest.rig.simulation import simulate
from uictest.running.campaign import RecordingRequest, Stop, run_stop

from ..c_compiler import build_library
from .conftest import controller_in_c

SCENARIO = """\
schema: uictest/scenario/1
name: stop
initial_speed: 60 km/h
rail: {{condition: wet, friction: 0.07, gradient: 5 permille}}
rig: {{sensors: {{extends: standard, {sensors}}}}}
controller: {controller}
"""
EXACT = "train_speed: {{period: {period}, delay: {delay}, noise: 0 km/h, gain_error: {gain}}}"
QUIET = "acceleration: {noise: 0 m/s2}"
PYTHON = """\
from uictest.controllers import Outputs
PARAMETERS = {"second_source": {"default": True}}
class Wsp:
    '''Takes the train's speed from the second source, or from the fastest wheelset, falling by 2 m/s2.'''
    contract = 2
    def __init__(self, config):
        self.config = config
    def reset(self):
        self.reference = self.config.initial_speed
    def step(self, inputs):
        self.reference = max(*inputs.wheel_speed, self.reference - 2.0 * self.config.cycle_time)
        if inputs.train_speed_valid and self.config.parameters["second_source"]:
            self.reference = inputs.train_speed
        slides = [1.0 - speed / max(self.reference, 1.0) for speed in inputs.wheel_speed]
        acts = self.reference > 2.0
        vent = [acts and slide > 0.15 for slide in slides]
        return Outputs([acts and slide > 0.08 for slide in slides], vent, self.reference)
"""
SHOWN = """\
class Shown:
    contract = 2
    def __init__(self, config): pass
    def reset(self): pass
    def step(self, inputs):
        held = [inputs.train_speed_valid, inputs.acceleration_valid, inputs.train_speed > 10.0, 0]
        return Outputs(held, [0] * 4, inputs.acceleration if inputs.cycle % 2 else inputs.train_speed)
"""
C = controller_in_c("""\
outputs->hold[0] = inputs->train_speed_valid;
    outputs->hold[1] = inputs->acceleration_valid;
    outputs->hold[2] = inputs->train_speed > 10.0;
    outputs->reference_speed = inputs->cycle % 2 ? inputs->acceleration : inputs->train_speed;""")


@pytest.fixture
def case(tmp_path, monkeypatch):
    """One case with such sensors; the classes are in the folder."""
    monkeypatch.chdir(tmp_path)
    (tmp_path / "wsp.py").write_text(PYTHON + SHOWN)

    def of(sensors, *overrides, controller="threshold"):
        path = tmp_path / "stop.yaml"
        path.write_text(SCENARIO.format(sensors=sensors, controller=controller))
        return load([path], list(overrides))[0]

    return of


@pytest.fixture
def columns(case):
    """Channels of a stop at the beginning of every controller cycle but the last."""
    return lambda sensors, *overrides: simulate(case(sensors, *overrides), 0.01).recording


def exact(period, delay, gain="0 %"):
    return EXACT.format(period=period, delay=delay, gain=gain)


@pytest.mark.parametrize(("period", "delay"), [(1, 0), (1, 3), (10, 0), (10, 7), (10, 10), (25, 60)])
def test_a_value_is_the_speed_at_the_last_whole_period_before_the_delay(columns, period, delay):
    """A sample shows what was read at the beginning of the cycle before it."""
    stop = columns(exact(f"{10 * period} ms", f"{10 * delay} ms", "1 %"))
    speed, shown = stop["speed"], stop["measured_train_speed"]
    cycle = np.arange(len(speed) - 1)
    taken = (cycle - delay) // period * period
    # Before the command the source gave the speed at it.
    expected = np.where(taken < 0, speed[0], 1.01 * speed[np.maximum(taken, 0)])
    assert shown[1:] == pytest.approx(expected, rel=1e-12)
    assert set(stop["train_speed_valid"]) == {1.0}


def test_an_accelerometer_shows_the_change_of_speed_and_the_share_of_gravity(columns):
    stop = columns("acceleration: {noise: 0 m/s2, offset: 0.25 m/s2}")
    change = np.diff(stop["speed"])[:-1] / 0.01
    assert stop["measured_acceleration"][2:] == pytest.approx(change + 9.80665 * 0.005 + 0.25, abs=1e-9)
    assert stop["measured_acceleration"][1] == pytest.approx(9.80665 * 0.005 + 0.25)


def test_noise_is_of_the_size_that_is_stated(columns):
    noisy = columns("train_speed: {period: 10 ms, delay: 0 s, noise: 1.8 km/h}, acceleration: {}")
    quiet = columns(f"{exact('10 ms', '0 s')}, {QUIET}")
    for channel, deviation in (("measured_train_speed", 0.5), ("measured_acceleration", 0.05)):
        moving = slice(1, round(0.9 * len(noisy["speed"])))
        error = (noisy[channel] - quiet[channel])[moving]
        assert np.std(error) == pytest.approx(deviation, rel=0.1)
        assert abs(np.mean(error)) < 0.1 * deviation


def test_a_stop_whose_controller_does_not_look_keeps_its_bits(case):
    without = simulate(case("name: own", "rail.friction=0.06"))
    looked_at = simulate(case("train_speed: {}, acceleration: {}", "rail.friction=0.06"))
    assert looked_at.measures.tobytes() == without.measures.tobytes()
    assert looked_at.wheelset_measures.tobytes() == without.wheelset_measures.tobytes()


LOST = "{at: 2 s, until: 3 s, part: train-speed, kind: lost}"
STUCK = "{at: 4 s, until: 5 s, part: train-speed, kind: stuck}"
STUCK_AT = "{at: 6 s, until: 7 s, part: train-speed, kind: stuck, value: 36 km/h}"
OFFSET = "{at: 8 s, until: 9 s, part: train-speed, kind: offset, value: -7.2 km/h}"


def test_faults_of_the_second_source(columns):
    """A lost one gives the defined value 0 and says so; the others say nothing."""
    stop = columns(exact("10 ms", "0 s"), f"faults=[{LOST}, {STUCK}, {STUCK_AT}, {OFFSET}]")
    sound = columns(exact("10 ms", "0 s"))
    time, shown = stop["time"], stop["measured_train_speed"]
    within = lambda begin: (time > begin + 0.005) & (time < begin + 1.005)  # noqa: E731
    assert set(shown[within(2.0)]) == {0.0}
    assert set(stop["train_speed_valid"][within(2.0)]) == {0.0}
    assert set(stop["train_speed_valid"][~within(2.0)]) <= {1.0}
    assert set(shown[within(4.0)]) == {shown[time <= 4.005][-1]}
    assert set(shown[within(6.0)]) == {10.0}
    assert shown[within(8.0)] == pytest.approx(sound["measured_train_speed"][within(8.0)] - 2.0)
    free = ~(within(2.0) | within(4.0) | within(6.0) | within(8.0))
    assert np.array_equal(shown[free], sound["measured_train_speed"][free])


def test_without_sensors_a_controller_gets_zeros_that_are_not_valid(case):
    stop = run_in_process(assemble(case("name: own", controller="{python: wsp.py, class: Shown}")), 20)
    assert set(stop.trace.train["reference_speed"][1:]) == {0.0}
    assert not stop.trace.wheelsets["hold_magnet"].any()


def test_every_kind_of_controller_is_given_the_same_alone_and_in_lanes(case, tmp_path):
    (tmp_path / "wsp.c").write_text(C)
    build_library(tmp_path / "libwsp.so", tmp_path / "wsp.c")
    sensors = "train_speed: {delay: 250 ms}, acceleration: {}"
    python, c = (
        assemble(case(sensors, f"faults=[{LOST}, {OFFSET}]", controller=controller))
        for controller in ("{python: wsp.py, class: Shown}", "{library: libwsp.so}")
    )
    alone = [run_in_process(each, 20) for each in (python, c)]
    assert alone[0].trace.train.tobytes() == alone[1].trace.train.tobytes()
    stops = [c, assemble(case("name: own")), python]
    run = run_block(BlockInputs.of(stops))
    assert run.failures == ["", "", ""]
    for place in (0, 2):
        assert run.measures[place].tobytes() == alone[0].measures.tobytes()
        assert run.wheelset_measures[place].tobytes() == alone[0].wheelset_measures.tobytes()
    case(sensors, controller="{python: wsp.py, class: Shown}")
    rig = uictest.Rig("stop.yaml", contract=2, record=100)
    inputs = rig.reset()
    given = []
    while not rig.stopped:
        given.append((inputs.train_speed, inputs.acceleration))
        held = [inputs.train_speed_valid, inputs.acceleration_valid, inputs.train_speed > 10.0, 0]
        inputs = rig.step(Outputs(held, [0] * 4))
    undisturbed = run_in_process(
        assemble(case(sensors, controller="{python: wsp.py, class: Shown}")), 20
    ).trace.train
    assert [pair[0] for pair in given] == undisturbed["measured_train_speed"][1 : len(given) + 1].tolist()
    assert [pair[1] for pair in given] == undisturbed["measured_acceleration"][1 : len(given) + 1].tolist()


def test_a_controller_that_takes_its_reference_from_it_keeps_braking_when_all_slide(case):
    """By the fastest wheelset all four are lost together; so they are once the source is lost."""

    def stopped(second_source, *faults):
        controller = f"{{python: wsp.py, class: Wsp, parameters: {{second_source: {second_source}}}}}"
        slippery = ("initial_speed=120 km/h", f"faults=[{', '.join(faults)}]")
        stop = run_in_process(assemble(case("train_speed: {}", *slippery, controller=controller)), 20)
        moving = stop.trace.train["speed"] > 5.0
        return stop.measures.braking_distance, stop.trace.wheelsets["slide"][moving].mean()

    (distance, slide), (blind_distance, blind_slide) = stopped("true"), stopped("false")
    assert distance < 0.8 * blind_distance
    assert slide < 0.3 < blind_slide
    lost_distance, lost_slide = stopped("true", "{at: 5 s, part: train-speed, kind: lost}")
    assert distance < lost_distance < blind_distance
    assert lost_slide > slide


@pytest.mark.parametrize(
    ("sensors", "overrides", "told"),
    [
        ("train_speed: {period: 50 ms, delay: 151 ms}", (), "151 ms is more than 3 periods of 50 ms"),
        ("name: own", (f"faults=[{LOST}]",), "this rig has no second source of speed"),
        ("train_speed: {}", ("faults=[{at: 0 s, wheelset: 1, part: train-speed, kind: lost}]",), "has one"),
        ("train_speed: {}", ("faults=[{at: 0 s, part: train-speed, kind: offset}]",), "needs a value"),
        ("train_speed: {noise: 0.2}", (), "unit"),
        ("acceleration: {noises: 1 m/s2}", (), "noises"),
    ],
)
def test_what_cannot_be_is_refused(case, sensors, overrides, told):
    with pytest.raises(ScenarioErrors, match=told):
        case(sensors, *overrides)


INSTANTS = ("at: 2 s", "at: 40 km/h")
FRICTIONS = ("0.06", "0.09", "0.12")
WHEELSETS = (1, 2, 3, 4)
SEEDS = (0, 1)
KINDS = {"lost": "kind: lost", "zero": "kind: factor, value: 0 %", "stuck": "kind: stuck"}


def stops(rig, controller, kind, instants=INSTANTS, frictions=FRICTIONS):
    """Measures of the stop and of its wheelsets, for every instant, friction, wheelset and seed."""
    inputs = []
    for at, friction, wheelset in product(instants, frictions, WHEELSETS):
        fault = f"faults=[{{{at}, wheelset: {wheelset}, part: speed-sensor, {KINDS[kind]}}}]"
        case = rig.inputs(
            *(f"controller={controller}", "rig.topology=four-caliper", "rail.condition=wet"),
            *(f"rail.friction={friction}", fault),
        )
        for seed in SEEDS:
            parameters = case.parameters.copy()
            parameters["seed"] = seed
            inputs.append(case._replace(parameters=parameters))
    batch = simulation.run_in_lanes(*simulation.stacked(inputs))
    yield from zip(batch.measures.view(np.recarray), batch.wheelset_measures.view(np.recarray), strict=True)


@pytest.mark.parametrize("kind", KINDS)
def test_a_lost_sensor_locks_no_sound_wheelset(rig, kind):
    """Nor does it capture the estimate of the train's speed, or keep its own brake released."""
    for measures, wheelsets in stops(rig, "threshold", kind):
        sound = wheelsets[wheelsets.faulty == 0.0]
        assert len(sound) == 3
        assert measures.stopped == 1.0
        assert sound.longest_lock.max() < 1.0
        assert measures.reference_excess < 1.0
        assert np.nanmax(wheelsets.longest_release) < 6.0
        assert abs(measures.air_residual) < 1e-9
        assert abs(measures.energy_residual) < 1e-6


def test_the_simplest_controller_follows_a_stuck_sensor(rig):
    """It takes what it reads for the speed of the train, unless that wheelset slides deep when it sticks."""
    found = list(stops(rig, "slip-band", "stuck", ["at: 30 km/h"], ["0.12"]))
    assert max(measures.reference_excess for measures, _ in found) > 3.0


def judged(rig, *overrides, **ranges):
    """A judged stop whose sensors of a kind have a range."""
    sensors = [f"rig.sensors.{kind}.range={limit}" for kind, limit in ranges.items()]
    return run_stop(
        Stop(rig.case("initial_speed=60 km/h", *overrides, *sensors)), RecordingRequest("all", 0.01)
    ).case_run


def check(run, name):
    return next(each for each in run.result.criteria if each.id == name)


@pytest.mark.parametrize(
    ("topology", "named"), [("one-caliper", ["1"]), ("four-caliper", ["1", "2", "3", "4"])]
)
def test_loadcells_that_show_less_than_there_is_make_a_stop_invalid(rig, topology, named):
    """The train brakes with what they show; the time is that of the recording."""
    run = judged(rig, f"rig.topology={topology}", loadcell="12 kN")
    verdict = check(run, "loadcells-in-range")
    assert (run.result.outcome, verdict.status) == ("invalid", "fail")
    assert [n for n in "1234" if f"loadcells of wheelset {n} limited to 12 kN" in verdict.reason] == named
    force = run.recording["clamping_force_1"]
    first = float(run.recording["time"][np.argmax(force >= 11.99e3)])
    [told] = re.findall(r"the first by ([0-9.]+) s", verdict.reason)
    assert float(told) == pytest.approx(first, abs=0.02)
    limited = 0.01 * float(np.sum(force >= 11.99e3)) * len(named)
    assert verdict.value == pytest.approx(limited, abs=0.05 * len(named))
    assert check(run, "pressure-sensors-in-range").status == "pass"


def test_checks_of_ranges_hold_or_name_every_sensor_that_was_limited_that_of_the_brake_line_too(rig):
    run = judged(rig, pressure="3 bar")
    reason = check(run, "pressure-sensors-in-range").reason
    assert run.result.outcome == "invalid"
    for place in ("wheelset 1", "wheelset 4", "the brake line"):
        assert f"pressure sensor of {place} limited to 3 bar for" in reason
    # One time is kept for all sensors; here it is not that of the loadcells, which follow.
    run = judged(rig, loadcell="14 kN", pressure="1 bar")
    for name in ("loadcells-in-range", "pressure-sensors-in-range"):
        assert "; the first of any kind by " in check(run, name).reason
    assert {each.status for each in judged(rig).result.criteria if each.layer == "rig"} == {"pass"}
