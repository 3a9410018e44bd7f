"""The dialect of a text file: separators, decimal sign, and the lines of the heading."""

from __future__ import annotations

import json
from dataclasses import asdict, dataclass

COMMENT = "#"


@dataclass(frozen=True, slots=True)
class Dialect:
    """The dialect of a CSV file. The default is that of the files this program writes.

    Lines are counted from one, as an editor counts them.

    Args:
        delimiter: the character between two cells.
        decimal: the character before decimals, `.` or `,`.
        thousands: the character between groups of three digits; empty: none.
        header_line: the line of the channels' names; 0: the first that is no comment.
        unit_line: the line of their units; 0: the line after the names where it holds units; units may also
            stand in the names, as in `speed [m/s]`.
        first_line: the first line of samples; 0: the one after names and units.
        encoding: of the text, where it does not begin with a byte-order mark.

    """

    delimiter: str = ","
    decimal: str = "."
    thousands: str = ""
    header_line: int = 0
    unit_line: int = 0
    first_line: int = 0
    encoding: str = "utf-8"

    def changes_to(self, other: Dialect) -> str:
        """Return the `csv` section with the settings of another dialect that differ from this one."""
        declared = asdict(self)
        changes = {name: value for name, value in asdict(other).items() if value != declared[name]}
        return f"csv: {{{', '.join(f'{name}: {json.dumps(value)}' for name, value in changes.items())}}}"
