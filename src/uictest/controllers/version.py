"""The version of a controller from outside, as reports show it."""

from typing import Final

LONGEST_VERSION: Final = 100
"""Characters of a version at most: it stands in sentences. Chosen."""


def shown_version(text: str) -> str:
    """Return a version that a program states, empty where it cannot be shown on one line."""
    return text if text.isprintable() and len(text) <= LONGEST_VERSION else ""
