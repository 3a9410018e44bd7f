"""Trains in lanes give the bits of trains one by one."""

import subprocess
import sys

import numpy as np
import pytest
from hypothesis import HealthCheck, given, settings, strategies as st

from uictest.rig.backends.lanes import run_in_lanes
from uictest.rig.backends.train_lanes import run_trains_in_lanes
from uictest.rig.coupled_cars import run_coupled
from uictest.rig.train_inputs import Coupling, assemble_train

COUPLED = Coupling(distance=26.4)
PIPED = Coupling(distance=26.4, stiffness=2.0e6, damping=0.2e6, pipe_speed=250.0)
LOOSE = Coupling(distance=26.4, stiffness=0.0, damping=0.0)
WET = ("rail.condition=wet", "rail.friction=0.09")
CLEANED = ("rail.condition=wet-cleaning", "rail.friction=0.05")
FADING = "rail.friction_over_time={points: [{time: 0 s, factor: 1}, {time: 2 s, factor: 0.5}]}"
VARIED = "rail.variation={spread: 30 %, correlation_length: 5 m, left_right_correlation: 0}"
MOTORS = "brake.dynamic={force: 60 kN, power: 1.6 MW, wheelsets: [1, 4]}"
COURSE = "brake.command=[{at: 0 s, value: 60 %}, {at: 0.4 s, value: 0 %}, {at: 1 s, value: 100 %}]"
AGAIN = "brake.command=[{at: 0 s, value: 100 %}, {at: 5 s, value: 80 %}]"
HOT = "brake.disc_temperature=modelled"
HOT_PAD = ("brake.pad=disc-pad", "brake.initial_disc_temperature=240 degC", HOT)
LEAKS = (
    "faults=[{at: 0.5 s, until: 2 s, wheelset: 2, part: tank, kind: leak, value: 1e-8 m3/(s Pa)},"
    " {at: 1 s, until: 2 s, part: controller, kind: silent, value: 500 ms},"
    " {at: 1 s, wheelset: 3, part: vent-valve, kind: blocked, value: 60 %}]"
)
FAILING = "faults=[{at: 1 s, part: dynamic-brake, kind: failed}]"
MAGNETS = "brake.track={attraction: 60 kN, when: always, delay: 0.3 s, cleaning: 10 %}"
SANDER = "sanders=[{wheelset: 3, density: 7.5 g/m, when: always, off_below: 3 km/h, delay: 0.1 s}]"
OTHER = "sanders=[{wheelset: 1, rate: 2 kg/min, delay: 0 s, off_below: 0 km/h}]"
TRAINS = (
    (COUPLED, WET, [()]),
    (COUPLED, CLEANED, [(), ("brake.command=60 %",)]),
    (PIPED, CLEANED, [(), ("brake.command=60 %",), ("rig.wsp=bypassed",), ("brake.command=80 %",)]),
    (LOOSE, CLEANED, [("brake.command=70 %",), ()]),
    (PIPED, WET, [(COURSE,), (COURSE,)]),
    (COUPLED, (*WET, VARIED), [(MOTORS, FAILING), (), (), (MOTORS, "controller=slip-band")]),
    (LOOSE, WET, [(AGAIN,), (AGAIN, "brake.position=G"), HOT_PAD, (*HOT_PAD, "brake.command=50 %")]),
    (COUPLED, WET, [(LEAKS,), ("rig.compensation=thermal",)]),
    (COUPLED, (*WET, FADING), [("rig.sensors=pole-wheel",), ("rig.topology=four-caliper",), (), (MOTORS,)]),
    (COUPLED, (*WET, "simulation.time_step=0.25 ms"), [(), ("brake.command=50 %",)]),
    (COUPLED, (*WET, "drag={speed: 8 km/h, duration: 0.7 s}"), [(), ()]),
    (COUPLED, (*WET, "until=6 km/h"), [("brake.command=50 %",), ()]),
    (COUPLED, WET, [(SANDER,), (), ("brake.command=60 %",), (OTHER,)]),
    (PIPED, CLEANED, [(), (SANDER,)]),
    (COUPLED, CLEANED, [()]),
    (PIPED, CLEANED, [(MAGNETS,), (MAGNETS, "brake.command=60 %")]),
)
ALL = range(2 * len(TRAINS))


class Trains:
    """Trains of all kinds from two speeds, and what each of them gives alone."""

    def __init__(self, rig):
        self.cases = [
            (coupling, [rig.case(*shared, *own, f"initial_speed={speed} km/h", f"seed={n}") for own in cars])
            for n, (coupling, shared, cars) in enumerate(TRAINS)
            for speed in (9, 20 + n)
        ]
        self.inputs = [assemble_train(cases, coupling) for coupling, cases in self.cases]
        self.alone = [run_coupled(cases, coupling) for coupling, cases in self.cases]

    def in_lanes(self, numbers, width=None):
        return run_trains_in_lanes([self.inputs[number] for number in numbers], width)

    def are_as_alone(self, numbers, width=None):
        return all(
            bits(stop) == bits_alone(self.alone[number])
            for number, stop in zip(numbers, self.in_lanes(numbers, width), strict=True)
        )


def bits(stop):
    return b"".join(each.tobytes() for each in (stop.measures, stop.wheelset_measures, stop.couplers))


def bits_alone(stop):
    measures = [np.array([car.measures for car in stop.cars])]
    measures += [car.wheelset_measures for car in stop.cars]
    return b"".join(each.tobytes() for each in (*measures, stop.couplers))


@pytest.fixture(name="trains", scope="module")
def _trains(rig):
    return Trains(rig)


def test_the_trains_differ_in_what_they_do(trains):
    ends = [[float(car.measures.end_time) for car in stop.cars] for stop in trains.alone]
    assert {len(times) for times in ends} == {1, 2, 4}
    assert max(max(times) - min(times) for times in ends) > 2.0
    assert max(max(times) for times in ends) > 2.0 * min(max(times) for times in ends)
    shares = [car.wheelsets["cleaned_share"].max() for stop in trains.alone for car in stop.cars]
    assert min(shares) == 0.0 < max(shares)


@pytest.mark.parametrize("width", [None, pytest.param(2, marks=pytest.mark.slow)])
def test_a_train_in_a_lane_has_the_bits_of_a_train_alone(trains, width):
    assert trains.are_as_alone(ALL, width)


@given(numbers=st.lists(st.sampled_from(ALL), max_size=20))
@settings(max_examples=10, suppress_health_check=[HealthCheck.function_scoped_fixture])
def test_neighbours_order_and_number_of_trains_do_not_matter(trains, numbers):
    assert trains.are_as_alone(numbers)


def test_a_train_of_one_car_has_the_bits_of_a_single_stop_in_lanes(trains):
    of_one = [number for number in ALL if len(trains.inputs[number].parameters) == 1]
    assert len(of_one) == 4
    inputs = [trains.inputs[number] for number in of_one]
    parameters, wheelsets = (
        np.concatenate([getattr(each, name) for each in inputs])
        for name in ("parameters", "wheelset_parameters")
    )
    batch = run_in_lanes(parameters, wheelsets, np.stack([each.rail for each in inputs]))
    for place, stop in enumerate(trains.in_lanes(of_one)):
        assert stop.measures.tobytes() == batch.measures[place].tobytes()
        assert stop.wheelset_measures.tobytes() == batch.wheelset_measures[place].tobytes()


def test_inputs_of_trains_are_only_read(trains):
    before = [[array.tobytes() for array in inputs] for inputs in trains.inputs]
    trains.in_lanes(ALL)
    assert [[array.tobytes() for array in inputs] for inputs in trains.inputs] == before


def test_the_compiler_is_loaded_only_for_trains():
    code = (
        "import sys; from uictest.rig import run_trains_in_lanes; "
        "sys.exit('numba' in sys.modules or 'llvmlite' in sys.modules or run_trains_in_lanes([]) != [])"
    )
    assert subprocess.run([sys.executable, "-c", code], check=False).returncode == 0
