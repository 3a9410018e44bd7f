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
    car.brake_command = p.first_command


def follow_commands(car: Car, measures: StopMeasures, p: Parameters) -> None:
    """Give further commands, and let the last one take effect whose dead time has passed; scalar code.

    A command that a later one overtakes never takes effect. Only of the first application is it known when it
    has built up: a further command ends what observes that.
    """
    now = car.time + 0.5 * p.step
    effective = car.command_place
    for k in range(car.command_place + 1, p.command_count):
        if now >= p.command_given[k]:
            car.brake_command = p.command_shares[k]
        if now >= p.command_times[k]:
            effective = k
    if effective > car.command_place:
        if p.command_pressures[car.command_place] == 0.0:
            car.dynamic_dropped = 0.0  # another application begins
        car.command_place = effective
        _begin_ramp(car, p)
        if car.closed == 0.0:
            measures.commanded_pressure = _NAN


def _begin_ramp(car: Car, p: Parameters) -> None:
    place = car.command_place
    change = p.command_pressures[place] - car.command_pressure
    rate = p.command_rates[place] if change > 0.0 else p.release_rates[place]
    car.demand_start = car.command_pressure
    car.demand_change = change
    car.demand_begins = car.time
    car.demand_rate = rate / abs(change) if change != 0.0 else 0.0
