"""Damaged and hostile files: a message within bounded time, nothing beside the file, never a traceback."""

import errno
import os
import random
import resource
import signal
import struct
import subprocess
import sys
import zlib
from functools import partial
from pathlib import Path

import pytest

from uictest.core import guarded_process
from uictest.core.guarded_process import GuardedProcess
from uictest.core.recording.formats import ReadingInterruptedError, UnreadableError, isolation, read_contents
from uictest.core.recording.formats.file_formats import format_of

from ...conftest import read_here
from ...processes import children_of, has_ended, waited_for

BINARY = ("mdf", "tdms", "mat", "parquet")
BEGINNINGS = {"mdf": b"MDF     4.10    ", "tdms": b"TDSm", "mat": b"MATLAB 5.0 MAT-file", "parquet": b"PAR1"}
SECONDS = 20.0


def _refused(path, seconds=SECONDS):
    before = sorted(path.parent.iterdir())
    with pytest.raises(UnreadableError) as caught:
        read_contents(path, seconds=seconds)
    assert sorted(path.parent.iterdir()) == before
    assert "\n" not in str(caught.value)
    return str(caught.value)


def _tolerated(path):
    """A file that may still hold something is read or refused, and leaves nothing behind either way."""
    before = sorted(path.parent.iterdir())
    try:
        contents = read_contents(path, seconds=SECONDS)
        assert all(len(group) for group in contents.groups)
    except UnreadableError:
        pass
    assert sorted(path.parent.iterdir()) == before


def test_an_empty_file_a_folder_a_missing_file_and_another_type_of_file(tmp_path):
    for suffix in (".csv", ".mf4", ".tdms", ".mat", ".parquet", ""):
        path = tmp_path / f"empty{suffix}"
        path.touch()
        assert _refused(path) == "the file is empty"
    path = tmp_path / "image.mf4"
    path.write_bytes(b"\x89PNG\r\n\x1a\n" + bytes(100))
    assert "not a recording" in _refused(path)
    with pytest.raises((UnreadableError, OSError)):
        read_contents(tmp_path)
    with pytest.raises(FileNotFoundError):
        read_contents(tmp_path / "missing.csv")


@pytest.mark.parametrize("name", BINARY)
def test_a_beginning_and_nothing_behind_it(tmp_path, name):
    path = tmp_path / "stub"
    path.write_bytes(BEGINNINGS[name] + random.Random(name).randbytes(300))
    assert format_of(path) == name
    _refused(path)


@pytest.mark.parametrize("share", [pytest.param(0.02, marks=pytest.mark.slow), 0.6])
@pytest.mark.parametrize("name", BINARY)
def test_a_truncated_file(written, name, share):
    path = written(name)
    content = path.read_bytes()
    path.write_bytes(content[: max(int(share * len(content)), len(BEGINNINGS[name]))])
    _tolerated(path)


@pytest.mark.slow
@pytest.mark.parametrize("seed", range(8))
@pytest.mark.parametrize("name", BINARY)
def test_a_file_with_changed_bytes(written, name, seed):
    path = written(name)
    content = bytearray(path.read_bytes())
    dice = random.Random(f"{name} {seed}")
    for _ in range(20):
        content[dice.randrange(16, len(content))] = dice.randrange(256)
    path.write_bytes(content)
    _tolerated(path)


def test_an_mdf_file_whose_groups_follow_each_other_in_a_circle(written):
    path = written("mdf")
    content = bytearray(path.read_bytes())
    group = content.index(b"##DG")
    content[group + 24 : group + 32] = struct.pack("<Q", group)
    path.write_bytes(content)
    _refused(path, seconds=2.0)


def test_a_mat_file_that_unpacks_to_more_than_memory(tmp_path):
    """A compressed variable that claims a billion values."""
    header = b"MATLAB 5.0 MAT-file".ljust(124) + struct.pack("<H2s", 0x0100, b"IM")
    flags = struct.pack("<IIII", 6, 8, 6, 0)
    shape = struct.pack("<IIii", 5, 8, 1, 10**9)
    name = struct.pack("<HH4s", 1, 1, b"v")
    body = flags + shape + name + struct.pack("<II", 9, 8 * 10**6) + bytes(8 * 10**6)
    packed = zlib.compress(struct.pack("<II", 14, len(body)) + body)
    path = tmp_path / "bomb.mat"
    path.write_bytes(header + struct.pack("<II", 15, len(packed)) + packed)
    assert "values; at most" in _refused(path)


def test_names_never_become_paths_and_a_reader_that_takes_too_long_is_ended(written, tmp_path):
    path = tmp_path / "names.csv"
    hostile = ["../../evil", "/etc/passwd", "\x1b[31m", "CON", "a" * 5000, "=cmd()"]
    path.write_text(",".join(hostile) + "\n" + ",".join("1" * len(hostile)) + "\n")
    assert len(read_contents(path).groups[0].channels) == len(hostile)
    assert sorted(tmp_path.iterdir()) == [path]
    assert "did not end within 0.01 s" in _refused(written("mdf"), seconds=0.01)


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


@pytest.mark.parametrize("number", [signal.SIGKILL, signal.SIGTERM, signal.SIGSEGV])
def test_a_reader_that_is_killed_says_nothing_about_the_file_and_one_that_crashes_does(
    written, monkeypatch, number
):
    """As the system kills it where memory runs out."""

    def end():
        if number == signal.SIGSEGV:
            signal.signal(number, signal.SIG_DFL)  # pytest's own handler would show where
        os.kill(os.getpid(), number)

    path = written("csv")
    reading_under(monkeypatch, end)
    if number == signal.SIGSEGV:
        with pytest.raises(UnreadableError, match="damaged"):
            read_contents(path)
        return
    with pytest.raises(ReadingInterruptedError, match=rf"was killed \({number.name}\)") as caught:
        read_contents(path)
    assert caught.value.filename == str(path)


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
