"""What a child process is told and answers, as messages: stops, drives, controllers."""

import json
import struct
from collections.abc import Sequence
from dataclasses import asdict
from typing import Any, BinaryIO, Final, NamedTuple

import numpy as np

from uictest.controllers import INPUTS, OUTPUTS, Config, ControllerProgram
from uictest.core.measures import STOP_MEASURES, WHEELSET_MEASURES
from uictest.rig.external.block import BlockInputs, BlockRun
from uictest.rig.external.drives import Driven, DriveRequest, Drives
from uictest.rig.model.couplers import COUPLER
from uictest.rig.model.parameters import PARAMETERS
from uictest.rig.model.rail import ROWS
from uictest.rig.model.state import CAR, WHEELSET
from uictest.rig.model.trace import TRAIN_SAMPLE, WHEELSET_SAMPLE, Trace
from uictest.rig.model.wheelset_parameters import WHEELSET_PARAMETERS
from uictest.rig.single_stop import FinishedStop, StopInputs
from uictest.rig.train_stop import TrainInputs, TrainStop

_COUNT: Final = struct.Struct("<I")
_LENGTH: Final = struct.Struct("<Q")
_MOST_BLOCKS: Final = 64
_LARGEST: Final = 1 << 32


class Message(NamedTuple):
    """What is sent at once."""

    head: dict[str, Any]
    blocks: tuple[bytes, ...] = ()


class BrokenMessageError(Exception):
    """What the other side sent is no message."""


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
    (count,) = _COUNT.unpack(_exactly(stream, _COUNT.size))
    if not 0 < count <= _MOST_BLOCKS:
        raise BrokenMessageError(f"{count} blocks")
    lengths = [_LENGTH.unpack(_exactly(stream, _LENGTH.size))[0] for _ in range(count)]
    if sum(lengths) > _LARGEST:
        raise BrokenMessageError(f"{sum(lengths)} bytes")
    head, *blocks = [_exactly(stream, length) for length in lengths]
    try:
        said = json.loads(head)
    except (ValueError, RecursionError) as error:
        raise BrokenMessageError("no JSON") from error
    if not isinstance(said, dict):
        raise BrokenMessageError("no JSON object")
    return Message(said, tuple(blocks))


def _exactly(stream: BinaryIO, size: int) -> bytes:
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
    """Return what a controller is driven through as a message."""
    head = {
        "request": "drive",
        "controllers": written_controllers([request.program], [request.config]),
        "beginnings": list(request.beginnings),
    }
    return Message(head, bytes_of([request.inputs]))


def drive_request_of(message: Message) -> DriveRequest:
    """Return what a controller is driven through from its message."""
    program, config = read_controller(message.head["controllers"][0])
    inputs = np.frombuffer(message.blocks[0], INPUTS)
    return DriveRequest(program, config, inputs, message.head["beginnings"])


def drives_message(drives: Drives) -> Message:
    """Return what a controller has answered as a message."""
    records = [each for driven in drives.drives for each in driven]
    head = {name: getattr(drives, name) for name in ("version", "declares", "contract", "traces")}
    return Message(head, bytes_of(records))


def drives_of(message: Message) -> Drives:
    """Return what a controller has answered from its message."""
    pairs = zip(message.blocks[::2], message.blocks[1::2], strict=True)
    drives = (Driven(np.frombuffer(outputs, OUTPUTS), np.frombuffer(seconds)) for outputs, seconds in pairs)
    head = message.head
    said = head["declares"], head["contract"], tuple(head["traces"])
    return Drives(head["version"], tuple(drives), *said)


_STOP: Final = (STOP_MEASURES, WHEELSET_MEASURES, CAR, WHEELSET, TRAIN_SAMPLE, WHEELSET_SAMPLE)


def stop_message(inputs: StopInputs, steps_per_sample: int) -> Message:
    """Return a stop with a controller from outside as a message."""
    records = inputs.parameters, inputs.wheelset_parameters, inputs.rail
    head = {
        "request": "stop",
        "steps_per_sample": steps_per_sample,
        "controllers": written_controllers([inputs.program], [inputs.config]),
    }
    return Message(head, bytes_of(records))


def stop_of(message: Message) -> tuple[StopInputs, int]:
    """Return the stop in a message, and the base steps from one sample of its trace to the next."""
    inputs = block_of(message)
    first = inputs.parameters[0], inputs.wheelset_parameters[0], inputs.rail[0]
    return StopInputs(*first, inputs.programs[0], inputs.configs[0]), message.head["steps_per_sample"]


def finished_message(finished: FinishedStop) -> Message:
    """Return what a stop leaves as a message."""
    own = finished.measures, finished.wheelset_measures, finished.car, finished.wheelsets
    head = {"controller_version": finished.controller_version, "contract": finished.contract}
    return Message(head, bytes_of((*own, *finished.trace)))


def finished_of(message: Message) -> FinishedStop:
    """Return what a stop has left."""
    records = [np.frombuffer(*each) for each in zip(message.blocks, _STOP, strict=True)]
    return _finished(records, message.head["controller_version"], message.head["contract"])


def _finished(records: Sequence[Any], controller_version: str, contract: int) -> FinishedStop:
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
_TRAIN_STOP: Final = (*_STOP, COUPLER)


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
    blocks = map(bytearray, message.blocks)  # to be written to
    parameters, of_wheelsets, distances, couplers, rail = (
        np.frombuffer(*each) if each[0] else np.empty(0, each[1]) for each in zip(blocks, _TRAIN, strict=True)
    )
    controllers = map(read_controller, message.head["controllers"])
    own = dict(zip(message.head["places"], controllers, strict=True))
    programs, configs = zip(*(own.get(car, (None, None)) for car in range(len(parameters))), strict=True)
    records = parameters, of_wheelsets.reshape(-1, 4), distances, couplers, rail.reshape(ROWS, -1)
    return TrainInputs(*records, programs, configs), message.head["steps_per_sample"]


def train_stop_message(stop: TrainStop) -> Message:
    """Return what a stop of a train leaves as a message."""
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
    """Return what a stop of a train has left; the parameters are those that it was given."""
    *of_cars, couplers = (
        np.frombuffer(*each) if each[0] else np.empty(0, each[1])
        for each in zip(message.blocks, _TRAIN_STOP, strict=True)
    )
    cars = zip(*(each.reshape(len(parameters), -1) for each in of_cars), strict=True)
    said = message.head["controller_version"], message.head["contract"]
    finished = tuple(_finished(*of_car) for of_car in zip(cars, *said, strict=True))
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
    """Return what stops leave as a message."""
    return Message({"failures": run.failures}, bytes_of((run.measures, run.wheelset_measures)))


def run_of(message: Message) -> BlockRun:
    """Return what stops have left."""
    measures, wheelset_measures = message.blocks
    return BlockRun(
        np.frombuffer(measures, STOP_MEASURES),
        np.frombuffer(wheelset_measures, WHEELSET_MEASURES).reshape(-1, 4),
        message.head["failures"],
    )
