"""FMUs on other systems and processors than this one, under wine and qemu: the same bits."""

import math
import shutil
import subprocess
import sys
from functools import cache
from importlib.util import find_spec
from pathlib import Path, PureWindowsPath

import pytest

from uictest.api import fmu
from uictest.plans import templates
from uictest.plans.scenario import load_controller

fmpy = pytest.importorskip("fmpy", reason="the extra fmu is not installed")
pytestmark = [
    pytest.mark.slow,
    pytest.mark.skipif(find_spec("ziglang") is None, reason="ziglang is not installed"),
    pytest.mark.skipif(sys.platform != "linux", reason="the others are run under wine and qemu on Linux"),
]
DRIVER = Path(__file__).parent / "driver.c"
WINE = shutil.which("wine64") or next(iter(Path("/usr/lib/wine").glob("wine64")), None)
OLD = shutil.which("qemu-x86_64")
QEMU = shutil.which("qemu-aarch64") or shutil.which("qemu-aarch64-static")

OBJECTS = """
from kernel.build import TARGETS
from kernel.fmu import objects_for
print(*objects_for(TARGETS["linux-aarch64"]._replace(triple="aarch64-linux-musl")))
"""


class Unpacked:
    """An FMU in a folder, and the script that steps it."""

    def __init__(self, folder, content, script):
        path = folder / "x.fmu"
        path.write_bytes(content)
        self.folder = Path(fmpy.extract(str(path), unzipdir=str(folder / "with blank and %")))
        self.description = fmpy.read_model_description(str(path))
        self.version = int(self.description.fmiVersion[0])
        self.references = {each.name: each.valueReference for each in self.description.modelVariables}
        self.script = "\n".join(script(self.references))

    def arguments(self, system, place=lambda path: path):
        """Return what the driver is given; `place` says where a path is on that system."""
        of = fmu.SYSTEMS[system]
        folder = of.folder_2 if self.version == 2 else of.folder
        library = next((self.folder / "binaries" / folder).iterdir())
        resources = place(self.folder / "resources")
        told = resources.as_uri() if self.version == 2 else str(resources)
        token = self.description.guid if self.version == 2 else self.description.instantiationToken
        return [str(self.version), str(place(library)), token, told, "0.01"]

    def run(self, command, system, place=lambda path: path, **options):
        """Return what the driver prints."""
        arguments = [*map(str, command), *self.arguments(system, place)]
        done = subprocess.run(
            arguments, input=self.script, capture_output=True, text=True, check=False, **options
        )
        assert done.returncode == 0, done.stdout + done.stderr
        return done.stdout.split()


def rig_script(references):
    """Hold and vent in turns, and read what moves."""
    names = [
        name for name in references if name.startswith(("true_wheel_speed", "clamping_force", "friction"))
    ]
    for cycle in range(600):
        for number in (1, 2, 3, 4):
            hold = cycle // (10 + number) % 3 > 0
            yield f"b {references[f'hold_{number}']} {int(hold)}"
            yield f"b {references[f'vent_{number}']} {int(hold and cycle % 7 < 3)}"
        yield "s"
        if cycle % 20 == 0:
            yield from (f"g {references[name]}" for name in ("train_speed", "distance", *names))


def controller_script(references):
    """Wheelsets that slide in turns, and what the controller makes of the train's speed."""
    for cycle in range(600):
        for number in (1, 2, 3, 4):
            speed = (30.0 - 0.01 * cycle) * (1.0 - 0.3 * max(0.0, math.sin(0.02 * cycle * number)))
            yield f"r {references[f'wheel_speed_{number}']} {speed!r}"
        yield f"r {references['brake_demand']} 1"
        yield "s"
        yield f"g {references['reference_speed']}"


@cache
def compiled(target, folder, *more):
    """Build the driver for a target."""
    program = folder / f"driver-{target}.exe"
    zig = [sys.executable, "-m", "ziglang", "c++" if more else "cc", "-target", target, "-O1"]
    source = ["-x", "c", str(DRIVER), "-x", "none"]
    subprocess.run([*zig, *source, *more, "-o", str(program)], check=True)
    return program


def in_c(folder):
    """Return a controller in C, and its libraries for all systems."""
    for name, text in templates.controller_files("c").items():
        (folder / name).write_text(text)
    with pytest.MonkeyPatch.context() as patch:
        patch.delenv("CC", raising=False)  # which names a compiler for this system alone
        libraries = fmu.compiled([folder / "wsp.c"])
    (folder / "libwsp.so").write_bytes(libraries[fmu.this_system()])
    return load_controller(str(folder / "my-wsp.yaml")), libraries


@pytest.fixture(name="unpacked", scope="module", params=[2, 3])
def _unpacked(request, case, tmp_path_factory):
    """The rig of the case, a built-in controller and one in C."""
    version = request.param
    rig, built_in, library = (tmp_path_factory.mktemp(name) for name in ("rig", "built-in", "library"))
    controllers = [(built_in, load_controller("slip-band"), None), (library, *in_c(library))]
    return [
        Unpacked(rig, fmu.build_fmu(case, version), rig_script),
        *(
            Unpacked(folder, fmu.build_controller_fmu(part, version, libraries).content, controller_script)
            for folder, part, libraries in controllers
        ),
    ]


@pytest.fixture(name="folder", scope="module")
def _folder(tmp_path_factory):
    return tmp_path_factory.mktemp("programs")


def here(each, folder):
    """Return what this system prints."""
    program = compiled("x86_64-linux-gnu.2.17", folder)
    numbers = each.run([program], "linux-x86_64")
    assert len(set(numbers)) > 100
    return numbers


@pytest.mark.skipif(WINE is None, reason="wine64 is not installed")
def test_windows_gives_the_same_bits(unpacked, folder):
    program = compiled("x86_64-windows-gnu", folder)
    own = {
        "WINEPREFIX": str(folder / "wine"),
        "WINEDEBUG": "-all",
        "HOME": str(folder),
        "PATH": "/usr/bin:/bin",
    }
    for each in unpacked:
        there = each.run(
            [WINE, program], "windows-x86_64", lambda path: PureWindowsPath(f"Z:{path}"), env=own
        )
        assert there == here(each, folder)


@pytest.mark.skipif(OLD is None, reason="qemu-x86_64 is not installed")
def test_a_processor_without_fused_operations_gives_the_same_bits(unpacked, folder):
    program = compiled("x86_64-linux-gnu.2.17", folder)
    for each in unpacked:
        assert each.run([OLD, "-cpu", "Nehalem", program], "linux-x86_64") == here(each, folder)


@pytest.mark.skipif(QEMU is None, reason="qemu-aarch64 is not installed")
def test_aarch64_gives_the_same_bits(unpacked, folder):
    """The code is linked into the program: what loads libraries is not there, so none is for a controller."""
    # In a process of its own: here tests have replaced an operation that is to be compiled.
    done = subprocess.run(
        [sys.executable, "-c", OBJECTS], cwd=DRIVER.parents[2], capture_output=True, text=True, check=True
    )
    program = compiled(
        "aarch64-linux-musl", folder, "-DSTATIC", "-static", "-nostdlib++", *done.stdout.split()
    )
    for each in unpacked[:2]:
        assert each.run([QEMU, program], "linux-aarch64") == here(each, folder)
