"""Object files are loaded with the same bits with LLVM's loader and without LLVM."""

import platform
import struct
import sys
from pathlib import Path

import pytest

from uictest.core import processor as processors
from uictest.plans.scenario import load
from uictest.rig import simulate
from uictest.rig.backends import loading, machine_code
from uictest.rig.backends.loading import UnsupportedObjectError, load_by_llvm, load_directly
from uictest.rig.backends.native import compiled_stop
from uictest.rig.backends.scalar import RUN, SCALAR

pytestmark = pytest.mark.skipif(
    sys.platform != "linux" or platform.machine() != "x86_64", reason="loaded by LLVM here"
)
STOP = "schema: uictest/scenario/1\nname: stop\ninitial_speed: 40 km/h\nrail: {condition: wet}\n"


@pytest.fixture(scope="module")
def code():
    return machine_code.object_code(SCALAR, RUN, machine_code.host())


@pytest.fixture
def stop_by(tmp_path, monkeypatch):
    """Run a stop whose code one of the loaders has loaded."""
    (tmp_path / "stop.yaml").write_text(STOP, "utf-8")

    def measures(loader):
        monkeypatch.setattr(machine_code, "_loaded", {})
        monkeypatch.setattr(machine_code, "load_object_file", loader)
        compiled_stop.cache_clear()
        stop = simulate(load([tmp_path / "stop.yaml"])[0])
        return stop.measures.tobytes() + stop.wheelset_measures.tobytes()

    yield measures
    compiled_stop.cache_clear()


def test_both_loaders_give_the_same_bits(stop_by):
    assert stop_by(load_directly) == stop_by(load_by_llvm)


def test_what_is_loaded_can_be_executed_and_not_written(code):
    loaded = load_directly(code)
    start = loaded.address_of(RUN)
    spans = [line.split()[:2] for line in Path("/proc/self/maps").read_text("utf-8").splitlines()]
    ends = [(*(int(end, 16) for end in span.split("-")), rights) for span, rights in spans]
    (rights,) = (rights for first, end, rights in ends if first <= start < end)
    assert rights.startswith("r-x")


def _with_relocations(code, change):
    """Return an object file with each relocation changed."""
    changed = bytearray(code)
    for section in loading._sections(code):
        if section.kind == loading._RELOCATIONS:
            for place in range(section.offset, section.offset + section.size, 24):
                words = change(*struct.unpack_from("<QIIq", code, place))
                struct.pack_into("<QIIq", changed, place, *words)
    return bytes(changed)


@pytest.mark.parametrize(
    ("change", "message"),
    [
        (lambda offset, kind, symbol, addend: (offset, 37, symbol, addend), "relocation 37"),
        (lambda offset, kind, symbol, addend: (offset, kind, 0, addend), "is not in the file"),
    ],
    ids=["of an unknown kind", "to another file"],
)
def test_what_it_does_not_do_is_left_to_llvm(code, change, message, monkeypatch):
    changed = _with_relocations(code, change)
    with pytest.raises(UnsupportedObjectError, match=message):
        load_directly(changed)
    monkeypatch.setattr(loading, "load_by_llvm", lambda given: (given, "by LLVM"))
    assert loading.load_object_file(changed) == (changed, "by LLVM")


def test_other_files_are_refused(code):
    for other in (b"\x7fELF\x01" + code[5:], b"MZ" + code[2:], code[:18] + b"\xb7\0" + code[20:]):
        with pytest.raises(UnsupportedObjectError, match="not an object file of this kind"):
            load_directly(other)


def test_a_system_that_forbids_made_code_is_served_by_llvm(code, monkeypatch):
    def forbid(start, size):
        raise PermissionError(13, "forbidden")

    monkeypatch.setattr(loading, "_make_executable", forbid)
    monkeypatch.setattr(loading, "load_by_llvm", lambda given: "by LLVM")
    assert loading.load_object_file(code) == "by LLVM"


def test_the_processor_is_the_one_that_llvm_names_also_when_read_back(tmp_path, monkeypatch):
    monkeypatch.setenv("UICTEST_CACHE", str(tmp_path / "cache"))
    asked = processors._asked()
    assert processors.processor.__wrapped__() == asked
    monkeypatch.setattr(processors, "_asked", lambda: pytest.fail("LLVM was asked again"))
    assert processors.processor.__wrapped__() == asked
    monkeypatch.setattr(processors, "_known_by", lambda: b"another processor")
    monkeypatch.setattr(processors, "_asked", lambda: processors.Processor("another", "-fma"))
    assert processors.processor.__wrapped__() == ("another", "-fma")


def test_features_are_read_as_llvm_writes_them():
    own = processors.Processor("x86-64", "+avx,-fma")
    assert (own.has("avx"), own.has("fma"), own.has("sve")) == (True, False, False)
    assert (own.has("fma", unlisted=True), own.has("sve", unlisted=True)) == (False, True)
