"""Controllers in C, compiled for FMUs: for all systems by ziglang, for this one by the user's compiler."""

import shutil
import sys

import pytest

from uictest.api import fmu

SOURCE = "int answer(void) { return 42; }\n"
KINDS = {"linux-x86_64": (b"\x7fELF", 18, 0x3E), "linux-aarch64": (b"\x7fELF", 18, 0xB7)}
"""First bytes of a library, and where its header says which processor it is for."""


@pytest.fixture(name="source")
def _source(tmp_path):
    path = tmp_path / "wsp.c"
    path.write_text(SOURCE)
    return path


def test_ziglang_compiles_for_every_system(source, monkeypatch):
    monkeypatch.delenv("CC", raising=False)
    pytest.importorskip("ziglang", reason="ziglang is not installed")
    libraries = fmu.compiled([source])
    assert libraries.keys() == fmu.SYSTEMS.keys()
    for system, (magic, place, machine) in KINDS.items():
        assert libraries[system].startswith(magic)
        assert libraries[system][place] == machine
    assert libraries["windows-x86_64"].startswith(b"MZ")


@pytest.mark.parametrize("named", ["by CC", "found"])
def test_without_ziglang_a_compiler_of_the_user_compiles_for_this_system(source, monkeypatch, named):
    compiler = shutil.which("cc")
    if compiler is None:
        pytest.skip("there is no cc here")
    if named == "found":
        monkeypatch.delenv("CC", raising=False)
        monkeypatch.setitem(sys.modules, "ziglang", None)
    else:
        monkeypatch.setenv("CC", compiler)
    assert list(fmu.compiled([source])) == [fmu.this_system()]


def test_without_a_compiler_it_says_what_to_install(source, monkeypatch, tmp_path):
    monkeypatch.setenv("PATH", str(tmp_path))
    monkeypatch.delenv("CC", raising=False)
    monkeypatch.setitem(sys.modules, "ziglang", None)
    with pytest.raises(
        fmu.CannotBuildError, match=r"no C compiler \(cc or gcc or clang\): pip install ziglang"
    ):
        fmu.compiled([source])


def test_a_compiler_that_fails_says_why(source, monkeypatch, tmp_path):
    broken = tmp_path / "broken-cc"
    broken.write_text("#!/bin/sh\necho 'cannot find crti.o' >&2\nexit 1\n")
    broken.chmod(0o755)
    monkeypatch.setenv("CC", str(broken))
    with pytest.raises(RuntimeError, match=r"^cannot find crti.o$"):
        fmu.compiled([source])


def test_a_machine_that_no_fmu_is_for_exports_no_library(monkeypatch):
    monkeypatch.setattr("platform.system", lambda: "Darwin")
    monkeypatch.setattr("platform.machine", lambda: "arm64")
    with pytest.raises(fmu.CannotBuildError, match="this machine is darwin-aarch64"):
        fmu.this_system()
