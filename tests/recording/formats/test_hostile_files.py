"""Damaged and hostile files: a message within bounded time, nothing beside the file, never a traceback."""

import random
import struct
import zlib

import pytest

from uictest.core.recording.formats import UnreadableError, read_contents
from uictest.core.recording.formats.file_formats import format_of

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


@pytest.mark.parametrize("suffix", [".csv", ".mf4", ".tdms", ".mat", ".parquet", ""])
def test_an_empty_file(tmp_path, suffix):
    path = tmp_path / f"empty{suffix}"
    path.touch()
    assert _refused(path) == "the file is empty"


def test_a_folder_a_missing_file_and_another_type_of_file(tmp_path):
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


def test_names_never_become_paths(written, tmp_path):
    path = tmp_path / "names.csv"
    hostile = ["../../evil", "/etc/passwd", "\x1b[31m", "CON", "a" * 5000, "=cmd()"]
    path.write_text(",".join(hostile) + "\n" + ",".join("1" * len(hostile)) + "\n")
    contents = read_contents(path)
    assert len(contents.groups[0].channels) == len(hostile)
    assert sorted(tmp_path.iterdir()) == [path]


def test_a_reader_that_takes_too_long_is_ended(written):
    assert "did not end within 0.01 s" in _refused(written("mdf"), seconds=0.01)
