"""The libraries of FMUs, one for each system, the same in every FMU: built by kernel/fmu.py."""

from __future__ import annotations

from functools import cache
from pathlib import Path
from typing import Final, NamedTuple

from uictest.rig import Built

FOLDER: Final = Path(__file__).parent / "binaries"


class System(NamedTuple):
    """A system that an FMU runs on.

    Attributes:
        folder_2: name of its folder in an FMU of FMI 2.0.
        folder: in one of FMI 3.0, and wherever the choice is ours.
        suffix: of a shared library.
    """

    folder_2: str
    folder: str
    suffix: str


SYSTEMS: Final = {
    "linux-x86_64": System("linux64", "x86_64-linux", "so"),
    "windows-x86_64": System("win64", "x86_64-windows", "dll"),
    "linux-aarch64": System("aarch64-linux", "aarch64-linux", "so"),
}
"""By the names that kernel/build.py has for them."""


@cache
def library_of(name: str) -> Path:
    """Return the library for a system. Raises KernelError where there is none that fits this package."""
    about = "the libraries of FMUs"
    return Built(FOLDER, f"fmu-{name}", SYSTEMS[name].suffix, ("--fmus",), about, name).path()
