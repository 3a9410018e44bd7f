"""What is stated of a recorded stop, how it is described, magnets in place of commands."""

from dataclasses import replace

import numpy as np
import pytest

from uictest.plans.scenario import ScenarioErrors
from uictest.recorded.field_data import RawChannel, recorded_description, stated_case
from uictest.recorded.field_data.raw_channels import with_valve_commands
from uictest.report.run_folder import read_subjects, subjects_form


def test_what_is_stated_becomes_a_case_and_what_is_not_acceptable_is_refused():
    case = stated_case("run", 20.0, ["rail.condition=wet", "brake.position=P", "criteria=uictest-stop"])
    assert case.scenario.rail.condition.name == "wet"
    assert case.scenario.brake.position == "P"
    assert case.scenario.initial_speed == 20.0
    assert any("rails/wet" in name for name in case.inputs)
    for statement in ("rail.condition=we", "brake.position=X", "nothing", "seed=1,2"):
        with pytest.raises(ScenarioErrors):
            stated_case("run", 20.0, [statement])


def test_a_recorded_stop_is_headed_by_its_file_and_by_what_was_read_and_derived(case, channels, prepared):
    names = ("speed", *(f"wheel_speed_{n}" for n in (1, 2, 3, 4)), "cylinder_pressure_1")
    subject = recorded_description(case, prepared({name: channels[name] for name in names}))
    assert subject.title == "Recorded stop"
    assert subject.recorded["file"] == "stop"
    assert subject.recorded["channels read"] == "time, speed, wheel_speed_1 .. 4, cylinder_pressure_1"
    assert subject.recorded["distance"] == "integrated from speed"
    assert subject.recorded["sampling"] == "speed every 10 ms"
    assert subject.recorded["trigger"] == "at 0 s, stated by the file"
    assert read_subjects({"subjects": subjects_form({"a": subject})}) == {"a": subject}
    subject = recorded_description(case, prepared(channels))
    assert "distance" not in subject.recorded
    text = str(subjects_form({"a": subject}))
    for of_the_rig in ("intercity-180", "one-caliper", "threshold", "compensation", "0.08", "ep-disc"):
        assert of_the_rig not in text
    assert dict(recorded_description(case, None).recorded) == {"file": "stop"}


def test_a_condition_that_nobody_stated_is_marked_as_assumed(channels, prepared):
    statements = ["rail.condition=wet", "brake.position=R", "rig.wsp=active", "criteria=uictest-stop"]
    stop = prepared(channels)
    settings = recorded_description(stated_case("run", 40 / 3.6, statements), stop).settings
    assert settings["initial speed"] == "40 km/h, recorded"
    assert settings["brake command"] == "100 % (assumed: not stated)"
    assert settings["gradient"] == "0 permille (assumed: not stated)"
    assert (settings["rail"], settings["brake position"], settings["WSP"]) == ("wet", "R", "active")
    stated = stated_case("run", 40 / 3.6, [*statements, "brake.command=80 %"])
    assert recorded_description(stated, stop).settings["brake command"] == "80 %"


TIME = np.array([0.0, 0.1, 0.2, 0.3, 0.4])
NAN = float("nan")


def _magnets(hold, vent):
    samples = {"hold_magnet_2": hold, "vent_magnet_2": vent}
    return {name: RawChannel(name, name, TIME, np.array(each)) for name, each in samples.items()}


def test_two_magnets_are_one_command_unless_one_is_recorded_or_their_times_differ():
    """00 fills, 10 holds, 11 vents; 01, which sensors may show for a moment, vents, too."""
    magnets = _magnets([0.0, 1.0, 1.0, 0.0, NAN], [0.0, 0.0, 1.0, 1.0, 0.0])
    command = with_valve_commands(magnets)["valve_command_2"]
    np.testing.assert_array_equal(command.samples, [0.0, 1.0, 2.0, 2.0, NAN])
    assert command.is_state
    # Half of a diagnosis would be other bits.
    for name in ("diagnosis", "hold_magnet_1", "vent_magnet_4"):
        assert RawChannel(name, name, TIME, np.zeros(5)).is_state
    command = RawChannel("valve_command_2", "MV2", TIME, np.ones(5))
    assert with_valve_commands({**magnets, command.name: command})["valve_command_2"] is command
    magnets["vent_magnet_2"] = replace(magnets["vent_magnet_2"], time=TIME + 0.01)
    assert "valve_command_2" not in with_valve_commands(magnets)


def test_magnets_of_a_stop_count_the_actuations_of_its_valves(channels, case, prepared):
    from uictest.recorded.field_data.judgement import observe

    commands = [f"valve_command_{n}" for n in (1, 2, 3, 4)]
    magnets = {name: channel for name, channel in channels.items() if name not in commands}
    expected = observe(prepared(channels), case.scenario)
    found = observe(prepared(with_valve_commands(magnets)), case.scenario)
    actuations = expected.wheelset_measures.valve_actuations
    assert actuations.min() > 0
    np.testing.assert_array_equal(found.wheelset_measures.valve_actuations, actuations)
