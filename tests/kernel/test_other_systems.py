"""The kernel gives on other processors and systems, emulated here, the bits that it gives on this machine."""

import os
import shutil
import struct
import subprocess
import sys
from pathlib import Path

import numpy as np
import pytest

from kernel import build
from kernel.contents import ENTRIES

from .recorded_calls import NAME

HERE = Path(__file__).parent
WINE = ["/usr/lib/wine/wine64"] if Path("/usr/lib/wine/wine64").exists() else ["wine64"]
SYSTEMS = {
    "linux-x86_64": (build.TARGETS["linux-x86_64"]._replace(triple="x86_64-linux-musl"), []),
    "linux-aarch64": (build.TARGETS["linux-aarch64"]._replace(triple="aarch64-linux-musl"), ["qemu-aarch64"]),
    "windows-x86_64": (build.TARGETS["windows-x86_64"], WINE),
    "wasm": (build.WASM, ["node", str(HERE / "call.mjs")]),
}
"""How each system is built for and run. For Linux the objects are linked without a library beside them."""
VARIANTS = [(name, level) for name, (target, _) in SYSTEMS.items() for level in target.levels]
pytestmark = pytest.mark.slow


@pytest.fixture(scope="module")
def record(tmp_path_factory):
    """Record calls once: of stops alone, or in lanes as wide as code for a level of processors has them."""
    root = tmp_path_factory.mktemp("calls")

    def recorded(kind, level=""):
        folder = root / f"{kind}{level}"
        if not folder.exists():
            command = [sys.executable, str(HERE / "recorded_calls.py"), kind, str(folder)]
            subprocess.run(command, check=True, env=os.environ | {"UICTEST_PROCESSOR": level})
        return folder

    return recorded


@pytest.fixture(scope="module", autouse=True)
def _one_wine(tmp_path_factory):
    """Keep the settings of Wine in a temporary folder, which takes some seconds to make."""
    with pytest.MonkeyPatch.context() as patch:
        patch.setenv("WINEPREFIX", str(tmp_path_factory.mktemp("wine") / "prefix"))
        patch.setenv("WINEDEBUG", "-all")
        yield


def program(system, level, folder):
    """Build what calls the kernel of a system, and return the command that runs it."""
    target, emulator = SYSTEMS[system]
    if emulator and not shutil.which(emulator[0]):
        pytest.skip(f"{emulator[0]} is not installed")
    objects = build.compile_kernel(target, folder)
    if system == "wasm":
        build.link_library(target, objects, folder / "rig.wasm")
        return [*emulator, str(folder / "rig.wasm")]
    if target.suffix == "dll":
        build.link_library(target, objects, folder / "rig.dll")
        objects = [folder / "rig.dll"]
    (folder / "entries.h").write_text("".join(f"X({entry.symbol})\n" for entry in ENTRIES), "utf-8")
    # Entries are declared without their arguments, which only C before C23 allows.
    options = ("-std=c11", "-w", "-O1", f"-I{folder}", f"-DVARIANT={level}", "-x", "c", str(HERE / "call.c"))
    executable = folder / "call.exe"
    build.run_compiler(target, *options, "-x", "none", *map(str, objects), "-o", str(executable))
    return [*emulator, str(executable)]


def first_difference(calls, expected, found):
    """Return where results differ, in words; nothing if they do not."""
    place = result = number = 0
    while place < len(calls):
        name, place = calls[place : place + NAME].rstrip(b"\0").decode(), place + NAME
        blocks, arguments = struct.unpack_from("<2q", calls, place)
        sizes = struct.unpack_from(f"<{blocks}q", calls, place + 16)
        place += 8 * (2 + blocks + 2 * arguments) + sum(sizes)
        for block, size in enumerate((8, *sizes)):
            pair = [each[result : result + size] for each in (expected, found)]
            if not same_bits(*pair):
                return f"call {number}, {name}: block {block} of what it returns and leaves has other bits"
            result += size
        number += 1
    return "" if len(expected) == len(found) == result else "more results than calls"


def same_bits(expected, found):
    """Return whether all bits are the same, but for those of NaN, in whose sign processors differ."""
    if expected == found:
        return True
    if len(expected) != len(found) or len(expected) % 8:
        return False
    words = [np.frombuffer(each, "u8") for each in (expected, found)]
    neither_is_a_number = np.logical_and(*(np.isnan(each.view("f8")) for each in words))
    return bool(np.all((words[0] == words[1]) | neither_is_a_number))


@pytest.mark.parametrize(("system", "level"), VARIANTS)
@pytest.mark.parametrize("kind", ["stops", "lanes"])
def test_the_same_bits(record, tmp_path, system, level, kind):
    folder = record(kind, level if kind == "lanes" else "")
    command = [*program(system, level, tmp_path), str(folder / "calls"), str(tmp_path / "results")]
    subprocess.run(command, check=True, cwd=tmp_path)
    contents = [(folder / name).read_bytes() for name in ("calls", "results")]
    assert first_difference(*contents, (tmp_path / "results").read_bytes()) == ""


def test_stops_in_lanes_of_every_width_have_the_same_bits(record):
    digests = {(record("lanes", level) / "digest").read_text("utf-8") for level in ("v1", "v3", "v4")}
    assert len(digests) == 1
