"""Machine code is called only if it is what the compiler made here."""

from contextlib import contextmanager
from typing import Any, NamedTuple

import numpy as np
import pytest
from llvmlite import binding

from uictest.core import user_cache
from uictest.core.lanes import Length, at, compile_inner
from uictest.rig.backends import machine_code
from uictest.rig.backends.machine_code import Entry, Unit, host, is_kept, native_function, object_file

TEST = Entry("uictest_test", "a test", (int,))
OTHER = Entry("uictest_other", "another", (int,))
UNIT = "uictest_tests"


damaged = pytest.mark.parametrize(
    "damage", [lambda code: b"", lambda code: code[:-64], lambda code: code[::-1]]
)


@pytest.fixture
def cache(tmp_path, monkeypatch):
    """A cache of its own, for a process that has loaded nothing yet."""
    monkeypatch.setenv("UICTEST_CACHE", str(tmp_path / "cache"))
    monkeypatch.setattr("tempfile.tempdir", str(tmp_path))
    return tmp_path / "cache"


@pytest.fixture
def begin(monkeypatch):
    """Load the function as a new process would."""

    def load():
        monkeypatch.setattr(machine_code, "_loaded", {})
        return _function(TEST)

    return load


def _function(entry):
    return native_function(Unit(UNIT, (TEST, OTHER), lambda: _functions()), entry)


def _functions():
    return [compile_inner(lambda number: 3 * number), compile_inner(lambda number: number - 1)]


def _kept(cache, kind=TEST.name):
    (path,) = cache.glob(f"{kind}-*")
    return path


CALL = """
declare i64 @missing(i64)
@elsewhere = external global i64
define i64 @uictest_test(i64 %number) {
    %part = call i64 @missing(i64 %number)
    store i64 %part, ptr @elsewhere
    ret i64 %part
}
"""


def test_code_that_needs_anything_from_outside_is_refused():
    bitcode = binding.parse_assembly(CALL).as_bitcode()
    with pytest.raises(RuntimeError, match=r"uictest_test needs what is not in it: elsewhere, missing$"):
        object_file(bitcode, TEST.name, host())


def test_what_would_raise_an_error_needs_nothing_from_outside(cache):
    """Numba checks the index of a tuple and would tell Python."""
    chosen = Entry("uictest_chosen", "a choice", (int,))
    unit = Unit("uictest_choice", (chosen,), lambda: [compile_inner(lambda number: (5, 6, 7)[number])])
    assert [native_function(unit, chosen)(number) for number in range(3)] == [5, 6, 7]


class Tables(NamedTuple):
    """A tuple that is handed to machine code."""

    counts: Any
    table: Any


def test_machine_code_finds_what_it_is_given(cache):
    """Each place has a weight of its own, so that nothing is read from another place."""
    rows, point = Length("rows"), np.dtype([("x", "f8"), ("n", "i8")])

    def sum_up(tables, record, factor):
        total = 0
        for row in range(len(tables.table)):
            for column in range(3):
                total += int(tables.table[row, column]) * (3 * row + column + 1)
        for k in range(len(tables.counts)):
            total += tables.counts[k] * (100 + k)
        record.x = 0.5
        return factor * (total + 1000 * record.n)

    arguments = Tables(at("i8", 2 * rows - 1), at("f8", rows, 3)), at(point), int
    entry = Entry("uictest_sum", "a sum", arguments)
    function = native_function(Unit("uictest_sums", (entry,), lambda: [compile_inner(sum_up)]), entry)
    for count in (1, 4):
        record, table = np.zeros(1, point)[0], np.arange(3.0 * count).reshape(count, 3)
        record["n"] = 7
        counts = np.arange(2 * count - 1) + 5
        expected = sum((n + 1) * n for n in range(3 * count)) + sum(
            (100 + k) * (k + 5) for k in range(len(counts))
        )
        assert function(Tables(counts, table), record, 3) == 3 * (expected + 7000)
        assert record["x"] == 0.5


def test_code_is_compiled_once(cache, begin, monkeypatch):
    assert not is_kept(TEST)
    assert begin()(14) == 42
    assert is_kept(TEST)
    monkeypatch.setitem(globals(), "_functions", lambda: pytest.fail("compiled again"))
    assert begin()(14) == 42


def test_what_shares_code_is_compiled_once(cache, begin, monkeypatch):
    begin()
    assert not is_kept(OTHER)
    monkeypatch.setitem(globals(), "_functions", lambda: pytest.fail("compiled again"))
    assert _function(OTHER)(14) == 13


@damaged
def test_damaged_bitcode_is_compiled_anew(cache, begin, damage):
    begin()
    sound = _kept(cache, UNIT).read_bytes()
    _kept(cache, UNIT).write_bytes(damage(sound))
    assert _function(OTHER)(14) == 13
    assert len(_kept(cache, UNIT).read_bytes()) > 64


def test_progress_is_told_from_nothing_to_the_end(cache, begin):
    told = []
    with machine_code.compilation_watched(lambda title, done: told.append((title, done))):
        begin()
        _function(OTHER)
        begin()
    assert {title for title, _ in told} == {"a test", "another"}
    shares = [done for title, done in told if title == "a test"]
    assert (shares[0], shares[-1]) == (0.0, 1.0)
    assert shares == sorted(shares)
    assert [done for title, done in told if title == "another"] == [0.0, 1.0]


@damaged
def test_damaged_code_is_compiled_anew(cache, begin, damage):
    begin()
    damaged = damage(_kept(cache).read_bytes())
    _kept(cache).write_bytes(damaged)
    assert not is_kept(TEST)
    assert begin()(14) == 42
    assert is_kept(TEST)
    assert _kept(cache).read_bytes() != damaged


def test_no_single_flipped_bit_is_executed(cache, begin):
    begin()
    sound = bytearray(_kept(cache).read_bytes())
    for place in range(0, len(sound), 97):
        sound[place] ^= 1
        _kept(cache).write_bytes(sound)
        assert not is_kept(TEST), place
        sound[place] ^= 1
    _kept(cache).write_bytes(sound)
    assert is_kept(TEST)


def test_code_of_another_processor_is_not_executed(cache, begin, monkeypatch):
    begin()
    monkeypatch.setattr(machine_code, "_inputs", lambda target: b"another processor")
    assert not is_kept(TEST)


def test_without_any_place_it_is_compiled_and_nothing_is_left(tmp_path, begin, monkeypatch):
    (tmp_path / "file").write_text("not a folder")
    monkeypatch.setenv("UICTEST_CACHE", str(tmp_path / "file" / "cache"))
    monkeypatch.setattr("tempfile.tempdir", str(tmp_path / "file"))
    assert begin()(14) == 42
    assert [path.name for path in tmp_path.iterdir()] == ["file"]


def test_what_another_process_compiles_meanwhile_is_used(cache, begin, monkeypatch):
    begin()
    path = _kept(cache)
    code = path.read_bytes()
    path.unlink()

    @contextmanager
    def turn(name, inputs):
        path.write_bytes(code)
        path.chmod(0o600)
        yield

    monkeypatch.setattr(user_cache, "turn", turn)
    monkeypatch.setitem(globals(), "_functions", lambda: pytest.fail("compiled as well"))
    assert begin()(14) == 42
