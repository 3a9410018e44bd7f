"""Every defect, made in a simulated stop: found, named, and never bridged."""

import re
from dataclasses import replace

import numpy as np
import pytest

from uictest.recorded.field_data import UnusableError
from uictest.recorded.field_data.raw_channels import MapError

from .conftest import judge_stop, kept


def _kinds(stop):
    return {(defect.kind, defect.channel) for defect in stop.defects}


def _reasons(case, stop):
    return {v.id: v.reason for v in judge_stop(case, stop).criteria if v.status == "inconclusive"}


def _change(channels, name, samples):
    channels[name] = replace(channels[name], samples=samples)


@pytest.mark.parametrize(
    ("kind", "damage"),
    [
        ("time-missing", lambda time: time.__setitem__(50, np.nan)),
        ("time-backwards", lambda time: time.__setitem__(slice(50, 52), time[[51, 50]])),
        ("time-duplicate", lambda time: time.__setitem__(50, time[49])),
    ],
)
def test_a_sound_record_has_no_defect_and_one_without_a_time_axis_is_unusable(
    channels, prepared, kind, damage
):
    assert prepared(channels).defects == ()
    time = channels["speed"].time.copy()
    damage(time)
    with pytest.raises(UnusableError) as caught:
        prepared({name: replace(channel, time=time) for name, channel in channels.items()})
    assert kind in [defect.kind for defect in caught.value.defects]
    assert kind in str(caught.value)


def test_a_gap_in_all_channels_leaves_no_integrated_distance(case, channels, prepared):
    time = channels["speed"].time
    stop = prepared(kept(channels, (time < 3.0) | (time > 3.805)))
    assert [defect.kind for defect in stop.defects] == ["gap"]
    assert "from 2.99 to 3.81 s" in str(stop.defects[0])
    reasons = _reasons(case, stop)
    assert "wheel_speed_1 is not known from 3 to 3.8 s" in reasons["locked-wheels"]
    assert "standstill" not in reasons
    del channels["distance"]
    result = judge_stop(case, prepared(kept(channels, (time < 3.0) | (time > 3.805))))
    assert np.isnan(result.measures["braking_distance_m"])
    assert np.isfinite(result.measures["braking_time_s"])


def _between(first, last, value):
    """Set samples to a value."""
    return lambda samples: np.concatenate((samples[:first], np.full(last - first, value), samples[last:]))


@pytest.mark.parametrize(
    ("name", "damage", "kind", "text"),
    [
        ("tank_pressure_4", lambda samples: 0.0 * samples, "stuck", ""),
        ("wheel_speed_4", lambda samples: 1.03 * samples, "offset", "+3.0 % from the train before it brakes"),
        ("speed", lambda samples: 1.06 * samples, "offset", ""),
        ("cylinder_pressure_2", lambda samples: samples + 0.4e5, "offset", ""),
        ("distance", lambda samples: 0.5 * samples, "contradiction", "by its speed the train runs"),
        ("distance", lambda samples: -samples, "contradiction", "grows by -"),
        ("valve_command_1", lambda samples: samples + 7.0, "out-of-range", "none of the states 0, 1, 2"),
        ("valve_command_3", lambda samples: samples + 0.4, "out-of-range", "none of the states 0, 1, 2"),
    ],
)
def test_a_damaged_channel_is_the_only_one_that_is_named(channels, prepared, name, damage, kind, text):
    _change(channels, name, damage(channels[name].samples))
    stop = prepared(channels)
    told = {("contradiction", "distance")} if name == "speed" else set()
    assert _kinds(stop) == {(kind, name)} | told
    assert text in str(stop.defects[0])


@pytest.mark.parametrize(
    ("damage", "kind", "reason"),
    [
        (_between(200, 210, np.nan), "not-a-number", "wheel_speed_2 is not known from 2 to 2.09 s"),
        (
            _between(100, 104, 0.0),
            *("dropout", "dropout: wheel_speed_2 falls and returns at once, 1 times from 1 to 1.03 s"),
        ),
    ],
)
def test_wheels_that_are_not_known_for_a_while_may_have_locked(
    case, channels, prepared, damage, kind, reason
):
    _change(channels, "wheel_speed_2", damage(channels["wheel_speed_2"].samples))
    stop = prepared(channels)
    assert _kinds(stop) == {(kind, "wheel_speed_2")}
    assert reason in _reasons(case, stop)["locked-wheels"]


@pytest.mark.parametrize("last", [104, 250, None])
def test_a_dropout_of_the_train_speed_is_no_standstill(case, channels, prepared, last):
    standstill = prepared(channels).standstill
    samples = channels["speed"].samples.copy()
    samples[100:last] = 0.0
    _change(channels, "speed", samples)
    stop = prepared(channels)
    assert ("dropout", "speed") in _kinds(stop)
    if last == 104:
        assert stop.standstill[0] == standstill[0]
    else:
        assert judge_stop(case, stop).outcome == "inconclusive"


@pytest.mark.parametrize("choices", [{"trigger_time": "4 s"}, {"trigger": "start"}])
def test_a_brake_command_at_rest_is_refused(channels, prepared, choices):
    _change(channels, "speed", np.minimum(channels["speed"].samples, 1.3))
    with pytest.raises(MapError, match=r"4\.68 km/h there, not above the 5 km/h"):
        prepared(channels, {}, **choices)


@pytest.mark.parametrize("name", ["speed", "wheel_speed_1"])
def test_a_stuck_speed(channels, prepared, name):
    samples = channels[name].samples.copy()
    samples[100:200] = samples[100]
    _change(channels, name, samples)
    assert ("stuck", name) in _kinds(prepared(channels))


@pytest.mark.parametrize("step_kmh", [0.2, 0.5, 1.0])
def test_a_coarse_sensor_of_a_wheel_that_turns_from_slide_to_recovery_is_not_stuck(
    channels, prepared, step_kmh
):
    """It stays within a step for longer than a fine one would show one number; to the end is too long."""
    channel, step = channels["wheel_speed_1"], step_kmh / 3.6
    since = channel.time - channel.time[150]
    turning = np.where(np.abs(since) < 1.0, channel.samples[150] + 0.8 * since**2, channel.samples)
    coarse = step * np.round(turning / step)
    _change(channels, "wheel_speed_1", coarse)
    assert ("stuck", "wheel_speed_1") not in _kinds(prepared(channels))
    _change(channels, "wheel_speed_1", np.where(np.arange(coarse.size) < 100, coarse, coarse[100]))
    assert ("stuck", "wheel_speed_1") in _kinds(prepared(channels))


def test_a_stuck_loadcell_is_no_clamping_force_and_defects_stand_in_every_verdict(case, channels, prepared):
    _change(channels, "clamping_force_1", np.zeros_like(channels["speed"].samples))
    result = judge_stop(case, prepared(channels))
    assert all(np.isnan(wheelset["maximum_clamping_force_n"]) for wheelset in result.wheelsets)
    for verdict in result.criteria:
        assert verdict.definition["defects"].startswith("stuck: clamping_force_1")


def test_a_record_that_starts_late_with_and_without_a_stated_command(case, channels, prepared):
    stop = prepared(kept(channels, channels["speed"].time >= 2.0))
    assert ("starts-late", "the record") in _kinds(stop)
    result = judge_stop(case, stop)
    assert np.isnan(result.measures["braking_time_s"])
    assert np.isnan(result.measures["initial_adhesion_g"])
    stop = prepared(kept(channels, channels["speed"].time >= 2.0), {})
    assert stop.trigger.late
    assert ("starts-late", "the record") in _kinds(stop)


def test_a_record_that_ends_before_standstill_is_inconclusive_not_a_skip(case, channels, prepared):
    stop = prepared(kept(channels, channels["speed"].time <= 5.0))
    assert _kinds(stop) == {("ends-before-standstill", "the record")}
    reason = _reasons(case, stop)["standstill"]
    assert re.fullmatch(r"no standstill; the record ends after 5 s with the train at [0-9.]+ km/h", reason)
    assert stop.standstill is None
    only = {"speed": channels["speed"]}
    result = judge_stop(case, prepared(kept(only, only["speed"].time <= 5.0)))
    assert result.outcome == "inconclusive"
    assert "the record ends after 5 s" in result.reason
    assert "not recorded: wheel_speed_1" in result.reason
