"""Every defect, made in a simulated stop: found, named, and never bridged."""

from __future__ import annotations

import re
from dataclasses import replace
from typing import Any

import numpy as np
import pytest

from uictest.recorded.field_data import UnusableError, unusable_result

from .conftest import judge_stop

Channels = dict[str, Any]


def _kinds(stop: Any) -> set[tuple[str, str]]:
    return {(defect.kind, defect.channel) for defect in stop.defects}


def _reasons(case: Any, stop: Any) -> dict[str, str]:
    return {v.id: v.reason for v in judge_stop(case, stop).criteria if v.status == "inconclusive"}


def _change(channels: Channels, name: str, samples: np.ndarray) -> None:
    channels[name] = replace(channels[name], samples=samples)


def _retime(channels: Channels, time: np.ndarray) -> None:
    for name, channel in channels.items():
        channels[name] = replace(channel, time=time)


def _keep(channels: Channels, kept: np.ndarray) -> None:
    time = channels["speed"].time[kept]
    for name, channel in channels.items():
        channels[name] = replace(channel, time=time, samples=channel.samples[kept])


def test_a_sound_record_has_none(channels: Channels, prepared: Any) -> None:
    assert prepared(channels).defects == ()


@pytest.mark.parametrize(
    ("kind", "damage"),
    [
        ("time-missing", lambda time: time.__setitem__(50, np.nan)),
        ("time-backwards", lambda time: time.__setitem__(slice(50, 52), time[[51, 50]])),
        ("time-duplicate", lambda time: time.__setitem__(50, time[49])),
    ],
)
def test_a_time_axis_that_is_none_makes_the_record_unusable(
    case: Any, channels: Channels, prepared: Any, kind: str, damage: Any
) -> None:
    time = channels["speed"].time.copy()
    damage(time)
    _retime(channels, time)
    with pytest.raises(UnusableError) as caught:
        prepared(channels)
    assert kind in [defect.kind for defect in caught.value.defects]
    result = unusable_result(case, caught.value.defects)
    assert result.outcome == "error"
    assert kind in result.reason


def test_a_gap_in_all_channels(case: Any, channels: Channels, prepared: Any) -> None:
    time = channels["speed"].time
    _keep(channels, (time < 3.0) | (time > 3.805))
    stop = prepared(channels)
    assert [defect.kind for defect in stop.defects] == ["gap"]
    assert "from 2.99 to 3.81 s" in str(stop.defects[0])
    reasons = _reasons(case, stop)
    assert "wheel_speed_1 is not known from 3 to 3.8 s" in reasons["locked-wheels"]
    assert "standstill" not in reasons


def test_a_gap_leaves_no_integrated_distance(channels: Channels, prepared: Any, case: Any) -> None:
    del channels["distance"]
    time = channels["speed"].time
    _keep(channels, (time < 3.0) | (time > 3.805))
    result = judge_stop(case, prepared(channels))
    assert np.isnan(result.measures["braking_distance_m"])
    assert np.isfinite(result.measures["braking_time_s"])


def test_missing_samples(case: Any, channels: Channels, prepared: Any) -> None:
    samples = channels["wheel_speed_3"].samples.copy()
    samples[200:210] = np.nan
    _change(channels, "wheel_speed_3", samples)
    stop = prepared(channels)
    assert _kinds(stop) == {("not-a-number", "wheel_speed_3")}
    assert "wheel_speed_3 is not known from 2 to 2.09 s" in _reasons(case, stop)["locked-wheels"]


def test_a_dropout_of_a_wheel_speed(case: Any, channels: Channels, prepared: Any) -> None:
    samples = channels["wheel_speed_2"].samples.copy()
    samples[100:104] = 0.0
    _change(channels, "wheel_speed_2", samples)
    stop = prepared(channels)
    assert _kinds(stop) == {("dropout", "wheel_speed_2")}
    assert (
        "dropout: wheel_speed_2 falls and returns at once, 1 times from 1 to 1.03 s"
        in (_reasons(case, stop)["locked-wheels"])
    )


def test_a_dropout_of_the_train_speed_is_no_standstill(channels: Channels, prepared: Any) -> None:
    standstill = prepared(channels).standstill
    samples = channels["speed"].samples.copy()
    samples[100:104] = 0.0
    _change(channels, "speed", samples)
    stop = prepared(channels)
    assert stop.standstill[0] == standstill[0]
    assert ("dropout", "speed") in _kinds(stop)


@pytest.mark.parametrize("name", ["speed", "wheel_speed_1"])
def test_a_stuck_speed(channels: Channels, prepared: Any, name: str) -> None:
    samples = channels[name].samples.copy()
    samples[100:200] = samples[100]
    _change(channels, name, samples)
    assert ("stuck", name) in _kinds(prepared(channels))


def test_a_stuck_pressure(channels: Channels, prepared: Any) -> None:
    _change(channels, "tank_pressure_4", np.zeros_like(channels["speed"].samples))
    assert _kinds(prepared(channels)) == {("stuck", "tank_pressure_4")}


def test_a_stuck_loadcell_is_no_clamping_force(case: Any, channels: Channels, prepared: Any) -> None:
    _change(channels, "clamping_force_1", np.zeros_like(channels["speed"].samples))
    result = judge_stop(case, prepared(channels))
    assert all(np.isnan(wheelset["maximum_clamping_force_n"]) for wheelset in result.wheelsets)


def test_an_offset_wheel_speed(channels: Channels, prepared: Any) -> None:
    _change(channels, "wheel_speed_4", 1.05 * channels["wheel_speed_4"].samples)
    stop = prepared(channels)
    assert _kinds(stop) == {("offset", "wheel_speed_4")}
    assert "+5.0 % from the train before it brakes" in str(stop.defects[0])


def test_an_offset_train_speed_is_told_from_offset_wheels(channels: Channels, prepared: Any) -> None:
    _change(channels, "speed", 1.06 * channels["speed"].samples)
    assert _kinds(prepared(channels)) == {("offset", "speed")}


def test_an_offset_pressure(channels: Channels, prepared: Any) -> None:
    _change(channels, "cylinder_pressure_2", channels["cylinder_pressure_2"].samples + 0.4e5)
    assert _kinds(prepared(channels)) == {("offset", "cylinder_pressure_2")}


def test_a_record_that_starts_late(case: Any, channels: Channels, prepared: Any) -> None:
    _keep(channels, channels["speed"].time >= 2.0)
    stop = prepared(channels)
    assert ("starts-late", "the record") in _kinds(stop)
    result = judge_stop(case, stop)
    assert np.isnan(result.measures["braking_time_s"])
    assert np.isnan(result.measures["initial_adhesion_g"])


def test_a_record_that_starts_late_without_a_stated_command(channels: Channels, prepared: Any) -> None:
    _keep(channels, channels["speed"].time >= 2.0)
    stop = prepared(channels, {})
    assert stop.trigger.late
    assert ("starts-late", "the record") in _kinds(stop)


def test_a_record_that_ends_before_standstill(case: Any, channels: Channels, prepared: Any) -> None:
    _keep(channels, channels["speed"].time <= 5.0)
    stop = prepared(channels)
    assert _kinds(stop) == {("ends-before-standstill", "the record")}
    reason = _reasons(case, stop)["standstill"]
    assert re.fullmatch(r"no standstill; the record ends after 5 s with the train at [0-9.]+ km/h", reason)
    assert stop.standstill is None


def test_a_record_too_damaged_to_judge_is_inconclusive_not_a_skip(
    case: Any, channels: Channels, prepared: Any
) -> None:
    only = {"speed": channels["speed"]}
    _keep(only, only["speed"].time <= 5.0)
    result = judge_stop(case, prepared(only))
    assert result.outcome == "inconclusive"
    assert "the record ends after 5 s" in result.reason
    assert "not recorded: wheel_speed_1" in result.reason


def test_defects_stand_in_every_verdict(case: Any, channels: Channels, prepared: Any) -> None:
    _change(channels, "wheel_speed_4", 1.05 * channels["wheel_speed_4"].samples)
    for verdict in judge_stop(case, prepared(channels)).criteria:
        assert verdict.definition["defects"].startswith("offset: wheel_speed_4")
