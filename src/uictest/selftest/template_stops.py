"""The stop of the first controller that `uictest init` writes, run in a child process: in Python, or in C."""

import os
import shutil
import subprocess
from collections.abc import Callable
from pathlib import Path
from typing import Final

from uictest import rig
from uictest.core import files
from uictest.plans import scenario, templates
from uictest.selftest.check import NotCheckedError

# As the Makefile of the template has them.
_FLAGS: Final = ("-O2", "-std=c99", "-ffp-contract=off", "-fPIC", "-shared", "-o", "libwsp.so", "wsp.c")


def python_stop() -> rig.SimulatedStop:
    """Return the stop with the controller in Python."""
    return _stop("python", lambda folder: None)


def c_stop() -> rig.SimulatedStop:
    """Return the stop with the controller in C. Raises NotCheckedError where it cannot be built."""
    return _stop("c", _build)


def _stop(language: templates.Language, build: Callable[[Path], None]) -> rig.SimulatedStop:
    with files.temporary_folder() as folder:
        for name, content in templates.controller_files(language).items():
            files.write(folder, name, content)
        build(folder)
        (case,) = scenario.load([folder / "slip-120.yaml"])
        return rig.simulate(case)


def _build(folder: Path) -> None:
    done = subprocess.run([_compiler(), *_FLAGS], cwd=folder, capture_output=True, text=True, check=False)
    if done.returncode != 0:
        raise NotCheckedError(f"the C compiler failed: {done.stderr.strip()}")


def _compiler() -> str:
    if os.name != "posix":
        raise NotCheckedError("the Makefile of the first controller in C is for Linux and macOS")
    names = [os.environ["CC"]] if os.environ.get("CC") else ["cc", "gcc", "clang"]
    compiler = next((path for name in names if (path := shutil.which(name))), None)
    if compiler is None:
        raise NotCheckedError(f"no C compiler ({' or '.join(names)}); name one in the variable CC")
    return compiler
