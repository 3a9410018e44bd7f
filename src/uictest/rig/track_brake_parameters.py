"""Parameters of the track brake, from its section of the scenario; without force where there is none."""

from typing import Final

from uictest.core.physics import MOST_COMMANDS
from uictest.plans.scenario import EMERGENCY, Scenario
from uictest.rig.derived_parameters import Assignment
from uictest.rig.model.parameters import Parameters

_BOGIES: Final = 2
_SLOWEST: Final = 0.01
"""m/s: friction is whole from there on where the step permits; chosen."""
_STABLE: Final = 0.5
"""Share of a bogie's speed that the magnets may take in a step at most: half of what never overshoots."""


def _set_magnets(p: Parameters, scenario: Scenario) -> None:
    brake, vehicle = scenario.brake.track, scenario.vehicle
    p.has_track_brake = float(brake is not None)
    p.magnet_attraction = p.magnet_friction = p.magnet_cleaning = 0.0
    p.magnet_numerator = p.magnet_denominator = p.magnet_slowest = p.magnet_change = 1.0
    if brake is not None:
        p.magnet_attraction = brake.attraction * brake.magnets / _BOGIES
        p.magnet_friction, p.magnet_cleaning = brake.friction, brake.cleaning
        p.magnet_numerator, p.magnet_denominator = brake.friction_speeds
        p.magnet_change = min(scenario.controller.cycle_time / brake.rise_time, 1.0)
        height = vehicle.traction_link.height - vehicle.bogie.height
        response = 1.0 / vehicle.bogie.mass + height**2 / vehicle.bogie.pitch_inertia
        change = scenario.simulation.time_step * response * brake.largest_force / _BOGIES
        p.magnet_slowest = max(_SLOWEST, change / _STABLE)


def _set_commands(p: Parameters, scenario: Scenario) -> None:
    brake = scenario.brake.track
    p.track_brake_first = p.track_brake_delay = p.track_brake_off_speed = p.track_brake_requested = 0.0
    p.track_brake_commands = [0.0] * MOST_COMMANDS
    if brake is not None:
        p.track_brake_delay = brake.delay
        p.track_brake_off_speed = 0.0 if brake.off_below is None else brake.off_below
        p.track_brake_requested = float(brake.when == "requested")
        for place, (_, share, position) in enumerate(scenario.brake.commands):
            serves = brake.when != EMERGENCY or position == EMERGENCY
            p.track_brake_commands[place] = float(share > 0.0 and serves)


TRACK_BRAKE: tuple[Assignment, ...] = (
    Assignment(
        _set_magnets,
        (
            *("brake.track", "vehicle.bogie", "vehicle.traction_link"),
            *("simulation.time_step", "controller.cycle_time"),
        ),
    ),
    Assignment(_set_commands, ("brake.track", "brake.command", "brake.position")),
)
"""What sets the parameters of the track brake."""
