"""The stored numbers and digests of this version."""

import hashlib
import json
from collections.abc import Iterator, Mapping
from functools import cache
from pathlib import Path
from typing import Any, Final

from uictest import __version__
from uictest.selftest.known_stops import (
    KnownStops,
    Numbers,
    inputs_digest,
    numbers_of_stop,
)
from uictest.selftest.template_stops import python_stop

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
