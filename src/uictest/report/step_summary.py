"""The summary of a step on GitHub Actions: a file that every step appends its Markdown to."""

from __future__ import annotations

import os
from collections.abc import Callable
from pathlib import Path

LIMIT = 1_000_000
"""Bytes of a summary at most: GitHub refuses a step's summary above 1 MiB."""

_ALWAYS = 2_000  # bytes that a summary may have where others have filled the file


def append_to_step_summary(summary: Callable[[int], str]) -> None:
    """Append a summary to the file that GitHub Actions names, where it does. Raises OSError.

    Args:
        summary: gives the Markdown when told how many bytes it may have.

    """
    place = os.environ.get("GITHUB_STEP_SUMMARY")
    if not place:
        return
    path = Path(place)
    written = path.stat().st_size if path.exists() else 0
    with path.open("a", encoding="utf-8") as file:
        file.write(summary(max(LIMIT - written, _ALWAYS)))
