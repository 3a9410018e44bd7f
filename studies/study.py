"""A study and its findings; every study there is."""

from __future__ import annotations

import pkgutil
from collections.abc import Callable, Mapping, Sequence
from dataclasses import dataclass, field
from importlib import import_module
from typing import TYPE_CHECKING, Any

import numpy as np

from studies import experiments
from studies.quantity import PaperComparison, Result, StudyQuantity, StudyValue
from studies.stop_runner import StopRunner
from uictest import Recording
from uictest.units import BAR, KILOMETRE_PER_HOUR, KILONEWTON

if TYPE_CHECKING:
    from matplotlib.figure import Figure


Table = Mapping[str, Sequence[Any]]
"""Columns of equal length; a name ends in the unit, as in `pressure_bar`."""

Drawing = Callable[["Figure"], None]
"""Draws into an empty figure, whose size it may set."""


@dataclass(frozen=True, slots=True)
class StudyFindings:
    """The findings of one study.

    Args:
        values: the value of every quantity of the study, by key.
        tables: data, by the name of the file.
        drawings: what draws each figure, by the name of the file.
        notes: sentences on the findings.
    """

    values: Mapping[str, StudyValue]
    tables: Mapping[str, Table] = field(default_factory=dict)
    drawings: Mapping[str, Drawing] = field(default_factory=dict)
    notes: Sequence[str] = ()


@dataclass(frozen=True, slots=True)
class Study:
    """An experiment.

    Args:
        name: its name on the command line.
        title: one line for people.
        paper: the statement of the paper's text; the data of its figures and tables are not public. Empty for
            a study of our own.
        quantities: those that are compared.
        run: function that runs it.
        position: place in the list of studies: those of the paper in its order, then ours.
    """

    name: str
    title: str
    paper: str
    quantities: Sequence[StudyQuantity]
    run: Callable[[StopRunner], StudyFindings]
    position: int = 0


@dataclass(frozen=True, slots=True)
class StudyResult:
    """A study and its findings; `inputs` are the files of its stops with their SHA-256."""

    study: Study
    findings: StudyFindings
    inputs: Mapping[str, str] = field(default_factory=dict)

    @property
    def comparisons(self) -> list[PaperComparison]:
        """The comparison with the paper for every quantity of the study, in its order."""
        values = self.findings.values
        return [PaperComparison(quantity, values[quantity.key]) for quantity in self.study.quantities]

    @property
    def result(self) -> Result:
        """`misses` if any quantity does, `shown` if none has a band, else `holds`."""
        results = {comparison.result for comparison in self.comparisons}
        return "misses" if "misses" in results else "holds" if "holds" in results else "shown"

    @property
    def fails(self) -> bool:
        """Whether a quantity misses and that is not declared, or holds although a miss is declared."""
        return any(comparison.fails for comparison in self.comparisons)


def run_study(study: Study, stop_runner: StopRunner) -> StudyResult:
    """Run a study. Raises KeyError if it returns no value for one of its quantities."""
    stop_runner.inputs.clear()
    findings = study.run(stop_runner)
    missing = [quantity.key for quantity in study.quantities if quantity.key not in findings.values]
    if missing:
        raise KeyError(f"{study.name} returns no value for {', '.join(missing)}")
    return StudyResult(study, findings, dict(stop_runner.inputs))


_UNITS = {
    "s": (1.0, 3),
    "m": (1.0, 3),
    "kmh": (KILOMETRE_PER_HOUR, 3),
    "bar": (BAR, 4),
    "kn": (KILONEWTON, 4),
}
"""End of the name of a column -> size of the unit in SI, and digits."""


def samples(recording: Recording, *columns: str, every: int = 1) -> dict[str, list[Any]]:
    """Return channels as columns, a row for every so many samples.

    A column is named as its channel and its unit, as `speed_kmh`; `NAME=CHANNEL_UNIT` gives it another name.
    """
    table = {}
    for column in columns:
        name, _, source = column.rpartition("=")
        channel, _, unit = source.rpartition("_")
        size, digits = _UNITS.get(unit, (1.0, 4))
        values = recording[channel if unit in _UNITS else source][::every]
        table[name or source] = np.round(values / size, digits).tolist()
    return table


def find_studies() -> dict[str, Study]:
    """Return every study by its name, in the order in which they are listed and run."""
    modules = (
        import_module(f"{experiments.__name__}.{module.name}")
        for module in pkgutil.iter_modules(experiments.__path__)
    )
    studies = [each for module in modules for each in vars(module).values() if isinstance(each, Study)]
    return {study.name: study for study in sorted(studies, key=lambda study: study.position)}


STUDIES: dict[str, Study] = find_studies()
"""Every study by its name."""
