"""Controllers from outside in child processes: what they do wrong ends their stop and nothing else."""

import ctypes
import os
import re
import shutil
import signal
import subprocess
import sys
from functools import partial
from pathlib import Path

import pytest

from uictest.controllers import ControllerError
from uictest.rig.external import worker
from uictest.rig.external.in_process import BlockInputs, run_in_process
from uictest.rig.external.worker import LARGEST_OUTPUT, PrintedOutput, Worker
from uictest.rig.external.workers import Workers

from ...processes import children_of, has_ended, waited_for
from ...stop_bits import bits

IN_PYTHON = {
    "create": "Bad(config) failed: ValueError: told to",
    "reset": "reset failed: ValueError: told to",
    "leave": "Bad(config) failed: SystemExit: 0",
    "leave-reset": "reset failed: SystemExit: 0",
    "mute": "step failed: MuteError (bad.py, line {line}) (cycle 700)",
    "crash": "crashed with SIGSEGV (cycle 700)",
    "exit": "ended its process with exit code 3 (cycle 700)",
    "raise": "step failed: ValueError: told to (bad.py, line {line}) (cycle 700)",
    "memory": "step failed: MemoryError (bad.py, line {line}) (cycle 700)",
    "end": "step failed: SystemExit: 0 (bad.py, line {line}) (cycle 700)",
    "nothing": "step failed: step returned NoneType, expected Outputs (cycle 700)",
    "nan": "step failed: hold[0] is nan, expected 0 or 1 (cycle 700)",
    "short": "step failed: hold has 3 values, expected 4 (cycle 700)",
    "forbidden": "forbidden command for wheelset 2: vent without hold (cycle 700)",
    "speed": "step failed: reference_speed is 'fast', expected a number (cycle 700)",
    "infinite": "the reference speed is -inf, expected a number of m/s, or NaN for none (cycle 700)",
    "way": "step failed: RuntimeError: told to, early (bad.py, line {line}) (cycle 702)",
    "files": "closed files of its process that are not its own: what its answers go through is one",
    "bits": "step failed: diagnosis is 4294967296, expected a whole number of 32 bits (cycle 700)",
}
IN_C = {
    "create": "uictest_create failed: told to",
    "reset": "uictest_reset returned 7: told to",
    "crash": "crashed with SIGSEGV (cycle 700)",
    "exit": "ended its process with exit code 3 (cycle 700)",
    "step": "step failed: told to (cycle 700)",
    "forbidden": "forbidden command for wheelset 2: vent without hold (cycle 700)",
    "magnet": "a magnet of wheelset 4 is neither 0 nor 1: hold 7, vent 0 (cycle 700)",
    "beyond": "the controller wrote beyond its outputs (cycle 700)",
    "destroy": "destroy crashed with SIGABRT",
}


def children():
    """The child processes of this one that are not yet collected."""
    return {int(pid) for pid in Path(f"/proc/{os.getpid()}/task/{os.getpid()}/children").read_text().split()}


def line_of(fault):
    text = (Path(__file__).parent / "bad.py").read_text("utf-8").splitlines()
    raising = {
        "raise": 'raise ValueError("told to")',
        "mute": "raise MuteError",
        "way": 'raise RuntimeError("told to, early")',
        "end": "raise SystemExit(0)",
        "memory": "bytearray(1 << 40)",
    }[fault]
    return max(number for number, line in enumerate(text, start=1) if raising in line)


def test_a_child_process_gives_the_bits_of_this_one(workers, stop_of):
    here, there = run_in_process(stop_of(), 10), workers.run(stop_of(), 10)
    assert bits(here) == bits(there)
    assert here.trace.train.tobytes() == there.trace.train.tobytes()
    assert here.trace.wheelsets.tobytes() == there.trace.wheelsets.tobytes()
    assert (here.car.tobytes(), here.wheelsets.tobytes()) == (there.car.tobytes(), there.wheelsets.tobytes())


@pytest.mark.parametrize("fault", IN_PYTHON)
def test_a_fault_in_python_names_the_reason_and_the_cycle(workers, stop_of, fault):
    expected = IN_PYTHON[fault]
    with pytest.raises(ControllerError) as error:
        workers.run(stop_of(fault))
    told = str(error.value).partition(" (cycle")[0] if fault == "files" else str(error.value)
    assert told == (expected.format(line=line_of(fault)) if "{line}" in expected else expected)


@pytest.mark.parametrize("fault", IN_C)
def test_a_fault_in_c_names_the_reason_and_the_cycle(workers, stop_of, library, fault):
    library()
    with pytest.raises(ControllerError) as error:
        workers.run(stop_of(fault, library="libbad.so"))
    assert str(error.value).startswith(IN_C[fault])


def test_a_controller_that_does_not_answer_is_ended_and_a_long_reason_is_shortened(workers, stop_of):
    with pytest.raises(ControllerError, match=r"^step did not return within 0\.5 s \(cycle 700\)$"):
        workers.run(stop_of("spin", limit="0.5 s"))
    with pytest.raises(ControllerError, match=r"^.{100,3000}$"):
        workers.run(stop_of("long"))


def test_a_fault_touches_no_later_stop_and_leaves_no_process_behind(stop_of):
    before = children()
    with Workers() as own:
        sound = bits(own.run(stop_of()))
        ends = {"crash": "SIGSEGV", "raise": "told to", "exit": "exit code 3", "hang": "within 0.5 s"}
        for fault, message in ends.items():
            with pytest.raises(ControllerError, match=message):
                own.run(stop_of(fault, limit="0.5 s"))
            assert len(children() - before) <= 1
            assert bits(own.run(stop_of())) == sound
    assert children() - before == set()


def test_a_second_close_leaves_files_of_others_alone():
    """What is opened after the first one has the numbers of what that has closed."""
    worker = Worker(frozenset({("python", "", "")}))
    worker.close()
    others = [end for _ in range(4) for end in os.pipe()]
    worker.close()
    for each in others:
        os.close(each)


@pytest.mark.parametrize(
    ("fault", "message"),
    [("immortal", "destroy did not return within 0.5 s"), ("hang-later", "what runs outside of its calls")],
)
def test_a_controller_that_hangs_after_its_stop_is_ended(
    workers, stop_of, folder, monkeypatch, fault, message
):
    """In its destructor, or while its process waits for the next stop."""
    workers.run(stop_of())  # a slow machine starts the process before the limits count
    with monkeypatch.context() as limits:
        limits.setattr(worker, "OPENING_LIMIT", 0.5)
        limits.setattr(worker, "IDLE_LIMIT", 0.5)
        with pytest.raises(ControllerError, match=re.escape(message)):
            workers.run(stop_of(fault, limit="0.5 s"))
            waited_for((folder / "hangs.txt").exists)
            workers.run(stop_of(fault, limit="0.5 s"))
    workers.run(stop_of())


def test_a_process_that_takes_no_request_is_ended(stop_of, monkeypatch):
    """A block of stops is more than the memory between two processes takes up."""
    monkeypatch.setattr(worker, "ANSWER_LIMIT", 0.2)
    asked = Worker(frozenset({("python", "", "")}))
    os.kill(asked._process.pid, signal.SIGSTOP)
    with pytest.raises(ControllerError, match=r"its process took no request within 0\.2 s"):
        asked.run_block(BlockInputs.of([stop_of()] * 256))
    assert not asked.usable


def test_children_end_with_their_parent(stop_of, folder):
    """The parent is killed while they hang in a step: no process and no temporary file is left.

    A controller that holds the interpreter lets no thread of its child run, and has started a process.
    """
    temporary = folder / "temporary"
    temporary.mkdir()
    for fault in ("hang", "hold"):
        stop_of(fault, limit="600 s")
        shutil.copy("stop.yaml", f"{fault}.yaml")
    program = """\
from concurrent.futures import ThreadPoolExecutor; from functools import partial
from pathlib import Path
from uictest import rig; from uictest.plans.scenario import load
cases = [load([Path(name)])[0] for name in ("hang.yaml", "hold.yaml")]
list(ThreadPoolExecutor().map(rig.simulate, cases))
"""
    environment = {**os.environ, "TMPDIR": str(temporary)}
    parent = subprocess.Popen([sys.executable, "-c", program], cwd=folder, env=environment)
    held = waited_for(lambda: len(found := children_of(parent.pid)) == 2 and found)
    guards = [waited_for(lambda child=child: next(iter(children_of(child)), 0)) for child in held]
    started = folder / "started.txt"
    sleeper = waited_for(lambda: int(started.read_text("utf-8") or 0) if started.exists() else 0)
    parent.kill()
    parent.wait()
    for process in (*held, *guards, sleeper):
        assert waited_for(partial(has_ended, process))
    assert waited_for(lambda: not list(temporary.iterdir()))


def test_libraries_that_are_none(workers, stop_of, library, folder):
    text = folder / "text.so"
    text.write_text("no library", "utf-8")
    (folder / "windows.so").write_bytes(b"MZ\x90\0")
    narrow = folder / "narrow.so"
    content = bytearray(library().read_bytes())
    content[4] = 1  # the class of an ELF file: 32 bits
    narrow.write_bytes(content)
    library("-DABI=7", name="libnew.so")
    library("-Duictest_step=own_step", name="libless.so")
    expected = {
        "text.so": r"text\.so cannot be loaded: text\.so: ",
        "windows.so": r"windows\.so cannot be loaded: it is built for Windows, expected a library for [A-Z]",
        "narrow.so": r"narrow\.so cannot be loaded: narrow\.so: wrong ELF class: ELFCLASS32",
        "libnew.so": r"libnew\.so has ABI version 7, expected 1 or 2",
        "libless.so": r"libless\.so does not export uictest_step",
    }
    for name, message in expected.items():
        with pytest.raises(ControllerError, match=message):
            workers.run(stop_of(library=name))


def test_a_program_that_changes_after_it_was_read_or_while_it_is_loaded_is_not_run(
    workers, stop_of, folder, library, monkeypatch
):
    own = shutil.copy("bad.py", folder / "own.py")
    inputs = stop_of(**{"python": "own.py", "class": "Bad"})
    with own.open("a") as file:
        file.write("# changed\n")
    with pytest.raises(ControllerError, match=r"^own\.py has changed since the scenario was read$"):
        workers.run(inputs)
    path = library(name="libown.so")
    inputs = stop_of(library="libown.so")
    load = ctypes.CDLL

    def replaced(location):
        with path.open("ab") as file:
            file.write(b"another build")
        return load(location)

    monkeypatch.setattr(ctypes, "CDLL", replaced)
    with pytest.raises(ControllerError, match=r"^libown\.so has changed since the scenario was read$"):
        run_in_process(inputs)


def test_a_fault_in_a_block_ends_its_own_stop_alone(workers, stop_of, library):
    """Stops of C libraries run side by side in lanes."""
    library()
    faults = ("create", "none", "crash", "none", "forbidden", "hang", "exit", "none", "destroy")
    stops = [stop_of(fault, at=7, limit="0.5 s", library="libbad.so") for fault in faults]
    run = workers.run_block(BlockInputs.of(stops))
    expected = {
        "create": "controller: uictest_create failed: told to",
        "none": "",
        "crash": "controller: crashed with SIGSEGV (cycle 7)",
        "forbidden": "controller: forbidden command for wheelset 2: vent without hold (cycle 7)",
        "hang": "controller: step did not return within 0.5 s (cycle 7)",
        "exit": "controller: ended its process with exit code 3 (cycle 7)",
        "destroy": "controller: destroy crashed with SIGABRT",
    }
    assert all(
        reason.startswith(expected[fault]) and bool(reason) == bool(expected[fault])
        for fault, reason in zip(faults, run.failures, strict=True)
    ), run.failures
    alone = run_in_process(stop_of(library="libbad.so"))
    for place in (1, 3, 7):
        own = run.measures[place].tobytes() + run.wheelset_measures[place].tobytes()
        assert own == bits(alone)


def test_something_else_than_an_answer_ends_the_stop(stop_of, folder, monkeypatch):
    """A controller may write into whatever its process has open."""
    monkeypatch.setattr(worker, "ANSWER_LIMIT", 0.2)
    with Workers() as own, pytest.raises(ControllerError, match="something else than an answer"):
        own.run(stop_of("scribble"))


@pytest.mark.parametrize("head", ["object", "list", "depth"])
def test_a_message_that_is_no_answer_ends_the_stop_and_its_process(workers, stop_of, head):
    """The true answer comes after it, and the next stop would get that."""
    with pytest.raises(ControllerError, match="something else than an answer"):
        workers.run(stop_of(f"forge-{head}"))
    workers.run(stop_of())


@pytest.fixture(scope="module")
def keeping():
    with pytest.MonkeyPatch.context() as patch, Workers(keep_output=True) as workers:
        patch.delenv("PYTHONUNBUFFERED", raising=False)
        yield workers


def test_each_stop_has_what_its_controller_printed(keeping, stop_of, library, capfd):
    library()
    said = [
        keeping.run(each).controller_output
        for each in (
            stop_of("say", at=3),
            stop_of("none"),
            stop_of("print", at=3, library="libbad.so"),
            stop_of("none", library="libbad.so"),
            stop_of("say", at=4),
        )
    ]
    python = "from Python from Python \n"
    assert said == [python, "", "from C\nand more", "", python]
    assert capfd.readouterr() == ("", "")


@pytest.mark.parametrize(
    ("program", "fault", "last_words"),
    [({}, "say-crash", "last wordslast words\n"), ({"library": "libbad.so"}, "print-crash", "from C\n")],
    ids=["Python", "C"],
)
def test_the_last_words_of_a_controller_that_crashes_are_kept(
    keeping, stop_of, library, program, fault, last_words
):
    library()
    with pytest.raises(ControllerError, match="crashed with SIGSEGV") as error:
        keeping.run(stop_of(fault, at=3, **program))
    assert error.value.output.startswith(last_words)


def test_a_flood_is_cut_and_said_to_be(keeping, stop_of):
    output = keeping.run(stop_of("flood", at=3)).controller_output
    lost = 64 * 65536 - LARGEST_OUTPUT
    assert output.endswith(f"\n... {lost} bytes more, {LARGEST_OUTPUT} are kept\n")
    assert LARGEST_OUTPUT < len(output) < LARGEST_OUTPUT + 100
    assert keeping.run(stop_of("none")).controller_output == ""


def test_a_controller_that_closes_what_it_prints_to_runs_on(keeping, stop_of, monkeypatch):
    """An end of the pipe that is closed is always ready: it is not waited for."""
    reads, read = [], PrintedOutput.read
    monkeypatch.setattr(PrintedOutput, "read", lambda own: reads.append(1) or read(own))
    assert keeping.run(stop_of("close", at=3)).controller_output == ""
    assert len(reads) < 100
    assert keeping.run(stop_of("none")).controller_output == ""


def test_without_a_place_for_it_output_goes_to_standard_error(workers, stop_of, capfd):
    with Workers() as own:
        assert own.run(stop_of("say", at=3)).controller_output == ""
    assert capfd.readouterr() == ("", "from Python from Python \n")
