"""A stop in this process, its controller built in or from outside; one from outside opened and driven."""

import ctypes
from collections.abc import Iterator, Sequence
from contextlib import contextmanager
from dataclasses import replace
from time import perf_counter
from typing import Any, Final, Literal, NamedTuple

import numpy as np
from numpy.typing import NDArray

from uictest.controllers import (
    CLOSING,
    EXCHANGE,
    FORBIDDEN_COMMAND,
    GUARD,
    NO_FAILURE,
    NO_MAGNET_STATE,
    NO_REDUCTION,
    NO_REQUEST,
    NOT_CALLED,
    OPENING,
    OUTPUTS,
    OUTPUTS_AT,
    STEP_FAILED,
    STEPPING,
    UNTOUCHED,
    WROTE_BEYOND,
    Config,
    ControllerError,
    ControllerInstance,
    ControllerProgram,
    open_controller,
    shown_version,
)
from uictest.rig.backends.native import compiled_stop
from uictest.rig.model.controller import call_step
from uictest.rig.single_stop import FinishedStop, StopInputs, run_to_end

_FAILURES: Final = {
    STEP_FAILED: "step failed: {error}",
    FORBIDDEN_COMMAND: "forbidden command for wheelset {wheelset}: vent without hold",
    NO_MAGNET_STATE: "a magnet of wheelset {wheelset} is neither 0 nor 1: hold {hold}, vent {vent}",
    WROTE_BEYOND: "the controller wrote beyond its outputs",
    NO_REDUCTION: "the reduction of the dynamic brake of wheelset {wheelset} is {reduction}, expected 0 to 1",
    NO_REQUEST: "a request is neither 0 nor 1: sand at wheelset {wheelset} {sand}, track brake {track_brake}",
}


def empty_exchange() -> Any:
    """Return a record of :data:`~uictest.controllers.EXCHANGE` in memory of its own."""
    return np.zeros(1, EXCHANGE)[0]


@contextmanager
def opened(
    program: ControllerProgram, config: Config, parameters: Any, exchange: Any
) -> Iterator[ControllerInstance]:
    """Open a controller, reset it, and tell the stop with these parameters where it is.

    Raises:
        ControllerError: when it cannot be loaded, created or reset, and after a stop in which it failed.
    """
    exchange["calling"] = OPENING
    try:
        instance = open_controller(program, config)
        try:
            instance.reset()
            exchange["calling"] = NOT_CALLED
            _check_requests(instance.contract, parameters)
            parameters["controller_step"] = instance.step_address
            parameters["controller_handle"] = instance.handle
            parameters["controller_contract"] = instance.contract
            parameters["controller_exchange"] = exchange.__array_interface__["data"][0]
            yield instance
            raise_failure(exchange, instance)
        finally:
            exchange["calling"] = CLOSING
            instance.close()
    finally:
        # Also where it could not be opened: whoever watches a block asks which controller does not return.
        exchange["calling"] = NOT_CALLED


def _check_requests(contract: int, parameters: Any) -> None:
    """Raise ControllerError where a part waits for a request that a controller of version 1 cannot make."""
    parts = {"track brake": parameters["track_brake_requested"], "sander": parameters["sanders_on_request"]}
    waiting = [name for name, requested in parts.items() if np.any(requested)]
    if contract == 1 and waiting:
        raise ControllerError(
            f"it keeps contract version 1 and can ask for no {' or '.join(waiting)}, which the scenario has"
            " with `when: requested`: that needs version 2"
        )


def raise_failure(exchange: Any, instance: ControllerInstance) -> None:
    """Raise ControllerError if the controller failed, with the reason and the cycle."""
    failure = int(exchange["failure"])
    if failure == NO_FAILURE:
        return
    place = int(exchange["failed_wheelset"])
    reason = _FAILURES[failure].format(
        error=instance.last_error() or "no reason given",
        wheelset=place + 1,
        hold=exchange["hold"][place],
        vent=exchange["vent"][place],
        reduction=exchange["dynamic_reduction"][place],
        sand=exchange["sand_request"][place],
        track_brake=exchange["track_brake_request"],
    )
    raise ControllerError(f"{reason} (cycle {exchange['cycle']})")


def run_in_process(inputs: StopInputs, steps_per_sample: int = 0, exchange: Any = None) -> FinishedStop:
    """Run a stop with its controller, built in or from outside, in this process.

    Args:
        inputs: parameters, rail and controller.
        steps_per_sample: base steps from one sample of the trace to the next; 0: no trace.
        exchange: zeroed record of :data:`~uictest.controllers.EXCHANGE` [default: memory of its own].

    Raises:
        ControllerError: when a controller from outside cannot be opened, or failed.
    """
    run_stop = compiled_stop()
    if inputs.program is None or inputs.config is None:
        return run_to_end(run_stop, inputs, steps_per_sample)
    exchange = empty_exchange() if exchange is None else exchange
    with opened(inputs.program, inputs.config, inputs.parameters, exchange) as controller:
        finished = run_to_end(run_stop, inputs, steps_per_sample)
    return replace(
        finished,
        controller_version=shown_version(controller.version),
        response_times=controller.response_times,
        contract=controller.contract,
    )


FILLING_TIME: Final = 2.0
"""Time from empty to full service pressure, s; chosen, of the size that a wheelset's brake has."""
VENTING_TIME: Final = 0.6
"""Time from full service pressure to empty, s; chosen, likewise."""

DYNAMIC_RESPONSE: Final = 0.3
"""Time constant of a motor that follows what is asked of it, s; chosen, that of `brake.dynamic`."""

Beginning = Literal["create", "reset"]
"""How a drive begins: with a new controller, or with the one of the drive before."""


class DriveRequest(NamedTuple):
    """What a controller is driven through.

    Attributes:
        program: what is loaded.
        config: what it is given.
        inputs: its inputs, one :data:`~uictest.controllers.INPUTS` for each cycle. The cylinder pressure is
            that of a brake which is never vented, and the dynamic brake that of a motor which is never
            reduced; valves and motors make of it what the controller asks for.
        beginnings: the drives through these cycles.
    """

    program: ControllerProgram
    config: Config
    inputs: NDArray[Any]
    beginnings: Sequence[Beginning] = ("create",)


class Driven(NamedTuple):
    """What a controller has answered.

    Attributes:
        outputs: one :data:`~uictest.controllers.OUTPUTS` for each cycle.
        seconds: how long each answer took.
    """

    outputs: NDArray[Any]
    seconds: NDArray[np.float64]


class Drives(NamedTuple):
    """What a controller says of itself, its drives, the JSON in which it declares its parameters, and the
    version of the contract that it keeps.
    """

    version: str
    drives: tuple[Driven, ...]
    declares: str = ""
    contract: int = 1


def drive_controller(request: DriveRequest, exchange: Any) -> Drives:
    """Drive a controller in this process. Raises ControllerError where it fails."""
    instance: ControllerInstance | None = None
    drives = []
    try:
        for beginning in request.beginnings:
            if beginning == "create":
                closed, instance = instance, None
                _close(closed, exchange)
                exchange["calling"] = OPENING
                instance = open_controller(request.program, request.config)
            if instance is None:
                raise ValueError("the first drive begins with a new controller")
            exchange["calling"] = OPENING
            instance.reset()
            exchange["calling"] = NOT_CALLED
            drives.append(drive(instance, request.inputs, request.config.cycle_time, exchange))
        if instance is None:
            return Drives("", ())
        return Drives(instance.version, tuple(drives), instance.declares, instance.contract)
    finally:
        _close(instance, exchange)


def drive(instance: ControllerInstance, inputs: NDArray[Any], cycle_time: float, exchange: Any) -> Driven:
    """Drive a controller that has been reset. Raises ControllerError where it fails."""
    seconds, answers = np.zeros(len(inputs)), bytearray()
    address = exchange.__array_interface__["data"][0]
    memory: Any = (ctypes.c_char * EXCHANGE.itemsize).from_address(address)
    names = "cylinder_pressure", "hold", "vent", "dynamic_reduction", "sand_request", "dynamic_brake"
    pressure, hold, vent, reduction, sand, dynamic = (exchange[name] for name in names)
    brakes, gain = bool(inputs["dynamic_brake"].any()), min(cycle_time / DYNAMIC_RESPONSE, 1.0)
    effort = inputs["dynamic_brake"][:1].copy()
    untouched = UNTOUCHED if instance.contract == 1 else 0.0
    newest = [0.0] * len(pressure)
    for cycle, demanded in enumerate(inputs["cylinder_pressure"].tolist()):
        memory[:OUTPUTS_AT] = inputs[cycle].tobytes()
        pressure[:] = newest
        if brakes:
            wanted = dynamic * (1.0 - np.clip(reduction, 0.0, 1.0)) if cycle else dynamic
            effort += gain * (wanted - effort)
            dynamic[:] = effort[0]
        exchange["reference_speed"] = np.nan
        hold[:] = vent[:] = sand[:] = exchange["diagnosis"] = exchange["track_brake_request"] = 0
        reduction[:] = untouched
        exchange["guard"] = GUARD
        exchange["cycles"] += 1
        exchange["calling"] = STEPPING
        started = perf_counter()
        status = call_step(instance.step_address, instance.handle, address)
        seconds[cycle] = perf_counter() - started
        exchange["calling"] = NOT_CALLED
        beyond = exchange["guard"] != GUARD
        if beyond or (
            untouched and (any(reduction != untouched) or any(sand) or exchange["track_brake_request"])
        ):
            exchange["failure"] = WROTE_BEYOND
        elif status != 0:
            exchange["failure"] = STEP_FAILED
        raise_failure(exchange, instance)
        answers += memory[OUTPUTS_AT : OUTPUTS_AT + OUTPUTS.itemsize]
        full, magnets = max(demanded), zip(hold.tolist(), vent.tolist(), strict=True)
        newest = [
            _pressure_after(*each, full, cycle_time) for each in zip(newest, demanded, magnets, strict=True)
        ]
    return Driven(np.frombuffer(answers, OUTPUTS), seconds)


def _close(instance: ControllerInstance | None, exchange: Any) -> None:
    if instance is not None:
        exchange["calling"] = CLOSING
        instance.close()
        exchange["calling"] = NOT_CALLED


def _pressure_after(
    pressure: float, demanded: float, magnets: tuple[int, int], full: float, cycle_time: float
) -> float:
    """Return a cylinder's pressure at the end of a cycle, Pa: filled, held or vented at a steady rate."""
    hold, vent = magnets
    if vent:
        return max(pressure - full * cycle_time / VENTING_TIME, 0.0)
    return min(pressure if hold else pressure + full * cycle_time / FILLING_TIME, demanded)
