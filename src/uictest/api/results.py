"""The results of a run in Python, as data frames and as a small table for a notebook."""

from __future__ import annotations

from collections.abc import Iterable, Iterator, Mapping, Sequence
from dataclasses import replace
from html import escape
from pathlib import Path
from typing import TYPE_CHECKING, Any, Final, overload

from uictest import report, runs
from uictest.api.arguments import PathName
from uictest.core import measures
from uictest.core.document import Table
from uictest.core.recording import Recording, read_parquet
from uictest.judging import evaluation
from uictest.judging.series import SeriesResult
from uictest.plans import scenario
from uictest.plans.scenario.yaml import suggestion

if TYPE_CHECKING:
    import pandas as pd


def frame_of(table: Table, index: Sequence[str]) -> pd.DataFrame:
    """Return a table as a data frame with the units of its columns in `attrs["units"]`.

    Columns of numbers are 64-bit floats (NaN: no number), or integers and booleans where every row has one.
    Texts are as written.
    """
    import pandas as pd

    records = list(table.records)
    # A table without rows may have no columns.
    names = [column.key for column in table.for_programs] or list(index)
    columns = {name: _column_array([record[name] for record in records]) for name in names}
    frame = pd.DataFrame(columns, columns=names).set_index(list(index))
    return with_units(frame)


def with_units(frame: pd.DataFrame) -> pd.DataFrame:
    """Add the units of the columns that hold measures."""
    frame.attrs["units"] = column_units(map(str, frame.columns))
    return frame


def column_units(names: Iterable[str]) -> dict[str, str]:
    """Return the unit of each column that holds a measure, `1` for a pure number."""
    measure_columns = {*measures.STOP_COLUMNS, *measures.WHEELSET_COLUMNS}
    stems = {name: _measure_name(name) for name in names}
    return {name: measures.column_unit(stem) for name, stem in stems.items() if stem in measure_columns}


def _measure_name(name: str) -> str:
    """Return the measure of a column, which may be of one wheelset or an end of a range."""
    stem, _, last = name.rpartition("_")
    return stem if last.isdigit() or last in ("lowest", "highest") else name


def _column_array(values: Sequence[Any]) -> Any:
    import numpy as np

    kinds = {type(value) for value in values}
    if not values or str in kinds:
        return np.array(values, object)
    if kinds in ({bool}, {int}):
        return np.array(values)
    return np.array([np.nan if value is None else value for value in values], float)


_MOST_ROWS: Final = 50


def run_summary_html(content: report.RunContent) -> str:
    """Return the counts of a run and one row for each case, those not as expected first. Text is escaped."""
    cases, series = report.explained_cases_table(content), report.comparison_table(content.series)
    first_cases = replace(cases, rows=list(cases.rows)[:_MOST_ROWS])
    tables = "".join(report.html_table(table) for table in (series, first_cases) if table.rows)
    further_cases = len(cases.rows) - len(first_cases.rows)
    note = ""
    if further_cases:
        note = f"<p>and {report.counted(further_cases, 'more case')}: <code>frame()</code> has all</p>"
    return f"<p>{escape(content.tally)}</p>{tables}{note}"


_SHOWN: Final = 10
"""Cases that the text form lists; chosen."""
_WIDTH: Final = 100
"""Letters of a line of the text form; chosen."""
_INDEX = {
    "summary": ("id",),
    "wheelsets": ("id", "wheelset"),
    "criteria": ("id", "criterion"),
    "repeats": ("id", "seed"),
    "requirements": ("requirement", "id"),
    "series": ("series", "speed_kmh", "rail", "measure"),
    "series-criteria": ("series", "criterion"),
    "series-stops": ("series", "case", "seed"),
}
"""Table -> the columns that tell its rows apart."""


class Results(Sequence[evaluation.CaseResult]):
    """The judged cases of a run, in order: iterate, count, or take one by its place or its id.

    The stops of series are not among them, but in :attr:`series`.

    Attributes:
        folder: folder of the reports, absolute; None where none were written.
    """

    def __init__(
        self,
        content: report.RunContent,
        *,
        recordings: Mapping[str, Recording] | None = None,
        cases: Sequence[scenario.Case] = (),
        every: float = 0.01,
        folder: Path | None = None,
    ) -> None:
        """Made by :func:`uictest.run`, :func:`uictest.evaluate` and :func:`uictest.read_results`."""
        self._content = content
        self._recordings = recordings or {}
        self._cases = cases
        self._every = every
        self.folder = None if folder is None else folder.absolute()

    def __len__(self) -> int:
        """Return the number of cases."""
        return len(self._content.results)

    def __iter__(self) -> Iterator[evaluation.CaseResult]:
        """Iterate over the cases."""
        return iter(self._content.results)

    @overload
    def __getitem__(self, key: int | str) -> evaluation.CaseResult: ...
    @overload
    def __getitem__(self, key: slice) -> Sequence[evaluation.CaseResult]: ...
    def __getitem__(self, key: int | str | slice) -> evaluation.CaseResult | Sequence[evaluation.CaseResult]:
        """Return a case by its place or its id, or several by a slice. Raises IndexError, KeyError."""
        if not isinstance(key, str):
            return self._content.results[key]
        results = {result.id: result for result in self._content.all_results}
        if key not in results:
            raise KeyError(f"no case {key!r}; {suggestion(key, results)}")
        return results[key]

    @property
    def met(self) -> bool:
        """Whether every case and every series came out as expected."""
        failed = self._content.campaign is not None and self._content.campaign.failed
        return all(map(self._content.expected, self)) and all(one.met for one in self.series) and not failed

    @property
    def tests(self) -> tuple[report.CampaignTest, ...]:
        """The tests of a programme with what came out: each has `name`, `status` and `lines`; else none."""
        return () if self._content.campaign is None else self._content.campaign.tests

    @property
    def series(self) -> tuple[SeriesResult, ...]:
        """The judged series, with their own cases."""
        return tuple(self._content.series)

    @property
    def tally(self) -> str:
        """The counts of the run in words, as `uictest run` ends with."""
        return self._content.tally

    def frame(self) -> pd.DataFrame:
        """Return one row per case, index `id`: the columns of summary.csv, numbers as numbers.

        Parameters are texts as written. Units are in `attrs["units"]`, by column.
        """
        return self.table("summary")

    def wheelsets(self) -> pd.DataFrame:
        """Return one row per case and wheelset (1 leads): the columns of wheelsets.csv."""
        return self.table("wheelsets")

    def criteria(self) -> pd.DataFrame:
        """Return one row per case and criterion: the columns of criteria.csv, units in `unit`."""
        return self.table("criteria")

    def repeats(self) -> pd.DataFrame:
        """Return one row per stop of repeated cases: the columns of repeats.csv. KeyError if none repeats."""
        return self.table("repeats")

    def table(self, name: str) -> pd.DataFrame:
        """Return any table of the reports, by the name of its CSV file without `.csv`.

        `summary`, `wheelsets`, `criteria`; where there are such, `repeats`, `requirements`, `series`,
        `series-criteria`, `series-stops`. Raises KeyError for others.
        """
        tables = {table.name: table for table in report.run_tables(self._content)}
        if name not in tables:
            raise KeyError(f"no table {name!r} in this run; {suggestion(name, tables)}")
        return frame_of(tables[name], _INDEX[name])

    def recording(self, case: str) -> Recording:
        """Return the recording of a case. Raises KeyError where it was not recorded."""
        case_id = self[case].id
        if case_id in self._recordings:
            return self._recordings[case_id]
        if self.folder is not None:
            path = report.recording_path(self.folder, case_id)
            if path.is_file():
                return read_parquet(path)
        raise KeyError(f"{case_id} was not recorded: run it with record='all', or call uictest.simulate")

    def save(self, output: PathName = "reports", *, formats: Sequence[str] = ("csv", "html")) -> Path:
        """Write the reports that `uictest run -o` writes, and the recordings; return the folder of the run.

        Args:
            output: folder of all runs; the run gets a folder in it, and `latest` names it.
            formats: as for `--report`, besides those that every run has.

        Raises:
            ValueError: there is no such format.
            OSError: the reports cannot be written.

        """
        for name in formats:
            if name not in report.FORMATS:
                raise ValueError(f"no format {name!r}; {suggestion(name, report.FORMATS)}")
        recordings = {result.id: self._recorded(result.id) for result in self._content.all_results}
        there = {name: samples for name, samples in recordings.items() if samples is not None}
        content = self._content
        if not report.DRAWING.isdisjoint(formats) and not content.traces:
            content = runs.with_traces(content, self._cases, there, self._every)
        return runs.publish_run(content, there, Path(output), formats).place

    def _recorded(self, case: str) -> Recording | None:
        try:
            return self.recording(case)
        except KeyError:
            return None

    def __repr__(self) -> str:
        """Return the summary, with the table of the first cases."""
        return "\n".join([self.tally, *report.run_lines(self._content, _WIDTH, most=_SHOWN)])

    def _repr_html_(self) -> str:
        return run_summary_html(self._content)
