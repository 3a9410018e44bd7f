"""Every band, held by the shipped library."""

from __future__ import annotations

from collections.abc import Callable

import pytest

from uictest.studies import STUDIES, StudyResult
from uictest.studies.comparison import band_text, ours_text

_SLOW = frozenset({"compensation-domain", "field-against-rig", "robustness"})

BOUNDED = [
    pytest.param(name, quantity.key, id=f"{name}-{quantity.key}", marks=[pytest.mark.slow] * (name in _SLOW))
    for name, study in STUDIES.items()
    for quantity in study.quantities
    if quantity.lower is not None or quantity.upper is not None
]


@pytest.mark.parametrize(("study", "key"), BOUNDED)
def test_the_figure_lies_in_its_band(study: str, key: str, result: Callable[[str], StudyResult]) -> None:
    comparison = next(each for each in result(study).comparisons if each.quantity.key == key)
    found, band = ours_text(comparison), band_text(comparison.quantity)
    assert comparison.status == "holds", f"{comparison.quantity.title}: {found}, band {band}"
