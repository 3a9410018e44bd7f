"""A stop in this process, of a car or a train; controllers from outside opened and driven."""

from collections.abc import Iterator, Sequence
from contextlib import ExitStack, contextmanager, nullcontext
from dataclasses import replace
from pathlib import Path
from threading import Lock
from typing import Any, Final

import numpy as np

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
from uictest.rig.backends.stops import compiled_rig
from uictest.rig.external.process_state import ControllerCalls
from uictest.rig.single_stop import FinishedStop, StopInputs
from uictest.rig.train_stop import TrainInputs, TrainStop, run_to_end, run_train_to_end

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
            instance = _reset_instance(program, config)
    try:
        check_requests(instance.contract, parameters)
        parameters["controller_step"] = instance.step_address
        parameters["controller_handle"] = instance.handle
        parameters["controller_contract"] = instance.contract
        parameters["controller_exchange"] = exchange.__array_interface__["data"][0]
        yield instance
        raise_failure(exchange, instance)
    finally:
        with alone, calls.of("destroy", CLOSING):
            instance.close()


def _reset_instance(program: ControllerProgram, config: Config) -> ControllerInstance:
    instance = open_controller(program, config)
    try:
        instance.reset()
    except BaseException:
        instance.close()
        raise
    return instance


def check_requests(contract: int, parameters: Any) -> None:
    """Raise ControllerError where a part waits for a request that a controller of version 1 cannot make."""
    parts = {"track brake": parameters["track_brake_requested"], "sander": parameters["sanders_on_request"]}
    waiting = [name for name, requested in parts.items() if np.any(requested)]
    if contract == 1 and waiting:
        raise ControllerError(
            f"it keeps contract version 1 and can ask for no {' or '.join(waiting)}, which the scenario has"
            " with `when: requested`: that needs version 2"
        )


def raise_failure(exchange: Any, instance: ControllerInstance) -> None:
    """Raise ControllerError if the controller failed, with the reason and the cycle.

    Raises:
        DamagedExchangeError: when what the rig noted on the controller is not what it left there.
    """
    failure, place = int(exchange["failure"]), int(exchange["failed_wheelset"])
    if _is_damaged(exchange, failure, place):
        exchange["failure"] = WROTE_BEYOND
        raise DamagedExchangeError("some controller of the process wrote beyond its outputs")
    if failure == NO_FAILURE:
        if not instance.failed:
            return
        failure = STEP_FAILED
    reason = _FAILURES[failure].format(
        error=_explanation(exchange, instance) if failure == STEP_FAILED else "",
        wheelset=place + 1,
        hold=exchange["hold"][place],
        vent=exchange["vent"][place],
        reduction=exchange["dynamic_reduction"][place],
        reference=exchange["reference_speed"],
        sand=exchange["sand_request"][place],
        track_brake=exchange["track_brake_request"],
    )
    raise ControllerError(f"{reason} (cycle {exchange['cycle']})")


def _is_at_fault(finished: FinishedStop, exchange: Any) -> bool:
    """Whether a controller failed, by more than what others wrote on it."""
    return bool(finished.car["controller_failed"] and exchange["failure"] != DAMAGED)


def _is_damaged(exchange: Any, failure: int, place: int) -> bool:
    if failure == NO_FAILURE:  # then the guard is whole: a broken one is a failure when its step returns
        return place != 0 or bool(exchange["cycles"] and exchange["guard"] != GUARD)
    return failure not in _FAILURES or not 0 <= place < len(exchange["hold"])


def _explanation(exchange: Any, instance: ControllerInstance) -> str:
    """Ask why a step failed; whoever watches sees which controller is asked."""
    exchange["calling"] = EXPLAINING
    error = instance.last_error()
    exchange["calling"] = NOT_CALLED
    return error or "no reason given"


def run_in_process(inputs: StopInputs, steps_per_sample: int = 0, exchange: Any = None) -> FinishedStop:
    """Run a stop with its controller, built in or from outside, in this process.

    Args:
        inputs: parameters, rail and controller.
        steps_per_sample: base steps from one sample of the trace to the next; 0: no trace.
        exchange: zeroed record of :data:`~uictest.controllers.EXCHANGE` [default: memory of its own].

    Raises:
        ControllerError: when a controller from outside cannot be opened, or failed.
    """
    run_stop = compiled_rig()
    if inputs.program is None or inputs.config is None:
        return run_to_end(run_stop, inputs, steps_per_sample)
    exchange = empty_exchange() if exchange is None else exchange
    with opened(inputs.program, inputs.config, inputs.parameters, exchange) as controller:
        finished = run_to_end(run_stop, inputs, steps_per_sample)
    return _with_controller(finished, controller)


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
        ControllerError: when a controller from outside cannot be opened, or failed; it names the car.
    """
    run_train, programs = compiled_rig(), inputs.from_outside
    if exchanges is None:
        exchanges = [empty_exchange() for _ in programs]
    own_exchanges = dict(zip(programs, exchanges, strict=True))
    controllers: dict[int, ControllerInstance] = {}
    with ExitStack() as stack:
        # In one order: trains that need the same programs at sockets do not wait for each other for ever.
        for car in sorted(programs, key=lambda car: programs[car].location):
            config, exchange = inputs.configs[car], own_exchanges[car]
            assert config is not None
            with of_car(car, programs[car]):
                context = opened(programs[car], config, inputs.parameters[car], exchange)
                controllers[car] = stack.enter_context(context)
        stop = run_train_to_end(run_train, inputs, steps_per_sample)
        # What a record says of a car that has not failed, another has written, which is told first.
        for car in sorted(programs, key=lambda car: not _is_at_fault(stop.cars[car], own_exchanges[car])):
            with of_car(car, programs[car]):
                raise_failure(own_exchanges[car], controllers[car])
    return stop._replace(
        cars=tuple(
            finished if car not in controllers else _with_controller(finished, controllers[car])
            for car, finished in enumerate(stop.cars)
        )
    )


@contextmanager
def of_car(car: int, program: ControllerProgram) -> Iterator[None]:
    """Let the error of a controller name its car, which is counted from 0, and its program."""
    try:
        yield
    except DamagedExchangeError:
        raise
    except ControllerError as error:
        name = program.location if program.kind == "connect" else Path(program.location).name
        named = ControllerError(f"car {car + 1} ({name}): {error}")
        named.output = error.output
        raise named from error


def _with_controller(finished: FinishedStop, controller: ControllerInstance) -> FinishedStop:
    return replace(
        finished,
        controller_version=shown_version(controller.version),
        response_times=controller.response_times,
        contract=controller.contract,
    )
