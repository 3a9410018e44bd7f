"""Run a sweep of many cases, and its results in Python."""

from __future__ import annotations

from collections.abc import Sequence
from html import escape
from pathlib import Path
from typing import TYPE_CHECKING, Final, Literal, Self

from uictest import report, runs
from uictest.api.arguments import (
    Assignments,
    PathName,
    Trusted,
    as_paths,
    checked_seed,
    expression_of,
    override_texts,
    thread_count,
)
from uictest.api.results import with_units
from uictest.core import files
from uictest.core.document import Column, Table
from uictest.plans import sweeps
from uictest.running import chunked
from uictest.runs import history

if TYPE_CHECKING:
    import pandas as pd


_TABLE = "summary.parquet"


class SweepResults:
    """The cases of a finished sweep.

    Attributes:
        result: counts, rates by parameter, maps, trends, sensitivities, the frontier, the worst cases.
        folder: folder of the results, absolute; None where none were kept.
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
        missed = Table(_MISSED, self.result.missed)
        table = report.html_table(missed) if missed.rows else ""
        return f"<p>{escape(self.result.name)}: {escape(self.tally)}</p>{table}"


_MISSED: Final[tuple[Column[report.MissedCase], ...]] = (
    Column(heading="not as expected", text=lambda case: case.id),
    Column(heading="outcome", text=lambda case: case.outcome),
    Column(heading="reason", text=lambda case: case.reason),
)


def sweep(
    file: PathName,
    *,
    set: Assignments | None = None,  # noqa: A002 - the name of the option
    seed: int | None = None,
    select: str | None = None,
    measures: str | Sequence[str] = ("braking_distance_m",),
    frontier: str | None = None,
    tolerance: str | None = None,
    validated: PathName | None = None,
    trust: Trusted = (),
    jobs: int | Literal["auto"] = "auto",
    output: PathName | None = None,
    restart: bool = False,
) -> SweepResults:
    """Run a sweep file: the same digits as `uictest sweep`.

    With `output`, finished chunks are kept in that folder: after an interruption the same call continues, and
    a sweep that is finished is not run again. Without it, nothing is kept.

    Args:
        file: a `*.sweep.yaml`.
        set: dotted key -> value in every case, as for :func:`uictest.load`.
        seed: seed of sensor noise and random rails in every case, 0 to 2^32 - 1.
        select: expression over ids, as `-k`.
        measures: columns of the table to map and to compute sensitivities of, one or several.
        frontier: parameter along which to find where the verdict flips.
        tolerance: accuracy of the frontier, such as `0.001` or `0.5 km/h` [default: 1/64 of the smallest
            step].
        validated: validation.json of a validation: cases outside of it are counted and named in the column
            `outside`; in place of what the scenario names under `validated`.
        trust: folders that scenarios may refer to, besides their own and the working folder.
        jobs: number of threads, `auto`: one for each processor.
        output: folder for results; the sweep gets a folder of its name in it, as with `-o`.
        restart: discard finished chunks and start again.

    Raises:
        uictest.ScenarioErrors: the file is invalid, or a key of `set`; the message has every error in it.
        ValueError: nothing is selected, an argument is invalid, or the folder is in use or holds the chunks
            of other inputs.
        OSError: the results cannot be written.

    """
    texts, folders, seed = override_texts(set), as_paths(trust), checked_seed(seed)
    plan = sweeps.load_sweep(Path(file), tuple(texts), seed, folders)
    with expression_of("select", select):
        selection = chunked.select_cases(plan, select)
    if selection.size == 0:
        raise ValueError(f"nothing selected among {plan.size} cases")

    option = None if validated is None else Path(validated)
    reference = runs.reference_of(option, plan.base.scenario.validated)

    def run_in(folder: Path, formats: Sequence[str] | None) -> runs.SweepRequest:
        return runs.SweepRequest(
            selection=selection,
            manifest=chunked.sweep_manifest(selection, expression=select, overrides=texts, seed=seed),
            folder=folder / plan.name,
            jobs=thread_count(jobs),
            restart=restart,
            pair=runs.first_pair(plan),
            measures=runs.measure_names([measures] if isinstance(measures, str) else measures),
            search=runs.frontier_search(plan, frontier, tolerance),
            reference=reference,
            formats=formats,
        )

    if output is not None:
        return _finished(run_in(Path(output), None), keep=True)
    with files.temporary_folder() as folder:
        return _finished(run_in(folder, ()), keep=False)


def _finished(request: runs.SweepRequest, *, keep: bool) -> SweepResults:
    finished = runs.run_sweep(request, runs.Observer())
    assert finished is not None  # there is one shard
    if keep:
        history.refresh_index(request.folder.parent)
    return SweepResults.read(finished.result, request.folder, keep=keep)
