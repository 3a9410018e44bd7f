"""The frames that uictest and a program at a socket exchange: little-endian, nothing between the fields.

Every frame is a header and a body. The header holds the kind of the frame (four letters), the number of bytes
of its body (32 bits) and the number of the frame (64 bits): uictest numbers what it sends on a connection
from 0. The program answers every frame but the last with one of the same kind and number, or with FAIL and a
reason.

    kind   body from uictest                                    body of the answer
    HELO   GREETING, then the parameters as JSON in UTF-8       PROGRAM
    RSET   none                                                 none
    STEP   `uictest_inputs`                                     `uictest_outputs`
    DONE   none                                                 no answer: both sides close the connection
    FAIL   -                                                    reason in UTF-8, at most 1000 bytes

Header, order of the frames and the first field of HELO stay as they are in every version of the protocol.
"""

import struct
from typing import Final

from uictest.controllers.adapters.instance import ControllerError
from uictest.controllers.exchange import INPUTS, OUTPUTS, WHEELSETS
from uictest.controllers.interface import Config

PROTOCOL_VERSION: Final = 1

HEADER: Final = struct.Struct("<4sIQ")
"""Kind, bytes of the body, number of the frame."""
GREETING: Final = struct.Struct(f"<4I2d{WHEELSETS}d32s")
"""Protocol version, bytes of `uictest_inputs`, of `uictest_outputs`, wheelsets, cycle time (s), initial speed
(m/s), wheel radii (m), SHA-256 of the case."""
PROGRAM: Final = struct.Struct("<I60s")
"""Protocol version, name and version of the program in UTF-8, filled up with zeros."""

HELLO: Final = b"HELO"
RESET: Final = b"RSET"
STEP: Final = b"STEP"
DONE: Final = b"DONE"
FAILED: Final = b"FAIL"
LONGEST_REASON: Final = 1000
LONGEST_PARAMETERS: Final = (1 << 16) - GREETING.size
"""Bytes; chosen, so that a program may receive every frame in memory of 64 KiB."""


def greeting(config: Config, parameters: str) -> bytes:
    """Return the body of the first frame. Raises ControllerError where the parameters are too long."""
    text = parameters.encode()
    if len(text) > LONGEST_PARAMETERS:
        raise ControllerError(
            f"parameters: {len(text)} bytes as JSON, at most {LONGEST_PARAMETERS} can be sent"
        )
    sizes = INPUTS.itemsize, OUTPUTS.itemsize, config.wheelsets
    speeds = config.cycle_time, config.initial_speed, *config.wheel_radius
    return GREETING.pack(PROTOCOL_VERSION, *sizes, *speeds, bytes.fromhex(config.case_sha256)) + text


def program_name(body: bytes) -> str:
    """Return name and version of the program from its answer. Raises ControllerError for another protocol."""
    version, name = PROGRAM.unpack(body)
    if version != PROTOCOL_VERSION:
        raise ControllerError(f"the program has protocol version {version}, expected {PROTOCOL_VERSION}")
    return text_of(name)


def text_of(content: bytes) -> str:
    """Return the text before the first zero."""
    return content.partition(b"\0")[0].decode("utf-8", "replace").strip()
