"""Machine code is called only if it is what the compiler made here."""

from contextlib import contextmanager

import pytest
from llvmlite import binding

from uictest.core import user_cache
from uictest.rig.backends import machine_code
from uictest.rig.backends.machine_code import Unit, host, is_kept, native_function, object_file

NAME, OTHER, UNIT = "uictest_test", "uictest_other", "uictest_tests"


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
        return _function(NAME)

    return load


def _function(name):
    return native_function(Unit(UNIT, {NAME: "a test", OTHER: "another"}, _entries), name, 1)


def _entries():
    return {NAME: (lambda number: 3 * number, (int,)), OTHER: (lambda number: number - 1, (int,))}


def _kept(cache, kind=NAME):
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
        object_file(bitcode, NAME, host())


def test_what_would_raise_an_error_needs_nothing_from_outside(cache):
    """Numba checks the index of a tuple and would tell Python."""
    entries = {"uictest_chosen": (lambda number: (5, 6, 7)[number], (int,))}
    unit = Unit("uictest_choice", {"uictest_chosen": "a choice"}, lambda: entries)
    assert [native_function(unit, "uictest_chosen", 1)(number) for number in range(3)] == [5, 6, 7]


def test_code_is_compiled_once(cache, begin, monkeypatch):
    assert not is_kept(NAME)
    assert begin()(14) == 42
    assert is_kept(NAME)
    monkeypatch.setitem(globals(), "_entries", lambda: pytest.fail("compiled again"))
    assert begin()(14) == 42


def test_what_shares_code_is_compiled_once(cache, begin, monkeypatch):
    begin()
    assert not is_kept(OTHER)
    monkeypatch.setitem(globals(), "_entries", lambda: pytest.fail("compiled again"))
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
    assert not is_kept(NAME)
    assert begin()(14) == 42
    assert is_kept(NAME)
    assert _kept(cache).read_bytes() != damaged


def test_no_single_flipped_bit_is_executed(cache, begin):
    begin()
    sound = bytearray(_kept(cache).read_bytes())
    for place in range(0, len(sound), 97):
        sound[place] ^= 1
        _kept(cache).write_bytes(sound)
        assert not is_kept(NAME), place
        sound[place] ^= 1
    _kept(cache).write_bytes(sound)
    assert is_kept(NAME)


def test_code_of_another_processor_is_not_executed(cache, begin, monkeypatch):
    begin()
    monkeypatch.setattr(machine_code, "_inputs", lambda target: b"another processor")
    assert not is_kept(NAME)


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
    monkeypatch.setitem(globals(), "_entries", lambda: pytest.fail("compiled as well"))
    assert begin()(14) == 42
