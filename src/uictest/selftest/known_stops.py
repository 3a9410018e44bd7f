"""The stops whose bits are known: run on this machine, and their numbers as stored for this version."""

import hashlib
import json
import os
import shutil
import subprocess
from collections.abc import Callable, Iterator, Mapping
from dataclasses import dataclass
from functools import cache
from pathlib import Path
from typing import Any, Final, Literal, NamedTuple

import numpy as np

from uictest import __version__, rig
from uictest.core import files
from uictest.plans import scenario, templates

_FOLDER: Final = Path(__file__).parent / "stops"
Numbers = Mapping[str, str]
"""Name of a number -> its shortest text that reads back as the same bits."""


class KnownStops:
    """The stored stops and their simulations."""

    def __init__(self) -> None:
        self.cases = {case.id: case for case in scenario.load([_FOLDER])}
        self._stops: dict[str, rig.SimulatedStop] = {}

    def stop(self, name: str) -> rig.SimulatedStop:
        """Return a stop, simulated alone."""
        if name not in self._stops:
            self._stops[name] = rig.simulate(self.cases[name])
        return self._stops[name]

    def in_lanes(self) -> dict[str, Numbers]:
        """Return the numbers of all stops, simulated side by side in the lanes of a register."""
        inputs = [rig.assemble(case) for case in self.cases.values()]
        points = max(each.rail.shape[1] for each in inputs)
        records = (
            np.array([each.parameters for each in inputs]),
            np.array([each.wheelset_parameters for each in inputs]),
            np.array([np.pad(each.rail, ((0, 0), (0, points - each.rail.shape[1]))) for each in inputs]),
        )
        batch = rig.run_in_lanes(*records)
        batch.measures["reference_distance"] = rig.reference_distances(*records)
        stops = zip(self.cases, *batch, strict=True)
        return {name: numbers_of(train, wheelsets) for name, train, wheelsets in stops}


def numbers_of(train: Any, wheelsets: Any) -> Numbers:
    """Return every number of the measures of a stop and of its wheelsets as text."""
    numbers = {name: _text(train[name]) for name in train.dtype.names}
    for place, wheelset in enumerate(wheelsets, start=1):
        numbers |= {f"wheelset_{place}.{name}": _text(wheelset[name]) for name in wheelset.dtype.names}
    return numbers


def numbers_of_stop(stop: rig.SimulatedStop) -> Numbers:
    """Return every number of a simulated stop as text."""
    return numbers_of(stop.measures, stop.wheelset_measures)


def digest_of(numbers: Numbers) -> str:
    """Return the SHA-256 of numbers, whatever their order."""
    lines = (f"{name}={text}\n" for name, text in sorted(numbers.items()))
    return hashlib.sha256("".join(lines).encode()).hexdigest()


def inputs_digest(case: scenario.Case) -> str:
    """Return the SHA-256 of the records that the rig is given for a stop."""
    inputs = rig.assemble(case)
    records = inputs.parameters, inputs.wheelset_parameters, np.ascontiguousarray(inputs.rail)
    return hashlib.sha256(b"".join(record.tobytes() for record in records)).hexdigest()


def _text(number: Any) -> str:
    return " ".join(repr(float(each)) for each in np.ravel(number))


# As the Makefile of the template has them.
Group = Literal["numerics", "physics", "lanes", "judging", "controllers", "environment"]
Origin = Literal[
    "own stored output",
    "closed form",
    "closed form of the rig's own force",
    "publication",
    "made by hand",
    "installed files",
]
"""Where a known answer comes from: only closed forms and publications are true without this program."""


class NotCheckedError(Exception):
    """What a check needs is not there; the message says what."""


class Answer(NamedTuple):
    """The known answer and that of this installation, two numbers or two texts; in words how they differ."""

    expected: float | str
    found: float | str
    words: str = ""


@dataclass(frozen=True, slots=True)
class Check:
    """One question with a known answer.

    Attributes:
        id: its name.
        group: what it is about.
        what: whose answer is known, in words.
        answer: returns both answers. Raises NotCheckedError.
        tolerance: largest difference of two numbers that passes, as a share of the known one; 0: none.
        unit: of the numbers.
        advisory: whether another answer is only a warning.
        origin: of the known answer.
    """

    id: str
    group: Group
    what: str
    answer: Callable[[KnownStops], Answer]
    tolerance: float = 0.0
    unit: str = ""
    advisory: bool = False
    origin: Origin = "own stored output"


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


def compiler_version() -> str:
    """Return what the C compiler of the check says of itself, or why there is none."""
    try:
        done = subprocess.run([_compiler(), "--version"], capture_output=True, text=True, check=False)
    except (NotCheckedError, OSError) as error:
        return f"absent: {error}"
    return (done.stdout.splitlines() or ["not known"])[0]


_PACKAGE: Final = Path(__file__).parents[1]
_FOLDERS: Final = ("plans/library", "selftest/stops", "selftest/record", "plans/templates")
"""Where the parts, criteria, known stops and first files of users lie."""
_LEFT_OUT: Final = {"__pycache__", "scenarios"}
"""What Python leaves there; the scenarios, which only a wheel has there: every run states their digests."""


def data_digests(package: Path = _PACKAGE) -> dict[str, str]:
    """Return the SHA-256 of every shipped data file below a package, by its path."""
    return {
        path.relative_to(package).as_posix(): hashlib.sha256(path.read_bytes()).hexdigest()
        for folder in _FOLDERS
        for path in _files(package / folder)
    }


def _files(folder: Path) -> Iterator[Path]:
    """Yield the files below a folder, without what Python leaves there and what editors hide."""
    for path in sorted(folder.rglob("*"), key=Path.as_posix):
        hidden = any(part.startswith(".") or part in _LEFT_OUT for part in path.relative_to(folder).parts)
        if path.is_file() and not hidden:
            yield path


SCHEMA: Final = "uictest/known-stops/1"
REFERENCE: Final = Path(__file__).parent / "reference.json"
_OUTSIDE: Final = "controller-from-outside"
_DATA: Final = "data"


@cache
def _stored() -> Mapping[str, Any]:
    stored: Mapping[str, Any] = json.loads(REFERENCE.read_text("utf-8"))
    if stored.get("schema") != SCHEMA:
        raise ValueError(f"{REFERENCE.name}: expected the schema {SCHEMA}, found {stored.get('schema')!r}")
    return stored


def reference_version() -> str:
    """Return the version of uictest that computed the stored numbers."""
    return str(_stored()["version"])


def stored_numbers(stop: str) -> Numbers:
    """Return the stored numbers of a known stop."""
    numbers: Numbers = _stored()["stops"][stop]["numbers"]
    return numbers


def stored_inputs(stop: str) -> str:
    """Return the SHA-256 of what the rig was given for a known stop."""
    return str(_stored()["stops"][stop]["inputs_sha256"])


def stored_numbers_from_outside() -> Numbers:
    """Return the stored numbers of the stop with a controller from outside."""
    numbers: Numbers = _stored()[_OUTSIDE]
    return numbers


def stored_data_digests() -> Mapping[str, str]:
    """Return the SHA-256 of every shipped data file of this version, by its path in the package."""
    digests: Mapping[str, str] = _stored()[_DATA]
    return digests


def computed_reference() -> str:
    """Return the content of the stored file as this installation computes it."""
    stops = KnownStops()
    content = {
        "schema": SCHEMA,
        "version": __version__,
        "stops": {
            name: {"inputs_sha256": inputs_digest(case), "numbers": numbers_of_stop(stops.stop(name))}
            for name, case in stops.cases.items()
        },
        _OUTSIDE: numbers_of_stop(python_stop()),
        _DATA: data_digests(),
    }
    return json.dumps(content, indent=1) + "\n"
