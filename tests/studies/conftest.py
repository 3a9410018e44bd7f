"""One laboratory for all tests of the studies: a stop or a study that several of them need is run once."""

from __future__ import annotations

from collections.abc import Callable
from functools import cache

import pytest

from uictest.studies import STUDIES, Conducted, Findings, Laboratory, Quantity, Reading, Study, conduct

Conduct = Callable[[str], Conducted]


@pytest.fixture(scope="session")
def laboratory() -> Laboratory:
    return Laboratory(jobs=2)


@pytest.fixture(scope="session")
def conducted(laboratory: Laboratory) -> Conduct:
    """Run a study of the catalogue, or give what it came to."""
    return cache(lambda name: conduct(STUDIES[name], laboratory))


@pytest.fixture
def made_up() -> Conducted:
    """A study of three quantities: one holds, one misses, one has no band and was not found."""
    quantities = (
        Quantity("time", "braking time", "s", "17.6 s", 16.5, 19.0, reason="ours"),
        Quantity("share", "[bold]share", "%", "below 2 %", upper=2.0, below=True, digits=2, reason="source"),
        Quantity("count", "actuations", digits=0),
    )
    figures = {
        "time": Reading(18.12, 17.9, 18.34),
        "share": Reading(2.0),
        "count": Reading(float("nan"), float("nan"), float("nan")),
    }
    findings = Findings(
        figures, {"data": {"time_s": [0.0, 0.5], "what": ["a, b", None]}}, notes=("Made up.",)
    )
    study = Study("made-up", "A made-up study", "17.6 s", quantities, lambda laboratory: findings)
    return Conducted(study, findings)
