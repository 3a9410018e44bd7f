"""Compare recorded stops with their simulation, and the validation in Python."""

from __future__ import annotations

from html import escape
from pathlib import Path
from typing import TYPE_CHECKING, Literal

from uictest import report, runs
from uictest.analysis import validation
from uictest.api.arguments import (
    Assignments,
    PathName,
    Trusted,
    as_paths,
    command_words,
    override_texts,
    thread_count,
)
from uictest.api.results import frame_of

if TYPE_CHECKING:
    import pandas as pd


class Validation:
    """Recorded stops beside their simulation: how far off the model is, and where that has been shown.

    Attributes:
        result: what validation.json has: stops, figures, domains.
        complete: whether every simulation came to an end.
        folder: of the files, absolute; None where none were written.
    """

    def __init__(self, result: validation.Validation, *, complete: bool, folder: Path | None) -> None:
        """Made by :func:`uictest.validate`."""
        self.result = result
        self.complete = complete
        self.folder = None if folder is None else folder.absolute()

    def __len__(self) -> int:
        """Return the number of recorded stops, counted or not."""
        return len(self.result.stops)

    @property
    def met(self) -> bool:
        """Whether every simulation ended, and every stop counts that is not marked as tuned."""
        return self.complete and not self.result.not_usable

    @property
    def tally(self) -> str:
        """How many of the recorded stops count, in words."""
        return validation.tally(self.result)

    @property
    def file(self) -> Path | None:
        """The file that `validated` takes; None where none was written."""
        return None if self.folder is None else self.folder / validation.RESULT

    def frame(self) -> pd.DataFrame:
        """Return one row per figure, index `figure`: the columns of figures.csv.

        `bias`, `deviation` and their intervals are in the `unit` of the row, `relative_...` are shares of the
        recorded figure. NaN is what the stops cannot show.
        """
        return frame_of(validation.figures_table(self.result), ("figure",))

    def stops(self) -> pd.DataFrame:
        """Return one row per stop and figure: recorded, simulated and their difference, as in stops.csv.

        A stop that cannot be used has one row without figure.
        """
        return frame_of(validation.stops_table(self.result), ("stop", "figure"))

    def __repr__(self) -> str:
        """Return the counts, the figures and the domain, as `uictest validate` prints them."""
        document = validation.validation_document(self.result, every_figure=False)
        lines = report.document_lines(document, None)
        return "\n".join([f"{self.result.name}: {self.tally}", *lines])

    def _repr_html_(self) -> str:
        shown = ["unit", "stops", "recorded_mean", "bias", "deviation", "limits_low", "limits_high"]
        table = self.frame()[shown].to_html(float_format="{:.5g}".format, na_rep="-")
        return f"<p>{escape(self.result.name)}: {escape(self.tally)}</p>{table}"


def validate(
    file: PathName,
    *,
    set: Assignments | None = None,  # noqa: A002 - the name of the option
    trust: Trusted = (),
    jobs: int | Literal["auto"] = "auto",
    output: PathName | None = None,
) -> Validation:
    """Compare recorded stops with their simulation: the same digits as `uictest validate`.

    Nothing is printed, and nothing is written unless `output` names a folder.

    Args:
        file: a validation file, or a `*.series.yaml` whose stops name recordings.
        set: dotted key -> value in every scenario, as for :func:`uictest.load`.
        trust: folders that files may refer to, besides their own and the working folder.
        jobs: number of threads, `auto`: one for each processor.
        output: folder for validations; this one gets a folder in it, as with `-o`.

    Raises:
        uictest.ScenarioErrors: the file is invalid, one that it names, or a key of `set`.
        ValueError: a recording cannot be read, no stop names one, the file has several series, or an argument
            is invalid.
        OSError: the files of the validation cannot be written.

    """
    threads, texts, folders = thread_count(jobs), override_texts(set), as_paths(trust)
    plan, *others = runs.load_validations([Path(file)], texts, folders)
    if others:
        names = ", ".join(each.name for each in (plan, *others))
        raise ValueError(f"{file}: each series is a validation of its own, found {names}: name a file of one")
    run = runs.run_validation(plan, threads, folders, runs.Observer())
    folder = None
    if output is not None:
        words = command_words(["validate", file], {"--set": texts, "--trust": folders, "-o": output})
        folder = runs.publish_validation(run.validation, words, Path(output))
    return Validation(run.validation, complete=run.complete, folder=folder)
