"""Compiles functions that are no part of the rig, such as those of a study, as the kernel is compiled."""

import ctypes
from pathlib import Path

from kernel import build
from kernel.cpp import Program
from uictest.rig.kernel.library import processor


def load(program: Program, folder: Path, level: str | None = None) -> ctypes.CDLL:
    """Compile a program for this machine and load it. Raises BuildError.

    Args:
        program: what it holds, without the bracket at the end.
        folder: where the library is written; it can be removed afterwards.
        level: of the processor, whose name the entries of the program have; the highest that it has.
    """
    target, level = build.TARGETS[build.host()], level or processor()
    source, library = folder / "program.cpp", folder / f"program-{level}.{target.suffix}"
    source.write_text(f"{program.text()}}}\n", encoding="utf-8")
    flags = (*build.flags_of(target, level), f"-I{build.HERE}", "-shared", "-nostdlib++")
    build.run_compiler(target, *flags, str(source), "-o", str(library), "-lm")
    return ctypes.CDLL(str(library))
