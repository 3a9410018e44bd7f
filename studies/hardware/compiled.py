"""The steps of the second module as machine code: compiled as the rig's are, in a library of their own."""

import ctypes
from collections.abc import Callable
from functools import cache
from math import exp, pow as power, sqrt
from pathlib import Path
from tempfile import TemporaryDirectory
from typing import Any

from kernel.alone import load
from kernel.build import ROOT
from kernel.contents import exported
from kernel.cpp import Program
from kernel.records import struct
from uictest.rig.kernel.arguments import Length, at, lengths, passed
from uictest.rig.kernel.library import Entry, processor


@cache
def compiled_walk(settings: Any, outputs: int) -> Callable[..., Any]:
    """Return :func:`studies.hardware.module.walk` compiled.

    Args:
        settings: layout of its settings.
        outputs: rows that it fills.
    """
    rows = Length("rows")
    arguments = at("f8", rows), at("i8", rows), at(settings, 1), int, at("f8", outputs, rows)
    entry = Entry("studies.hardware.module:walk", arguments)
    program = Program(ROOT, {sqrt: "sqrt", exp: "__builtin_exp", power: "__builtin_pow"})
    program.add('#include "runtime.hpp"\nnamespace {\n' + struct("Settings", settings))
    program.add(exported(program, entry, {settings: "Settings"}))
    with TemporaryDirectory() as folder:
        library = load(program, Path(folder))
    prototype = ctypes.CFUNCTYPE(*[ctypes.c_int64] * (1 + len(lengths(arguments)) + len(arguments)))
    function = prototype((f"{entry.symbol}_{processor()}", library))
    return lambda *values: function(*passed(arguments, values))
