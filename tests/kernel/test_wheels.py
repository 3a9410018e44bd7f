"""Every wheel that is made here holds the library of its own system, and the sources of that."""

import os
import struct
import subprocess
import sys
import zipfile
from pathlib import Path

import pytest
from packaging.tags import platform_tags
from packaging.utils import parse_wheel_filename

from kernel import build

REPOSITORY = Path(__file__).parents[2]
MACHINES = {
    "linux-x86_64": ("elf", 62),
    "linux-aarch64": ("elf", 183),
    "windows-x86_64": ("pe", 0x8664),
    "macos-x86_64": ("mach-o", 0x01000007),
    "macos-aarch64": ("mach-o", 0x0100000C),
}
"""Format of a library, and what it calls the processor."""
pytestmark = pytest.mark.slow


def machine(content):
    """Return the format of a library and the processor that it is for, as its head says."""
    if content[:4] == b"\x7fELF":
        return "elf", struct.unpack_from("<H", content, 18)[0]
    if content[:2] == b"MZ":
        return "pe", struct.unpack_from("<H", content, struct.unpack_from("<I", content, 60)[0] + 4)[0]
    assert content[:4] == b"\xcf\xfa\xed\xfe"
    return "mach-o", struct.unpack_from("<I", content, 4)[0]


def build_wheel(target, folder):
    """Make the wheel of a system, in this environment."""
    command = [sys.executable, "-m", "build", "--wheel", "--no-isolation", "--outdir", str(folder)]
    environment = os.environ | {"UICTEST_TARGET": target}
    return subprocess.run(
        command, cwd=REPOSITORY, env=environment, capture_output=True, text=True, check=False
    )


@pytest.fixture(scope="module", params=build.TARGETS)
def wheel(request, tmp_path_factory):
    """The name of a system, its wheel, and a folder with what is in it."""
    folder = tmp_path_factory.mktemp(request.param)
    done = build_wheel(request.param, folder)
    assert done.returncode == 0, done.stdout + done.stderr
    [path] = folder.glob("*.whl")
    zipfile.ZipFile(path).extractall(folder / "unpacked")
    return request.param, path, folder / "unpacked"


def test_a_wheel_has_the_library_of_its_system_only_and_pip_takes_that_of_this_machine_alone(wheel):
    name, _, unpacked = wheel
    [library] = (unpacked / "uictest" / "rig" / "kernel").glob("rig-*")
    content = library.read_bytes()
    assert (library.suffix, machine(content)) == (f".{build.TARGETS[name].suffix}", MACHINES[name])
    if name.startswith("linux"):
        assert b"GLIBC" not in content
        assert b"libc" not in content
    name, path, _ = wheel
    *_, tags = parse_wheel_filename(path.name)
    assert {(tag.interpreter, tag.abi) for tag in tags} == {("py3", "none")}
    assert any(tag.platform in set(platform_tags()) for tag in tags) == (name == build.host())


def test_the_name_of_the_library_has_the_digest_of_the_sources_beside_it(wheel):
    _, _, unpacked = wheel
    code = "from uictest.rig.kernel import library; print(library.FOLDER, library.source_digest())"
    command = [sys.executable, "-c", code]
    environment = os.environ | {"PYTHONPATH": str(unpacked)}
    folder, digest = subprocess.check_output(command, cwd=unpacked, env=environment, text=True).split()
    [library] = Path(folder).glob("rig-*")
    assert (unpacked in library.parents, library.name.split("-")[1]) == (True, digest)


def test_an_unknown_target_is_said_in_a_sentence(tmp_path):
    done = build_wheel("linux-riscv64", tmp_path)
    said = done.stdout + done.stderr
    assert done.returncode != 0
    assert "no kernel can be built for linux-riscv64; there is one for linux-x86_64, linux-aarch64, " in said
