"""Stops and trains in lanes give the bits of stops and trains one by one.

They stand in one file since most of what is compiled for lanes is the same for both.
"""

from concurrent.futures import ThreadPoolExecutor

import numpy as np
import pytest
from hypothesis import HealthCheck, given, settings, strategies as st

from uictest.rig.kernel.library import WIDTHS, processors
from uictest.rig.lanes import _longest_first, run_in_lanes, run_trains_in_lanes
from uictest.rig.model.parameters import PARAMETERS
from uictest.rig.model.rail import FRICTIONS, ROWS
from uictest.rig.train_stop import compiled_rig, run_to_end, stacked

from .trains_in_lanes import ALL as ALL_TRAINS, Trains

WET = ("rail.condition=wet", "rail.friction=0.09")
PLACES = "{position: 0 m, friction: 0.2}, {position: 9 m, friction: 0.04}"
TIMES = "{time: 0 s, factor: 1}, {time: 2 s, factor: 0.5}, {time: 3 s, factor: 1.5}"
STEPPED = f"rail.friction={{interpolation: steps, points: [{PLACES}]}}"
FADING = f"rail.friction_over_time={{points: [{TIMES}]}}"
UNALIKE = (
    "{1: {wheel_radius: 0.42 m, wsp_valve: {switching_delay: 31 ms, vent_conductance: 2e-8 m3/(s Pa)}},"
    " 2: {configured_radius: 0.44 m, brake_force: 80 %%, sensors: {speed: {teeth: 60}}},"
    " 3: {pad_friction: 0.3, %s sensors: {pressure: {offset: 0.1 bar}}},"
    " 4: {%s sensors: {loadcell: {gain_error: -3 %%}}}}"
)
WITH_TANKS = UNALIKE % ("", "")
WITH_CALIPERS = UNALIKE % ("caliper: {load_friction: 9 %},", "caliper: {coulomb_friction: 200 N},")
LIMITED = "rig.sensors={extends: standard, pressure: {range: 2 bar}, loadcell: {range: 6 kN}}"
FAULTS = (
    "faults=[{at: 0.4 s, wheelset: 2, part: speed-sensor, kind: stuck},"
    " {at: 8 km/h, until: 6 km/h, wheelset: 1, part: speed-sensor, kind: drop-out, value: 30 %},"
    " {at: 1 m, wheelset: 3, part: vent-valve, kind: blocked, value: 60 %},"
    " {at: 1 s, wheelset: 4, part: wsp-valve, kind: slow, value: 100 ms}]"
)
LEAKS = (
    "faults=[{at: 0.5 s, until: 2 s, wheelset: 2, part: tank, kind: leak, value: 1e-8 m3/(s Pa)},"
    " {at: 1 s, part: brake-line, kind: leak, value: 2e-8 m3/(s Pa)},"
    " {at: 1 s, until: 2 s, part: controller, kind: silent, value: 500 ms},"
    " {at: 1 s, wheelset: 3, part: brake, kind: cut-out}]"
)
TEETH = "faults=[{at: 1 s, wheelset: 2, part: speed-sensor, kind: missing-teeth, value: 3}]"
CLEANED = "rail.condition=wet-cleaning"
VARIED = "rail.variation={spread: 30 %, correlation_length: 5 m, left_right_correlation: 0}"
COURSE = (
    "brake.command=[{at: 0 s, value: 60 %}, {at: 0.4 s, value: 0 %}, {at: 1 s, value: 100 %, position: P}]"
)
MOTORS = "brake.dynamic={force: 60 kN, power: 1.6 MW, wheelsets: [1, 4]}"
FAILING = "faults=[{at: 2 s, part: dynamic-brake, kind: failed}]"
MAGNETS = "brake.track={attraction: 60 kN, when: always, delay: 0.3 s, cleaning: 10 %}"
LETTING_GO = "faults=[{at: 1 s, part: track-brake, kind: failed}]"
SANDERS = (
    "sanders=[{wheelset: 2, density: 7.5 g/m, when: always, off_below: 5 km/h, delay: 0.1 s},"
    " {wheelset: 4, rate: 2 kg/min, off_below: 0 km/h, delay: 0 s}]"
)
BLOCKED = "faults=[{at: 1.5 s, wheelset: 2, part: sander, kind: blocked}]"
VARIANTS = (
    (),
    ("rig.compensation=none", *WET),
    ("rig.compensation=cylinder", *WET),
    ("rig.compensation=hysteresis", *WET),
    ("rig.compensation=thermal", *WET),
    ("rig.topology=four-caliper", *WET),
    ("rig.wsp=bypassed", *WET),
    ("controller=slip-band", *WET),
    ("rail.condition=wet", STEPPED),
    ("rail.condition=wet", FADING),
    ("simulation.time_step=0.25 ms", *WET),
    ("vehicle=crh380a", "rail.gradient=10 permille"),
    ("brake.position=G", "brake.command=70 %"),
    (f"vehicle.wheelsets={WITH_TANKS}", *WET),
    ("rig.sensors=pole-wheel", f"vehicle.wheelsets={WITH_TANKS}", *WET),
    ("rig.topology=four-caliper", f"vehicle.wheelsets={WITH_CALIPERS}", *WET),
    (LIMITED, *WET),
    (LIMITED, "rig.topology=four-caliper", *WET),
    (LIMITED, "rig.compensation=thermal", *WET),
    ("rig.compensation=thermal", "rig.topology=four-caliper", *WET),
    (CLEANED, "rail.friction=0.05"),
    (CLEANED, "rail.friction=0.05", "vehicle=crh380a", "rail.condition.cleaning.carry_over=1"),
    (CLEANED, STEPPED, "rig.wsp=bypassed"),
    ("rail.condition=wet-curves", "rail.friction=0.06"),
    ("rail.condition=leaf-layer", "rail.condition.cleaning.spent=40 kJ/m", "rig.wsp=bypassed"),
    ("rail.condition=leaf-film", "rail.condition.cleaning.spent=180 kJ/m"),
    (VARIED, *WET),
    (VARIED, CLEANED, "rail.friction=0.05"),
    ("brake.pad=composite-block", *WET),
    ("brake.pad=disc-pad", "brake.initial_disc_temperature=240 degC"),
    ("brake.disc_temperature=modelled", *WET),
    (FAULTS, *WET),
    (LEAKS, *WET),
    (LEAKS, "rig.topology=four-caliper", "controller=slip-band", *WET),
    (TEETH, "rig.sensors=pole-wheel", *WET),
    (MOTORS, *WET),
    (MOTORS, "controller=slip-band", *WET),
    (COURSE, *WET),
    ("drag={speed: 8 km/h, duration: 0.7 s}", *WET),
    (COURSE, MOTORS, "until=4 km/h"),
    (MOTORS, FAILING, "rig.wsp=bypassed"),
    (MAGNETS, *WET),
    (MAGNETS, CLEANED, "rail.friction=0.05", LETTING_GO),
    (
        "brake.track={attraction: 100 kN, magnets: 4}",
        "brake.position=emergency",
        CLEANED,
        "brake.command=20 %",
    ),
    (SANDERS, *WET),
    (SANDERS, BLOCKED, CLEANED, "rail.friction=0.05"),
)

EVERY_WIDTH = [
    pytest.param(WIDTHS[level], marks=[pytest.mark.slow] if level != processors()[-1] else [])
    for level in processors()
]
"""The code without fused multiply-add, of two lanes, takes five times as long."""


class Batch:
    """Cases of all kinds and what each of them gives alone."""

    def __init__(self, rig):
        cases = [
            rig.inputs(*variant, f"initial_speed={speed} km/h", noise_key=number)
            for number, variant in enumerate(VARIANTS)
            for speed in (9, 24 + number)
        ]
        cases.append(rig.inputs(cycles=120))
        self.parameters, self.wheelsets, self.rail = stacked(cases)
        self.alone = [run_to_end(compiled_rig(), case) for case in cases]

    def in_lanes(self, numbers, width=None):
        chosen = list(numbers)
        inputs = (self.parameters[chosen], self.wheelsets[chosen], self.rail[chosen])
        return run_in_lanes(*inputs, width)

    def is_as_alone(self, numbers, batch):
        return all(
            batch.measures[place].tobytes() == self.alone[number].measures.tobytes()
            and batch.wheelset_measures[place].tobytes() == self.alone[number].wheelset_measures.tobytes()
            for place, number in enumerate(numbers)
        )


@pytest.fixture(name="batch", scope="module")
def _batch(rig):
    return Batch(rig)


ALL = range(2 * len(VARIANTS) + 1)


def test_the_cases_differ_in_what_they_do(batch):
    stopped = {float(outcome.measures.stopped) for outcome in batch.alone}
    slides = [outcome.wheelset_measures.maximum_slide.max() for outcome in batch.alone]
    assert stopped == {0.0, 1.0}
    assert min(slides) < 0.05
    assert max(slides) > 0.3
    assert sum(outcome.wheelset_measures.valve_actuations.sum() for outcome in batch.alone) > 20
    assert len(set(batch.parameters["steps_per_cycle"])) == 2


@pytest.mark.parametrize("width", EVERY_WIDTH)
def test_a_lane_of_any_number_of_them_gives_the_bits_of_a_stop_alone(batch, width):
    assert batch.is_as_alone(ALL, batch.in_lanes(ALL, width))


@given(numbers=st.lists(st.sampled_from(ALL), max_size=20))
@settings(max_examples=15, suppress_health_check=[HealthCheck.function_scoped_fixture])
def test_neighbours_order_and_number_do_not_matter(batch, numbers):
    assert batch.is_as_alone(numbers, batch.in_lanes(numbers))


def test_threads_run_batches_of_their_own_and_inputs_are_only_read(batch):
    inputs = (batch.parameters, batch.wheelsets, batch.rail)
    before = [each.tobytes() for each in inputs]
    batch.in_lanes(ALL)
    assert [each.tobytes() for each in inputs] == before
    shares = [ALL[first::3] for first in range(3)]
    with ThreadPoolExecutor(3) as pool:
        batches = list(pool.map(batch.in_lanes, shares))
    assert all(batch.is_as_alone(share, result) for share, result in zip(shares, batches, strict=True))


def test_stops_that_should_take_longest_begin_first():
    """From a high speed or on a slippery rail; a rail that is better than needed shortens none."""
    parameters, rail = np.zeros(4, PARAMETERS), np.zeros((4, ROWS, 2))
    parameters["initial_speed"] = 20.0, 20.0, 40.0, 20.0
    rail[:, FRICTIONS] = np.array([0.3, 0.06, 0.3, 0.2])[:, None]
    order = _longest_first(parameters, rail, np.array([0, 1, 2, 3]))
    assert order.tolist() == [1, 2, 0, 3]
    assert _longest_first(parameters, rail, np.array([0, 3, 1])).tolist() == [1, 0, 3]


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


@pytest.mark.parametrize("width", EVERY_WIDTH)
def test_a_train_in_a_lane_has_the_bits_of_a_train_alone(trains, width):
    assert trains.are_as_alone(ALL_TRAINS, width)


@given(numbers=st.lists(st.sampled_from(ALL_TRAINS), max_size=20))
@settings(max_examples=10, suppress_health_check=[HealthCheck.function_scoped_fixture])
def test_neighbours_order_and_number_of_trains_do_not_matter(trains, numbers):
    assert trains.are_as_alone(numbers)


def test_a_train_of_one_car_has_the_bits_of_a_single_stop_in_lanes(trains):
    of_one = [number for number in ALL_TRAINS if len(trains.inputs[number].parameters) == 1]
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
    def content():
        return [[array.tobytes() for array in inputs[:5]] for inputs in trains.inputs]

    before = content()
    trains.in_lanes(ALL_TRAINS)
    assert content() == before


def test_a_width_that_no_register_has_is_refused_and_no_trains_are_run(batch):
    assert run_trains_in_lanes([]) == []
    with pytest.raises(ValueError, match=r"^3 lanes: on this processor it is 2(, 4)?(, 8)?$"):
        batch.in_lanes([0], 3)
