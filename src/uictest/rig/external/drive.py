"""A controller driven through given cycles, without the rig: what it answers, and how long it takes."""

import ctypes
from collections.abc import Sequence
from time import perf_counter
from typing import Any, Final, Literal, NamedTuple

import numpy as np
from numpy.typing import NDArray

from uictest.controllers import (
    CLOSING,
    EXCHANGE,
    GUARD,
    NOT_CALLED,
    OPENING,
    OUTPUTS,
    OUTPUTS_AT,
    STEP_FAILED,
    STEPPING,
    WROTE_BEYOND,
    Config,
    ControllerInstance,
    ControllerProgram,
    open_controller,
)
from uictest.rig.external.opened import raise_failure
from uictest.rig.model.external_controller import call_step

FILLING_TIME: Final = 2.0
"""Time from empty to full service pressure, s; chosen, of the size that a wheelset's brake has."""
VENTING_TIME: Final = 0.6
"""Time from full service pressure to empty, s; chosen, likewise."""

Beginning = Literal["create", "reset"]
"""How a drive begins: with a new controller, or with the one of the drive before."""


class DriveRequest(NamedTuple):
    """What a controller is driven through.

    Attributes:
        program: what is loaded.
        config: what it is given.
        inputs: its inputs, one :data:`~uictest.controllers.INPUTS` for each cycle. The cylinder pressure is
            that of a brake which is never vented; valves make of it what the controller asks for.
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
    """What a controller says of itself, and its drives."""

    version: str
    drives: tuple[Driven, ...]


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
        return Drives(instance.version if instance else "", tuple(drives))
    finally:
        _close(instance, exchange)


def drive(instance: ControllerInstance, inputs: NDArray[Any], cycle_time: float, exchange: Any) -> Driven:
    """Drive a controller that has been reset. Raises ControllerError where it fails."""
    outputs, seconds = np.zeros(len(inputs), OUTPUTS), np.zeros(len(inputs))
    address = exchange.__array_interface__["data"][0]
    memory: Any = (ctypes.c_char * EXCHANGE.itemsize).from_address(address)
    pressure = np.frombuffer(memory, EXCHANGE)["cylinder_pressure"][0]
    newest = np.zeros(pressure.shape)
    for cycle, current in enumerate(inputs):
        memory[:OUTPUTS_AT] = current.tobytes()
        pressure[:] = newest
        _clear_outputs(exchange)
        exchange["cycles"] += 1
        exchange["calling"] = STEPPING
        started = perf_counter()
        status = call_step(instance.step_address, instance.handle, address)
        seconds[cycle] = perf_counter() - started
        exchange["calling"] = NOT_CALLED
        _note_failure(exchange, status)
        raise_failure(exchange, instance)
        outputs[cycle] = np.frombuffer(memory, OUTPUTS, 1, OUTPUTS_AT)[0]
        newest = _pressure_after(newest, current["cylinder_pressure"], outputs[cycle], cycle_time)
    return Driven(outputs, seconds)


def _close(instance: ControllerInstance | None, exchange: Any) -> None:
    if instance is not None:
        exchange["calling"] = CLOSING
        instance.close()
        exchange["calling"] = NOT_CALLED


def _clear_outputs(exchange: Any) -> None:
    exchange["reference_speed"] = np.nan
    exchange["hold"] = exchange["vent"] = exchange["diagnosis"] = 0
    exchange["guard"] = GUARD


def _note_failure(exchange: Any, status: int) -> None:
    if exchange["guard"] != GUARD:
        exchange["failure"] = WROTE_BEYOND
    elif status != 0:
        exchange["failure"] = STEP_FAILED


def _pressure_after(pressure: Any, demanded: Any, outputs: Any, cycle_time: float) -> Any:
    """Return the cylinder pressures at the end of a cycle, Pa: filled, held or vented at a steady rate."""
    full = demanded.max()
    filled = np.minimum(pressure + full * cycle_time / FILLING_TIME, demanded)
    vented = np.maximum(pressure - full * cycle_time / VENTING_TIME, 0.0)
    unvented = np.where(outputs["hold"] != 0, np.minimum(pressure, demanded), filled)
    return np.where(outputs["vent"] != 0, vented, unvented)
