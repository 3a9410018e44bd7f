"""Checks by stored bits: the known stops alone, side by side in lanes, and with a controller from outside."""

from collections.abc import Iterator
from functools import partial
from itertools import islice
from typing import Final

from uictest.selftest.check import Answer, Check
from uictest.selftest.known_stops import (
    KnownStops,
    Numbers,
    digest_of,
    inputs_digest,
    numbers_of_stop,
)
from uictest.selftest.reference import stored_inputs, stored_numbers, stored_numbers_from_outside
from uictest.selftest.template_stops import c_stop, python_stop

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
