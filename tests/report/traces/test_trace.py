import numpy as np
import pytest

from uictest.core.recording import Recording
from uictest.report.traces.quantities import HOLD, VENT
from uictest.report.traces.trace import BINS, MOST_SAMPLES, deceleration, slide, trace_of

from ..builders import make_recording


def test_series_are_in_the_units_an_engineer_reads():
    trace = trace_of(make_recording(sliding_time="5.01"))
    assert trace.curves["speed"].y[0] == pytest.approx(120.0)
    assert np.nanmax(trace.curves["slide_1"].y) == pytest.approx(40.0)
    assert trace.curves["tank_pressure_4"].y.max() == pytest.approx(3.8)
    assert trace.curves["clamping_force_2"].y.max() == pytest.approx(14.0)


def test_discs_are_drawn_in_degrees_where_their_temperature_is_recorded():
    time = np.arange(10.0)
    channels = {"time": time, "disc_surface_temperature_3": 293.15 + 10.0 * time}
    trace = trace_of(Recording(channels, {"time": "s", "disc_surface_temperature_3": "K"}))
    assert trace.curves["disc_surface_temperature_3"].y[[0, -1]] == pytest.approx([20.0, 110.0])
    assert list(trace.curves) == ["disc_surface_temperature_3"]


@pytest.mark.parametrize("samples", [1, 2, BINS, MOST_SAMPLES, MOST_SAMPLES + 1, 3 * MOST_SAMPLES])
def test_every_sample_is_drawn_and_of_a_long_record_the_extremes(samples):
    time = np.arange(samples) / 100
    noise = np.random.default_rng(1).normal(size=samples)
    trace = trace_of(Recording({"time": time, "speed": noise}, {"time": "s", "speed": "m/s"}))
    drawn = {len(curve.x) for curve in trace.curves.values()}
    assert drawn == {samples} if samples <= MOST_SAMPLES else max(drawn) <= 2 * (2 * BINS + 2)
    assert len({id(curve.x) for curve in trace.curves.values()}) == 1
    assert (trace.start, trace.end) == (time[0], time[-1])


def test_a_peak_of_a_single_sample_is_drawn_at_its_time():
    time = np.arange(2 * MOST_SAMPLES) / 100
    force = np.zeros_like(time)
    force[[1234, 5678]] = 9e3, -1e3
    units = {"time": "s", "clamping_force_1": "N"}
    curve = trace_of(Recording({"time": time, "clamping_force_1": force}, units)).curves["clamping_force_1"]
    drawn = dict(zip(curve.x.tolist(), curve.y.tolist(), strict=True))
    assert (drawn[time[1234]], drawn[time[5678]]) == (9.0, -1.0)


def valves(time, **command):
    """What is drawn of the commands of a valve."""
    return trace_of(Recording({"time": time, **command}, {"time": "s", **dict.fromkeys(command, "1")}))


def test_every_change_of_a_valve_is_kept_however_long_the_record():
    time = np.arange(30 * BINS) / 100
    command = np.zeros_like(time)
    command[100::7], command[102::7] = 2, 1  # a vent of one sample, a fill, a hold of one, then fill
    trace = valves(time, valve_command_2=command)
    expected = len(command[100::7])
    assert len(trace.valve_spans(2, (VENT,))) == expected
    assert len(trace.valve_spans(2, (HOLD, VENT))) == pytest.approx(2 * expected, abs=1)
    assert trace.valve_spans(2, (VENT,))[0] == (1.0, 1.01)
    assert trace.valve_spans(1, (VENT,)) == []
    gap = valves(np.arange(6.0), valve_command_1=np.array([2, 2, np.nan, np.nan, 2, 2]))
    assert gap.valve_spans(1, (VENT,)) == [(0.0, 2.0), (4.0, 5.0)]  # in no state where it was not recorded


def test_the_hold_magnet_stays_on_while_the_vent_magnet_goes_on_and_off():
    time = np.arange(8.0)
    command = np.array([0, 1, 2, 2, 1, 0, 1, 1])
    trace = valves(time, valve_command_3=command)
    assert trace.valve_spans(3, (HOLD, VENT)) == [(1.0, 5.0), (6.0, 7.0)]
    assert trace.valve_spans(3, (VENT,)) == [(2.0, 4.0)]


def test_a_slide_that_was_not_recorded_is_derived_and_said_to_be():
    whole = make_recording()
    channels = {name: samples for name, samples in whole.channels.items() if not name.startswith("slide")}
    trace = trace_of(Recording(channels, {name: whole.units[name] for name in channels}))
    assert np.nanmax(trace.curves["slide_1"].y) == pytest.approx(40.0)
    assert trace.derived == ("slide_1", "slide_2", "slide_3", "slide_4", "deceleration")
    assert trace_of(whole).derived == ("deceleration",)


def test_a_slide_is_missing_where_the_train_hardly_runs_and_where_its_speed_is():
    derived = slide(np.array([10.0, 0.5, np.nan]), np.array([5.0, 0.0, 1.0]))
    assert derived == pytest.approx([0.5, np.nan, np.nan], nan_ok=True)


def test_a_recorded_slide_at_rest_is_a_gap_in_its_line():
    speed = np.array([3.0, 2.0, 1.5, 0.5, 0.0])
    channels = {"time": np.arange(5.0), "speed": speed, "adhesion_1": np.full(5, 0.1)}
    channels["slide_1"] = np.where(speed > 1.0, 0.2, 0.0)
    units = {"time": "s", "speed": "m/s", "slide_1": "1", "adhesion_1": "1"}
    trace = trace_of(Recording(channels, units))
    assert trace.curves["slide_1"].y == pytest.approx([20.0, 20.0, 20.0, np.nan, np.nan], nan_ok=True)


def test_the_deceleration_of_a_constant_brake_is_constant_to_the_ends_of_what_was_measured():
    time = np.linspace(0.0, 10.0, 1001)
    speed = 30.0 - 0.5 * 9.80665 * time
    assert deceleration(time, speed) == pytest.approx(0.5)
    assert np.isnan(deceleration(time, np.where(time < 5.0, speed, np.nan))[-1])


@pytest.mark.parametrize(
    ("share", "rise", "drawn"),
    [(0.0, 0.0, set()), (0.3, 0.0, {"friction", "cleaned_share"}), (0.0, 0.01, {"friction"})],
)
def test_the_rail_is_drawn_only_where_sliding_has_cleaned_it_or_it_varies(share, rise, drawn):
    """Elsewhere the friction that a wheelset meets is what was set, and the share is nothing."""
    plain = make_recording()
    friction = 0.08 + 0.2 * share + rise * (plain["time"] > 0.0)
    of_rail = {f"friction_{n}": friction for n in (1, 2, 3, 4)}
    of_rail |= {f"cleaned_share_{n}": np.full_like(plain["time"], share) for n in (1, 2, 3, 4)}
    units = dict.fromkeys(of_rail, "1")
    record = Recording({**plain.channels, **of_rail}, {**plain.units, **units}, plain.metadata)
    curves = trace_of(record).curves
    assert {name for name in of_rail if name in curves} == {
        f"{each}_{n}" for each in drawn for n in range(1, 5)
    }
    assert set(trace_of(plain).curves) == set(curves) - set(of_rail)
