"""Which cases and series a run selects."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass
from pathlib import PurePosixPath


@dataclass(frozen=True, slots=True)
class Scope:
    """The cases and series that a run selects.

    Args:
        selected: ids of the cases and series to be run.
        searched: scenario files and folders of which every case was selected; none where an expression, a tag
            or the last failures chose among them.

    """

    selected: frozenset[str]
    searched: Sequence[str] = ()

    def misses(self, own_id: str, file: str) -> bool:
        """Return whether the files searched should contain a case or a series and do not."""
        path = PurePosixPath(file)
        places = (path, *path.parents)
        return own_id not in self.selected and any(PurePosixPath(name) in places for name in self.searched)
