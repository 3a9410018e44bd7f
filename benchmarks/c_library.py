"""The C rig as a shared library: its records' header written from our dtypes, compiled, called by ctypes.

The library is kept in a temporary folder named after its sources, header, flags, compiler and processor.
"""

import ctypes
import hashlib
import os
import shutil
import subprocess
import tempfile
from dataclasses import dataclass
from pathlib import Path
from typing import Any

import numpy as np
from machine import processor
from numpy.typing import NDArray

from uictest.core.measures import STOP_MEASURES, WHEELSET_MEASURES
from uictest.rig.model.parameters import PARAMETERS
from uictest.rig.model.state import BOGIE, CAR, WHEELSET
from uictest.rig.model.wheelset_parameters import WHEELSET_PARAMETERS

SOURCES = Path(__file__).parent / "c"
PLAIN = ("-O3", "-march=native")
"""Flags of the scalar C rig; gcc contracts multiplications and additions by default."""
STRICT = (*PLAIN, "-ffp-contract=off")
"""Flags that keep the operations as they are written, as our own build does."""

RECORDS = {
    "Parameters": PARAMETERS,
    "WheelsetParameters": WHEELSET_PARAMETERS,
    "Car": CAR,
    "Bogie": BOGIE,
    "Wheelset": WHEELSET,
    "Measures": STOP_MEASURES,
    "WheelsetMeasures": WHEELSET_MEASURES,
}
STATES = ("Car", "Bogie", "Wheelset")
"""Records whose numbers lie STRIDE apart where scalar code works on one lane of several."""
_BESIDE = """
#ifdef STRIDE
#define BESIDE(name) double name##_beside[STRIDE - 1];
#else
#define BESIDE(name)
#endif
"""
_C_TYPES = {"f": "real", "i": "integer"}


class NoCompilerError(RuntimeError):
    """No C compiler was found."""


def records_header() -> str:
    """Return records.h: the struct of each record, field by field in the order of its dtype."""
    structs = (_struct(name, dtype) for name, dtype in RECORDS.items())
    return "\n".join(["#pragma once", '#include "number.h"', _BESIDE, *structs, _copy_function()])


def _copy_function() -> str:
    """Return what sets the parameters in the state of a wheelset, which is scalar code."""
    names = WHEELSET_PARAMETERS.names or ()
    lines = "".join(f"    wheelset->{name} = own->{name};\n" for name in names)
    head = "OURS void copy_wheelset_parameters(Wheelset *wheelset, const WheelsetParameters *own)"
    return f"{head}\n{{\n{lines}}}\n"


def _struct(name: str, dtype: np.dtype[Any]) -> str:
    beside = "    BESIDE({})\n" if name in STATES else ""
    fields = (_field(field, dtype[field]) + beside.format(field) for field in dtype.names or ())
    return f"typedef struct {{\n{''.join(fields)}}} {name};\n"


def _field(name: str, dtype: np.dtype[Any]) -> str:
    length = f"[{dtype.shape[0]}]" if dtype.shape else ""
    if dtype.base.itemsize != 8:
        raise AssertionError(f"{name}: the C rig knows numbers of eight bytes only")
    return f"    {_C_TYPES[dtype.base.kind]} {name}{length};\n"


def compiler() -> str:
    """Return the C compiler: ``$CC``, else gcc.

    Raises:
        NoCompilerError: when there is none.
    """
    path = shutil.which(os.environ.get("CC", "gcc"))
    if path is None:
        raise NoCompilerError("no C compiler: install gcc or set CC")
    return path


@dataclass(frozen=True)
class Unit:
    """One source file of the C rig and the flags that it is compiled with."""

    source: str
    flags: tuple[str, ...]


def library(*units: Unit) -> ctypes.CDLL:
    """Return the shared library of these units, compiled unless it lies there already."""
    folder = _folder(units)
    linked = folder / "rig.so"
    if not linked.exists():
        with tempfile.TemporaryDirectory(dir=folder) as workplace:
            _link(units, Path(workplace)).replace(linked)
    return ctypes.CDLL(str(linked))


def _link(units: tuple[Unit, ...], folder: Path) -> Path:
    """Compile the units and link them in ``folder``."""
    (folder / "records.h").write_text(records_header())
    objects = [folder / f"{Path(unit.source).stem}.o" for unit in units]
    for unit, compiled in zip(units, objects, strict=True):
        paths = [f"-I{folder}", f"-I{SOURCES}", "-c", str(SOURCES / unit.source), "-o", str(compiled)]
        subprocess.run([compiler(), *unit.flags, "-Wall", "-fPIC", *paths], check=True)
    linked = folder / "rig.so"
    subprocess.run([compiler(), "-shared", *map(str, objects), "-o", str(linked), "-lm"], check=True)
    return linked


def _folder(units: tuple[Unit, ...]) -> Path:
    digest = hashlib.sha256(repr((units, compiler(), processor())).encode())
    digest.update(records_header().encode())
    for file in sorted(SOURCES.rglob("*.[ch]")):
        digest.update(file.read_bytes())
    user = os.getuid() if hasattr(os, "getuid") else 0
    folder = Path(tempfile.gettempdir()) / f"uictest-benchmarks-{user}" / digest.hexdigest()[:20]
    folder.mkdir(parents=True, exist_ok=True, mode=0o700)
    return folder


class CLanes:
    """Many stops of the C rig in lanes of the processor's vectors.

    `strict` keeps the operations as they are written, as our own build does; else they may be contracted and
    ordered anew.
    """

    def __init__(self, width: int = 8, *, strict: bool = False) -> None:
        freedom = ("-ffp-contract=off", "-DSTRICT") if strict else ("-ffast-math",)
        of_headers = ("-Wno-psabi", "-Wno-uninitialized", "-Wno-maybe-uninitialized")
        vectors = (*PLAIN, *freedom, f"-DLANES={width}", "-x", "c++", *of_headers)
        scalar = (*(STRICT if strict else PLAIN), "-fno-strict-aliasing", f"-DSTRIDE={width}")
        # The measures compare with NaN, which -ffast-math assumes away: only the steps get it.
        self._stops = library(Unit("lanes.c", scalar), Unit("lanes_step.c", vectors)).stops
        self._stops.restype = None
        # number of stops, parameters, those of wheelsets, friction laws, measures, wheelsets' measures
        self._stops.argtypes = [ctypes.c_int64] + [ctypes.c_void_p] * 5

    def __call__(
        self,
        parameters: Any,
        wheelset_parameters: Any,
        rails: NDArray[np.float64],
        measures: Any,
        wheelset_measures: Any,
    ) -> None:
        """Run a stop for each parameter record and its row of ``rails``: place, friction, time, factor."""
        _reject_what_is_missing(parameters)
        self._stops(
            len(parameters),
            _address(parameters),
            _address(wheelset_parameters),
            _address(rails),
            _address(measures),
            _address(wheelset_measures),
        )


class CStop:
    """The stop of the C rig with the threshold controller, called as ours is; nothing is recorded."""

    def __init__(self, flags: tuple[str, ...]) -> None:
        self._stop = library(Unit("rig.c", flags)).stop
        self._stop.restype = None
        # car, bogies, wheelsets, parameters, those of wheelsets, friction laws, number of their points,
        # both measures
        pointer = ctypes.c_void_p
        self._stop.argtypes = [pointer] * 6 + [ctypes.c_int64] + [pointer] * 2

    def __call__(
        self,
        car: Any,
        bogies: Any,
        wheelsets: Any,
        parameters: Any,
        wheelset_parameters: Any,
        rail: NDArray[np.float64],
        memory: Any,
        measures: Any,
        wheelset_measures: Any,
        trace: Any,
        steps_per_sample: int,
    ) -> int:
        """Run one stop on zeroed records; return the number of rows recorded, which is none."""
        if steps_per_sample:
            raise ValueError("the C rig records nothing")
        _reject_what_is_missing(parameters)
        self._stop(
            _address(car),
            _address(bogies),
            _address(wheelsets),
            _address(parameters),
            _address(wheelset_parameters),
            _address(rail),
            rail.shape[1],
            _address(measures),
            _address(wheelset_measures),
        )
        return 0


MISSING = {
    "uses_module_air": "modelled air: it cannot run rig.compensation=thermal",
    "uses_pole_wheels": "pole wheels: it cannot run rig.sensors.speed.method=whole-teeth or an eccentricity",
    "cleans_rail": "rail that sliding cleans: it cannot run rail.cleaning",
    "varies_friction": "friction that varies at random: it cannot run rail.variation",
    "command_times": "commands that change: it cannot run a course of brake.command",
    "end_speed": "end above standstill: it cannot run until",
    "drag_duration": "traction: it cannot run drag",
    "has_sanders": "sanders: it cannot run sanders",
    "has_dynamic_brake": "motors: it cannot run brake.dynamic",
    "has_track_brake": "magnets on the rail: it cannot run brake.track",
    "has_train_speed": "second source of speed: it cannot run rig.sensors.train_speed",
    "has_accelerometer": "accelerometer: it cannot run rig.sensors.acceleration",
    "fault_count": "faults: it cannot run a scenario with any",
    "varies_pad_friction": "pads that vary: it cannot run brake.pad other than constant",
    "models_disc_temperature": "discs that warm: it cannot run brake.disc_temperature=modelled",
}
"""Parameter that uses a part which the C rig lacks, and what it then says."""


def can_run(parameters: Any) -> bool:
    """Return whether the C rig has all parts that a stop uses."""
    return not any(np.any(parameters[name]) for name in MISSING)


def _reject_what_is_missing(parameters: Any) -> None:
    for name, part in MISSING.items():
        if np.any(parameters[name]):
            raise ValueError(f"the C rig has no {part}")


def _address(values: Any) -> int:
    return int(values.__array_interface__["data"][0])
