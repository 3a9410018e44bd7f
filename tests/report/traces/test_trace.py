"""What the plots of a stop are drawn from: units, states, faults, vents, the band of repeated stops."""

import math
from dataclasses import replace

import numpy as np
import pytest
from hypothesis import given, strategies as st

from uictest.core.recording import Recording
from uictest.core.units import SIZES
from uictest.report.page.marks import fault_marks
from uictest.report.traces.quantities import (
    HOLD,
    PANELS,
    PLOT_QUANTITIES,
    STRIPS,
    VENT,
    channel_names,
    channel_title,
    shown_unit,
)
from uictest.report.traces.trace import (
    BINS,
    MOST_SAMPLES,
    FaultSpan,
    deceleration,
    extremes,
    fault_spans,
    slide,
    stop_extremes,
    thinned,
    trace_of,
    vent_cycles,
    with_band,
)

from ..builders import make_recording

SI = {"km/h": "m/s", "bar": "Pa", "kN": "N", "N m": "N m", "degC": "K", "%": "1", "m": "m", "1": "1"} | {
    "g/m": "kg/m"
}


@pytest.mark.parametrize("key", [key for key in PLOT_QUANTITIES if key != "deceleration"])
def test_every_quantity_of_the_page_has_its_unit_everywhere(key):
    quantity = PLOT_QUANTITIES[key]
    for name in channel_names(key):
        assert shown_unit(name, SI[quantity.unit]) == quantity.unit
    if quantity.scale != 1.0:
        assert quantity.scale == SIZES[quantity.unit]


@pytest.mark.parametrize(
    ("channel", "recorded", "shown", "title"),
    [
        ("caliper_force_2", "N", "kN", "Caliper force of wheelset 2"),
        ("demanded_pressure", "Pa", "bar", "Demanded pressure"),
        ("measured_speed_3", "m/s", "km/h", "Measured speed of wheelset 3"),
        ("air_temperature", "K", "degC", "Air temperature"),
        ("pad_friction_1", "1", "1", "Pad friction of wheelset 1"),
        ("lateral_acceleration", "m/s2", "m/s2", "Lateral acceleration"),
        ("brake_torque_1", "N m", "N m", "Brake torque of wheelset 1"),
        ("speed", "knot", "knot", "Speed"),
        ("channel_20", "1", "1", "channel_20"),
        ("MVB: v/ist", "1", "1", "MVB: v/ist"),
    ],
)
def test_other_channels_have_a_title_and_are_shown_in_the_units_of_the_page(channel, recorded, shown, title):
    assert (shown_unit(channel, recorded), channel_title(channel)) == (shown, title)


WHEELSETS = (1, 2, 3, 4)


def recorded(time, unit="1", metadata=None, **channels):
    """A record of some channels that share a unit; speeds are in m/s."""
    units = {"time": "s", **dict.fromkeys(channels, unit)}
    units |= {name: "m/s" for name in channels if "speed" in name}
    return Recording({"time": time, **channels}, units, metadata or {})


_SAMPLES = st.lists(st.integers(-50, 50) | st.none(), min_size=1, max_size=300)


@given(_SAMPLES, st.integers(1, 40))
def test_no_extreme_and_no_gap_of_a_column_is_lost(samples, width):
    y = np.array([np.nan if value is None else value for value in samples], dtype=float)
    columns = np.arange(len(y)) // width
    rows = extremes(columns.astype(float), y)
    assert np.array_equal(rows, np.unique(rows))
    for column in np.unique(columns):
        every, kept = y[columns == column], y[rows[columns[rows] == column]]
        assert np.isnan(every).any() == np.isnan(kept).any()
        if np.isfinite(every).any():
            assert (np.nanmin(kept), np.nanmax(kept)) == (np.nanmin(every), np.nanmax(every))


@given(_SAMPLES, st.integers(1, 400))
def test_a_thinned_series_keeps_its_ends_and_is_short(samples, bins):
    rows = thinned(np.array([np.nan if value is None else value for value in samples], dtype=float), bins)
    assert (rows[0], rows[-1]) == (0, len(samples) - 1)
    assert len(rows) <= 3 * bins + 2


def test_series_are_in_the_units_an_engineer_reads():
    curves = trace_of(make_recording(sliding_time="5.01")).curves
    largest = {"speed": 120.0, "slide_1": 40.0, "tank_pressure_4": 3.8, "clamping_force_2": 14.0}
    assert {name: np.nanmax(curves[name].y) for name in largest} == pytest.approx(largest)
    time = np.arange(10.0)
    hot = trace_of(recorded(time, "K", disc_surface_temperature_3=293.15 + 10.0 * time)).curves
    assert list(hot) == ["disc_surface_temperature_3"]
    assert hot["disc_surface_temperature_3"].y[[0, -1]] == pytest.approx([20.0, 110.0])


@pytest.mark.parametrize("samples", [1, 2, BINS, MOST_SAMPLES, MOST_SAMPLES + 1, 3 * MOST_SAMPLES])
def test_every_sample_is_drawn_and_of_a_long_record_the_extremes(samples):
    time = np.arange(samples) / 100
    trace = trace_of(recorded(time, speed=np.random.default_rng(1).normal(size=samples)))
    drawn = {len(curve.x) for curve in trace.curves.values()}
    assert drawn == {samples} if samples <= MOST_SAMPLES else max(drawn) <= 2 * (2 * BINS + 2)
    assert len({id(curve.x) for curve in trace.curves.values()}) == 1
    assert (trace.start, trace.end) == (time[0], time[-1])


def test_a_peak_of_a_single_sample_is_drawn_at_its_time():
    time = np.arange(2 * MOST_SAMPLES) / 100
    force = np.zeros_like(time)
    force[[1234, 5678]] = 9e3, -1e3
    curve = trace_of(recorded(time, "N", clamping_force_1=force)).curves["clamping_force_1"]
    drawn = dict(zip(curve.x.tolist(), curve.y.tolist(), strict=True))
    assert (drawn[time[1234]], drawn[time[5678]]) == (9.0, -1.0)


def test_every_change_of_a_valve_is_kept_however_long_the_record():
    time = np.arange(30 * BINS) / 100
    command = np.zeros_like(time)
    command[100::7], command[102::7] = 2, 1  # a vent of one sample, a fill, a hold of one, then fill
    trace = trace_of(recorded(time, valve_command_2=command))
    expected = len(command[100::7])
    assert len(trace.valve_spans(2, (VENT,))) == expected
    assert len(trace.valve_spans(2, (HOLD, VENT))) == pytest.approx(2 * expected, abs=1)
    assert trace.valve_spans(2, (VENT,))[0] == (1.0, 1.01)
    assert trace.valve_spans(1, (VENT,)) == []


@pytest.mark.parametrize(
    ("command", "held", "vented"),
    [
        # The hold magnet stays on while the vent magnet goes on and off; in no state where none was recorded.
        ([0, 1, 2, 2, 1, 0, 1, 1], [(1.0, 5.0), (6.0, 7.0)], [(2.0, 4.0)]),
        ([2, 2, np.nan, np.nan, 2, 2], [(0.0, 2.0), (4.0, 5.0)], [(0.0, 2.0), (4.0, 5.0)]),
    ],
)
def test_a_magnet_is_on_in_some_states_of_its_valve(command, held, vented):
    trace = trace_of(recorded(np.arange(float(len(command))), valve_command_3=np.array(command)))
    assert trace.valve_spans(3, (HOLD, VENT)) == held
    assert trace.valve_spans(3, (VENT,)) == vented


def test_a_slide_that_was_not_recorded_is_derived_and_missing_where_the_train_hardly_runs():
    whole = make_recording()
    channels = {name: samples for name, samples in whole.channels.items() if not name.startswith("slide")}
    trace = trace_of(Recording(channels, {name: whole.units[name] for name in channels}))
    assert np.nanmax(trace.curves["slide_1"].y) == pytest.approx(40.0)
    assert trace.derived == ("slide_1", "slide_2", "slide_3", "slide_4", "deceleration")
    assert trace_of(whole).derived == ("deceleration",)
    derived = slide(np.array([10.0, 0.5, np.nan]), np.array([5.0, 0.0, 1.0]))
    assert derived == pytest.approx([0.5, np.nan, np.nan], nan_ok=True)
    speed = np.array([3.0, 2.0, 1.5, 0.5, 0.0])
    record = recorded(np.arange(5.0), speed=speed, slide_1=np.where(speed > 1.0, 0.2, 0.0))
    shown = trace_of(record).curves["slide_1"].y
    assert shown == pytest.approx([20.0, 20.0, 20.0, np.nan, np.nan], nan_ok=True)


def test_the_deceleration_of_a_constant_brake_is_constant_to_the_ends_of_what_was_measured():
    time = np.linspace(0.0, 10.0, 1001)
    speed = 30.0 - 0.5 * 9.80665 * time
    assert deceleration(time, speed) == pytest.approx(0.5)
    assert np.isnan(deceleration(time, np.where(time < 5.0, speed, np.nan))[-1])
    # Averaged over half a second around each moment.
    begun = deceleration(time, 30.0 - 9.80665 * np.clip(time - 5.0, 0.0, None))
    assert begun[[475, 500, 525]] == pytest.approx([0.0, 0.5, 1.0])


@pytest.mark.parametrize(
    ("share", "rise", "drawn"),
    [(0.0, 0.0, set()), (0.3, 0.0, {"friction", "cleaned_share"}), (0.0, 0.01, {"friction"})],
)
def test_the_rail_is_drawn_only_where_sliding_has_cleaned_it_or_it_varies(share, rise, drawn):
    """Elsewhere the friction that a wheelset meets is what was set, and the share is nothing."""
    plain = make_recording()
    friction = 0.08 + 0.2 * share + rise * (plain["time"] > 0.0)
    of_rail = {f"friction_{n}": friction for n in WHEELSETS}
    of_rail |= {f"cleaned_share_{n}": np.full_like(plain["time"], share) for n in WHEELSETS}
    units = dict.fromkeys(of_rail, "1")
    record = Recording({**plain.channels, **of_rail}, {**plain.units, **units}, plain.metadata)
    of_both = set(trace_of(record).curves)
    assert of_both - set(trace_of(plain).curves) == {f"{name}_{n}" for name in drawn for n in WHEELSETS}


def test_each_fault_has_its_own_stretches_which_every_plot_shades():
    time = np.arange(0.0, 10.0, 0.1)
    lost, leak = "speed-sensor-lost-2", "brake-line-leak"
    bits = 1.0 * ((time >= 1.95) & (time < 3.95)) + 2.0 * (time >= 2.95) + 1.0 * (time >= 7.95)
    record = recorded(time, metadata={"faults": f"{lost}, {leak}"}, speed=30.0 - time, active_faults=bits)
    expected = [
        FaultSpan("speed sensor of wheelset 2: lost", 2.0, 4.0),
        FaultSpan("speed sensor of wheelset 2: lost", 8.0, 9.9),
        FaultSpan("brake line: leak", 3.0, 9.9),
    ]
    spans = fault_spans(record)
    assert [FaultSpan(each.label, round(each.start, 3), round(each.end, 3)) for each in spans] == expected
    marks = list(fault_marks(trace_of(record)))
    assert {mark.plot for mark in marks} == {plot.key for plot in (*PANELS, *STRIPS)}
    assert {mark.kind for mark in marks} == {"fault"}
    assert [mark.label for mark in marks if mark.label] == [f"fault: {each.label}" for each in expected]
    assert fault_spans(replace(record, metadata={})) == ()
    assert fault_spans(recorded(time, metadata={"faults": leak}, active_faults=0.0 * time)) == ()
    assert fault_spans(recorded(time, speed=30.0 - time)) == ()


TIME = np.arange(0.0, 10.0, 0.01)


def _cycles(**series):
    return vent_cycles(TIME, {name: np.asarray(samples, dtype=float) for name, samples in series.items()})


def _valve(*spans):
    return 2.0 * np.any([(start - 1e-9 <= TIME) & (end - 1e-9 > TIME) for start, end in spans], axis=0)


def test_a_vent_is_measured_from_its_start_to_the_next():
    pressure = 4.0 - np.clip(TIME - 2.0, 0.0, 1.0) + np.clip(TIME - 5.0, 0.0, 0.5)
    slides = 100.0 * np.interp(TIME, [0.0, 1.0, 3.0, 5.0], [0.0, 0.0, 0.4, 0.0])
    (one, other) = _cycles(
        valve_command_2=_valve((2.0, 3.0), (6.0, 6.2)), slide_2=slides, tank_pressure_2=pressure
    )
    # Back at 20 % at 4 s; its peak is at 3 s.
    assert one == pytest.approx((2, 2.0, 1.0, 20.0, 1.0, 2.0), abs=0.011)
    assert other[:3] == pytest.approx((2, 6.0, 0.2))
    assert other.drop == pytest.approx(0.0)


def test_what_is_not_recorded_or_not_back_in_time_has_no_number():
    (locked,) = _cycles(valve_command_1=_valve((2.0, 3.0)), slide_1=10.0 * TIME)
    assert math.isnan(locked.recovery)
    assert math.isnan(locked.drop)
    assert locked.slide == pytest.approx(20.0)
    slides = 100.0 * np.interp(TIME, [0.0, 2.0, 3.0, 4.0, 9.0], [0.0, 0.2, 0.5, 0.3, 0.0])
    (one, other) = _cycles(valve_command_1=_valve((2.0, 2.5), (4.0, 4.5)), slide_1=slides)
    assert math.isnan(one.recovery)
    assert other.recovery == pytest.approx(0.0)
    (cut,) = _cycles(valve_command_3=_valve((9.5, 20.0)))  # it ends with the record
    assert cut.start + cut.duration == pytest.approx(TIME[-1])
    assert math.isnan(cut.slide)
    assert _cycles(valve_command_1=np.zeros(len(TIME)), slide_1=np.zeros(len(TIME))) == ()


def test_vents_of_all_wheelsets_stand_in_the_order_of_their_starts():
    cycles = _cycles(valve_command_1=_valve((1.0, 2.0), (5.0, 6.0)), valve_command_4=_valve((3.0, 4.0)))
    assert [(round(cycle.start, 6), cycle.wheelset) for cycle in cycles] == [(1.0, 1), (3.0, 4), (5.0, 1)]
    vents = trace_of(make_recording()).vents
    assert [(vent.wheelset, round(vent.slide)) for vent in vents] == [(n, 40) for n in WHEELSETS]


def _stop(seed, samples, every=0.01):
    """A train that slows down, and a wheelset that slides in some other way under every seed."""
    time = every * np.arange(samples)
    time[-1] -= 0.4 * every  # the last sample is that of the standstill, wherever it lies
    speed = 30.0 * (1.0 - time / time[-1]) + 1e-3 * seed
    noise = np.random.default_rng(seed).uniform(0.5, 1.0, samples)
    return recorded(time, speed=speed, wheel_speed_1=speed * noise)


def _with_band(*stops):
    return with_band(trace_of(stops[0]), [stop_extremes(each) for each in stops])


@pytest.mark.parametrize("every", [0.01, 0.002, 0.03, 0.2])
@pytest.mark.parametrize("samples", [(901, 901, 901), (877, 951, 702), (1001, 803, 40)])
def test_no_sample_of_any_stop_lies_beyond_the_band(every, samples):
    stops = [_stop(seed, count, every) for seed, count in enumerate(samples)]
    trace = _with_band(*stops)
    for name in ("speed", "wheel_speed_1"):
        low, high = trace.band[name]
        assert (low.x[0], low.x[-1]) == (0.0, trace.end)
        for stop in stops:
            seen = stop["time"] <= trace.end
            time, value = stop["time"][seen], 3.6 * stop[name][seen]
            assert np.all(np.interp(time, low.x, low.y) <= value + 1e-9)
            assert np.all(value - 1e-9 <= np.interp(time, high.x, high.y))


def test_an_edge_is_where_some_stop_was_within_a_part_of_a_second():
    stops = [_stop(seed, count) for seed, count in enumerate((901, 851, 951))]
    low, high = _with_band(*stops).band["wheel_speed_1"]
    for x, lowest, highest in zip(low.x, low.y, high.y, strict=True):
        near = [stop["wheel_speed_1"][np.abs(stop["time"] - x) < 0.051] for stop in stops]
        values = 3.6 * np.concatenate(near)
        assert np.min(np.abs(values - lowest)) < 1e-9
        assert np.min(np.abs(values - highest)) < 1e-9


def test_beyond_the_end_of_a_shorter_stop_the_band_is_that_of_those_that_still_run():
    long, short = _stop(0, 901), _stop(1, 301)
    alone, both = (_with_band(*stops).band["wheel_speed_1"] for stops in ((long, long), (long, short)))
    behind = alone[0].x > short["time"][-1] + 0.06
    for edge, of_both in zip(alone, both, strict=True):
        assert np.array_equal(edge.y[behind], of_both.y[behind])
    assert both[0].y[~behind].min() < alone[0].y[~behind].min()


def test_the_band_depends_on_no_order_and_one_stop_has_none():
    trace, stops = trace_of(_stop(0, 901)), [stop_extremes(_stop(seed, 901 - 7 * seed)) for seed in range(4)]
    bands = [with_band(trace, each).band["speed"] for each in (stops, stops[::-1])]
    for edge, other in zip(*bands, strict=True):
        assert np.array_equal(edge, other)
    assert with_band(trace, stops[:1]) == trace
    assert (trace.band, trace.band_stops) == ({}, 0)
