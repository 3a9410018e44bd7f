"""Every measure of a series, found in the modules of the catalogue."""

from __future__ import annotations

import importlib
import pkgutil
from collections.abc import Iterator
from types import MappingProxyType
from typing import Final

from uictest.core.series_measures import catalogue
from uictest.core.series_measures.measure import SeriesMeasure

_ORDER: Final = ("k_wet", "distance", "passing", "wheels", "utilisation", "air", "balance")
"""Order of the modules in results and lists; modules not named here follow in the order of their names."""


def _declared() -> Iterator[SeriesMeasure]:
    names = [module.name for module in pkgutil.iter_modules(catalogue.__path__)]
    for name in sorted(names, key=lambda name: (_ORDER.index(name) if name in _ORDER else len(_ORDER), name)):
        yield from importlib.import_module(f"{catalogue.__name__}.{name}").MEASURES


SERIES_MEASURES: Final = MappingProxyType({measure.name: measure for measure in _declared()})
"""Every measure of a series by name."""
