"""Requests to a child process and its answers, as messages: stops, drives, controllers."""

import json
import struct
from collections.abc import Sequence
from dataclasses import asdict
from typing import Any, BinaryIO, Final, NamedTuple

import numpy as np
from numpy.typing import NDArray

from uictest.controllers import INPUTS, OUTPUTS, Config, ControllerProgram
from uictest.core.measures import STOP_MEASURES, WHEELSET_MEASURES
from uictest.rig.external.drives import Driven, DriveRequest, Drives
from uictest.rig.external.in_process import BlockInputs, BlockRun
from uictest.rig.model.parameters import PARAMETERS, WHEELSET_PARAMETERS
from uictest.rig.model.rail import ROWS
from uictest.rig.model.state import CAR, COUPLER, WHEELSET
from uictest.rig.model.trace import TRAIN_SAMPLE, WHEELSET_SAMPLE, Trace
from uictest.rig.train_stop import FinishedStop, TrainInputs, TrainStop

_COUNT: Final = struct.Struct("<I")
_LENGTH: Final = struct.Struct("<Q")
_MOST_BLOCKS: Final = 64
_LARGEST: Final = 1 << 32


class Message(NamedTuple):
    """A message, sent in one piece."""

    head: dict[str, Any]
    blocks: tuple[bytes, ...] = ()


class BrokenMessageError(Exception):
    """The received bytes are not a message."""


class StreamEndedError(Exception):
    """The other side has ended."""


def write_message(stream: BinaryIO, message: Message) -> None:
    """Write a message at once."""
    parts = [json.dumps(message.head).encode(), *message.blocks]
    stream.write(_COUNT.pack(len(parts)) + b"".join(_LENGTH.pack(len(part)) for part in parts))
    for part in parts:
        stream.write(part)
    stream.flush()


def read_message(stream: BinaryIO) -> Message:
    """Wait for a message and return it. Raises BrokenMessageError, StreamEndedError."""
    (count,) = _COUNT.unpack(_read_exactly(stream, _COUNT.size))
    if not 0 < count <= _MOST_BLOCKS:
        raise BrokenMessageError(f"{count} blocks")
    lengths = [_LENGTH.unpack(_read_exactly(stream, _LENGTH.size))[0] for _ in range(count)]
    if sum(lengths) > _LARGEST:
        raise BrokenMessageError(f"{sum(lengths)} bytes")
    head, *blocks = [_read_exactly(stream, length) for length in lengths]
    try:
        content = json.loads(head)
    except (ValueError, RecursionError) as error:
        raise BrokenMessageError("no JSON") from error
    if not isinstance(content, dict):
        raise BrokenMessageError("no JSON object")
    return Message(content, tuple(blocks))


def _read_exactly(stream: BinaryIO, size: int) -> bytes:
    content = stream.read(size)
    if len(content) != size:
        raise StreamEndedError
    return content


def written_controllers(
    programs: Sequence[ControllerProgram | None], configs: Sequence[Config | None]
) -> list[dict[str, Any]]:
    """Return programs and what each is given before a stop, in the form of JSON."""
    return [
        {"program": asdict(program), "config": asdict(config)}
        for program, config in zip(programs, configs, strict=True)
        if program is not None and config is not None
    ]


def read_controller(form: dict[str, Any]) -> tuple[ControllerProgram, Config]:
    """Return one of them."""
    config = form["config"] | {"wheel_radius": tuple(form["config"]["wheel_radius"])}
    return ControllerProgram(**form["program"]), Config(**config)


def bytes_of(records: Sequence[Any]) -> tuple[bytes, ...]:
    """Return the bytes of records or arrays."""
    return tuple(np.ascontiguousarray(each).tobytes() for each in records)


def drive_message(request: DriveRequest) -> Message:
    """Return a drive request as a message."""
    head = {
        "request": "drive",
        "controllers": written_controllers([request.program], [request.config]),
        "beginnings": list(request.beginnings),
    }
    return Message(head, bytes_of([request.inputs]))


def drive_request_of(message: Message) -> DriveRequest:
    """Return the drive request of a message."""
    program, config = read_controller(message.head["controllers"][0])
    inputs = np.frombuffer(message.blocks[0], INPUTS)
    return DriveRequest(program, config, inputs, message.head["beginnings"])


def drives_message(drives: Drives) -> Message:
    """Return a controller's answers as a message."""
    records = [each for driven in drives.drives for each in driven]
    head = {name: getattr(drives, name) for name in ("version", "declares", "contract", "traces")}
    return Message(head, bytes_of(records))


def drives_of(message: Message) -> Drives:
    """Return a controller's answers from a message."""
    pairs = zip(message.blocks[::2], message.blocks[1::2], strict=True)
    drives = (Driven(np.frombuffer(outputs, OUTPUTS), np.frombuffer(seconds)) for outputs, seconds in pairs)
    head = message.head
    declared = head["declares"], head["contract"], tuple(head["traces"])
    return Drives(head["version"], tuple(drives), *declared)


_STOP: Final = (STOP_MEASURES, WHEELSET_MEASURES, CAR, WHEELSET, TRAIN_SAMPLE, WHEELSET_SAMPLE)


def _finished_stops(records: Sequence[Any], controller_version: str, contract: int) -> FinishedStop:
    measures, wheelset_measures, car, wheelsets, train, samples = records
    return FinishedStop(
        measures[0],
        wheelset_measures.view(np.recarray),
        car[0],
        wheelsets.view(np.recarray),
        Trace(train, samples.reshape(-1, 4)),
        controller_version,
        contract=contract,
    )


_TRAIN: Final = (PARAMETERS, WHEELSET_PARAMETERS, np.float64, COUPLER, np.float64)


def _arrays_of_blocks(blocks: Sequence[bytes | bytearray], layouts: Sequence[Any]) -> list[NDArray[Any]]:
    pairs = zip(blocks, layouts, strict=True)
    return [np.frombuffer(block, layout) if block else np.empty(0, layout) for block, layout in pairs]


def train_message(inputs: TrainInputs, steps_per_sample: int) -> Message:
    """Return a stop of a train, some or all of its controllers from outside, as a message."""
    head = {
        "request": "train",
        "steps_per_sample": steps_per_sample,
        "places": list(inputs.from_outside),
        "controllers": written_controllers(inputs.programs, inputs.configs),
    }
    return Message(head, bytes_of(inputs[: len(_TRAIN)]))


def train_of(message: Message) -> tuple[TrainInputs, int]:
    """Return the stop of a train in a message, and the base steps from one sample to the next."""
    blocks = [bytearray(block) for block in message.blocks]  # to be written to
    parameters, of_wheelsets, distances, couplers, rail = _arrays_of_blocks(blocks, _TRAIN)
    controllers = map(read_controller, message.head["controllers"])
    controller_of_car = dict(zip(message.head["places"], controllers, strict=True))
    programs, configs = zip(
        *(controller_of_car.get(car, (None, None)) for car in range(len(parameters))), strict=True
    )
    records = parameters, of_wheelsets.reshape(-1, 4), distances, couplers, rail.reshape(ROWS, -1)
    return TrainInputs(*records, programs, configs), message.head["steps_per_sample"]


def train_stop_message(stop: TrainStop) -> Message:
    """Return the results of a train's stop as a message."""
    head = {
        "controller_version": [car.controller_version for car in stop.cars],
        "contract": [car.contract for car in stop.cars],
    }
    of_cars = zip(
        *((car.measures, car.wheelset_measures, car.car, car.wheelsets, *car.trace) for car in stop.cars),
        strict=True,
    )
    return Message(head, bytes_of((*map(np.stack, of_cars), stop.couplers)))


def train_stop_of(message: Message, parameters: Any) -> TrainStop:
    """Return the results of a train's stop from a message; `parameters` are those of its inputs."""
    *of_cars, couplers = _arrays_of_blocks(message.blocks, (*_STOP, COUPLER))
    cars = zip(*(each.reshape(len(parameters), -1) for each in of_cars), strict=True)
    stated = message.head["controller_version"], message.head["contract"]
    finished = tuple(_finished_stops(*of_car) for of_car in zip(cars, *stated, strict=True))
    return TrainStop(finished, couplers, parameters)


def block_message(inputs: BlockInputs) -> Message:
    """Return stops that all have controllers from outside as a message."""
    head = {"request": "block", "controllers": written_controllers(inputs.programs, inputs.configs)}
    return Message(head, bytes_of((inputs.parameters, inputs.wheelset_parameters, inputs.rail)))


def block_of(message: Message) -> BlockInputs:
    """Return the stops in a message."""
    parameters, wheelset_parameters, rail = message.blocks
    programs, configs = zip(*map(read_controller, message.head["controllers"]), strict=True)
    count = len(programs)
    return BlockInputs(
        programs,
        configs,
        np.frombuffer(bytearray(parameters), PARAMETERS),
        np.frombuffer(bytearray(wheelset_parameters), WHEELSET_PARAMETERS).reshape(count, 4),
        np.frombuffer(rail).reshape(count, ROWS, -1),
    )


def run_message(run: BlockRun) -> Message:
    """Return the results of stops as a message."""
    return Message({"failures": run.failures}, bytes_of((run.measures, run.wheelset_measures)))


def run_of(message: Message) -> BlockRun:
    """Return the results of stops from a message."""
    measures, wheelset_measures = message.blocks
    return BlockRun(
        np.frombuffer(measures, STOP_MEASURES),
        np.frombuffer(wheelset_measures, WHEELSET_MEASURES).reshape(-1, 4),
        message.head["failures"],
    )
