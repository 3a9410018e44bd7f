"""A sound file is not called damaged where the machine is what fails."""

import errno
import os
import resource
import signal
import subprocess
import sys
from functools import partial
from pathlib import Path

import pytest

from uictest.core import guarded_process
from uictest.core.guarded_process import GuardedProcess
from uictest.core.recording.formats import ReadingInterruptedError, UnreadableError, isolation, read_contents

from ...conftest import read_here
from ...processes import children_of, has_ended, waited_for

pytestmark = pytest.mark.skipif(sys.platform == "win32", reason="limits and signals are POSIX")


def reading_under(monkeypatch, before):
    """Call a function in the process that reads before it becomes the reader."""
    process = partial(GuardedProcess, preexec_fn=before)
    monkeypatch.setattr(guarded_process, "GuardedProcess", process)


def files_up_to(size):
    def limit():
        signal.signal(signal.SIGXFSZ, signal.SIG_IGN)
        resource.setrlimit(resource.RLIMIT_FSIZE, (size, size))

    return limit


def reading_here_up_to(size):
    """Read in this process, under the limit of one whose start takes longer than all it reads."""

    def read(*request):
        soft, hard = resource.getrlimit(resource.RLIMIT_FSIZE)
        resource.setrlimit(resource.RLIMIT_FSIZE, (size, hard))
        try:
            yield from read_here(*request)
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
        monkeypatch.setattr(isolation, "read_apart", reading_here_up_to(size))
    with pytest.raises(ReadingInterruptedError) as caught:
        read_contents(path)
    assert caught.value.filename == str(tmp_path)
    assert caught.value.errno == errno.ENOSPC
    assert str(path) in str(caught.value)
    assert list(tmp_path.iterdir()) == [path]


def test_a_reader_writes_nothing_but_what_it_read(written, monkeypatch):
    """Half a compiled module, as a full disk leaves it, would make every sound file seem damaged."""
    begun = []

    def recorded(*arguments, **options):
        begun.append(GuardedProcess(*arguments, **options))
        return begun[-1]

    monkeypatch.setattr(guarded_process, "GuardedProcess", recorded)
    read_contents(written("mdf"))
    (command,) = (each.args for each in begun)
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


HANGING = """\
from pathlib import Path
from uictest.core.recording.formats import isolation
start, hanging = isolation.reading_process, ["-n", "1", "-r", "1", "import time; time.sleep(3600)"]
isolation.reading_process = lambda _, __, folder: start("timeit", hanging, folder)
{read}
"""


@pytest.mark.skipif(not Path("/proc/self").exists(), reason="processes are those of Linux")
@pytest.mark.parametrize(
    "read",
    ["isolation.read_contents(Path('good.csv'))", "list(isolation.read_apart('csv', Path('good.csv'), {}))"],
)
def test_a_reader_and_its_folder_are_gone_with_a_program_that_is_killed(tmp_path, read):
    """The reader hangs: nothing of its own would end it."""
    temporary = tmp_path / "temporary"
    temporary.mkdir()
    (tmp_path / "good.csv").write_text("time,speed\n0,1\n", "utf-8")
    environment = {**os.environ, "TMPDIR": str(temporary)}
    command = [sys.executable, "-c", HANGING.format(read=read)]
    program = subprocess.Popen(command, cwd=tmp_path, env=environment)
    reader_process = waited_for(lambda: next(iter(children_of(program.pid)), 0))
    guard = waited_for(lambda: next(iter(children_of(reader_process)), 0))
    assert list(temporary.iterdir())
    program.kill()
    program.wait()
    for process in (reader_process, guard):
        assert waited_for(partial(has_ended, process))
    assert waited_for(lambda: not list(temporary.iterdir()))
