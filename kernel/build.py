"""Builds the kernel: writes its C++, compiles it for several processors, makes a library of it.

Run `python kernel/build.py`, or let `pip install` do so. The compiler is clang from the package `ziglang`, on
every machine the same.
"""

import argparse
import hashlib
import os
import platform
import subprocess
import sys
import tempfile
from collections.abc import Sequence
from concurrent.futures import ThreadPoolExecutor
from contextlib import suppress
from pathlib import Path
from struct import unpack_from
from typing import Final, NamedTuple

HERE: Final = Path(__file__).parent
ROOT: Final = HERE.parent
sys.path[:0] = [str(ROOT / "src"), str(ROOT)]
OBJECTS: Final = ROOT / "build" / "kernel"
"""What was compiled before, by the digest of what it was compiled from."""
FLAGS: Final = (
    *("-std=c++20", "-O3", "-g0", "-Wall", "-Wfloat-conversion", "-Werror", "-Wno-unused", "-Wno-psabi"),
    # Arithmetic as it is written: nothing is fused, reordered or left out, on any machine.
    *("-ffp-contract=off", "-fno-math-errno", "-fwrapv"),
    *("-fno-exceptions", "-fno-rtti", "-fomit-frame-pointer", "-fvisibility=hidden", "-fPIC"),
    # Loops are over wheelsets, and lanes are vectors: as measured, it runs no faster, and compiles longer.
    *("-fno-vectorize", "-fno-slp-vectorize", "-fno-unroll-loops", "-mllvm", "-enable-misched=false"),
    "-Wno-unused-command-line-argument",
)


class Target(NamedTuple):
    """A system that libraries are built for.

    Attributes:
        triple: its name for the compiler.
        wheel_tag: its name in a wheel's.
        levels: of its processor that the library has code for, and what the compiler calls them.
        suffix: of a shared library.
        link: how one is linked.
    """

    triple: str
    wheel_tag: str
    levels: dict[str, str]
    suffix: str
    link: tuple[str, ...] = ()


_X86: Final = {"v1": "x86_64", "v3": "x86_64_v3", "v4": "x86_64_v4"}
"""The first, that since 2013 with fused multiplication and addition, that with registers of 512 bits."""
_ARM: Final = {"v1": "generic"}
_ALONE: Final = ("-nostdlib", "-lcompiler_rt")
"""The compiler brings what little there is to call, so that the library loads beside any C library."""
TARGETS: Final = {
    "linux-x86_64": Target(
        "x86_64-linux-gnu.2.17", "manylinux_2_17_x86_64.musllinux_1_1_x86_64", _X86, "so", _ALONE
    ),
    "linux-aarch64": Target(
        "aarch64-linux-gnu.2.17", "manylinux_2_17_aarch64.musllinux_1_1_aarch64", _ARM, "so", _ALONE
    ),
    "windows-x86_64": Target("x86_64-windows-gnu", "win_amd64", _X86, "dll"),
    "macos-x86_64": Target(
        "x86_64-macos.11.0", "macosx_11_0_x86_64", {"v1": "x86_64", "v3": "x86_64_v3"}, "dylib"
    ),
    "macos-aarch64": Target("aarch64-macos.11.0", "macosx_11_0_arm64", {"v1": "apple_m1"}, "dylib"),
}
"""Systems that there is a wheel for."""
WASM: Final = Target(
    *("wasm32-freestanding", "", {"v1": "generic+simd128"}, "wasm"),
    (*_ALONE, "-Wl,--no-entry", "-Wl,--export-dynamic"),
)
"""WebAssembly, of which there is no wheel: for browsers and Node."""


class BuildError(Exception):
    """A library cannot be built; the message, maybe the compiler's own, says why."""


def digests() -> tuple[str, str]:
    """Return the digests of the package's Python files and of these programs, as they are now."""
    from uictest.rig.kernel import library

    return library.source_digest.__wrapped__(), library.builder_digest.__wrapped__()


_AT_START: Final = digests()
"""Before the model is imported, to be read."""


def host() -> str:
    """Return the name of this machine's target; :func:`target_named` says whether there is one."""
    system, machine = platform.system().lower(), platform.machine().lower()
    usual = {"darwin": "macos", "amd64": "x86_64", "arm64": "aarch64"}
    return f"{usual.get(system, system)}-{usual.get(machine, machine)}"


def target_named(name: str) -> Target:
    """Return the target of a name. Raises BuildError where there is none."""
    if name not in TARGETS:
        raise BuildError(f"no kernel can be built for {name}; there is one for {', '.join(TARGETS)}")
    return TARGETS[name]


def compile_file(source: Path, target: Target, flags: Sequence[str]) -> Path:
    """Compile a C or C++ file and return the object file, from before where nothing has changed."""
    headers = [path.read_bytes() for folder in (HERE, source.parent) for path in sorted(folder.rglob("*.h*"))]
    inputs = repr((source.name, source.read_bytes(), headers, target.triple, flags, _compiler_version()))
    done = OBJECTS / f"{hashlib.sha256(inputs.encode()).hexdigest()[:24]}.o"
    if not done.exists():
        OBJECTS.mkdir(parents=True, exist_ok=True)
        with tempfile.TemporaryDirectory(dir=OBJECTS) as folder:
            new = Path(folder) / "new.o"
            run_compiler(target, *flags, f"-I{HERE}", "-c", str(source), "-o", str(new))
            os.replace(new, done)  # noqa: PTH105 - whole or not at all, whoever else builds
    return done


def run_compiler(target: Target, *arguments: str) -> None:
    """Run clang. Raises BuildError with what it says."""
    command = [sys.executable, "-m", "ziglang", "c++", "-target", target.triple, *arguments]
    own = {"ZIG_GLOBAL_CACHE_DIR": str(OBJECTS / "compiler"), **os.environ}  # else in the user's home
    done = subprocess.run(command, cwd=ROOT, env=own, capture_output=True, text=True, check=False)
    if done.returncode != 0:
        raise BuildError(done.stderr.strip() or f"the compiler ended with code {done.returncode}")


def _compiler_version() -> str:
    from importlib.metadata import PackageNotFoundError, version

    try:
        return version("ziglang")
    except PackageNotFoundError:
        raise BuildError("the compiler is not installed: pip install ziglang==0.17.1") from None


def write_source(folder: Path) -> Path:
    """Write the kernel as C++ to a folder and return the file."""
    from kernel.contents import written

    source = folder / "rig.cpp"
    source.write_text(written().text(), encoding="utf-8", newline="\n")
    return source


def compile_kernel(target: Target, folder: Path) -> list[Path]:
    """Write the kernel to a folder and return its object files. Raises BuildError, UntranslatableError."""
    source = write_source(folder)
    return compile_files(target, [*((source, flags_of(target, level)) for level in target.levels), PROCESSOR])


def flags_of(target: Target, level: str) -> tuple[str, ...]:
    """Return the flags for generated code, for a level of the processor."""
    from uictest.rig.kernel.library import WIDTHS

    variant = (f"-mcpu={target.levels[level]}", f"-DVARIANT={level}", f"-DLANES={WIDTHS[level]}")
    return (*FLAGS, *variant)


PROCESSOR: Final = (HERE / "processor.c", ("-x", "c", "-O2", "-fPIC", "-fvisibility=hidden"))
"""What says which level a processor has, and its flags."""


def compile_files(target: Target, work: Sequence[tuple[Path, Sequence[str]]]) -> list[Path]:
    """Compile files, each with flags of its own, and return the object files. Raises BuildError."""
    with ThreadPoolExecutor(os.cpu_count()) as pool:
        return list(pool.map(lambda each: compile_file(each[0], target, each[1]), work))


def link_library(target: Target, objects: Sequence[Path], library: Path) -> None:
    """Make a shared library of object files. Raises BuildError."""
    kind = () if target is WASM else ("-shared",)
    run_compiler(target, *kind, "-s", "-nostdlib++", *map(str, objects), *target.link, "-o", str(library))
    if target.suffix == "dll":
        library.write_bytes(without_dates(library.read_bytes()))


def without_dates(content: bytes) -> bytes:
    """Return a library for Windows without when it was linked: the same is built everywhere, at any time."""
    undated = bytearray(content)
    [header] = unpack_from("<I", content, 0x3C)  # of the file; behind it the optional one, then the sections
    sections, size = unpack_from("<2xH12xH", content, header + 4)
    [exports] = unpack_from("<I", content, header + 24 + 112)
    undated[header + 8 : header + 12] = bytes(4)
    for number in range(sections):
        length, begins, _, place = unpack_from("<4I", content, header + 24 + size + 40 * number + 8)
        if begins <= exports < begins + length:
            undated[place + exports - begins + 4 : place + exports - begins + 8] = bytes(4)
    return bytes(undated)


def build_library(name: str, folder: Path) -> Path:
    """Build the library of a target into a folder and return it; the one before goes.

    Raises BuildError, UntranslatableError.
    """
    target = target_named(name)
    with tempfile.TemporaryDirectory() as temporary:
        return put_library(target, compile_kernel(target, Path(temporary)), folder, "rig")


def put_library(target: Target, objects: Sequence[Path], folder: Path, stem: str) -> Path:
    """Link a library into a folder, its digests behind the stem of its name; the one before goes."""
    from uictest.rig.kernel.library import digest_of

    if digests() != _AT_START:
        raise BuildError("Python files were changed while they were compiled; build again")
    with tempfile.TemporaryDirectory() as temporary:
        linked = Path(temporary) / f"{stem}.{target.suffix}"
        link_library(target, objects, linked)
        content = linked.read_bytes()
    library = folder / f"{stem}-{'-'.join((*_AT_START, digest_of(content)))}.{target.suffix}"
    folder.mkdir(parents=True, exist_ok=True)
    with tempfile.TemporaryDirectory(dir=folder) as temporary:
        whole = Path(temporary) / library.name
        whole.write_bytes(content)
        os.replace(whole, library)  # noqa: PTH105 - whole or not at all
    for other in folder.glob(f"{stem}-*"):
        if other != library:
            with suppress(OSError):  # Windows removes none that a process has loaded; the next build does
                other.unlink()
    return library


def build_package(target: str | None = None) -> Path:
    """Build the library of a target, or of this machine, into the package."""
    from uictest.rig.kernel.library import FOLDER

    return build_library(target or host(), FOLDER)


def _built(*, fmus: bool) -> list[Path]:
    if not fmus:
        return [build_package()]
    from kernel.fmu import build_libraries

    return build_libraries()


def main() -> int:
    """Run the command line and return the exit code."""
    parser = argparse.ArgumentParser(description="Build the kernel of uictest.")
    parser.add_argument("--write", metavar="FOLDER", type=Path, help="only write the C++ there")
    parser.add_argument("--targets", action="store_true", help="only list the systems of the wheels")
    parser.add_argument("--fmus", action="store_true", help="build the libraries of FMUs in its place")
    given = parser.parse_args()
    if given.targets:
        print(*TARGETS, sep="\n")
        return 0
    from filelock import FileLock

    from kernel.names import UntranslatableError

    try:
        if given.write:
            print(write_source(given.write))
            return 0
        OBJECTS.mkdir(parents=True, exist_ok=True)
        with FileLock(OBJECTS / "lock"):  # of processes that begin at once one compiles
            print(*_built(fmus=given.fmus), sep="\n")
    except (BuildError, UntranslatableError, OSError) as error:
        print(error, file=sys.stderr)
        return 1
    return 0


if __name__ == "__main__":
    sys.exit(main())
