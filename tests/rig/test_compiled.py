"""Plain Python and compiled code give the same bits."""

from concurrent.futures import ThreadPoolExecutor
from types import SimpleNamespace

import numpy as np
import pytest

from uictest.controllers import CONTROLLERS
from uictest.core.measures import STOP_MEASURES, WHEELSET_MEASURES
from uictest.rig.model import controller as controllers
from uictest.rig.model.controller import CHOICES, decide
from uictest.rig.model.parameters import WHEELSET_PARAMETERS
from uictest.rig.model.rail import RAIL_MEMORY
from uictest.rig.model.records import TrainRecords
from uictest.rig.model.state import BOGIE, CAR, COUPLER, WHEELSET
from uictest.rig.model.trace import TRAIN_SAMPLE, Trace
from uictest.rig.model.train import run_train
from uictest.rig.train_stop import compiled_rig, empty_trace

from .plain_numbers import run_on_numbers

QUICK_BRAKE = {"dead_time": 0.0, "filling_rate": 20.0, "fill_conductance": 5e-7, "moving_speed": 0.5}
FAULTS = (
    "[{at: 0.3 s, until: 0.8 s, wheelset: 1, part: speed-sensor, kind: lost},"
    " {at: 29 km/h, wheelset: 2, part: speed-sensor, kind: stuck},"
    " {at: 2 m, wheelset: 3, part: speed-sensor, kind: missing-teeth, value: 5},"
    " {at: 0.2 s, wheelset: 4, part: speed-sensor, kind: jumps, value: 20 km/h},"
    " {at: 0 s, until: 1 s, wheelset: 1, part: tank, kind: leak, value: 1e-8 m3/(s Pa)},"
    " {at: 0.1 s, part: brake-line, kind: leak, value: 2e-8 m3/(s Pa)},"
    " {at: 0.2 s, until: 0.9 s, wheelset: 3, part: vent-magnet, kind: shorted},"
    " {at: 0.5 s, until: 0.7 s, part: controller, kind: silent, value: 100 ms}]"
)
"""Speed, distance and time, sensors, valves, leaks and silence."""
# Each setting takes other ways through the code, within few steps.
SETTINGS = {
    "standstill on a dry rail": (
        ("initial_speed=1.1 km/h", "rail.gradient=20 permille", "simulation.time_step=1 ms"),
        QUICK_BRAKE,
    ),
    "slides, vents and a lock on a slippery rail": (
        ("initial_speed=15 km/h", "rail.condition=wet", "rail.friction=0.03", "simulation.time_step=1 ms"),
        {**QUICK_BRAKE, "valve_delay_cycles": 1, "sounding_interval": 0.1, "cycles": 70},
    ),
    "four calipers and the slip-band controller": (
        ("rig.topology=four-caliper", "controller=slip-band", "rail.condition=wet", "rail.friction=0.04"),
        {**QUICK_BRAKE, "valve_delay_cycles": 0, "lower_slide": 0.02, "upper_slide": 0.05, "cycles": 30},
    ),
    "modelled air of modules that fill and vent": (
        ("rig.compensation=thermal", "initial_speed=20 km/h", "rail.condition=wet", "rail.friction=0.03"),
        {**QUICK_BRAKE, "valve_delay_cycles": 0, "cycles": 50},
    ),
    "pole wheels, wheelsets that differ": (
        (
            *("rig.sensors=pole-wheel", "rail.condition=wet", "rail.friction=0.04", "initial_speed=30 km/h"),
            "simulation.time_step=1 ms",
            (
                "vehicle.wheelsets={2: {wheel_radius: 0.42 m, brake_force: 80 %, pad_friction: 0.4}, 3:"
                " {sensors: {speed: {method: momentary, missing_teeth: 0}, pressure: {offset: 0.1 bar}}}}"
            ),
        ),
        {**QUICK_BRAKE, "cycles": 150},
    ),
    "pads that fade on discs that warm": (
        (
            *("brake.pad=disc-pad", "initial_speed=20 km/h", "brake.initial_disc_temperature=200 degC"),
            "simulation.time_step=1 ms",
        ),
        {**QUICK_BRAKE, "cycles": 60},
    ),
    "motors that fade out and drop": (
        (
            *("brake.dynamic={force: 60 kN, power: 400 kW, wheelsets: [2, 3]}", "initial_speed=14 km/h"),
            *("rail.condition=wet", "rail.friction=0.05", "simulation.time_step=1 ms"),
            "controller=slip-band",
        ),
        {**QUICK_BRAKE, "cycles": 90},
    ),
    "motors that are reduced": (
        (
            *("brake.dynamic={force: 60 kN, power: 400 kW, wheelsets: [2, 3]}", "initial_speed=30 km/h"),
            *("rail.condition=wet", "rail.friction=0.05", "simulation.time_step=1 ms"),
        ),
        {**QUICK_BRAKE, "cycles": 90},
    ),
    "magnets that come, clean and let go": (
        (
            "brake.track={attraction: 60 kN, when: always, delay: 50 ms, off_below: 13 km/h, cleaning: 50 %}",
            *("rail.condition=wet-cleaning", "initial_speed=14 km/h", "simulation.time_step=1 ms"),
        ),
        {**QUICK_BRAKE, "cycles": 90},
    ),
    "a brake that is released and applied again, until 12 km/h": (
        (
            "brake.command=[{at: 0 s, value: 60 %}, {at: 0.3 s, value: 0 %}, {at: 0.6 s, value: 100 %}]",
            *("initial_speed=14 km/h", "until=12 km/h", "simulation.time_step=1 ms"),
            "drag={speed: 13.5 km/h, duration: 0.2 s}",
        ),
        {**QUICK_BRAKE, "cycles": 130},
    ),
    "composite blocks on discs that stay cold": (
        ("brake.pad=composite-block", "initial_speed=20 km/h", "rail.condition=wet", "rail.friction=0.05"),
        {**QUICK_BRAKE, "cycles": 40},
    ),
    "no compensation, WSP bypassed, downhill": (
        ("rig.compensation=none", "rig.wsp=bypassed", "rail.gradient=-30 permille", "seed=4294967295"),
        {**QUICK_BRAKE, "cycles": 20},
    ),
    "wheelsets that follow on a rail that is cleaned": (
        ("initial_speed=120 km/h", "rail.condition=wet-cleaning", "rail.friction=0.005"),
        {**QUICK_BRAKE, "cycles": 60},
    ),
    "a rail that varies at random, on slippery rail": (
        (
            *("initial_speed=120 km/h", "rail.condition=wet-cleaning", "rail.friction=0.01"),
            "rail.variation={spread: 40 %, correlation_length: 1 km, left_right_correlation: 0.5}",
        ),
        {**QUICK_BRAKE, "cycles": 40},
    ),
    "sanders on a rail that is cleaned": (
        (
            *("initial_speed=120 km/h", "rail.condition=wet-cleaning", "rail.friction=0.005"),
            (
                "sanders=[{wheelset: 1, rate: 2 kg/min, when: always, delay: 50 ms},"
                " {wheelset: 3, density: 7.5 g/m, delay: 20 ms, sliding_time: 50 ms}]"
            ),
        ),
        {**QUICK_BRAKE, "valve_delay_cycles": 0, "cycles": 60},
    ),
    "faults of every part, each for a while": (
        (
            *("rig.sensors=pole-wheel", "rail.condition=wet", "rail.friction=0.04", "initial_speed=30 km/h"),
            "simulation.time_step=1 ms",
            f"faults={FAULTS}",
        ),
        {**QUICK_BRAKE, "cycles": 150},
    ),
}


LAYOUTS = {
    "cars": CAR,
    "bogies": BOGIE,
    "wheelsets": WHEELSET,
    "memories": RAIL_MEMORY,
    "measures": STOP_MEASURES,
    "wheelset_measures": WHEELSET_MEASURES,
}
COUNTS = {"bogies": 2, "wheelsets": 4, "wheelset_measures": 4}


def records_of(inputs):
    """The records of a stop that has not begun."""
    return TrainRecords(
        **{name: np.zeros(COUNTS.get(name, 1), layout) for name, layout in LAYOUTS.items()},
        parameters=np.array([inputs.parameters]),
        wheelset_parameters=inputs.wheelset_parameters,
        distances=np.zeros(1),
        couplers=np.zeros(0, COUPLER),
        rail=inputs.rail,
    )


def everything(run, inputs, every):
    """Bytes of all records and of the trace after a stop."""
    train, p = records_of(inputs), inputs.parameters
    trace = empty_trace(1, p.cycles * p.steps_per_cycle + 1 if every else 0)
    for samples in trace:
        samples[...] = 0.0
    run(train, trace, every)
    return {name: getattr(train, name).tobytes() for name in LAYOUTS} | {
        "trace": trace.train.tobytes() + trace.wheelsets.tobytes()
    }


def fields_that_differ(layout, one, other):
    a, b = (np.frombuffer(data, layout) for data in (one, other))
    return [name for name in layout.names or () if a[name].tobytes() != b[name].tobytes()]


@pytest.mark.parametrize("setting", SETTINGS)
def test_plain_and_compiled_code_give_the_same_bits(rig, setting):
    """In every field of every record, and in every sample."""
    overrides, fields = SETTINGS[setting]
    if "cycles" not in fields:
        fields = {**fields, "cycles": 200}
    inputs = rig.inputs(*overrides, **fields)
    as_it_is = setting == "standstill on a dry rail"
    plain = everything(run_train if as_it_is else run_on_numbers(run_train), inputs, 1)
    compiled = everything(compiled_rig(), inputs, 1)
    for name, layout in LAYOUTS.items():
        assert fields_that_differ(layout, plain[name], compiled[name]) == []
    assert plain == compiled


def test_the_settings_reach_what_they_say(rig):
    """Standstill, venting and locks happen within the short stops that are compared."""
    ends = {name: rig.stop(*overrides, **fields) for name, (overrides, fields) in SETTINGS.items()}
    standstill, slides, band, air, counted, fading, motors, reduced, magnets, again, *others = ends.values()
    blocks, downhill, cleaned, varied, sanded, faulty = others
    assert standstill.measures.stopped == 1.0
    assert slides.wheelset_measures.valve_actuations.all()
    assert slides.wheelset_measures.locked_time.any()
    assert band.wheelset_measures.valve_actuations.any()
    assert air.wheelset_measures.valve_actuations.all()
    assert air.wheelsets["modelled_travel"].max() == 1.0
    assert abs(air.wheelsets["pressure_ratio"][1:] - 1.0).min() > 1e-4
    assert counted.wheelset_measures.valve_actuations.any()
    assert counted.wheelsets["last_tooth"].min() > 10.0
    for pads in (fading, blocks):
        assert 0.005 < abs(pads.wheelsets["pad_friction"] - 0.38).min() < 0.2
    assert (fading.wheelset_measures.maximum_disc_temperature > 473.2).all()
    assert (motors.wheelsets["dynamic_energy"] > 0.0).tolist() == [False, True, True, False]
    assert (motors.car.dynamic_dropped, reduced.car.dynamic_dropped) == (1.0, 0.0)
    assert reduced.wheelsets["dynamic_reduction"][1:3].max() > 0.0
    assert magnets.measures.track_brake_energy > 0.0
    assert magnets.car.magnet_share == 0.0
    assert magnets.wheelsets["cleaned_share"][1] > magnets.wheelsets["cleaned_share"][0]
    assert again.car.command_place == 2
    assert again.car.stopped == 1.0
    assert again.measures.end_speed < 12.0 / 3.6
    assert downhill.measures.end_speed > 0.0
    assert cleaned.wheelsets["cleaned_share"].min() > 0.01
    assert cleaned.car.position > 4.0 * rig.parameters()[0].half_wheelbase
    assert (sanded.wheelset_measures.sand_laid[::2] > 0.0).all()
    assert (sanded.wheelsets["sand_density"] > 0.0).all()
    assert len({*varied.wheelsets["rail_factor"]}) == 4
    assert faulty.car.begun_faults == 0b1111_1111
    assert faulty.car.ended_faults == 0b1101_0001
    assert faulty.car.leaked_air > 0.0
    assert (faulty.wheelset_measures.faulty == 1.0).all()
    used = {CHOICES[rig.inputs(*overrides).parameters.controller].name for overrides, _ in SETTINGS.values()}
    assert used == CONTROLLERS.keys()


@pytest.mark.parametrize("number", range(len(CHOICES)), ids=[each.name for each in CHOICES])
def test_the_number_of_a_controller_chooses_it(number, monkeypatch):
    called = []
    noting = [SimpleNamespace(decide=lambda *_, name=each.name: called.append(name)) for each in CHOICES]
    monkeypatch.setattr(controllers, "CHOICES", noting)
    decide(None, None, SimpleNamespace(controller=number))
    assert called == [CHOICES[number].name]


SLIDING = ("rail.condition=wet", "rail.friction=0.08", "initial_speed=60 km/h")


@pytest.mark.parametrize("overrides", [SLIDING, (*SLIDING, "rail.condition=wet-cleaning")])
def test_recording_changes_nothing(rig, overrides):
    """The same bits without a recording and at several rates, one of them no divisor of the cycle."""
    first, *others = (rig.stop(*overrides, every=every) for every in (0, 1, 7, 20, 200))
    for other in others:
        for record in ("car", "wheelsets", "measures", "wheelset_measures"):
            assert getattr(other, record).tobytes() == getattr(first, record).tobytes()


def test_a_sparse_trace_is_part_of_a_dense_one(rig):
    dense, sparse = (rig.stop(*SLIDING, every=every).trace for every in (1, 7))
    for one, other in zip(dense, sparse, strict=True):
        np.testing.assert_array_equal(one[::7], other)


def test_threads_do_not_disturb_each_other(rig):
    """The same stop in six places, and others beside it."""
    cases = [rig.inputs(*SLIDING, f"rail.friction={mu}") for mu in (0.08, 0.05, 0.08, 0.12, 0.08)]
    compiled = compiled_rig()
    with ThreadPoolExecutor(4) as threads:
        jobs = [threads.submit(everything, compiled, inputs, 0) for inputs in cases * 2]
        ends = [job.result() for job in jobs]
    assert ends[0] == ends[2] == ends[4] == ends[5] == ends[7] == ends[9]
    assert ends[1] == ends[6] != ends[0]


def test_seed_and_case_change_the_noise_and_nothing_else_does(rig):
    speeds = [
        rig.columns(*SLIDING, f"seed={seed}", noise_key=key)["measured_speed"][1]
        for seed, key in ((0, 1), (0, 1), (1, 1), (0, 2))
    ]
    assert speeds[0].tobytes() == speeds[1].tobytes()
    assert np.all(speeds[0] != speeds[2])
    assert np.all(speeds[0] != speeds[3])


@pytest.mark.parametrize(
    ("name", "other"),
    {
        "cars": np.zeros(1, WHEELSET),
        "wheelsets": np.zeros(2, WHEELSET),
        "wheelset_parameters": np.zeros(1, WHEELSET_PARAMETERS),
        "wheelset_measures": np.zeros(8, WHEELSET_MEASURES)[::2],
        "rail": np.zeros((4, 2), np.float32),
        "couplers": np.zeros(1, COUPLER),
        "trace": Trace(np.zeros((1, 0), TRAIN_SAMPLE), np.zeros((1, 0, 4), TRAIN_SAMPLE)),
    }.items(),
)
def test_another_layout_is_refused(rig, name, other):
    """Machine code would read and write beyond it."""
    train, trace = records_of(rig.inputs(cycles=1)), empty_trace(1, 0)
    refused = (train, other) if name == "trace" else (train._replace(**{name: other}), trace)
    with pytest.raises(TypeError, match="contiguous"):
        compiled_rig()(*refused, 0)
    assert compiled_rig()(train, trace, 0) == 0
