"""Every measure, declared once: each module here has a tuple `MEASURES`, which is found and listed here."""

from __future__ import annotations

import importlib
import math
import pkgutil
import sys
from collections.abc import Iterable, Iterator
from types import MappingProxyType, ModuleType
from typing import Final

from uictest.core.measures.measure import DefinitionValues, Measure, StopColumn, WheelsetColumn
from uictest.core.measures.records import StopMeasures, WheelsetMeasures
from uictest.core.units import in_unit

_ORDER: Final = ["stopping", "deceleration", "sliding", "brake", "simulation", "diagnosis"]
"""Order of the modules in results and lists; modules not named here follow in the order of their names."""


def measures_in(package: ModuleType) -> dict[str, Measure]:
    """Return the measures in the modules of a package by name: those of stops, then those of wheelsets.

    Raises ValueError where two have the same name, or two of stops or of wheelsets the same column.
    """
    measures = sorted(_declared_in(package), key=lambda measure: measure.of_wheelsets)
    _reject_duplicates("measures", (measure.name for measure in measures))
    for columns in (StopColumn, WheelsetColumn):
        names = (measure.column.name for measure in measures if isinstance(measure.column, columns))
        _reject_duplicates("columns", names)
    return {measure.name: measure for measure in measures}


def _declared_in(package: ModuleType) -> Iterator[Measure]:
    names = [module.name for module in pkgutil.iter_modules(package.__path__)]
    for name in sorted(names, key=lambda name: (_ORDER.index(name) if name in _ORDER else len(_ORDER), name)):
        yield from importlib.import_module(f"{package.__name__}.{name}").MEASURES


def _reject_duplicates(things: str, names: Iterable[str]) -> None:
    seen: set[str] = set()
    for name in names:
        if name in seen:
            raise ValueError(f"two {things} are called {name!r}")
        seen.add(name)


MEASURES: Final = MappingProxyType(measures_in(sys.modules[__name__]))
"""Every measure by name."""
_COLUMNS: Final = [measure.column for measure in MEASURES.values()]

_BY_COLUMN: Final = {
    (measure.column.name, measure.of_wheelsets): measure for measure in MEASURES.values() if measure.column
}

STOP_COLUMNS: Final = MappingProxyType(
    {column.name: column for column in _COLUMNS if isinstance(column, StopColumn)}
)
"""Every column of stops in results, by name, in the order of results."""

WHEELSET_COLUMNS: Final = MappingProxyType(
    {column.name: column for column in _COLUMNS if isinstance(column, WheelsetColumn)}
)
"""Every column of wheelsets in results, by name, in the order of results."""


def column_unit(name: str) -> str:
    """Return the unit of a column of results, `1` for a pure number or another name.

    The number of a wheelset may follow the name: `locked_time_s_3`.
    """
    column = STOP_COLUMNS.get(name) or WHEELSET_COLUMNS.get(without_wheelset(name)[0])
    return column.unit if column else "1"


def without_wheelset(name: str) -> tuple[str, str]:
    """Return a column without the number of a wheelset behind it, and that number, empty without one."""
    stem, _, number = name.rpartition("_")
    return (stem, number) if stem in WHEELSET_COLUMNS and number.isdigit() else (name, "")


def measure_of_column(name: str, *, of_wheelsets: bool = False) -> Measure | None:
    """Return the measure of a column of stops, or of wheelsets; None for another name.

    The number of a wheelset may follow the name, which then is that of a column of wheelsets.
    """
    stem, wheelset = without_wheelset(name)
    return _BY_COLUMN.get((stem, bool(wheelset) or of_wheelsets))


def stop_column_values(stop: StopMeasures, definition: DefinitionValues) -> dict[str, float]:
    """Return what results report of a stop: column -> number in its unit, NaN where there is none.

    `definition` holds the SI value of every definition that a column has a default of.
    """
    return {name: _number(column, column.read(stop, definition)) for name, column in STOP_COLUMNS.items()}


def wheelset_column_values(wheelset: WheelsetMeasures) -> dict[str, float]:
    """Return what results report of one wheelset: column -> number in its unit, NaN where there is none."""
    return {name: _number(column, column.read(wheelset)) for name, column in WHEELSET_COLUMNS.items()}


def _number(column: StopColumn | WheelsetColumn, value: float) -> float:
    number = in_unit(float(value), column.unit)
    return int(number) if column.whole and not math.isnan(number) else number
