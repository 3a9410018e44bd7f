import pytest

from studies.experiments import dry_distance
from studies.experiments.dry_distance import COMMANDS, RIGS, SPEEDS, WITHIN, DryStop, dry_stops, worst_stop
from studies.study import STUDIES, run_study
from uictest.plans.scenario import COMPENSATION_SETTINGS


@pytest.fixture
def stops(stop_runner, monkeypatch):
    monkeypatch.setattr(dry_distance, "SPEEDS", ("120 km/h",))
    monkeypatch.setattr(dry_distance, "COMMANDS", ("100 %",))
    monkeypatch.setattr(dry_distance, "SEEDS", range(1))
    return dry_stops(stop_runner)


def test_the_distance_depends_on_the_hysteresis_where_nothing_slides(stops):
    assert [stop.rig for stop in stops] == list(RIGS)
    assert stops[0].difference == 0.0
    differences = {stop.rig: stop.difference for stop in stops}
    for name, setting in COMPENSATION_SETTINGS.items():
        assert (abs(differences[name]) < 1.0) is setting.hysteresis


def test_no_wheelset_slides_in_any_stop(stop_runner):
    cases = stop_runner.cases("dry-120", {"initial_speed": SPEEDS, "brake.command": COMMANDS})
    for repeats in stop_runner.repeated(cases, [0]):
        assert [each["valve_actuations"] for each in repeats.stops[0].wheelsets] == [0] * 4


def test_the_worst_stop_keeps_its_sign():
    made_up = [("full", 100.1), ("full", 99.0), ("none", 90.0)]
    worst = worst_stop([DryStop(None, rig, distance, 100.0) for rig, distance in made_up], "full")
    assert worst.difference == pytest.approx(-1.0)


def test_every_setting_with_hysteresis_has_a_band():
    banded = {each.key for each in STUDIES["dry-distance"].quantities if each.band is not None}
    assert banded == {name for name, setting in COMPENSATION_SETTINGS.items() if setting.hysteresis}


def test_the_band_is_of_fast_and_strong_stops_and_others_differ_more(stop_runner, monkeypatch):
    """Within 0.2 % of four calipers: not `full` from 30 km/h, not `thermal` at 30 % command."""
    monkeypatch.setattr(dry_distance, "SPEEDS", ("30 km/h", "100 km/h"))
    monkeypatch.setattr(dry_distance, "COMMANDS", ("30 %", "100 %"))
    monkeypatch.setattr(dry_distance, "SEEDS", range(1))
    values = run_study(STUDIES["dry-distance"], stop_runner).findings.values
    for setting in ("full", "thermal"):
        assert abs(values[setting].value) < WITHIN < abs(values[f"{setting}_all"].value)
