"""The data that ships: every file of the library, the known stops and the templates, by its digest."""

from collections.abc import Iterator, Mapping
from typing import Final

from uictest.selftest.check import Answer, Check
from uictest.selftest.known_stops import KnownStops
from uictest.selftest.reference import data_digests, stored_data_digests

_MOST_NAMED: Final = 5


def data_checks() -> Iterator[Check]:
    """Yield the check of the shipped data, which a working tree has as an installed package does."""
    what = "files of the library, known stops and templates that are not those of this version"
    yield Check("shipped-data", "environment", what, _shipped_data, unit="files")


def _shipped_data(stops: KnownStops) -> Answer:
    differ = list(different_files(stored_data_digests(), data_digests()))
    more = len(differ) - _MOST_NAMED
    rest = f" and {more} more" if more > 0 else ""
    return Answer(0.0, float(len(differ)), ", ".join(differ[:_MOST_NAMED]) + rest)


def different_files(stored: Mapping[str, str], found: Mapping[str, str]) -> Iterator[str]:
    """Yield the files that differ, and how."""
    for name in sorted({*stored, *found}):
        if name not in found:
            yield f"{name} is missing"
        elif name not in stored:
            yield f"{name} is not part of it"
        elif stored[name] != found[name]:
            yield f"{name} was changed"
