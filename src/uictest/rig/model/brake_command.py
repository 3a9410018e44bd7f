"""The course of the brake command: each command begins a ramp from the pressure that is demanded then."""

from uictest.core.measures import StopMeasures
from uictest.rig.model.parameters import Parameters
from uictest.rig.model.state import Car

_NAN = float("nan")


def start_command(car: Car, p: Parameters) -> None:
    """Let the first command be in effect."""
    car.demand_change = p.commanded_pressure
    car.demand_begins = p.dead_time
    car.demand_rate = p.filling_rate
    car.brake_command = p.commanded_pressure * p.demand_per_pressure


def follow_commands(car: Car, measures: StopMeasures, p: Parameters) -> None:
    """Let a further command take effect in the coming cycle if its time has come; scalar code.

    Only of the first application is it known when it has built up: a further command ends what observes that.
    """
    following = car.command_place + 1
    if following < p.command_count and car.time >= p.command_times[following] - 0.5 * p.step:
        car.command_place = following
        change = p.command_pressures[following] - car.command_pressure
        rate = p.command_rates[following] if change > 0.0 else p.release_rates[following]
        car.demand_start = car.command_pressure
        car.demand_change = change
        car.demand_begins = car.time
        car.demand_rate = rate / abs(change) if change != 0.0 else 0.0
        car.brake_command = p.command_pressures[following] * p.demand_per_pressure
        measures.commanded_pressure = _NAN
