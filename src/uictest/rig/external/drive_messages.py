"""A drive as messages: what a child process needs for it, and what the controller has answered."""

import numpy as np

from uictest.controllers import INPUTS, OUTPUTS
from uictest.rig.external.controller_messages import bytes_of, read_controller, written_controllers
from uictest.rig.external.drive import Driven, DriveRequest, Drives
from uictest.rig.external.messages import Message


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
    return DriveRequest(
        program,
        config,
        np.frombuffer(message.blocks[0], INPUTS),
        message.head["beginnings"],
    )


def drives_message(drives: Drives) -> Message:
    """Return what a controller has answered as a message."""
    records = [each for driven in drives.drives for each in driven]
    return Message({"version": drives.version}, bytes_of(records))


def drives_of(message: Message) -> Drives:
    """Return what a controller has answered from its message."""
    pairs = zip(message.blocks[::2], message.blocks[1::2], strict=True)
    drives = (Driven(np.frombuffer(outputs, OUTPUTS), np.frombuffer(seconds)) for outputs, seconds in pairs)
    return Drives(message.head["version"], tuple(drives))
