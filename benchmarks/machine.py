"""The machine that runs a benchmark."""

import os
import platform
import shutil
import subprocess
from importlib import metadata
from pathlib import Path


def processor() -> str:
    """Return the processor's name."""
    try:
        lines = Path("/proc/cpuinfo").read_text().splitlines()
    except OSError:
        return platform.processor() or platform.machine()
    names = [line.partition(":")[2].strip() for line in lines if line.startswith("model name")]
    return names[0] if names else platform.machine()


def vectors() -> str:
    """Return the widest vectors that the processor knows, as far as the system tells."""
    try:
        flags = Path("/proc/cpuinfo").read_text()
    except OSError:
        return "vectors unknown"
    return next(
        (name for name in ("avx512f", "avx2", "avx", "sse2") if f" {name} " in flags), "vectors unknown"
    )


def description(*packages: str) -> str:
    """Return one paragraph: processor, cores, compiler, Python and the versions of ``packages``."""
    versions = ", ".join(f"{name} {_version(name)}" for name in packages)
    return (
        f"{processor()} ({vectors()}), {os.cpu_count()} cores, {platform.system()} {platform.machine()}; "
        f"{_compiler()}; Python {platform.python_version()}, {versions}"
    )


def _version(package: str) -> str:
    try:
        return metadata.version(package)
    except metadata.PackageNotFoundError:
        return "not installed"


def _compiler() -> str:
    path = shutil.which(os.environ.get("CC", "gcc"))
    if path is None:
        return "no C compiler"
    return subprocess.run(
        [path, "--version"], capture_output=True, text=True, check=True
    ).stdout.splitlines()[0]
