"""Machine code is called only if it is what the compiler made here."""

from __future__ import annotations

from collections.abc import Callable, Iterator
from contextlib import contextmanager
from pathlib import Path
from typing import Any

import pytest

from uictest import user_cache
from uictest.rig.backends import machine_code
from uictest.rig.backends.compiled import callback
from uictest.rig.backends.machine_code import is_kept, native_function

NAME = "uictest_test"


@pytest.fixture
def cache(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> Path:
    """A cache of its own, for a process that has loaded nothing yet."""
    monkeypatch.setenv("UICTEST_CACHE", str(tmp_path / "cache"))
    monkeypatch.setattr("tempfile.tempdir", str(tmp_path))
    return tmp_path / "cache"


@pytest.fixture
def begin(monkeypatch: pytest.MonkeyPatch) -> Callable[[], Callable[..., int]]:
    """Load the function as a new process would; the compiler is `compiled`."""

    def load() -> Callable[..., int]:
        monkeypatch.setattr(machine_code, "_loaded", {})
        return native_function(NAME, _compiled, 1)

    return load


def _compiled() -> Any:
    return callback(lambda number: 3 * number, int)


def _kept(cache: Path) -> Path:
    (path,) = cache.iterdir()
    return path


def test_code_is_compiled_once(
    cache: Path, begin: Callable[[], Callable[..., int]], monkeypatch: pytest.MonkeyPatch
) -> None:
    assert not is_kept(NAME)
    assert begin()(14) == 42
    assert is_kept(NAME)
    monkeypatch.setitem(globals(), "_compiled", lambda: pytest.fail("compiled again"))
    assert begin()(14) == 42


@pytest.mark.parametrize("damage", [lambda code: b"", lambda code: code[:-64], lambda code: code[::-1]])
def test_damaged_code_is_compiled_anew(
    cache: Path, begin: Callable[[], Callable[..., int]], damage: Callable[[bytes], bytes]
) -> None:
    begin()
    damaged = damage(_kept(cache).read_bytes())
    _kept(cache).write_bytes(damaged)
    assert not is_kept(NAME)
    assert begin()(14) == 42
    assert is_kept(NAME)
    assert _kept(cache).read_bytes() != damaged


def test_no_single_flipped_bit_is_executed(cache: Path, begin: Callable[[], Callable[..., int]]) -> None:
    begin()
    sound = bytearray(_kept(cache).read_bytes())
    for place in range(0, len(sound), 97):
        sound[place] ^= 1
        _kept(cache).write_bytes(sound)
        assert not is_kept(NAME), place
        sound[place] ^= 1
    _kept(cache).write_bytes(sound)
    assert is_kept(NAME)


def test_code_of_another_processor_is_not_executed(
    cache: Path, begin: Callable[[], Callable[..., int]], monkeypatch: pytest.MonkeyPatch
) -> None:
    begin()
    monkeypatch.setattr(machine_code, "_inputs", lambda target: b"another processor")
    assert not is_kept(NAME)


def test_without_any_place_it_is_compiled_and_nothing_is_left(
    tmp_path: Path, begin: Callable[[], Callable[..., int]], monkeypatch: pytest.MonkeyPatch
) -> None:
    (tmp_path / "file").write_text("not a folder")
    monkeypatch.setenv("UICTEST_CACHE", str(tmp_path / "file" / "cache"))
    monkeypatch.setattr("tempfile.tempdir", str(tmp_path / "file"))
    assert begin()(14) == 42
    assert [path.name for path in tmp_path.iterdir()] == ["file"]


def test_what_another_process_compiles_meanwhile_is_used(
    cache: Path, begin: Callable[[], Callable[..., int]], monkeypatch: pytest.MonkeyPatch
) -> None:
    begin()
    path = _kept(cache)
    code = path.read_bytes()
    path.unlink()

    @contextmanager
    def turn(name: str, inputs: bytes) -> Iterator[None]:
        path.write_bytes(code)
        path.chmod(0o600)
        yield

    monkeypatch.setattr(user_cache, "turn", turn)
    monkeypatch.setitem(globals(), "_compiled", lambda: pytest.fail("compiled as well"))
    assert begin()(14) == 42
