"""The results of a sweep in Python."""

from __future__ import annotations

from html import escape
from pathlib import Path
from typing import TYPE_CHECKING, Self

from uictest import report
from uictest.api.frames import with_units

if TYPE_CHECKING:
    import pandas as pd

_TABLE = "summary.parquet"


class SweepResults:
    """The cases of a finished sweep.

    Attributes:
        result: counts, rates by parameter, maps, trends, sensitivities, the frontier, the worst cases.
        folder: of the results, absolute; None where none were kept.
    """

    def __init__(self, result: report.SweepResult, frame: pd.DataFrame, folder: Path | None) -> None:
        """Made by :func:`uictest.sweep`."""
        self.result = result
        self.folder = None if folder is None else folder.absolute()
        self._frame = frame

    @classmethod
    def read(cls, result: report.SweepResult, folder: Path, *, keep: bool) -> Self:
        """Return the results in a folder, which stays there if `keep`. Raises OSError."""
        import pandas as pd

        return cls(result, pd.read_parquet(folder / _TABLE).set_index("id"), folder if keep else None)

    def __len__(self) -> int:
        """Return the number of cases."""
        return self.result.cases

    @property
    def met(self) -> bool:
        """Whether every case came out as expected."""
        return self.result.met == self.result.cases

    @property
    def tally(self) -> str:
        """The counts of the sweep in words, as `uictest sweep` ends with."""
        return report.sweep_tally(self.result)

    def frame(self) -> pd.DataFrame:
        """Return one row per case, index `id`: the columns of summary.csv, numbers as numbers.

        A parameter has its text in `parameters.KEY`, and in `values.KEY` its number in SI units if it has
        one. Units of measures are in `attrs["units"]`, by column.
        """
        return with_units(self._frame.copy())

    def __repr__(self) -> str:
        """Return the counts, and the first cases that are not as expected."""
        lines = [f"{case.outcome} {case.id} {case.reason}".rstrip() for case in self.result.missed]
        return "\n".join([f"{self.result.name}: {self.tally}", *map(report.printable, lines)])

    def _repr_html_(self) -> str:
        rows = "".join(
            f"<tr><td>{escape(case.id)}</td><td>{escape(case.outcome)}</td><td>{escape(case.reason)}</td></tr>"
            for case in self.result.missed
        )
        head = "<tr><th>not as expected</th><th>outcome</th><th>reason</th></tr>"
        table = f"<table><thead>{head}</thead><tbody>{rows}</tbody></table>" if rows else ""
        return f"<p>{escape(self.result.name)}: {escape(self.tally)}</p>{table}"
