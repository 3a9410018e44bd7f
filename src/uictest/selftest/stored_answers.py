"""Stored answers: the bits of known stops, and the data files that ship."""

from collections.abc import Iterator, Mapping
from functools import partial
from itertools import islice
from typing import Final

from uictest.selftest.known_stops import (
    Answer,
    Check,
    KnownStops,
    Numbers,
    c_stop,
    data_digests,
    digest_of,
    inputs_digest,
    numbers_of_stop,
    python_stop,
    stored_data_digests,
    stored_inputs,
    stored_numbers,
    stored_numbers_from_outside,
)

_MOST_NAMED: Final = 3
_DIGITS: Final = 12
"""Of a SHA-256 that are shown."""


def stop_checks(stops: KnownStops) -> Iterator[Check]:
    """Yield two checks of every known stop: what the rig is given, and every number that comes out."""
    for name, case in stops.cases.items():
        title = case.scenario.title
        yield Check(
            f"inputs-of-{name}", "numerics", f"SHA-256 of the inputs of {name}", partial(_inputs, name)
        )
        yield Check(name, "numerics", f"SHA-256 of all measures: {title}", partial(_alone, name))
    yield Check("lanes", "lanes", "SHA-256 of all stops, side by side in SIMD lanes", _in_lanes)


def controller_checks() -> Iterator[Check]:
    """Yield the checks of a stop whose controller runs in a child process."""
    what = "SHA-256 of all measures: controller in {} in a child process"
    yield Check("python-controller", "controllers", what.format("Python"), _from_python)
    yield Check("c-controller", "controllers", what.format("C"), _from_c)


def _inputs(name: str, stops: KnownStops) -> Answer:
    expected, found = stored_inputs(name), inputs_digest(stops.cases[name])
    words = (
        "" if found == expected else "parts of the library, or their assembly, are not those of this version"
    )
    return Answer(expected[:_DIGITS], found[:_DIGITS], words)


def _alone(name: str, stops: KnownStops) -> Answer:
    return answer_of(stored_numbers(name), numbers_of_stop(stops.stop(name)))


def _in_lanes(stops: KnownStops) -> Answer:
    expected = {f"{stop}.{name}": text for stop in stops.cases for name, text in stored_numbers(stop).items()}
    found = stops.in_lanes()
    return answer_of(
        expected, {f"{stop}.{name}": text for stop in found for name, text in found[stop].items()}
    )


def _from_python(stops: KnownStops) -> Answer:
    return answer_of(stored_numbers_from_outside(), numbers_of_stop(python_stop()))


def _from_c(stops: KnownStops) -> Answer:
    return answer_of(stored_numbers_from_outside(), numbers_of_stop(c_stop()))


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
    yield Check("shipped-data", "environment", what, _shipped_data, unit="files")


def _shipped_data(stops: KnownStops) -> Answer:
    differ = list(different_files(stored_data_digests(), data_digests()))
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
