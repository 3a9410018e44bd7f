"""Controllers in a program at a socket: every frame, and everything that a program can do wrong."""

import socket
import struct
import threading
import time

import numpy as np
import pytest

from uictest.controllers import (
    INPUTS,
    OUTPUTS,
    Config,
    ControllerError,
    ControllerProgram,
    ResponseTimes,
    interrupt_turns,
    open_controller,
)
from uictest.controllers.adapters import socket as turns
from uictest.controllers.adapters.socket import RealTime

STEPPED = 2
"""Number of the first step frame: behind greeting and reset."""


def step(controller, cycle=0):
    """Call a controller as compiled code does; return its status and outputs."""
    inputs, outputs = np.zeros(1, INPUTS), np.zeros(1, OUTPUTS)
    inputs["cycle"], inputs["wheel_speed"], inputs["speed_valid"] = cycle, [[1.0, 2.0, 3.0, 4.0]], 1
    inputs["dynamic_brake"], inputs["axle_load"], inputs["brake_command"] = (
        [[0.1, 0.2, 0.3, 0.4]],
        1.1e5,
        0.75,
    )
    inputs["train_speed"], inputs["acceleration"], inputs["train_speed_valid"] = 9.5, -0.5, 1
    status = controller._callback(None, inputs.ctypes.data, outputs.ctypes.data)
    return status, outputs[0]


def failure(program, config):
    """Return what goes wrong in the greeting, the reset, or the first of two steps that fails."""
    try:
        controller = open_controller(program, config)
    except ControllerError as error:
        return str(error)
    try:
        controller.reset()
        failed = any(step(controller, cycle)[0] for cycle in range(2))  # as a stop, it ends at the first
        return controller.last_error() if failed else "nothing"
    except ControllerError as error:
        return str(error)
    finally:
        controller.close()


def test_the_greeting_says_what_the_program_has_to_know(start, at, config):
    """The digest of no case is zero."""
    program = start()
    controller = open_controller(at(program.address), config)
    controller.close()
    kind, number, body = program.received[0]
    assert (kind, number) == (b"HELO", 0)
    assert struct.unpack_from("<4I", body) == (1, 104, 48, 4)
    assert struct.unpack_from("<6d", body, 16) == (0.01, 33.25, 0.41, 0.42, 0.43, 0.44)
    assert body[64:96].hex() == config.case_sha256
    assert body[96:] == b'{"lower": 0.08}'
    assert controller.version == "Bremsprüfer 2.1"
    other = start()
    open_controller(at(other.address), Config(4, 0.01, 30.0, (0.4,) * 4, {})).close()
    assert other.received[0][2][64:96] == bytes(32)


def test_inputs_and_outputs_travel_as_they_lie_in_memory(start, at, config):
    program = start()
    controller = open_controller(at(program.address), config)
    controller.reset()
    status, outputs = step(controller, cycle=7)
    controller.close()
    frames = program.frames()
    step_frame = frames[2]
    assert step_frame[:2] == (b"STEP", 2)
    speeds_and_demand = (1.0, 2.0, 3.0, 4.0, 0.0, 0.0, 0.0, 0.0, 0.0)
    assert struct.unpack("<q10d4i", step_frame[2]) == (7, 0.0, *speeds_and_demand, 1, 1, 1, 1)
    assert (status, outputs["reference_speed"], outputs["diagnosis"]) == (0, 31.5, 0xFFFFFFFF)
    assert (outputs["hold"].tolist(), outputs["vent"].tolist()) == ([1, 1, 0, 0], [0, 1, 0, 0])
    assert [(kind, number) for kind, number, _ in frames[1:]] == [(b"RSET", 1), (b"STEP", 2), (b"DONE", 3)]


def test_a_program_that_answers_with_version_2_gets_its_inputs_and_gives_its_outputs(start, at, config):
    """The greeting is that of version 1: the program says what it speaks."""
    added = struct.pack("<4d5ii", 0.0, 0.25, 0.5, 1.0, 0, 1, 0, 0, 1, 0)
    frames_of_2 = {b"HELO": changed(16, "<I", 2), b"STEP": lambda frame: resized(frame + added)}
    program = start(lambda frame: frames_of_2.get(frame[:4], bytes)(frame), at=None)
    controller = open_controller(at(program.address), config)
    controller.reset()
    status, outputs = step(controller, cycle=7)
    controller.close()
    greeting, _, step_frame, _ = program.frames()
    assert struct.unpack_from("<3I", greeting[2]) == (1, 104, 48)
    assert (controller.contract, status, len(step_frame[2])) == (2, 0, 176)
    assert struct.unpack_from("<6d", step_frame[2], 104) == (0.1, 0.2, 0.3, 0.4, 1.1e5, 0.75)
    assert struct.unpack_from("<2d2i", step_frame[2], 152) == (9.5, -0.5, 1, 0)
    assert outputs["dynamic_reduction"].tolist() == [0.0, 0.25, 0.5, 1.0]
    assert (outputs["sand_request"].tolist(), outputs["track_brake_request"]) == ([0, 1, 0, 0], 1)


def resized(frame):
    """State the size of the body in the header."""
    return frame[:4] + struct.pack("<I", len(frame) - 16) + frame[8:]


def changed(place, layout, value):
    """Write a value into the answer."""

    def fault(frame):
        content = bytearray(frame)
        struct.pack_into(layout, content, place, value)
        return bytes(content)

    return fault


def refusal(text):
    """Answer FAIL and a reason."""
    return lambda frame: struct.pack("<4sI", b"FAIL", len(text)) + frame[8:16] + text


FAULTS = {
    "closes before the greeting": (
        *(0, lambda frame: None),
        "the program closed the connection before its answer to the greeting",
    ),
    "closes in mid-stop": (
        *(STEPPED + 1, lambda frame: None),
        "the program closed the connection before its answer to the step frame",
    ),
    "other version": (*(0, changed(16, "<I", 3)), "the program has protocol version 3, expected 1 or 2"),
    "talks another protocol": (
        *(0, lambda frame: b"HTTP/1.1 400 Bad Request\r\n\r\n"),
        "the answer to the greeting begins with b'HTTP', expected b'HELO'",
    ),
    "garbage": (
        *(STEPPED, lambda frame: bytes(range(200, 256)) * 20),
        r"the answer to the step frame begins with b'\xc8\xc9\xca\xcb', expected b'STEP'",
    ),
    "other kind": (
        *(1, changed(0, "<4s", b"STEP")),
        "the answer to the reset frame begins with b'STEP', expected b'RSET'",
    ),
    "wrong number": (
        *(STEPPED + 1, changed(8, "<Q", STEPPED)),
        "the answer to the step frame has the number 2, expected 3",
    ),
    "wrong size": (
        *(STEPPED, changed(4, "<I", 40)),
        "the answer to the step frame has 40 bytes, expected 48",
    ),
    "longer than it says": (
        *(STEPPED, lambda frame: frame + b"12345"),
        "5 bytes follow the answer to the step frame",
    ),
    "refuses": (0, refusal(b"no licence"), "no licence"),
    "refuses a step": (STEPPED, refusal("Ölstand".encode()), "Ölstand"),
    "refuses without a reason": (STEPPED, refusal(b""), "no reason given"),
    "refuses at length": (
        *(STEPPED, refusal(bytes(1001))),
        "the answer to the step frame begins with b'FAIL', expected b'STEP'",
    ),
}


@pytest.mark.parametrize("name", FAULTS)
def test_every_departure_from_the_protocol_is_named(start, at, config, name):
    number, fault, message = FAULTS[name]
    program = start(fault, number)
    assert failure(at(program.address), config) == message


@pytest.mark.parametrize("part", [1, 15, 16, 40])
def test_a_short_frame_is_named_where_the_connection_ends(start, at, config, part):
    def send_a_part(frame):
        program.streams[-1].sendall(frame[:part])

    program = start(send_a_part, STEPPED)
    needed = 16 if part < 16 else 64
    expected = (
        f"the program closed the connection after {part} of {needed} bytes of its answer to the step frame"
    )
    assert failure(at(program.address), config) == expected


def test_a_program_that_says_nothing_or_sends_byte_by_byte_has_its_time(start, at, config):
    busy = "; does the program serve another stop?"
    ended = threading.Event()
    program = start(lambda frame: b"late" if ended.wait() else None)
    assert failure(at(program.address, 0.05), config) == f"no answer to the greeting within 0.05 s{busy}"
    ended.set()

    def trickle(frame):
        for position in range(len(frame)):
            program.streams[-1].sendall(frame[position : position + 1])
            time.sleep(0.01)

    program = start(trickle)
    message = failure(at(program.address, 0.2), config)
    assert message.startswith(("only ", "no answer "))
    assert message.removesuffix(busy).endswith(" to the greeting within 0.2 s")


def test_where_nobody_listens_only_the_first_stop_waits_and_the_reason_is_given(at, config, monkeypatch):
    waited = []
    monkeypatch.setattr(turns, "STARTING", 0.2)
    monkeypatch.setattr(turns, "sleep", lambda pause: waited.append(pause) or time.sleep(pause))
    with socket.create_server(("127.0.0.1", 0)) as listener:
        address = f"tcp://127.0.0.1:{listener.getsockname()[1]}"
    expected = f"no program listens at {address} (Connection refused); start it before the run"
    assert failure(at(address), config) == expected
    assert waited
    waited.clear()
    assert failure(at(address), config) == expected
    assert not waited

    def unknown(*arguments, **options):
        raise socket.gaierror(-2, "Name or service not known")

    monkeypatch.setattr(socket, "create_connection", unknown)
    message = failure(at("tcp://box.invalid:5025"), config)
    assert message.startswith("no program listens at tcp://box.invalid:5025 (Name or service not known)")


def test_a_program_may_start_after_the_run_and_gets_nothing_that_no_frame_holds(
    start, at, config, monkeypatch
):
    program = start()
    connect = socket.create_connection
    attempts = []

    def refused_twice(*arguments, **options):
        attempts.append(arguments)
        if len(attempts) <= 2:
            raise ConnectionRefusedError(111, "Connection refused")
        return connect(*arguments, **options)

    monkeypatch.setattr(turns, "STARTING", 600.0)
    monkeypatch.setattr(socket, "create_connection", refused_twice)
    assert failure(at(program.address), config) == "nothing"
    long = ControllerProgram("connect", program.address, parameters=f'{{"map": "{"x" * 65536}"}}')
    assert failure(long, config) == "parameters: 65547 bytes as JSON, at most 65440 can be sent"


def in_threads(count, do):
    """Start so many threads that do it, and return them with what each returned."""
    results = []
    threads = [threading.Thread(target=lambda: results.append(do())) for _ in range(count)]
    for thread in threads:
        thread.start()
    return threads, results


def test_stops_at_one_address_run_one_after_the_other(start, at, config):
    program = start()
    threads, messages = in_threads(6, lambda: failure(at(program.address), config))
    for thread in threads:
        thread.join()
    assert messages == ["nothing"] * 6
    kinds = [kind for kind, _, _ in program.frames()]
    # The end of a stop is not answered: its frame may be read when the next stop has begun.
    assert [kind for kind in kinds if kind != b"DONE"] == [b"HELO", b"RSET", b"STEP", b"STEP"] * 6
    assert kinds.count(b"DONE") == 6


def test_an_interruption_ends_stops_that_run_and_stops_that_wait(start, at, config):
    asked, ended = threading.Event(), threading.Event()

    def hang(frame):
        asked.set()
        ended.wait()

    program = start(hang, STEPPED)
    threads, messages = in_threads(2, lambda: failure(at(program.address, 600.0), config))
    asked.wait()
    while len(turns._TURNS) < len(threads):
        time.sleep(0.001)
    interrupt_turns()
    for thread in threads:
        thread.join()
    ended.set()
    assert messages == [
        "the program closed the connection before its answer to the step frame",
        "interrupted before the program was connected",
    ]


class Clock:
    """A clock that goes only while somebody waits."""

    def __init__(self):
        self.now = 1000.0
        self.late = 0.0
        """Time that every wait takes too long, s."""

    def __call__(self):
        return self.now

    def wait(self, time):
        self.now += time + self.late


def starts_and_times(answers, clock):
    """Let each cycle of 10 ms be answered after a time, s; return when they began, s, and what was noted."""
    paced = RealTime(0.01, clock, clock.wait)
    began, starts = clock.now, []
    for seconds in answers:
        paced.begin_cycle()
        starts.append(clock.now - began)
        clock.now += seconds
        paced.end_cycle()
    return starts, paced.response_times


def test_cycles_begin_at_multiples_of_the_cycle_time_whatever_answers_take():
    starts, times = starts_and_times([0.003, 0.0, 0.009, 0.001], Clock())
    assert starts == pytest.approx([0.0, 0.01, 0.02, 0.03])
    assert times == ResponseTimes(4, 0.01, 0, pytest.approx(0.009), 2, pytest.approx(0.0, abs=1e-9))


def test_a_late_answer_misses_a_deadline_in_every_cycle_until_the_schedule_is_met():
    """It is no jitter of this machine."""
    starts, times = starts_and_times([0.001, 0.035, 0.001, 0.001, 0.001, 0.001], Clock())
    # Cycle 1 is answered at 45 ms: cycles 2 and 3 have ended before they begin, cycle 4 ends in time.
    assert starts == pytest.approx([0.0, 0.01, 0.045, 0.046, 0.047, 0.05])
    assert (times.missed_deadlines, times.longest_answer_cycle) == (3, 1)
    assert times.longest_answer_s == pytest.approx(0.035)
    assert times.start_jitter_s == pytest.approx(0.0, abs=1e-9)


def test_waits_that_take_too_long_do_not_add_up_are_the_jitter_and_may_miss_a_deadline():
    clock = Clock()
    clock.late = 0.0005
    starts, times = starts_and_times([0.001] * 1000, clock)
    assert starts[-1] == pytest.approx(9.99 + 0.0005)
    assert times.start_jitter_s == pytest.approx(0.0005)
    assert times.missed_deadlines == 0
    clock.late = 0.012
    _, times = starts_and_times([0.001, 0.001], clock)
    assert times.missed_deadlines == 1
    assert times.longest_answer_s == pytest.approx(0.001)
    assert times.start_jitter_s == pytest.approx(0.012)
