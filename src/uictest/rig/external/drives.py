"""A controller from outside driven through given cycles in this process, without the rig."""

from collections.abc import Iterable, Iterator, Sequence
from contextlib import ExitStack, contextmanager
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
    UNTOUCHED,
    WROTE_BEYOND,
    Config,
    ControllerInstance,
    ControllerProgram,
    OnlyOneError,
    open_controller,
)
from uictest.rig.external.in_process import raise_if_failed
from uictest.rig.external.process_state import ControllerCalls
from uictest.rig.model.controller import call_step

FILLING_TIME: Final = 2.0
"""Time from empty to full service pressure, s; chosen, of the size that a wheelset's brake has."""
VENTING_TIME: Final = 0.6
"""Time from full service pressure to empty, s; chosen, likewise."""

DYNAMIC_RESPONSE: Final = 0.3
"""Time constant of a motor that follows what is asked of it, s; chosen, that of `brake.dynamic`."""

_GUARD_AT: Final = OUTPUTS_AT + OUTPUTS.itemsize
"""Offset of the guard in :data:`~uictest.controllers.EXCHANGE`."""

Beginning = Literal["create", "reset", "beside"]
"""How a drive begins: with a new controller, with that of the previous drive after a reset, or with a new one
together with another, called first in each cycle, which is given the inputs from last to first."""


class DriveRequest(NamedTuple):
    """Inputs of one or several drives of a controller.

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
    """Answers of a controller in one drive.

    Attributes:
        outputs: one :data:`~uictest.controllers.OUTPUTS` for each cycle.
        seconds: how long each answer took.
    """

    outputs: NDArray[Any]
    seconds: NDArray[np.float64]


class Drives(NamedTuple):
    """What a controller says of itself, its drives, the JSON in which it declares its parameters, and the
    version of the contract that it keeps.

    `traces` is what its calls left changed in the process, and the call, e.g. `locale de_DE after step`.
    """

    version: str
    drives: tuple[Driven, ...]
    declares: str = ""
    contract: int = 1
    traces: tuple[str, ...] = ()


def drive_controller(request: DriveRequest, exchange: Any) -> Drives:
    """Drive a controller in this process. Raises ControllerError where it fails.

    A drive beside another controller has no answers where only one can be open in a process.
    """
    drives: list[Driven] = []
    calls = ControllerCalls(exchange)
    with ExitStack() as controllers:
        instance: ControllerInstance | None = None
        for beginning in request.beginnings:
            if beginning != "reset":
                controllers.close()
                instance = controllers.enter_context(_opened_controller(request, calls))
            if instance is None:
                raise ValueError("the first drive begins with a new controller")
            with calls.of("reset", OPENING):
                instance.reset()
            if beginning == "beside":
                drives.append(_drive_beside(instance, request, calls))
            else:
                drives.append(
                    _collected_answers(
                        _answers_by_cycle(instance, request.inputs, request.config.cycle_time, calls)
                    )
                )
    if instance is None:
        return Drives("", ())
    said = instance.declares, instance.contract
    return Drives(instance.version, tuple(drives), *said, tuple(calls.traces.values()))


@contextmanager
def _opened_controller(request: DriveRequest, calls: ControllerCalls) -> Iterator[ControllerInstance]:
    with calls.of("loading or create", OPENING):
        instance = open_controller(request.program, request.config)
    try:
        yield instance
    finally:
        with calls.of("destroy", CLOSING):
            instance.close()


def drive(instance: ControllerInstance, inputs: NDArray[Any], cycle_time: float, exchange: Any) -> Driven:
    """Drive a controller that has been reset. Raises ControllerError where it fails."""
    return _collected_answers(_answers_by_cycle(instance, inputs, cycle_time, ControllerCalls(exchange)))


def _drive_beside(instance: ControllerInstance, request: DriveRequest, calls: ControllerCalls) -> Driven:
    inputs, cycle_time = request.inputs, request.config.cycle_time
    reversed_inputs = inputs[::-1].copy()
    for name in ("cycle", "time"):  # its own cycles begin at 0, too: no clock runs backwards
        reversed_inputs[name] = inputs[name]
    with ExitStack() as others:
        try:
            other = others.enter_context(_opened_controller(request, calls))
        except OnlyOneError:
            return _collected_answers(())
        with calls.of("reset", OPENING):
            other.reset()
        both = zip(
            _answers_by_cycle(other, reversed_inputs, cycle_time, calls),
            _answers_by_cycle(instance, inputs, cycle_time, calls),
            strict=True,
        )
        return _collected_answers(own for _, own in both)


def _collected_answers(answers: Iterable[tuple[bytes, float]]) -> Driven:
    outputs, seconds = bytearray(), []
    for answer, duration in answers:
        outputs += answer
        seconds.append(duration)
    return Driven(np.frombuffer(outputs, OUTPUTS), np.array(seconds, float))


def _answers_by_cycle(
    instance: ControllerInstance, inputs: NDArray[Any], cycle_time: float, calls: ControllerCalls
) -> Iterator[tuple[bytes, float]]:
    """Yield a controller's answer in each cycle, as bytes, and the time that it took, s.

    Between two cycles the exchange may serve another controller. Raises ControllerError.
    """
    exchange = calls.exchange
    address = exchange.__array_interface__["data"][0]
    layout: Any = EXCHANGE
    fields: Any = np.ctypeslib.as_ctypes_type(layout).from_address(address)
    memory = memoryview(fields).cast("B")
    pressure, reduction = fields.cylinder_pressure, fields.dynamic_reduction
    dynamic, reduced = exchange["dynamic_brake"], exchange["dynamic_reduction"]
    brakes, gain = bool(inputs["dynamic_brake"].any()), min(cycle_time / DYNAMIC_RESPONSE, 1.0)
    effort = inputs["dynamic_brake"][:1].copy()
    untouched = UNTOUCHED if instance.contract == 1 else 0.0
    blank, untouched_reduction = np.zeros(1, OUTPUTS), [untouched] * len(reduction)
    blank["reference_speed"], blank["dynamic_reduction"] = np.nan, untouched
    newest = [0.0] * len(pressure)
    for cycle, demanded in enumerate(inputs["cylinder_pressure"].tolist()):
        memory[:OUTPUTS_AT] = inputs[cycle].tobytes()
        pressure[:] = newest
        if brakes:
            wanted = dynamic * (1.0 - np.clip(reduced, 0.0, 1.0)) if cycle else dynamic
            effort += gain * (wanted - effort)
            dynamic[:] = effort[0]
        memory[OUTPUTS_AT:_GUARD_AT] = blank.tobytes()
        fields.guard = GUARD
        fields.cycles += 1
        fields.calling = STEPPING
        started = perf_counter()
        status = call_step(instance.step_address, instance.handle, address)
        seconds = perf_counter() - started
        fields.calling = NOT_CALLED
        calls.restore_state("step")
        beyond = fields.guard != GUARD
        if beyond or (
            untouched
            and (
                reduction[:] != untouched_reduction or any(fields.sand_request) or fields.track_brake_request
            )
        ):
            fields.failure = WROTE_BEYOND
        elif status != 0:
            fields.failure = STEP_FAILED
        raise_if_failed(exchange, instance)
        answer = bytes(memory[OUTPUTS_AT:_GUARD_AT])
        full, magnets = max(demanded), zip(fields.hold, fields.vent, strict=True)
        newest = [
            _pressure_after(*each, full, cycle_time) for each in zip(newest, demanded, magnets, strict=True)
        ]
        yield answer, seconds


def _pressure_after(
    pressure: float, demanded: float, magnets: tuple[int, int], full: float, cycle_time: float
) -> float:
    """Return a cylinder's pressure at the end of a cycle, Pa: filled, held or vented at a steady rate."""
    hold, vent = magnets
    if vent:
        return max(pressure - full * cycle_time / VENTING_TIME, 0.0)
    return min(pressure if hold else pressure + full * cycle_time / FILLING_TIME, demanded)
