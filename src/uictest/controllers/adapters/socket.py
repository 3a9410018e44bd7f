"""Controllers in a program of their own that listens on a TCP port; uictest connects for every stop."""

import ctypes

from uictest.controllers.adapters.connection import Connection
from uictest.controllers.adapters.instance import CallbackInstance
from uictest.controllers.adapters.real_time import RealTime, ResponseTimes
from uictest.controllers.adapters.socket_frames import (
    HELLO,
    PROGRAM,
    RESET,
    STEP,
    greeting,
    program_name,
)
from uictest.controllers.adapters.turns import Turn
from uictest.controllers.exchange import INPUTS, OUTPUTS
from uictest.controllers.interface import Config
from uictest.controllers.program import ControllerProgram


class SocketInstance(CallbackInstance):
    """The program for one stop: connected and greeted."""

    def __init__(
        self, turn: Turn, connection: Connection, program: ControllerProgram, config: Config
    ) -> None:
        super().__init__()
        self._turn = turn
        self._connection = connection
        self._clock = RealTime(config.cycle_time) if program.real_time else None
        answer = connection.request(HELLO, greeting(config, program.parameters), PROGRAM.size)
        self.version = program_name(answer)

    @property
    def response_times(self) -> ResponseTimes | None:
        """How the program answered, where cycles are paced by the clock."""
        return None if self._clock is None else self._clock.response_times

    def reset(self) -> None:
        """Let the program reset."""
        self._connection.request(RESET, b"", 0)

    def answer(self, inputs: int, outputs: int) -> None:
        """Let the program answer one cycle, in real time once the cycle is due."""
        if self._clock is not None:
            self._clock.begin_cycle()
        body = self._connection.request(STEP, ctypes.string_at(inputs, INPUTS.itemsize), OUTPUTS.itemsize)
        if self._clock is not None:
            self._clock.end_cycle()
        ctypes.memmove(outputs, body, OUTPUTS.itemsize)

    def close(self) -> None:
        """Say that the stop is over, and close the connection."""
        self._connection.finish()
        self._turn.end()


def open_controller(program: ControllerProgram, config: Config) -> SocketInstance:
    """Wait for the turn of this stop, connect, and exchange greetings. Raises ControllerError."""
    turn = Turn(program.location)
    stream = turn.begin()
    try:
        return SocketInstance(turn, Connection(stream, program.time_limit), program, config)
    except BaseException:
        turn.end()
        raise
