"""A sound file is not called damaged where the machine is what fails."""

import errno
import os
import resource
import signal
import subprocess
import sys

import pytest

from uictest.core.recording.formats import (
    ReadingInterruptedError,
    UnreadableError,
    isolation,
    read_contents,
    reader,
)

pytestmark = pytest.mark.skipif(sys.platform == "win32", reason="limits and signals are POSIX")


def reading_under(monkeypatch, before):
    """Call a function in the process that reads before it becomes the reader."""
    run = subprocess.run

    def prepared(command, **options):
        return run(command, preexec_fn=before, **options)

    monkeypatch.setattr(isolation.subprocess, "run", prepared)


def files_up_to(size):
    def limit():
        signal.signal(signal.SIGXFSZ, signal.SIG_IGN)
        resource.setrlimit(resource.RLIMIT_FSIZE, (size, size))

    return limit


def reading_here_up_to(size):
    """Read in this process, under the limit of one whose start takes longer than all it reads."""

    def read(name, path, dialect, folder, seconds):
        soft, hard = resource.getrlimit(resource.RLIMIT_FSIZE)
        resource.setrlimit(resource.RLIMIT_FSIZE, (size, hard))
        try:
            return reader.read_into(folder, name, path, dialect)
        finally:
            resource.setrlimit(resource.RLIMIT_FSIZE, (soft, hard))

    return read


@pytest.mark.parametrize("size", [0, 300, 1700])
@pytest.mark.parametrize("name", ["mdf", "csv", "parquet"])
def test_a_full_temporary_folder_is_named(written, tmp_path, monkeypatch, name, size):
    path = written(name)
    monkeypatch.setattr("tempfile.tempdir", str(tmp_path))
    if name == "mdf":
        reading_under(monkeypatch, files_up_to(size))
    else:
        monkeypatch.setattr(isolation, "_read_in_process", reading_here_up_to(size))
    with pytest.raises(ReadingInterruptedError) as caught:
        read_contents(path)
    assert caught.value.filename == str(tmp_path)
    assert caught.value.errno == errno.ENOSPC
    assert str(path) in str(caught.value)
    assert list(tmp_path.iterdir()) == [path]


def test_a_reader_writes_nothing_but_what_it_read(written, monkeypatch):
    """Half a compiled module, as a full disk leaves it, would make every sound file seem damaged."""
    commands = []
    run = subprocess.run

    def recorded(command, **options):
        commands.append(command)
        return run(command, **options)

    monkeypatch.setattr(isolation.subprocess, "run", recorded)
    read_contents(written("mdf"))
    (command,) = commands
    flags = command[: command.index("-m")]
    shown = subprocess.run(
        [*flags, "-c", "import sys; print(sys.dont_write_bytecode)"],
        capture_output=True,
        text=True,
        check=True,
    )
    assert shown.stdout == "True\n"


def test_a_full_temporary_folder_excuses_no_damaged_file(tmp_path, monkeypatch):
    """As long as there is room for the refusal."""
    path = tmp_path / "stub.mf4"
    path.write_bytes(b"MDF     4.10    " + bytes(300))
    reading_under(monkeypatch, files_up_to(1700))
    with pytest.raises(UnreadableError):
        read_contents(path)


@pytest.mark.parametrize("number", [signal.SIGKILL, signal.SIGTERM])
def test_a_reader_that_is_killed_says_nothing_about_the_file(written, monkeypatch, number):
    """As the system does where memory runs out."""
    path = written("csv")
    reading_under(monkeypatch, lambda: os.kill(os.getpid(), number))
    with pytest.raises(ReadingInterruptedError, match=rf"was killed \({number.name}\)") as caught:
        read_contents(path)
    assert caught.value.filename == str(path)


def test_a_reader_that_crashes_does(written, monkeypatch):
    def crash():
        signal.signal(signal.SIGSEGV, signal.SIG_DFL)  # pytest's own handler would show where
        os.kill(os.getpid(), signal.SIGSEGV)

    path = written("csv")
    reading_under(monkeypatch, crash)
    with pytest.raises(UnreadableError, match="damaged"):
        read_contents(path)
