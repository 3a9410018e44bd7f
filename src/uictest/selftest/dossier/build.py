"""Which build this is: a release, or what differs from the last one by unreleased changes."""

from __future__ import annotations

import re
from pathlib import Path
from typing import Final, NamedTuple

from uictest import __version__
from uictest.selftest.dossier.manual import change_log

_HEADING: Final = re.compile(r"^## \[(\d\S*)\] - (\S+)$", re.MULTILINE)


class Release(NamedTuple):
    """Version and date, as the changes name them."""

    version: str
    date: str


def last_release(changes: Path | None = None) -> Release:
    """Return the newest release that the changes name."""
    found = _HEADING.search((changes or change_log()).read_text("utf-8"))
    assert found is not None
    return Release(*found.groups())


def is_release(version: str = __version__) -> bool:
    """Return whether the changes name this version with a date."""
    return version == last_release().version


def identity(version: str = __version__, release: Release | None = None) -> str:
    """Return which build this is, in a sentence or two."""
    last = release or last_release()
    if version == last.version:
        return f"This build is uictest {version}, the release of {last.date}."
    return (
        f"This build is uictest {version}, which is not a release. "
        f"It differs from {last.version} of {last.date} by what stands under Unreleased in the changes."
    )
