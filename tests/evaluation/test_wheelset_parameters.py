"""What single wheelsets have of their own is among the effective parameters."""

from uictest.judging.evaluation.effective_parts import EffectiveParts
from uictest.plans.scenario import load


def test_own_values_are_listed_with_their_marks_and_nothing_else_is(tmp_path):
    path = tmp_path / "stop.yaml"
    path.write_text(
        "schema: uictest/scenario/1\nname: stop\ninitial_speed: 80 km/h\nvehicle: intercity-180\n"
    )
    own = {"wheelsets.2.wheel_radius": "0.4214 m", "wheelsets.4.sensors.speed.method": "whole-teeth"}
    case = load([path], [f"vehicle.{key}={value}" for key, value in own.items()])[0]
    vehicle = EffectiveParts().of(case.scenario)["vehicle"]
    listed = {each.key: each for each in vehicle.parameters if "wheelsets" in each.key}
    assert {key: each.written for key, each in listed.items()} == {
        f"vehicle.{key}": value for key, value in own.items()
    }
    assert all(each.differs and each.mark == "user" for each in listed.values())
    regular = EffectiveParts().of(load([path])[0].scenario)["vehicle"]
    assert not any("wheelsets" in each.key for each in regular.parameters)
