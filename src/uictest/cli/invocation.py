"""What one call of the program carries from the command line to its commands."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass


@dataclass(slots=True)
class Invocation:
    """The arguments as typed, and how much the user wants to see (0; 1 and more with `-v`)."""

    arguments: Sequence[str]
    verbosity: int = 0
