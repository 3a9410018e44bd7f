"""What controllers print belongs to their stop: all of it, bounded, whatever becomes of the process."""

import pytest

from uictest.controllers import ControllerError
from uictest.rig.external.printed import LARGEST_OUTPUT, PrintedOutput
from uictest.rig.external.workers import Workers


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
    [
        ({}, "say-crash", "last wordslast words\n"),
        ({"library": "libbad.so"}, "print-crash", "from C\n"),
    ],
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
