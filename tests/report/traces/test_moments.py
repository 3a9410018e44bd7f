from dataclasses import replace
from pathlib import Path

import numpy as np
import pytest

from uictest.core.measures import MEASURES, wheelset_column_values
from uictest.core.recording import Recording
from uictest.core.units import in_unit
from uictest.judging.evaluation import AppliedDefinition
from uictest.plans.scenario import load
from uictest.report.page.marks import marks_of
from uictest.report.traces.instants import taken_at
from uictest.report.traces.moments import TRAIN, Moments, duration, moments_of
from uictest.report.traces.quantities import PANELS, STRIPS
from uictest.report.traces.trace import trace_of
from uictest.rig import simulate

from ..builders import make_recording, make_verdict

DEFINED = {"locked_speed": 0.1, "moving_speed": 10 / 3.6, "low_speed_cutoff": 30 / 3.6, "end_speed": 60 / 3.6}
DEFINED |= {"sliding_slide": 0.05, "sliding_slip": 0.3, "sliding_below": 0.9, "deceleration_filter": 0.5}
DEFINED |= {"rising_share": 0.05, "developed_share": 0.95, "reduced_share": 0.9, "released_share": 0.2}
DEFINED |= {"developed_time": 2.0, "first_phase_duration": 3.0}
DEFINED |= {"monitored_speed": 50 / 3.6, "monitored_share": 0.3}


def _verdict(measure, value=None, **definitions):
    applied = tuple(AppliedDefinition(name, number, "", "chosen") for name, number in definitions.items())
    unit = MEASURES[measure].unit
    return make_verdict(id="it", measure=measure, unit=unit, value=value, definitions=applied)


TIMES = [
    name
    for name, measure in MEASURES.items()
    if measure.kind == "time" and measure.decided and measure.decided.how in ("intervals", "longest")
]


@pytest.fixture(scope="module")
def faulty_stop():
    """A stop on a slippery rail in which a speed sensor fails, sampled in every cycle."""
    path = Path(__file__).parents[3] / "examples" / "faults" / "slip-120-with-fault.yaml"
    motors = "brake.dynamic={force: 60 kN, power: 1.6 MW}"
    sanders = ", ".join(f"{{wheelset: {n}, rate: {n} kg/min, sliding_time: {n} s}}" for n in (1, 2, 3, 4))
    without_effect = [f"sanders=[{sanders}]", "rail.sand.friction=0.001"]
    changes = ["brake.pad=disc-pad", motors, "controller=slip-band", *without_effect]
    (case,) = load([path], overrides=changes)
    return simulate(case, record_every=0.01)


@pytest.fixture(scope="module")
def reported(faulty_stop):
    """The recording of the stop with a diagnosis: of wheelset 2, whose sensor fails at 5 s, from 8 s on, of
    wheelset 4 from 9 s on."""
    recording = faulty_stop.recording
    time, bits = recording["time"], np.zeros(len(recording["time"]))
    bits[time >= 8.0] = 0b0010
    bits[time >= 9.0] = 0b1010
    channels = {**recording.channels, "diagnosis": bits}
    return Recording(channels, {**recording.units, "diagnosis": "1"}, recording.metadata)


def test_every_measure_says_when_it_is_decided_and_where_that_is_shown():
    plots = {plot.key for plot in (*PANELS, *STRIPS)}
    decided = {name: measure.decided for name, measure in MEASURES.items()}
    assert {own.plot for own in decided.values() if own is not None} <= plots
    # Neither what the rail would have allowed nor how far the rig is from that which its compensation was
    # identified for is seen in the samples of a stop.
    undecided = {name for name, own in decided.items() if own is None}
    assert undecided == {"reference_distance", "compensation_misfit"}


@pytest.mark.parametrize(
    ("measure", "wheelset", "start", "end"),
    [("report_time", 2, 5.0, 8.0), ("required_report_time", 2, 5.0, 8.0), ("false_reports", 4, 9.0, None)],
)
def test_a_report_is_late_from_the_fault_to_the_first_that_says_so_and_a_false_one_to_the_end(
    reported, measure, wheelset, start, end
):
    moments = moments_of([_verdict(measure, 3.0, **DEFINED)], reported)["it"]
    assert moments.intervals.keys() == {wheelset}
    last = reported["time"][-1] if end is None else end
    assert moments.intervals[wheelset] == [pytest.approx((start, last), abs=0.021)]
    assert measure == "false_reports" or moments.wheelset == wheelset


@pytest.mark.parametrize("measure", [name for name, measure in MEASURES.items() if measure.decided])
def test_a_criterion_is_drawn_whatever_it_measures(faulty_stop, reported, measure):
    record = reported if measure == "false_reports" else faulty_stop.recording
    verdict = replace(_verdict(measure, 1.0, **DEFINED), status="fail")
    trace = trace_of(record, [verdict], _reported(faulty_stop))
    taken, marks = taken_at(verdict, trace), marks_of([verdict], trace)
    assert 0.0 <= taken.start <= taken.end <= record["time"][-1]
    assert any(mark.x0 is not None or mark.y is not None for mark in marks)


def _reported(stop):
    return [wheelset_column_values(wheelset) for wheelset in stop.wheelset_measures]


@pytest.mark.parametrize("measure", [name for name, measure in MEASURES.items() if measure.of_wheelsets])
def test_the_wheelset_that_has_the_value_is_found_whichever_measure_is_judged_alone(faulty_stop, measure):
    """What a measure reads of the records was fed, or comes from the result: air and what the rail offers."""
    record, own = faulty_stop.recording, MEASURES[measure]
    values = own.read(faulty_stop.measures, faulty_stop.wheelset_measures, DEFINED).values
    for wheelset in (values.index(max(values)) + 1, values.index(min(values)) + 1):
        verdict = _verdict(measure, in_unit(values[wheelset - 1], own.unit), **DEFINED)
        moments = moments_of([verdict], record, _reported(faulty_stop))["it"]
        assert moments.wheelset == wheelset


def test_without_the_wheelset_that_decides_no_place_is_shown(faulty_stop):
    """The vents of all wheelsets together are no place at which one of them vented its air."""
    record = faulty_stop.recording
    verdict = replace(_verdict("air_vented", 1.0), status="fail")
    assert taken_at(verdict, trace_of(record, [verdict])) is None
    vented = [own["air_vented_nl"] for own in _reported(faulty_stop)]
    wheelset = vented.index(max(vented)) + 1
    verdict = replace(verdict, value=max(vented))
    trace = trace_of(record, [verdict], _reported(faulty_stop))
    taken = taken_at(verdict, trace)
    assert taken is not None
    assert taken.wheelset == wheelset
    [interval] = trace.moments["it"].intervals[wheelset]
    assert (taken.start, taken.end) == interval
    [labelled] = [mark.wheelset for mark in marks_of([verdict], trace) if mark.label]
    assert labelled == wheelset


@pytest.mark.parametrize("measure", TIMES)
def test_the_intervals_of_a_duration_last_as_long_as_the_rig_measured(faulty_stop, measure):
    record, own = faulty_stop.recording, MEASURES[measure]
    values = own.read(faulty_stop.measures, faulty_stop.wheelset_measures, DEFINED).values
    value = max(values)
    moments = moments_of([_verdict(measure, value, **DEFINED)], record)["it"]
    assert moments.wheelset is not None
    lengths = [duration(each) for each in moments.intervals[moments.wheelset]]
    longest = own.decided is not None and own.decided.how == "longest"
    assert value > 0.0
    assert (max(lengths) if longest else sum(lengths)) == pytest.approx(value)


@pytest.mark.parametrize(
    ("measure", "unit"),
    [
        ("maximum_slide_above_cutoff", "%"),
        ("maximum_clamping_force", "kN"),
        ("maximum_disc_temperature", "degC"),
        ("minimum_deceleration", "g"),
        ("maximum_deceleration", "g"),
        ("reservoir_minimum_pressure", "bar"),
    ],
)
def test_an_extreme_is_as_high_as_the_rig_measured(faulty_stop, measure, unit):
    record = faulty_stop.recording
    values = MEASURES[measure].read(faulty_stop.measures, faulty_stop.wheelset_measures, DEFINED).values
    moments = moments_of([_verdict(measure, 1.0, **DEFINED)], record)["it"]
    assert [height for _, height in moments.extremes.values()] == pytest.approx(
        [in_unit(value, unit) for value in values]
    )


def test_a_lock_of_a_few_samples_is_found_and_a_slide_and_a_pressure_where_they_count():
    record = make_recording(34_001)
    record["wheel_speed_2"][20_000:20_003] = 0.0
    lock = _verdict("longest_lock", moving_speed=2.0, locked_speed=0.1)
    [(wheelset, intervals)] = moments_of([lock], record)["it"].intervals.items()
    assert wheelset == 2
    # From the sample before the lock to its last, as the measure counts it.
    assert intervals == [(pytest.approx(19.999), pytest.approx(20.002))]
    # The largest slide counts above the cut-off only.
    record = make_recording()
    record["wheel_speed_1"][(record["time"] > 30.0)] *= 0.1
    slide = _verdict("maximum_slide_above_cutoff", low_speed_cutoff=30 / 3.6, moving_speed=10 / 3.6)
    moments = moments_of([slide], record)["it"]
    time, value = moments.extremes[1]
    assert 5.0 < time < 15.0
    assert value == pytest.approx(40.0)
    assert moments.span == (0.0, pytest.approx(25.0, abs=0.011))
    # A pressure that only rises is lowest at the beginning.
    record["reservoir_pressure"][:] = 7e5 + 1e3 * record["time"]
    moments = moments_of([_verdict("reservoir_minimum_pressure")], record)["it"]
    assert moments.extremes == {TRAIN: (0.0, pytest.approx(7.0))}


def test_what_is_not_defined_or_not_recorded_has_no_moments():
    time = np.linspace(0.0, 1.0, 11)
    lock = _verdict("longest_lock")
    phase = _verdict("initial_adhesion")
    units = {"time": "s", "speed": "m/s"}
    assert moments_of([lock], Recording({"time": time, "speed": 1.0 - time}, units)) == {"it": Moments()}
    assert moments_of([phase], Recording({"time": time, "speed": 1.0 - time}, units)) == {}
    assert moments_of([lock], Recording({"time": time}, {"time": "s"})) == {}


def test_a_gap_in_the_demanded_pressure_hides_no_build_up(faulty_stop):
    record = faulty_stop.recording
    build_up = _verdict("build_up_time", **DEFINED)
    whole = moments_of([build_up], record)["it"]
    assert whole.span is not None
    demanded = record["demanded_pressure"].copy()
    for gap in (slice(200, 300), slice(None)):
        demanded[gap] = np.nan
        channels = {**record.channels, "demanded_pressure": demanded.copy()}
        moments = moments_of([build_up], replace(record, channels=channels))["it"]
        assert moments == (whole if np.isfinite(demanded).any() else Moments())
