import re
from dataclasses import replace
from functools import cache

import numpy as np
import pytest

from uictest.core.measures import MEASURES
from uictest.core.measures.catalogue.deceleration import initial_adhesion
from uictest.core.recording import TRACK_BRAKES_BESIDE
from uictest.core.recording.formats import FORMATS, Dialect, writer_of
from uictest.core.recording.formats.isolation import read_here
from uictest.judging.evaluation import evaluate
from uictest.plans.scenario import load
from uictest.recorded.field_data import (
    MapError,
    Preparation,
    judge_recording,
    load_map,
    prepare,
    select_channels,
    stated_case,
)
from uictest.recorded.field_data.judgement import observe
from uictest.rig import simulate

from .conftest import channels_of, judge_stop, kept

OURS = ("rail.condition=wet", "brake.position=R", "rig.wsp=active", "criteria=[uictest-stop]")

RESOLUTION = {
    "braking_time_s": 0.1,
    "braking_distance_m": 0.1,
    "mean_deceleration_mps2": 0.01,
    "initial_adhesion_g": 0.05,
    "minimum_deceleration_mps2": 1.0,
    "maximum_deceleration_mps2": 1.0,
    "reservoir_minimum_bar": 0.1,
    "build_up_time_s": 0.05,
    "deceleration_distance_m": 0.5,
    "developed_deceleration_mps2": 0.02,
    "adhesion_utilisation": 0.5,
    "deceleration_bogie_1_mps2": 0.2,
    "deceleration_bogie_2_mps2": 0.2,
}
TRAIN = """
schema: uictest/scenario/1
name: stop
initial_speed: 60 km/h
rail: {condition: wet, friction: 0.06}
criteria: uictest-stop
brake: {position: emergency}
train: [{}, {brake: {track: {attraction: 100 kN, off_below: 20 km/h}}}]
"""
LOCKED = 10.0
"""Sampling intervals by which the time in a handful of locks may be off."""


@pytest.fixture(scope="module")
def exported(simulated, tmp_path_factory):
    """What a file of a format holds, into which the stop was written as recorded at a rate in Hz."""

    @cache
    def contents(name, rate):
        recording = simulated(rate).recording
        assert recording is not None
        path = tmp_path_factory.mktemp("exported") / f"stop{FORMATS[name].suffix}"
        writer_of(name)(recording, path)
        return read_here(name, path, Dialect())

    return contents


@pytest.mark.parametrize(
    ("name", "rate"), [("parquet", 2000.0), *((name, 100.0) for name in FORMATS), ("parquet", 20.0)]
)
def test_an_exported_stop_gets_the_verdict_and_the_measures_of_the_simulated_one(
    name, rate, case, simulated, exported
):
    stop, contents = simulated(rate), exported(name, rate)
    recorded_stop = _prepared(contents)
    expected, actual = evaluate(case, stop.measures, stop.wheelset_measures), judge_stop(case, recorded_stop)
    assert recorded_stop.defects == ()
    assert actual.outcome == expected.outcome
    verdicts = [(v.id, v.status) for v in actual.criteria if not v.is_check]
    known = [(v.id, v.status) for v in expected.criteria if not v.is_check]
    no_reference = ("distance-over-reference", "not_applicable")  # nobody knows the rail of a record
    assert verdicts == [no_reference if id_ == no_reference[0] else (id_, status) for id_, status in known]
    _compare(actual, expected, max(1.0 / rate, 0.01))


@pytest.mark.parametrize("rate", [2000.0, 100.0, 20.0])
def test_the_sliding_share_of_a_record_is_that_of_the_simulated_stop(rate, case, simulated, exported):
    """Simulated, it has the same bits at any recording rate; recorded, it is off by some samples a slide."""
    stop, slower, contents = simulated(rate), simulated(100.0), exported("parquet", rate)
    seen = observe(_prepared(contents), case.scenario)
    for name in ("sliding_share", "sliding_share_of_wheelsets"):
        for below in (0.85, 0.9, 0.95):
            definition = {"sliding_below": below, "end_speed": 20.0 / 3.6}
            read = MEASURES[name].read
            expected = read(stop.measures, stop.wheelset_measures, definition).values
            assert expected == read(slower.measures, slower.wheelset_measures, definition).values
            recorded = read(seen.measures, seen.wheelset_measures, definition).values
            duration = float(stop.measures.reached_time[1])
            assert recorded == pytest.approx(expected, abs=LOCKED * max(1.0 / rate, 0.01) / duration)
        assert max(expected) > 0.1


@pytest.mark.parametrize("rail", ["wet-cleaning", "wet-curves"])
def test_what_a_cleaned_rail_offered_is_known_from_a_record_that_has_the_share(rail):
    case = stated_case("stop", 60.0 / 3.6, ["rail.friction=0.07", f"rail.condition={rail}"])
    stop = simulate(case, record_every=0.01)
    seen = observe(_recorded(stop), case.scenario).measures
    assert 0.5 < stop.measures.adhesion_utilisation < 1.0
    assert seen.adhesion_utilisation == pytest.approx(stop.measures.adhesion_utilisation, abs=5e-3)
    partly = observe(_recorded(stop, ("cleaned_share_2",)), case.scenario)
    known = partly.wheelset_measures.adhesion_utilisation
    assert np.isnan(known).tolist() == [False, rail == "wet-curves", False, False]


def _prepared(contents):
    channel_map, _ = load_map("uictest")
    return prepare(select_channels(contents, channel_map), contents.metadata, channel_map.preparation)


def _recorded(simulated, without=()):
    """Return the recording of a simulated stop as a recorded one."""
    channels = {n: c for n, c in channels_of(simulated.recording).items() if n not in without}
    return prepare(channels, simulated.recording.metadata, Preparation())


def _compare(actual, expected, interval):
    bounds = {name: share * interval for name, share in RESOLUTION.items()}
    for name, bound in {**bounds, "reservoir_margin_bar": 10.0 * (interval - 0.01) + 0.02}.items():
        value = expected.measures[name]
        coarse = 1e-3 * abs(value) * (interval > 0.01)
        assert actual.measures[name] == pytest.approx(value, abs=bound + coarse, nan_ok=True), name
    tolerances = {
        "locked_time_s": LOCKED * (interval - 0.01) + 1e-6,
        "valve_actuations": 0 if interval == 0.01 else 2,
        "maximum_slide": 2.0 * (interval - 0.01) + 1e-6,
        "sliding_time_s": 10.0 * (interval - 0.01) + 1e-6,
        "slid_distance_m": 100.0 * (interval - 0.01) + 1e-3,
        "contact_energy_kj": 60.0 * interval,
        "adhesion_utilisation": 1.0 * interval,
    }
    for one, other in zip(actual.wheelsets, expected.wheelsets, strict=True):
        for column, tolerance in tolerances.items():
            assert one[column] == pytest.approx(other[column], abs=tolerance), column


def test_what_a_record_lacks_is_inconclusive_and_what_no_train_has_is_not_judged(case, channels, prepared):
    result = judge_stop(case, prepared({"speed": channels["speed"]}))
    verdicts = {each.id: each for each in result.criteria}
    assert result.outcome == "inconclusive"
    assert "energy-balance" not in verdicts
    assert verdicts["standstill"].status == "pass"
    locked = verdicts["locked-wheels"]
    assert (locked.status, locked.reason) == (
        "inconclusive",
        "not recorded: wheel_speed_1, wheel_speed_2, wheel_speed_3, wheel_speed_4",
    )
    assert result.measures["braking_time_s"] > 0.0
    assert all(wheelset["valve_actuations"] != wheelset["valve_actuations"] for wheelset in result.wheelsets)


@pytest.mark.parametrize("pattern", [".*", "(wheel_)?speed.*|.*pressure.*", "(wheel_)?speed.*"])
def test_a_sound_record_of_a_good_stop_passes_by_our_own_criteria(pattern, channels, prepared):
    chosen = {name: each for name, each in channels.items() if re.fullmatch(pattern, name)}
    case = stated_case("good", 40.0 / 3.6, OURS)
    assert judge_stop(case, prepared(chosen)).outcome == "pass"


def test_the_recording_of_a_judged_stop_says_when_a_wheelset_first_slid_unless_it_begins_late(
    case, simulated, channels, prepared
):
    expected = simulated(100.0).measures.sliding_time
    _, recording = judge_recording(case, prepared(channels))
    assert float(recording.metadata["sliding_time"]) == pytest.approx(expected)
    assert recording.metadata["brake_command_time"] == "0 s"
    stop = prepared(kept(channels, channels["speed"].time >= 2.0), trigger_time="1 s")
    assert stop.trigger.late
    assert dict(judge_recording(case, stop)[1].metadata) == {"case": case.id}


def test_the_preparation_stands_in_every_verdict_and_a_missing_distance_is_integrated(
    case, channels, prepared
):
    result = judge_stop(case, prepared(channels, low_pass="10 Hz", raster="20 ms"))
    for verdict in result.criteria:
        assert verdict.definition["trigger"] == "at 0 s, stated by the file"
        assert verdict.definition["filter"] == "low-pass 10 Hz"
        assert verdict.definition["raster"].startswith("20 ms")
        assert verdict.definition["distance"] == "recorded"
    expected = prepared(channels).standstill
    del channels["distance"]
    integrated = prepared(channels)
    assert integrated.choices["distance"] == "integrated from speed"
    assert integrated.standstill == pytest.approx(expected, rel=1e-4)


def test_a_recorded_track_brake_gives_its_energy_and_time_and_leaves_no_initial_adhesion():
    track = "brake.track={attraction: 100 kN, off_below: 20 km/h, delay: 0.3 s}"
    settings = ("rail.condition=wet", "rail.friction=0.06", "brake.position=emergency", track)
    case = stated_case("stop", 60.0 / 3.6, settings)
    simulated = simulate(case, record_every=0.01)
    observed = observe(_recorded(simulated), case.scenario).measures
    assert observed.track_brake_energy == pytest.approx(simulated.measures.track_brake_energy, rel=1e-2)
    assert observed.track_brake_time == pytest.approx(simulated.measures.track_brake_time, abs=0.05)
    result = evaluate(case, observed, simulated.wheelset_measures)
    assert np.isnan(result.measures["initial_adhesion_g"])


def test_a_recording_of_a_car_says_that_track_brakes_of_others_acted(tmp_path):
    (tmp_path / "stop.yaml").write_text(TRAIN, "utf-8")
    without, _ = load([tmp_path / "stop.yaml"])
    stop = simulate(without, record_every=0.01)
    recorded, case = _recorded(stop), replace(without, train=None)
    observed = observe(recorded, case.scenario)
    assert observed.measures.track_brake_time_beside == pytest.approx(stop.measures.track_brake_time_beside)
    reason = "the track brake of another car acted"
    assert initial_adhesion(observed.measures, 3.0).unavailable_reason.startswith(reason)
    _, again = judge_recording(case, recorded)
    facts = stop.recording.metadata
    assert again.metadata[TRACK_BRAKES_BESIDE] == facts[TRACK_BRAKES_BESIDE]
    with pytest.raises(MapError, match="track_brakes_beside in the header of the file"):
        prepare(channels_of(stop.recording), {**facts, TRACK_BRAKES_BESIDE: "long"}, Preparation())
