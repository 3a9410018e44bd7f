"""One stop from the brake command to standstill."""

from collections.abc import Sequence
from typing import Any

from uictest.measures import begin as begin_measures
from uictest.measures import begin_wheelset, finish, observe_train, observe_wheelset
from uictest.rig.balance import air_residual, energy_residual
from uictest.rig.cycle import begin_cycle, sense
from uictest.rig.start import start
from uictest.rig.step import step
from uictest.rig.trace import sample

Record = Any


def stop(
    car: Record,
    bogies: Sequence[Record],
    wheelsets: Sequence[Record],
    p: Record,
    rail: Any,
    measures: Record,
    wheelset_measures: Sequence[Record],
    trace: Any,
    steps_per_sample: int,
) -> int:
    """Run one stop on zeroed records, fill the measures and return the number of rows written to ``trace``.

    Steps run in whole controller cycles. Standstill is found within the step and the cycle is finished,
    so that a stop runs the same steps alone or beside others. ``trace`` has
    :data:`~uictest.rig.trace.ROW` columns and a row for every ``steps_per_sample`` steps; with 0
    nothing is recorded. Recording reads the state and never changes it.
    """
    start(car, bogies, wheelsets, p)
    begin_stop_measures(car, measures, wheelset_measures, p)
    rows = 0
    steps = 0
    while car.stopped == 0.0 and car.cycle < p.cycles:
        sense(car, wheelsets, p)
        begin_cycle(car, wheelsets, p, rail)
        if steps_per_sample > 0 and rows == 0:
            sample(trace[0], car, wheelsets, p)
            rows = 1
        for _ in range(p.steps_per_cycle):
            step(car, bogies, wheelsets, p)
            steps += 1
            if steps_per_sample > 0 and steps % steps_per_sample == 0:
                sample(trace[rows], car, wheelsets, p)
                rows += 1
        observe_cycle(car, wheelsets, measures, wheelset_measures, p)
    close_stop_measures(car, bogies, wheelsets, measures, wheelset_measures, p)
    return rows


def begin_stop_measures(
    car: Record, measures: Record, wheelset_measures: Sequence[Record], p: Record
) -> None:
    """Start the measures of a stop."""
    begin_measures(
        measures, car.time, car.position, car.speed, car.reservoir_pressure - p.atmospheric_pressure
    )
    for i in range(4):
        begin_wheelset(wheelset_measures[i])


def observe_cycle(
    car: Record, wheelsets: Sequence[Record], measures: Record, wheelset_measures: Sequence[Record], p: Record
) -> None:
    """Feed the measures at the end of a controller cycle; at standstill only with the standstill itself."""
    reservoir = car.reservoir_pressure - p.atmospheric_pressure
    if car.stopped > 0.0:
        observe_train(measures, p, car.stop_time, car.stop_position, 0.0, reservoir)
        finish(measures, car.stop_time, car.stop_position)
        return
    for i in range(4):
        wheelset = wheelsets[i]
        observe_wheelset(
            wheelset_measures[i],
            measures,
            p,
            i + 1,
            car.time,
            car.speed,
            wheelset.rotation * p.wheel_radius,
            wheelset.venting,
            wheelset.clamping_force,
        )
    observe_train(measures, p, car.time, car.position, car.speed, reservoir)


def close_stop_measures(
    car: Record,
    bogies: Sequence[Record],
    wheelsets: Sequence[Record],
    measures: Record,
    wheelset_measures: Sequence[Record],
    p: Record,
) -> None:
    """Add the ledgers and balances of the whole stop."""
    measures.air_consumed = car.consumed_air
    measures.energy_residual = energy_residual(car, bogies, wheelsets, p)
    measures.air_residual = air_residual(car, wheelsets)
    for i in range(4):
        wheelset_measures[i].air_vented = wheelsets[i].vented_air
