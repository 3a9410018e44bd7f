"""Records that hold the magnets of the valves instead of their commands."""

from dataclasses import replace

import numpy as np

from uictest.recorded.field_data import RawChannel
from uictest.recorded.field_data.raw_channels import with_valve_commands

TIME = np.array([0.0, 0.1, 0.2, 0.3, 0.4])
NAN = float("nan")


def _magnets(hold, vent):
    samples = {"hold_magnet_2": hold, "vent_magnet_2": vent}
    return {name: RawChannel(name, name, TIME, np.array(each)) for name, each in samples.items()}


def test_two_magnets_are_one_command_and_states_hold_between_two_samples():
    """00 fills, 10 holds, 11 vents; 01, which sensors may show for a moment, vents, too."""
    magnets = _magnets([0.0, 1.0, 1.0, 0.0, NAN], [0.0, 0.0, 1.0, 1.0, 0.0])
    command = with_valve_commands(magnets)["valve_command_2"]
    np.testing.assert_array_equal(command.samples, [0.0, 1.0, 2.0, 2.0, NAN])
    assert command.is_state
    # Half of a diagnosis would be other bits.
    for name in ("diagnosis", "hold_magnet_1", "vent_magnet_4"):
        assert RawChannel(name, name, TIME, np.zeros(5)).is_state


def test_a_recorded_command_has_precedence_and_times_of_their_own_make_none():
    magnets = _magnets([0.0] * 5, [0.0] * 5)
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
