"""A WSP controller in a program of its own: uictest connects to it and asks for one answer per cycle.

    python wsp.py 5025        port 0: the system chooses one

It fills below a lower slide, vents above an upper one and holds between them. Put your own controller in the
place of SlipBand. docs/socket.md describes the frames.
"""

import json
import socket
import struct
import sys

HEADER = struct.Struct("<4sIQ")  # kind, bytes of the body, number
GREETING = struct.Struct("<4I6d32s")  # version, sizes, times, speeds, SHA-256; parameters as JSON follow
PROGRAM = struct.Struct("<I60s")  # protocol version, name and version of this program
INPUTS = struct.Struct("<q10d4i")  # cycle, time, speeds, pressures, brake demand, validity of the speeds
OUTPUTS = struct.Struct("<d8i2I")  # reference speed, hold, vent, diagnosis, padding


class SlipBand:
    """One band of slide against the fastest wheelset."""

    def __init__(self, cycle_time: float, initial_speed: float, parameters: dict[str, float]) -> None:
        self.cycle_time, self.initial_speed = cycle_time, initial_speed
        self.deceleration = parameters.get("reference_deceleration", 1.8)  # m/s2
        self.minimum_speed = parameters.get("minimum_speed", 5 / 3.6)  # m/s
        self.lower_slide = parameters.get("lower_slide", 0.08)
        self.upper_slide = parameters.get("upper_slide", 0.20)

    def reset(self) -> None:
        self.reference = self.initial_speed

    def step(self, speeds: tuple[float, ...]) -> tuple[float, list[int], list[int]]:
        """Return the reference speed, m/s, and the states of the holding and of the venting magnets."""
        self.reference = max(self.reference - self.deceleration * self.cycle_time, *speeds)
        slides = [(self.reference - speed) / max(self.reference, self.minimum_speed) for speed in speeds]
        protects = self.reference >= self.minimum_speed
        hold = [int(protects and slide >= self.lower_slide) for slide in slides]
        vent = [int(protects and slide > self.upper_slide) for slide in slides]
        return self.reference, hold, vent


def received(stream: socket.socket, size: int) -> bytes:
    content = b""
    while len(content) < size:
        part = stream.recv(size - len(content))
        if not part:
            raise ConnectionError("uictest has closed the connection")
        content += part
    return content


def answer(stream: socket.socket, kind: bytes, number: int, body: bytes = b"") -> None:
    stream.sendall(HEADER.pack(kind, len(body), number) + body)


def serve(stream: socket.socket) -> None:
    """Serve one stop."""
    stream.setsockopt(socket.IPPROTO_TCP, socket.TCP_NODELAY, 1)
    while True:
        kind, size, number = HEADER.unpack(received(stream, HEADER.size))
        body = received(stream, size)
        if kind == b"HELO":
            version, inputs, outputs, _, cycle_time, initial_speed, *_ = GREETING.unpack_from(body)
            if (version, inputs, outputs) != (1, INPUTS.size, OUTPUTS.size):
                answer(stream, b"FAIL", number, b"expected protocol version 1")
                return
            controller = SlipBand(cycle_time, initial_speed, json.loads(body[GREETING.size :]))
            answer(stream, kind, number, PROGRAM.pack(1, b"slip band in Python 1.0"))
        elif kind == b"RSET":
            controller.reset()
            answer(stream, kind, number)
        elif kind == b"STEP":
            _, _, *values = INPUTS.unpack(body)
            reference, hold, vent = controller.step(tuple(values[:4]))
            answer(stream, kind, number, OUTPUTS.pack(reference, *hold, *vent, 0, 0))
        else:
            return


def main(port: int) -> None:
    with socket.create_server(("127.0.0.1", port)) as listener:
        print(f"listening on tcp://127.0.0.1:{listener.getsockname()[1]}", flush=True)
        while True:
            stream, _ = listener.accept()
            with stream:
                try:
                    serve(stream)
                except ConnectionError as error:
                    print(error, file=sys.stderr)


if __name__ == "__main__":
    main(int(sys.argv[1]) if len(sys.argv) > 1 else 5025)
