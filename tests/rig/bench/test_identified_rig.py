"""The compensation that is identified from the bench for the rig of a stop."""

from importlib import resources

import pytest

from uictest import rig
from uictest.core import user_cache
from uictest.plans.scenario import load, rig_differences
from uictest.rig import bench
from uictest.rig.bench import identified_rig

LINES = resources.files("uictest.plans.library") / "compensations" / "six-inch.yaml"


def stop(folder, *overrides):
    path = folder / "stop.yaml"
    path.write_text("schema: uictest/scenario/1\nname: stop\ninitial_speed: 120 km/h\n")
    return load([path], ["rig.compensation_model=identify", *overrides])[0]


@pytest.fixture(name="identifications")
def _identifications(monkeypatch):
    """The names of what is identified, each as if it were like six-inch; the cache begins empty."""
    names = []
    kept = {}

    def identify(scenario, pressure, name):
        names.append(name)
        return LINES.read_text("utf-8").replace("name: six-inch", f"name: {name}")

    monkeypatch.setattr(identified_rig, "_identify", identify)
    monkeypatch.setattr(identified_rig, "_texts", {})
    monkeypatch.setattr(user_cache, "read", lambda kind, inputs: kept.get(inputs))
    monkeypatch.setattr(user_cache, "write", lambda kind, inputs, content: kept.update({inputs: content}))
    return names


def test_each_distinct_rig_is_identified_once(tmp_path, identifications):
    first = bench.identified(stop(tmp_path, "rig.caliper.lever_ratio=3"))
    again = bench.identified(stop(tmp_path, "rig.caliper.lever_ratio=3.0", "seed=7", "initial_speed=80 km/h"))
    assert first.scenario.rig.compensation_model.name == again.scenario.rig.compensation_model.name
    other = bench.identified(stop(tmp_path, "rig.caliper.lever_ratio=3.1"))
    assert identifications == [each.scenario.rig.compensation_model.name for each in (first, other)]
    identified_rig._texts.clear()
    bench.identified(stop(tmp_path, "rig.caliper.lever_ratio=3"))
    assert len(identifications) == 2


def test_what_is_identified_lists_its_very_rig(tmp_path, identifications):
    case = bench.identified(stop(tmp_path, "rig.caliper.lever_ratio=3", "rig.caliper.load_friction=15 %"))
    differences = rig_differences(case.scenario)
    assert differences
    assert {each.share for each in differences} == {0.0}
    assert float(rig.assemble(case).parameters["compensation_misfit"]) == 0.0


def test_four_calipers_need_none_and_no_stop_is_run_with_numbers_that_stand_in(tmp_path, identifications):
    case = stop(tmp_path, "rig.topology=four-caliper")
    assert bench.identified(case) is case
    assert identifications == []
    with pytest.raises(ValueError, match="is to be identified first"):
        rig.assemble(stop(tmp_path))


def test_lines_identified_for_another_lever_follow_it(tmp_path):
    """Twice the lever, twice the force; the brake and its sensors are given the room for it."""
    sensors = "rig.sensors.loadcell.range=60 kN"
    lines = [
        bench.identified(
            stop(tmp_path, f"rig.caliper.lever_ratio={ratio}", "rig.compensation=hysteresis", sensors)
        ).scenario.rig.compensation_model.hysteresis.bc_squeezing
        for ratio in (1.2, 2.4)
    ]
    assert lines[1].slope / lines[0].slope == pytest.approx(2.0, rel=0.01)
    assert lines[0].slope.text != lines[1].slope.text


def test_a_bench_that_saturates_the_loadcells_identifies_nothing(tmp_path):
    case = stop(tmp_path, "rig.caliper.lever_ratio=4", "rig.compensation=hysteresis")
    with pytest.raises(ValueError, match=r"their range, 25 kN: give rig\.sensors\.loadcell\.range"):
        bench.identified(case)
