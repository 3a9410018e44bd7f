"""The threshold controller in C is the built-in one, bit for bit."""

import hashlib
import json
from types import SimpleNamespace

import numpy as np
import pytest
from numpy.typing import NDArray

from uictest import rig
from uictest.controllers import (
    EXCHANGE,
    OUTPUTS_AT,
    Config,
    ControllerError,
    ControllerProgram,
    open_controller,
)
from uictest.controllers.adapters.instance import STEP
from uictest.controllers.built_in import threshold
from uictest.core.physics import FILL, VENT
from uictest.plans.scenario import load
from uictest.rig.external.in_process import run_in_process
from uictest.running.campaign import map_on_threads

from .conftest import EXAMPLES, ROOT, bits, listening

Array = NDArray[np.float64]


@pytest.fixture
def in_process(threshold_library, with_controller):
    return lambda case: rig.simulate(with_controller(case, threshold_library), run=run_in_process)


@pytest.fixture
def in_a_child_process(threshold_library, with_controller):
    with rig.Workers() as workers:
        yield lambda case: rig.simulate(with_controller(case, threshold_library), run=workers.run)


@pytest.fixture
def over_tcp(serve, with_controller):
    with listening(serve(EXAMPLES / "threshold-c" / "threshold.c")) as address:
        yield lambda case: rig.simulate(with_controller(case, address))


@pytest.mark.parametrize("way", ["in_process", "in_a_child_process", "over_tcp"])
def test_every_shipped_stop_has_the_bits_of_the_built_in_controller(way, request, shipped, built_in):
    simulate = request.getfixturevalue(way)
    stops = [simulate(case) for case in shipped]
    assert len(stops) > 20
    assert {stop.controller_version for stop in stops} == {"1.0"}
    found = zip(shipped, stops, built_in, strict=True)
    assert [case.id for case, stop, expected in found if bits(stop) != expected] == []


def test_every_car_of_a_train_has_the_bits_of_the_built_in_controller(threshold_library, with_controller):
    cases = load([ROOT / "scenarios" / "train-120.yaml"])
    outside = [with_controller(case, threshold_library) for case in cases]
    stops = rig.simulate_cars(outside)
    assert [bits(stop) for stop in stops] == [bits(stop) for stop in rig.simulate_cars(cases)]
    assert {stop.controller_version for stop in stops} == {"1.0"}


def test_programs_at_sockets_serve_a_car_each_whatever_the_order_of_the_cars(
    serve, with_controller, tmp_path
):
    """Two trains at once that need the same programs: neither waits for ever for what the other has."""
    (tmp_path / "pair.yaml").write_text(
        "schema: uictest/scenario/1\nname: pair\ninitial_speed: 14 km/h\nuntil: 12 km/h\n"
        "rail: {condition: wet, friction: 0.05}\ntrain: [{count: 2}]\n"
        "criteria: uictest-rig\nexpect: skipped\n"
    )
    cars = load([tmp_path / "pair.yaml"])
    program = serve(EXAMPLES / "threshold-c" / "threshold.c")
    with listening(program) as one, listening(program) as other:

        def simulated(addresses):
            return rig.simulate_cars([with_controller(*each) for each in zip(cars, addresses, strict=True)])

        orders = [(one, other), (other, one)] * 4
        trains = list(map_on_threads(simulated, orders, jobs=4))
    expected = [bits(stop) for stop in rig.simulate_cars(cars)]
    assert [[bits(stop) for stop in stops] for stops in trains] == [expected] * 8


def test_the_example_scenario_runs_with_the_parameters_of_the_built_in_controller(
    threshold_library, parameters_of, shipped
):
    case = load([threshold_library.parent / "threshold.yaml"])[0]
    written = case.scenario.controller.program
    assert written is not None
    assert json.loads(written.parameters) == parameters_of(shipped[0])
    assert float(rig.simulate(case, run=run_in_process).measures.braking_distance) > 0.0


@pytest.mark.parametrize("seed", range(8))
def test_it_answers_as_the_built_in_controller_does_to_any_speeds(
    threshold_library, parameters_of, shipped, seed
):
    """Speeds that no rig gives reach the modes that shipped stops do not: probing, watchdogs."""
    parameters = {**parameters_of(shipped[0]), "sounding_interval": 0.1}
    built_in = BuiltIn({**parameters, "cycle_time": 0.01}, 30.0)
    instance = opened_library(threshold_library, parameters, 30.0)
    try:
        instance.reset()
        for cycle, (speeds, valid) in enumerate(zip(wandering_speeds(seed), failing(seed), strict=True)):
            expected = built_in.asked(speeds, valid)
            assert asked(instance, cycle, speeds, valid) == expected, f"cycle {cycle}"
        assert built_in.modes == {0, 1, 2, 3, 4}
        assert built_in.distrusted == {0, 1}
    finally:
        instance.close()


def wandering_speeds(seed):
    """Four speeds over 60 s that slide, lock and catch up by chance, m/s."""
    random = np.random.default_rng(seed)
    train = np.maximum(30.0 - 0.5 * 0.01 * np.arange(6000), 0.0)
    share = np.clip(np.cumsum(random.normal(0.0, 0.012, (6000, 4)), axis=0) + 1.0, 0.0, 1.0)
    return np.asarray(train[:, None] * share + np.abs(random.normal(0.0, 0.005, (6000, 4))))


def failing(seed):
    """For each cycle whether the four sensors are valid; each fails a few times for about a second."""
    random = np.random.default_rng(seed + 100)
    valid = np.ones((6000, 4), np.int64)
    for begin, wheelset in zip(random.integers(0, 5900, 8), random.integers(0, 4, 8), strict=True):
        valid[begin : begin + 100, wheelset] = 0
    return valid


class BuiltIn:
    """The built-in controller in plain Python."""

    def __init__(self, parameters, speed):
        self.parameters = SimpleNamespace(**parameters)
        self.train = SimpleNamespace()
        self.wheelsets = [SimpleNamespace() for _ in range(4)]
        self.modes = set()
        self.distrusted = set()
        threshold.begin(self.train, self.wheelsets, speed)

    def asked(self, speeds, valid):
        for wheelset, speed, sound in zip(self.wheelsets, speeds.tolist(), valid.tolist(), strict=True):
            wheelset.measured_speed, wheelset.speed_valid, wheelset.dynamic_brake = speed, sound, 0.0
        threshold.decide(self.train, self.wheelsets, self.parameters)
        self.modes |= {wheelset.mode for wheelset in self.wheelsets}
        self.distrusted |= {wheelset.distrusted for wheelset in self.wheelsets}
        commands = [wheelset.valve_command for wheelset in self.wheelsets]
        hold, vent = [int(each != FILL) for each in commands], [int(each == VENT) for each in commands]
        return hold, vent, self.train.reference_speed


def opened_library(library, parameters, speed):
    digest = hashlib.sha256(library.read_bytes()).hexdigest()
    program = ControllerProgram("library", str(library), digest, json.dumps(parameters))
    return open_controller(program, Config(4, 0.01, speed, (0.46,) * 4, parameters))


def asked(instance, cycle, speeds, valid):
    exchange = np.zeros(1, EXCHANGE)[0]
    exchange["cycle"], exchange["time"], exchange["wheel_speed"] = cycle, cycle * 0.01, speeds
    exchange["speed_valid"] = valid
    address = exchange.__array_interface__["data"][0]
    assert STEP(instance.step_address)(instance.handle, address, address + OUTPUTS_AT) == 0
    return exchange["hold"].tolist(), exchange["vent"].tolist(), float(exchange["reference_speed"])


@pytest.mark.parametrize(
    ("parameters", "reason"),
    [
        ({"slip_threshold": "high"}, "parameter slip_threshold is missing or not a number"),
        ({"hold_limit": None}, "parameter hold_limit is missing or not a number"),
        ({"fill_pulse_on": 0.001}, "fill_pulse_on is shorter than one cycle"),
    ],
)
def test_parameters_that_are_none_are_named(threshold_library, parameters_of, shipped, parameters, reason):
    stated = parameters_of(shipped[0]) | parameters
    changed = {name: value for name, value in stated.items() if value is not None}
    with pytest.raises(ControllerError, match=f"^uictest_create failed: {reason}$"):
        opened_library(threshold_library, changed, 30.0)
