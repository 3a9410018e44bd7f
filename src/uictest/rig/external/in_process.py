"""Stops in this process, of a train or of many cars alone; controllers from outside opened and driven."""

from collections.abc import Iterator, Sequence
from contextlib import ExitStack, contextmanager, nullcontext
from dataclasses import replace
from pathlib import Path
from threading import Lock
from typing import Any, Final, NamedTuple

import numpy as np
from numpy.typing import NDArray

from uictest.controllers import (
    CLOSING,
    DAMAGED,
    EXCHANGE,
    EXPLAINING,
    FORBIDDEN_COMMAND,
    GUARD,
    NO_FAILURE,
    NO_MAGNET_STATE,
    NO_REDUCTION,
    NO_REFERENCE,
    NO_REQUEST,
    NOT_CALLED,
    OPENING,
    STEP_FAILED,
    WROTE_BEYOND,
    Config,
    ControllerError,
    ControllerInstance,
    ControllerProgram,
    open_controller,
    shown_version,
)
from uictest.core.measures import STOP_MEASURES, WHEELSET_MEASURES
from uictest.rig.external.process_state import ControllerCalls
from uictest.rig.train_stop import (
    FinishedStop,
    StopInputs,
    TrainInputs,
    TrainStop,
    alone,
    compiled_rig,
    run_to_end,
    run_train_to_end,
    stacked,
)

_FAILURES: Final = {
    STEP_FAILED: "step failed: {error}",
    FORBIDDEN_COMMAND: "forbidden command for wheelset {wheelset}: vent without hold",
    NO_MAGNET_STATE: "a magnet of wheelset {wheelset} is neither 0 nor 1: hold {hold}, vent {vent}",
    WROTE_BEYOND: "the controller wrote beyond its outputs",
    NO_REDUCTION: "the reduction of the dynamic brake of wheelset {wheelset} is {reduction}, expected 0 to 1",
    NO_REFERENCE: "the reference speed is {reference}, expected a number of m/s, or NaN for none",
    NO_REQUEST: "a request is neither 0 nor 1: sand at wheelset {wheelset} {sand}, track brake {track_brake}",
}


class DamagedExchangeError(ControllerError):
    """A library wrote over the exchange of a controller, maybe of another: nobody is to blame for certain."""


_ALONE: Final = Lock()
"""Held while a controller is opened or closed: its folder and locale are those of all threads meanwhile."""


def empty_exchange() -> Any:
    """Return a record of :data:`~uictest.controllers.EXCHANGE` in memory of its own."""
    return np.zeros(1, EXCHANGE)[0]


@contextmanager
def opened(
    program: ControllerProgram, config: Config, parameters: Any, exchange: Any
) -> Iterator[ControllerInstance]:
    """Open a controller, reset it, and tell the stop with these parameters where it is.

    What it changes of the process is put back once it is reset and once it is closed; within the stop the
    compiled rig puts back what its numbers depend on after every step.

    Raises:
        ControllerError: when it cannot be loaded, created or reset, and after a stop in which it failed.
    """
    # A program at a socket changes nothing here, and may wait until it has served another.
    alone: Any = nullcontext() if program.kind == "connect" else _ALONE
    with alone:
        calls = ControllerCalls(exchange)
        with calls.of("loading, create or reset", OPENING):
            instance = open_controller(program, config)
            try:
                instance.reset()
            except BaseException:
                instance.close()
                raise
    try:
        check_requests(instance.contract, parameters)
        parameters["controller_step"] = instance.step_address
        parameters["controller_handle"] = instance.handle
        parameters["controller_contract"] = instance.contract
        parameters["controller_exchange"] = exchange.__array_interface__["data"][0]
        yield instance
        raise_if_failed(exchange, instance)
    finally:
        with alone, calls.of("destroy", CLOSING):
            instance.close()


def check_requests(contract: int, parameters: Any) -> None:
    """Raise ControllerError where a part waits for a request that a controller of version 1 cannot make."""
    parts = {"track brake": parameters["track_brake_requested"], "sander": parameters["sanders_on_request"]}
    waiting = [name for name, requested in parts.items() if np.any(requested)]
    if contract == 1 and waiting:
        raise ControllerError(
            f"it keeps contract version 1 and can ask for no {' or '.join(waiting)}, which the scenario has"
            " with `when: requested`: that needs version 2"
        )


def raise_if_failed(exchange: Any, instance: ControllerInstance) -> None:
    """Raise ControllerError if the controller failed, with the reason and the cycle.

    Raises:
        DamagedExchangeError: when what the rig noted on the controller is not what it left there.
    """
    failure, wheelset = int(exchange["failure"]), int(exchange["failed_wheelset"])
    if _is_damaged(exchange, failure, wheelset):
        exchange["failure"] = WROTE_BEYOND
        raise DamagedExchangeError("some controller of the process wrote beyond its outputs")
    if failure == NO_FAILURE:
        if not instance.failed:
            return
        failure = STEP_FAILED
    error = ""
    if failure == STEP_FAILED:
        exchange["calling"] = EXPLAINING  # for whoever watches the process
        error = instance.last_error() or "no reason given"
        exchange["calling"] = NOT_CALLED
    reason = _FAILURES[failure].format(
        error=error,
        wheelset=wheelset + 1,
        hold=exchange["hold"][wheelset],
        vent=exchange["vent"][wheelset],
        reduction=exchange["dynamic_reduction"][wheelset],
        reference=exchange["reference_speed"],
        sand=exchange["sand_request"][wheelset],
        track_brake=exchange["track_brake_request"],
    )
    raise ControllerError(f"{reason} (cycle {exchange['cycle']})")


def _is_damaged(exchange: Any, failure: int, wheelset: int) -> bool:
    if failure == NO_FAILURE:  # then the guard is whole: a broken one is a failure when its step returns
        return wheelset != 0 or bool(exchange["cycles"] and exchange["guard"] != GUARD)
    return failure not in _FAILURES or not 0 <= wheelset < len(exchange["hold"])


def run_in_process(inputs: StopInputs, steps_per_sample: int = 0, exchange: Any = None) -> FinishedStop:
    """Run a stop of a car alone with its controller, built in or from outside, in this process.

    Args:
        inputs: parameters, rail and controller.
        steps_per_sample: base steps from one sample of the trace to the next; 0: no trace.
        exchange: zeroed record of :data:`~uictest.controllers.EXCHANGE` [default: memory of its own].

    Raises:
        ControllerError: when a controller from outside cannot be opened, or failed.
    """
    exchanges = None if exchange is None or inputs.program is None else [exchange]
    [finished] = run_train_in_process(alone(inputs), steps_per_sample, exchanges).cars
    return finished


def run_train_in_process(
    inputs: TrainInputs, steps_per_sample: int = 0, exchanges: Sequence[Any] | None = None
) -> TrainStop:
    """Run a stop of a train in this process; the failure of one controller ends it.

    Args:
        inputs: of its cars.
        steps_per_sample: base steps from one sample of the traces to the next; 0: no traces.
        exchanges: zeroed records of :data:`~uictest.controllers.EXCHANGE`, one for each controller from
            outside in the order of the train [default: memory of its own].

    Raises:
        ControllerError: when a controller from outside cannot be opened, or failed; it names the car of a
            train of several.
    """
    run_train, programs = compiled_rig(), inputs.from_outside
    if exchanges is None:
        exchanges = [empty_exchange() for _ in programs]
    exchange_of_car = dict(zip(programs, exchanges, strict=True))
    controllers: dict[int, ControllerInstance] = {}
    with ExitStack() as stack:
        # In one order: trains that need the same programs at sockets do not wait for each other for ever.
        for car in sorted(programs, key=lambda car: programs[car].location):
            config = inputs.configs[car]
            assert config is not None
            with of_car(car, inputs):
                context = opened(programs[car], config, inputs.parameters[car], exchange_of_car[car])
                controllers[car] = stack.enter_context(context)
        stop = run_train_to_end(run_train, inputs, steps_per_sample)
        # What a record says of a car that has not failed, another has written, which is told first.
        at_fault = {
            car: stop.cars[car].car["controller_failed"] and exchange_of_car[car]["failure"] != DAMAGED
            for car in programs
        }
        for car in sorted(programs, key=lambda car: not at_fault[car]):
            with of_car(car, inputs):
                raise_if_failed(exchange_of_car[car], controllers[car])
    cars = list(stop.cars)
    for car, controller in controllers.items():
        cars[car] = replace(
            cars[car],
            controller_version=shown_version(controller.version),
            response_times=controller.response_times,
            contract=controller.contract,
        )
    return stop._replace(cars=tuple(cars))


@contextmanager
def of_car(car: int, inputs: TrainInputs) -> Iterator[None]:
    """Let the error of a controller in a train of several cars name its car and its program."""
    try:
        yield
    except DamagedExchangeError:
        raise
    except ControllerError as error:
        program = inputs.programs[car]
        if program is None or len(inputs.programs) == 1:
            raise
        name = program.location if program.kind == "connect" else Path(program.location).name
        named = ControllerError(f"car {car + 1} ({name}): {error}")
        named.output = error.output
        raise named from error


class BlockRun(NamedTuple):
    """Results of a block of stops.

    Attributes:
        measures: records of :data:`uictest.core.measures.STOP_MEASURES`, shape (cases,).
        wheelset_measures: records of :data:`uictest.core.measures.WHEELSET_MEASURES`, shape (cases, 4).
        failures: for each case why its controller failed, empty where it did not; the measures of a case
            that failed mean nothing.
    """

    measures: NDArray[Any]
    wheelset_measures: NDArray[Any]
    failures: list[str]


class BlockInputs(NamedTuple):
    """Inputs of a block of stops.

    Attributes:
        programs: the controller of each case that comes from outside, None where it is built in.
        configs: what those controllers are given before the stop.
        parameters: as for :func:`~uictest.rig.lanes.run_in_lanes`; the addresses of controllers from
            outside are written into them.
        wheelset_parameters: likewise.
        rail: likewise.
    """

    programs: Sequence[ControllerProgram | None]
    configs: Sequence[Config | None]
    parameters: NDArray[Any]
    wheelset_parameters: NDArray[Any]
    rail: NDArray[np.float64]

    @classmethod
    def of(cls, stops: Sequence[StopInputs]) -> "BlockInputs":
        """Return some stops as a block."""
        return cls([stop.program for stop in stops], [stop.config for stop in stops], *stacked(stops))

    def at(self, cases: Sequence[int]) -> "BlockInputs":
        """Return some of the cases."""
        return BlockInputs(
            [self.programs[case] for case in cases],
            [self.configs[case] for case in cases],
            *(self.parameters[cases], self.wheelset_parameters[cases], self.rail[cases]),
        )


def run_block(inputs: BlockInputs, exchanges: NDArray[Any] | None = None) -> BlockRun:
    """Run the stop of every case; a controller that fails ends its own stop, the others keep their bits.

    Controllers in machine code are called by address, lane by lane. Others run their stops one after the
    other: they need the interpreter, or can have only one controller at a time.

    Args:
        inputs: the cases.
        exchanges: zeroed records of :data:`~uictest.controllers.EXCHANGE`, one per case, through which the
            controllers are called [default: memory of its own].
    """
    count = len(inputs.programs)
    run, exchanges = empty_run(count), np.zeros(count, EXCHANGE) if exchanges is None else exchanges
    in_lanes: list[int] = []
    with ExitStack() as controllers:
        for case in range(count):
            program, config = inputs.programs[case], inputs.configs[case]
            records = inputs.parameters[case], inputs.wheelset_parameters[case], inputs.rail[case]
            if program is None or config is None:
                in_lanes.append(case)
                continue
            with ExitStack() as opening:
                # The outer context gets the failure of a stop, which is known when its controller is closed.
                opening.enter_context(_noting_failure(run.failures, case))
                controller = opening.enter_context(opened(program, config, records[0], exchanges[case]))
                if controller.runs_beside_others:
                    controllers.enter_context(opening.pop_all())
                    in_lanes.append(case)
                else:
                    finished = run_to_end(compiled_rig(), StopInputs(*records))
                    run.measures[case] = finished.measures
                    run.wheelset_measures[case] = finished.wheelset_measures
        if in_lanes:
            from uictest.rig.lanes import run_in_lanes  # single stops do without them

            selected = inputs.at(in_lanes)
            batch = run_in_lanes(selected.parameters, selected.wheelset_parameters, selected.rail)
            run.measures[in_lanes], run.wheelset_measures[in_lanes] = batch
    return run


def empty_run(count: int) -> BlockRun:
    """Return blank results of a number of stops, to be filled."""
    return BlockRun(np.zeros(count, STOP_MEASURES), np.zeros((count, 4), WHEELSET_MEASURES), [""] * count)


@contextmanager
def _noting_failure(failures: list[str], case: int) -> Iterator[None]:
    """Store the error of the controller of a case instead of raising it."""
    try:
        yield
    except ControllerError as error:
        failures[case] = f"controller: {error}"
