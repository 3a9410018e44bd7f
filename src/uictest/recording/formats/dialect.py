"""How a text file writes its table: what separates cells and decimals, which lines are the heading."""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import asdict, dataclass
from typing import Any

COMMENT = "#"


@dataclass(frozen=True, slots=True)
class Dialect:
    """The dialect of a CSV file. The default is that of the files this program writes.

    Lines are counted from one, as an editor counts them.

    Args:
        delimiter: the character between two cells.
        decimal: the character before decimals, `.` or `,`.
        header_line: the line of the channels' names; 0: the first that is no comment.
        unit_line: the line of their units; 0: units stand in the names, as in `speed [m/s]`.
        first_line: the first line of samples; 0: the one after the heading.
        encoding: of the text.

    """

    delimiter: str = ","
    decimal: str = "."
    header_line: int = 0
    unit_line: int = 0
    first_line: int = 0
    encoding: str = "utf-8-sig"

    def to_dict(self) -> dict[str, Any]:
        """Return the fields by name."""
        return asdict(self)

    @classmethod
    def from_dict(cls, fields: Mapping[str, Any]) -> Dialect:
        """Return the dialect whose `to_dict` is `fields`."""
        return cls(**fields)

    def __str__(self) -> str:
        """Return the dialect as the `csv` section of a channel map would declare it."""
        return ", ".join(f"{name}: {value!r}" for name, value in self.to_dict().items())
