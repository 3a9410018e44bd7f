"""Stored answers: the bits of known stops, the verdicts on a known record, and the data files that ship."""

import hashlib
import json
import os
import shutil
import subprocess
from collections.abc import Callable, Iterator, Mapping
from dataclasses import dataclass
from functools import cache, partial
from itertools import islice
from pathlib import Path
from typing import Any, Final, Literal, NamedTuple

import numpy as np

from uictest import __version__, rig
from uictest.core import files
from uictest.core.units import KILOMETRE_PER_HOUR
from uictest.judging import evaluation
from uictest.plans import scenario, templates
from uictest.recorded import field_data

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
        stops = zip(self.cases, *rig.run_in_lanes(*rig.stacked(inputs)), strict=True)
        return {name: measures_as_text(train, wheelsets) for name, train, wheelsets in stops}


def measures_as_text(train: Any, wheelsets: Any) -> Numbers:
    """Return the measures of a stop and of its wheelsets as text: name -> all digits of its numbers."""
    numbers = {name: _numbers_as_text(train[name]) for name in train.dtype.names}
    for number, wheelset in enumerate(wheelsets, start=1):
        numbers |= {
            f"wheelset_{number}.{name}": _numbers_as_text(wheelset[name]) for name in wheelset.dtype.names
        }
    return numbers


def numbers_of_stop(stop: rig.SimulatedStop) -> Numbers:
    """Return every number of a simulated stop as text."""
    return measures_as_text(stop.measures, stop.wheelset_measures)


def digest_of(numbers: Numbers) -> str:
    """Return the SHA-256 of numbers, whatever their order."""
    lines = (f"{name}={text}\n" for name, text in sorted(numbers.items()))
    return hashlib.sha256("".join(lines).encode()).hexdigest()


def inputs_digest(case: scenario.Case) -> str:
    """Return the SHA-256 of the records that the rig is given for a stop."""
    inputs = rig.assemble(case)
    records = inputs.parameters, inputs.wheelset_parameters, np.ascontiguousarray(inputs.rail)
    return hashlib.sha256(b"".join(record.tobytes() for record in records)).hexdigest()


def _numbers_as_text(number: Any) -> str:
    return " ".join(repr(float(value)) for value in np.ravel(number))


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
"""Origin of a known answer: only closed forms and publications are independent of this program."""


class NotCheckedError(Exception):
    """Something that a check needs is missing; the message names it."""


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
    return _stop_of_template("python", lambda folder: None)


def c_stop() -> rig.SimulatedStop:
    """Return the stop with the controller in C. Raises NotCheckedError where it cannot be built."""

    def build(folder: Path) -> None:
        done = subprocess.run(
            [_compiler_version(), *_FLAGS], cwd=folder, capture_output=True, text=True, check=False
        )
        if done.returncode != 0:
            raise NotCheckedError(f"the C compiler failed: {done.stderr.strip()}")

    return _stop_of_template("c", build)


def _stop_of_template(language: templates.Language, build: Callable[[Path], None]) -> rig.SimulatedStop:
    with files.temporary_folder() as folder:
        for name, content in templates.controller_files(language).items():
            files.write(folder, name, content)
        build(folder)
        (case,) = scenario.load([folder / "slip-120.yaml"])
        return rig.simulate(case)


def _compiler_version() -> str:
    if os.name != "posix":
        raise NotCheckedError("the Makefile of the first controller in C is for Linux and macOS")
    names = [os.environ["CC"]] if os.environ.get("CC") else ["cc", "gcc", "clang"]
    compiler = next((path for name in names if (path := shutil.which(name))), None)
    if compiler is None:
        raise NotCheckedError(f"no C compiler ({' or '.join(names)}); name one in the variable CC")
    return compiler


def compiler_version() -> str:
    """Return the version text of the C compiler of the check, or the reason why there is none."""
    try:
        done = subprocess.run([_compiler_version(), "--version"], capture_output=True, text=True, check=False)
    except (NotCheckedError, OSError) as error:
        return f"absent: {error}"
    return (done.stdout.splitlines() or ["not known"])[0]


_PACKAGE: Final = Path(__file__).parents[1]
_FOLDERS: Final = ("plans/library", "selftest/stops", "selftest/record", "plans/templates")
"""Folders of the parts, criteria, known stops and templates."""
_LEFT_OUT: Final = {"__pycache__", "scenarios"}
"""Left out, as hidden files of editors are: what Python leaves there, and the scenarios, which only a wheel
has there and whose digests every run states."""


def data_digests(package: Path = _PACKAGE) -> dict[str, str]:
    """Return the SHA-256 of every shipped data file below a package, by its path."""
    digests = {}
    for folder in (package / name for name in _FOLDERS):
        for path in sorted(folder.rglob("*"), key=Path.as_posix):
            parts = path.relative_to(folder).parts
            left_out = any(part.startswith(".") or part in _LEFT_OUT for part in parts)
            if path.is_file() and not left_out:
                digests[path.relative_to(package).as_posix()] = hashlib.sha256(path.read_bytes()).hexdigest()
    return digests


SCHEMA: Final = "uictest/known-stops/1"
REFERENCE: Final = Path(__file__).parent / "reference.json"
_OUTSIDE: Final = "controller-from-outside"
_DATA: Final = "data"


@cache
def _stored_reference() -> Mapping[str, Any]:
    stored: Mapping[str, Any] = json.loads(REFERENCE.read_text("utf-8"))
    if stored.get("schema") != SCHEMA:
        raise ValueError(f"{REFERENCE.name}: expected the schema {SCHEMA}, found {stored.get('schema')!r}")
    return stored


def reference_version() -> str:
    """Return the version of uictest that computed the stored numbers."""
    return str(_stored_reference()["version"])


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


_MOST_NAMED: Final = 3
_DIGITS: Final = 12
"""Of a SHA-256 that are shown."""


def stop_checks(stops: KnownStops) -> Iterator[Check]:
    """Yield two checks of every known stop: what the rig is given, and every number that comes out."""
    for name, case in stops.cases.items():
        what = f"SHA-256 of the inputs of {name}"
        yield Check(f"inputs-of-{name}", "numerics", what, partial(_answer_of_inputs, name))
        what = f"SHA-256 of all measures: {case.scenario.title}"
        yield Check(name, "numerics", what, partial(_answer_alone, name))
    yield Check("lanes", "lanes", "SHA-256 of all stops, side by side in SIMD lanes", _answer_in_lanes)


def _answer_of_inputs(name: str, stops: KnownStops) -> Answer:
    expected, computed = _stored_reference()["stops"][name]["inputs_sha256"], inputs_digest(stops.cases[name])
    words = "parts of the library, or their assembly, are not those of this version"
    return Answer(expected[:_DIGITS], computed[:_DIGITS], "" if computed == expected else words)


def _answer_alone(name: str, stops: KnownStops) -> Answer:
    return answer_of(_stored_reference()["stops"][name]["numbers"], numbers_of_stop(stops.stop(name)))


def _answer_in_lanes(stops: KnownStops) -> Answer:
    stored = {stop: _stored_reference()["stops"][stop]["numbers"] for stop in stops.cases}
    expected, computed = (
        {f"{stop}.{name}": text for stop, numbers in of_stops.items() for name, text in numbers.items()}
        for of_stops in (stored, stops.in_lanes())
    )
    return answer_of(expected, computed)


def controller_checks() -> Iterator[Check]:
    """Yield the checks of a stop whose controller runs in a child process."""
    what = "SHA-256 of all measures: controller in {} in a child process"
    for language, run in (("Python", python_stop), ("C", c_stop)):
        answer = partial(_from_outside, run)
        yield Check(f"{language.lower()}-controller", "controllers", what.format(language), answer)


def _from_outside(run: Callable[[], rig.SimulatedStop], stops: KnownStops) -> Answer:
    return answer_of(_stored_reference()[_OUTSIDE], numbers_of_stop(run()))


def answer_of(expected: Numbers, found: Numbers) -> Answer:
    """Return the digests of numbers, and in words which differ."""
    names = dict.fromkeys((*expected, *found))
    different = [name for name in names if expected.get(name) != found.get(name)]
    named = "; ".join(
        f"{name}: expected {expected.get(name, 'no such number')}, found {found.get(name, 'no such number')}"
        for name in islice(different, _MOST_NAMED)
    )
    words = f"{len(different)} of {len(names)} numbers differ: {named}" if different else ""
    return Answer(digest_of(expected)[:_DIGITS], digest_of(found)[:_DIGITS], words)


_MOST_FILES_NAMED: Final = 5


def data_checks() -> Iterator[Check]:
    """Yield the check of the shipped data, which a working tree has as an installed package does."""
    what = "files of the library, known stops and templates that are not those of this version"
    yield Check("shipped-data", "environment", what, _shipped_data, unit="files", origin="installed files")


def _shipped_data(stops: KnownStops) -> Answer:
    differ = list(different_files(_stored_reference()[_DATA], data_digests()))
    more = len(differ) - _MOST_FILES_NAMED
    rest = f" and {more} more" if more > 0 else ""
    return Answer(0.0, float(len(differ)), ", ".join(differ[:_MOST_FILES_NAMED]) + rest)


def different_files(stored: Mapping[str, str], found: Mapping[str, str]) -> Iterator[str]:
    """Yield the files that differ, and how."""
    for name in sorted({*stored, *found}):
        if name not in found:
            yield f"{name} is missing"
        elif name not in stored:
            yield f"{name} is not part of it"
        elif stored[name] != found[name]:
            yield f"{name} was changed"


_SPEED: Final = 120.0 * KILOMETRE_PER_HOUR
_DECELERATION: Final = 1.0
"""m/s2."""
_LOCK: Final = (10.0, 10.5, 11.25, 11.75)
"""When the third wheelset begins to lose its speed, stands still, begins to turn and rolls again, s."""
_SCENARIO: Final = Path(__file__).parent / "record" / "record.yaml"
_AT_ZERO: Final = field_data.Preparation.model_validate({"trigger_time": "0 s"})
"""The brake command is given at the time 0."""
_VERDICTS: Final = {
    "distance-met": "pass",
    "distance-missed": "fail",
    "lock-met": "pass",
    "lock-missed": "fail",
    "lock-of-most": "pass",
    "reservoir": "inconclusive",
    "simulation": "not_applicable",
    "wet": "not_applicable",
}
"""Criterion of `record/criteria.yaml` -> its verdict."""


def judging_checks() -> Iterator[Check]:
    """Yield a check of every verdict, of two figures and of the outcome."""
    of_record = "of a record made by hand: {}"
    closed_forms = (
        ("record-distance", "braking distance", "v0^2/(2 a)", "braking_distance_m", "m"),
        ("record-deceleration", "deceleration", "v0^2/(2 s)", "mean_deceleration_mps2", "m/s2"),
    )
    known = {"m": _SPEED**2 / (2.0 * _DECELERATION), "m/s2": _DECELERATION}
    for name, quantity, formula, column, unit in closed_forms:
        what, answer = (
            f"{quantity} {of_record.format(formula)}",
            partial(_answer_of_measure, column, known[unit]),
        )
        yield Check(name, "judging", what, answer, 1e-6, unit, origin="closed form")
    for criterion, status in _VERDICTS.items():
        what, answer = (
            f"verdict {of_record.format(criterion)}",
            partial(_answer_of_verdict, criterion, status),
        )
        yield Check(f"verdict-{criterion}", "judging", what, answer, origin="made by hand")
    what = f"outcome {of_record.format('two limits missed')}"
    yield Check(
        *("record-outcome", "judging", what),
        lambda stops: Answer("fail", _judged_record().outcome, _judged_record().reason),
        origin="made by hand",
    )


def _answer_of_measure(column: str, expected: float, stops: KnownStops) -> Answer:
    measures = _judged_record().measures
    assert measures is not None
    return Answer(expected, measures[column])


def _answer_of_verdict(criterion: str, status: str, stops: KnownStops) -> Answer:
    verdict = next(verdict for verdict in _judged_record().criteria if verdict.id == criterion)
    return Answer(status, verdict.status, verdict.reason)


@cache
def _judged_record() -> evaluation.CaseResult:
    (case,) = scenario.load([_SCENARIO])
    stop = field_data.prepare(_record_made_by_hand(), {}, _AT_ZERO)
    result, _ = field_data.judge_recording(case, stop)
    return result


def _record_made_by_hand() -> dict[str, field_data.RawChannel]:
    """Return speeds from a second before the brake command until a second after the stop, at 100 Hz."""
    time = np.arange(-100, 100 * round(_SPEED / _DECELERATION) + 100) / 100.0
    speed = np.clip(_SPEED - _DECELERATION * time, 0.0, _SPEED)
    locked = speed * np.interp(time, _LOCK, (1.0, 0.0, 0.0, 1.0))
    samples: dict[str, Any] = {"speed": speed}
    samples |= {f"wheel_speed_{number}": locked if number == 3 else speed for number in (1, 2, 3, 4)}
    return {name: field_data.RawChannel(name, name, time, values) for name, values in samples.items()}
