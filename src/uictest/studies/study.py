"""A study: one experiment of the source, or of our own about it, and what it finds."""

from __future__ import annotations

from collections.abc import Callable, Mapping, Sequence
from dataclasses import dataclass, field
from typing import TYPE_CHECKING, Any

import numpy as np
from numpy.typing import NDArray

from uictest.studies.quantity import BandStatus, FoundValue, PaperComparison, StudyQuantity

if TYPE_CHECKING:
    from matplotlib.figure import Figure

    from uictest.studies.stop_runner import StopRunner

Table = Mapping[str, Sequence[Any]]
"""Columns of equal length; a name ends in the unit, as in `pressure_bar`."""

Drawing = Callable[["Figure"], None]
"""Draws into an empty figure, whose size it may set."""


@dataclass(frozen=True, slots=True)
class StudyFindings:
    """What a study comes to.

    Args:
        figures: what was found for every quantity of the study, by key.
        tables: data, by the name of the file.
        drawings: figures to be drawn, by the name of the file.
        notes: sentences about what was found.
    """

    figures: Mapping[str, FoundValue]
    tables: Mapping[str, Table] = field(default_factory=dict)
    drawings: Mapping[str, Drawing] = field(default_factory=dict)
    notes: Sequence[str] = ()


@dataclass(frozen=True, slots=True)
class Study:
    """An experiment.

    Args:
        name: what it is called on the command line.
        title: one line for people.
        source: what the text of the source says, whose figure and table data are not public; empty where
            the study is ours alone.
        quantities: what is compared.
        run: runs it.
    """

    name: str
    title: str
    source: str
    quantities: Sequence[StudyQuantity]
    run: Callable[[StopRunner], StudyFindings]


@dataclass(frozen=True, slots=True)
class StudyResult:
    """A study and what it came to."""

    study: Study
    findings: StudyFindings

    @property
    def comparisons(self) -> list[PaperComparison]:
        """Source beside here, one for every quantity of the study, in its order."""
        figures = self.findings.figures
        return [PaperComparison(quantity, figures[quantity.key]) for quantity in self.study.quantities]

    @property
    def verdict(self) -> BandStatus:
        """`misses` if any quantity does, `shown` if none has a band, else `holds`."""
        verdicts = {comparison.verdict for comparison in self.comparisons}
        return "misses" if "misses" in verdicts else "holds" if "holds" in verdicts else "shown"


def run_study(study: Study, stop_runner: StopRunner) -> StudyResult:
    """Run a study. Raises KeyError if it finds no figure for one of its quantities."""
    findings = study.run(stop_runner)
    missing = [quantity.key for quantity in study.quantities if quantity.key not in findings.figures]
    if missing:
        raise KeyError(f"{study.name} finds no figure for {', '.join(missing)}")
    return StudyResult(study, findings)


def column(samples: NDArray[Any], unit: float, digits: int) -> list[float]:
    """Return samples, SI, in a unit of that size, rounded for the column of a table."""
    rounded: list[float] = np.round(samples / unit, digits).tolist()
    return rounded
