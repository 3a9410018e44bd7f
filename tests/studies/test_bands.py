"""Every band is held by the shipped library, or declared missed and missed."""

import pytest

from studies.comparison import band_text, ours_text
from studies.study import STUDIES

_SLOW = frozenset({"compensation-domain", "field-against-rig", "robustness"})

BOUNDED = [
    pytest.param(name, quantity.key, id=f"{name}-{quantity.key}", marks=[pytest.mark.slow] * (name in _SLOW))
    for name, study in STUDIES.items()
    for quantity in study.quantities
    if quantity.band is not None
]


@pytest.mark.parametrize(("study", "key"), BOUNDED)
def test_the_figure_is_as_claimed(study, key, result):
    comparison = next(each for each in result(study).comparisons if each.quantity.key == key)
    found, band = ours_text(comparison), band_text(comparison.quantity)
    assert not comparison.fails, f"{comparison.quantity.title}: {found}, band {band}"
