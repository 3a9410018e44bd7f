"""One stop of a train: cars with a rig each, coupled, on one rail. A car alone is a train of one.

Between the cars are the couplers and the rail, with what the wheelsets of all cars before have left. A
coupler is a spring and a damper side by side, slack-free; it acts on the body at its height and makes the
cars pitch. All forces come from the state at the beginning of a step, before any car is advanced, so that the
order of the cars does not matter. Work is that of the force with the mean of the speeds of its point at both
ends of the step.
"""

from typing import Any

from uictest.controllers import NO_FAILURE
from uictest.core.physics import longitudinal, maximum, suspension_force
from uictest.rig.model.controller import FROM_OUTSIDE, decide_watched, read_outputs, write_inputs
from uictest.rig.model.cycle import command_valves, read_sensors
from uictest.rig.model.friction_brake import warm_discs
from uictest.rig.model.parameters import Parameters
from uictest.rig.model.rail import hand_rail_on
from uictest.rig.model.records import CarRecords, TrainRecords, car_of, needs_of
from uictest.rig.model.sand import hand_sand_on
from uictest.rig.model.state import Car, Coupler
from uictest.rig.model.step import step_brake
from uictest.rig.model.stop import (
    begin_stop,
    end_cycle,
    is_running,
    keep_measures,
    meet_rail,
    move_air,
    move_car,
    notice_faults,
    set_demands,
    take_commands,
)
from uictest.rig.model.stop_measures import close_stop_measures
from uictest.rig.model.trace import Trace, sample


def run_train(train: TrainRecords, trace: Trace, steps_per_sample: int) -> int:
    """Run one stop on zeroed records, fill the measures and return the rows written to the trace.

    The measures of a car are those up to its own standstill; it stays coupled until all cars stand. Steps run
    in whole controller cycles: standstill is interpolated within its step and the cycle is finished, so that
    a stop runs the same steps alone or together with others. Recording reads the state and never changes it.

    Args:
        train: records of the train.
        trace: samples of every car, shapes (n, rows) and (n, rows, 4).
        steps_per_sample: base steps from one sample to the next; 0: none.
    """
    begin_train(train)
    rows = 0
    running = len(train.cars)
    while running > 0:
        for j in range(len(train.cars)):
            _begin_cycle(train, j)
            decide_watched(j, train.cars, car_of(train, j).wheelsets, train.parameters)
            _act(car_of(train, j))
        rows = _step_cycle(train, trace, steps_per_sample, rows)
        running = _observe(train)
    return rows


def step_train(
    train: TrainRecords, exchanges: Any, present: Trace, trace: Trace, steps_per_sample: int, rows: int
) -> int:
    """Carry out the commands in the exchanges for one cycle; on zeroed records, begin the stop instead.

    Afterwards the exchanges hold what the sensors show then, and ``present``, a trace of one row, the true
    state. While a command of one car is refused, which its ``exchange.failure`` tells, none moves. A car is
    asked for commands until all cars have ended. Returns the number of rows that ``trace`` has.
    """
    if exchanges[0].cycles == 0:
        for j in range(len(train.cars)):
            train.parameters[j].controller = FROM_OUTSIDE  # whoever carries the stop on decides
        begin_train(train)
    else:
        if not _read_commands(train, exchanges):
            return rows
        for j in range(len(train.cars)):
            _act(car_of(train, j))
        rows = _step_cycle(train, trace, steps_per_sample, rows)
        _observe(train)
    # Also at the end: whoever drives the rig sees the sensors at standstill. No measure is taken from this.
    for j in range(len(train.cars)):
        _begin_cycle(train, j)
        write_inputs(exchanges[j], train.cars[j], car_of(train, j).wheelsets, train.parameters[j])
        exchanges[j].cycles += 1
    _sample(train, present, 0)
    return rows


def _read_commands(train: TrainRecords, exchanges: Any) -> bool:
    """Set what is commanded of every car; return whether all of it can be carried out."""
    sound = True
    for j in range(len(train.cars)):
        exchanges[j].failure = NO_FAILURE
        read_outputs(exchanges[j], train.cars[j], car_of(train, j).wheelsets, train.parameters[j])
        sound = sound and exchanges[j].failure == NO_FAILURE
    return sound


def begin_train(train: TrainRecords) -> None:
    """Set zeroed records to the instant of the brake command."""
    for j in range(len(train.cars)):
        begin_stop(car_of(train, j))
        for i in range(4):
            train.wheelsets[4 * j + i].behind += train.distances[j]


def _begin_cycle(train: TrainRecords, j: int) -> None:
    """Do what comes before the controller of a car decides: read the sensors, find the friction of the rail.

    The rail that the last wheelset of the car has passed is left to the next car.
    """
    records = car_of(train, j)
    notice_faults(records)
    read_sensors(records.car, records.wheelsets, records.parameters, needs_of(records.parameters))
    meet_rail(records, train.rail)
    if j + 1 < len(train.cars):
        hand_on(records, train.memories[j + 1])


def hand_on(records: CarRecords, behind: Any) -> None:
    """Leave to the next car what the last wheelset of this one leaves of the rail and on it."""
    if records.parameters.cleans_rail > 0.0:
        hand_rail_on(records.wheelsets[3], records.parameters, records.memory, behind)
    if records.parameters.has_sanders > 0.0:
        hand_sand_on(records.wheelsets[3], records.parameters, records.memory, behind)


def _act(records: CarRecords) -> None:
    """Set valves and demands for a cycle by what the controller has decided and the driver commands."""
    take_commands(records)
    command_valves(records.car, records.wheelsets, records.parameters)
    set_demands(records)


def _step_cycle(train: TrainRecords, trace: Trace, steps_per_sample: int, rows: int) -> int:
    p = train.parameters[0]
    steps = (train.cars[0].cycle - 1) * p.steps_per_cycle
    if steps_per_sample > 0 and rows == 0:
        rows = _sample(train, trace, rows)
    for _ in range(p.steps_per_cycle):
        _step(train)
        steps += 1
        if steps_per_sample > 0 and steps % steps_per_sample == 0:
            rows = _sample(train, trace, rows)
    return rows


def _step(train: TrainRecords) -> None:
    """Make one base step; all coupler forces come from the state before any car moves."""
    cars, parameters, couplers = train.cars, train.parameters, train.couplers
    for j in range(len(cars)):
        release_couplers(cars[j])
    for j in range(len(couplers)):
        pull_cars(couplers[j], cars[j], parameters[j], cars[j + 1], parameters[j + 1])
    for j in range(len(cars)):
        records, needs = car_of(train, j), needs_of(parameters[j])
        move_air(records.car, records.wheelsets, records.parameters, needs)
        step_brake(records.car, records.wheelsets, records.parameters)
        move_car(records.car, records.bogies, records.wheelsets, records.parameters, needs)
    for j in range(len(couplers)):
        account_for_coupler(couplers[j], cars[j], parameters[j], cars[j + 1], parameters[j + 1])


def _sample(train: TrainRecords, trace: Trace, row: int) -> int:
    """Write a row of the trace and return the number of the next."""
    for j in range(len(train.cars)):
        of_car = Trace(trace.train[j], trace.wheelsets[j])
        sample(of_car, row, train.cars[j], car_of(train, j).wheelsets, train.parameters[j])
    return row + 1


def _observe(train: TrainRecords) -> int:
    """End a cycle: feed the measures of the cars that ran in it; return how many run on.

    None does where a controller from outside has failed. All begin their cycles together, so that a car
    whose measures are closed is one that had stopped before.
    """
    running = 0
    failed = 0
    for j in range(len(train.cars)):
        records = car_of(train, j)
        failed += records.car.controller_failed
        if records.car.closed > 0.0:
            if records.parameters.models_disc_temperature > 0.0:
                warm_discs(records.wheelsets, records.parameters)  # others may still push the car along
            continue
        needs = needs_of(records.parameters)
        end_cycle(
            records.car,
            records.wheelsets,
            records.measures,
            records.wheelset_measures,
            records.parameters,
            needs,
        )
        keep_measures(records, records.measures, records.wheelset_measures)
        if is_running(records.car, records.parameters):
            running += 1
        else:
            close_stop_measures(records)
            records.car.closed = 1.0
    return 0 if failed > 0 else running


def release_couplers(car: Car) -> None:
    """Clear the coupler forces on a car before they are summed for a step."""
    car.coupler_force = 0.0
    car.coupler_moment = 0.0


def pull_cars(
    coupler: Coupler, leading: Car, leading_p: Parameters, trailing: Car, trailing_p: Parameters
) -> None:
    """Add the force of a coupler to the cars before and after it, for a step."""
    coupler.leading_speed = point_speed(leading, leading_p, coupler)
    coupler.trailing_speed = point_speed(trailing, trailing_p, coupler)
    stretch = point_position(leading, leading_p, coupler) - point_position(trailing, trailing_p, coupler)
    rate = coupler.leading_speed - coupler.trailing_speed
    coupler.force = suspension_force(coupler.stiffness, coupler.damping, stretch, rate)
    coupler.largest_pull = maximum(coupler.force, coupler.largest_pull)
    coupler.largest_push = maximum(-coupler.force, coupler.largest_push)
    _load(leading, leading_p, coupler, -coupler.force)
    _load(trailing, trailing_p, coupler, coupler.force)


def account_for_coupler(
    coupler: Coupler, leading: Car, leading_p: Parameters, trailing: Car, trailing_p: Parameters
) -> None:
    """Add the work of a coupler in the last step."""
    leading_mean = 0.5 * (coupler.leading_speed + point_speed(leading, leading_p, coupler))
    trailing_mean = 0.5 * (coupler.trailing_speed + point_speed(trailing, trailing_p, coupler))
    duration = leading_p.step
    leading.coupler_work -= duration * coupler.force * leading_mean
    trailing.coupler_work += duration * coupler.force * trailing_mean
    rate = coupler.leading_speed - coupler.trailing_speed
    coupler.loss += duration * coupler.damping * rate * (leading_mean - trailing_mean)


def point_speed(car: Car, p: Parameters, coupler: Coupler) -> float:
    """Speed of a coupler's point on a car body, m/s."""
    return longitudinal(car.speed, car.pitch_rate, coupler.height - p.body_height)


def point_position(car: Car, p: Parameters, coupler: Coupler) -> float:
    """Position of that point, m."""
    return longitudinal(car.position, car.pitch, coupler.height - p.body_height)


def _load(car: Car, p: Parameters, coupler: Coupler, force: float) -> None:
    car.coupler_force += force
    car.coupler_moment -= (coupler.height - p.body_height) * force
