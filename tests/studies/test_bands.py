"""Every band is held by the shipped library, or declared missed and missed."""

from __future__ import annotations

from collections.abc import Callable
from pathlib import Path

import pytest

from uictest import studies
from uictest.studies import STUDIES, Study, StudyResult
from uictest.studies.comparison import band_text, ours_text

from ..docs.conftest import REPOSITORY, tools_on_path  # noqa: F401
from ..docs.test_examples import check_consoles, runs_a_study, takes_long

_SLOW = frozenset({"compensation-domain", "field-against-rig", "robustness"})

BOUNDED = [
    pytest.param(name, quantity.key, id=f"{name}-{quantity.key}", marks=[pytest.mark.slow] * (name in _SLOW))
    for name, study in STUDIES.items()
    for quantity in study.quantities
    if quantity.band is not None
]


@pytest.mark.parametrize(("study", "key"), BOUNDED)
def test_the_figure_is_as_claimed(study: str, key: str, result: Callable[[str], StudyResult]) -> None:
    comparison = next(each for each in result(study).comparisons if each.quantity.key == key)
    found, band = ours_text(comparison), band_text(comparison.quantity)
    assert not comparison.fails, f"{comparison.quantity.title}: {found}, band {band}"


@pytest.mark.usefixtures("tools_on_path")
def test_the_page_shows_what_the_program_prints(
    result: Callable[[str], StudyResult], tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    """Of the studies that are run here; those that take long are compared among the slow tests."""

    def known(study: Study, stop_runner: object) -> StudyResult:
        return result(study.name)

    monkeypatch.setattr(studies, "run_study", known)
    chosen = []

    def is_chosen(block: object) -> bool:
        chosen.append(runs_a_study(block) and not takes_long(block))
        return chosen[-1]

    check_consoles(REPOSITORY / "docs" / "studies.md", tmp_path, is_chosen)
    assert any(chosen)
