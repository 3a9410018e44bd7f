"""One stop_runner for all tests of the studies: a stop or a study that several of them need is run once."""

from __future__ import annotations

from collections.abc import Callable
from functools import cache

import pytest

from uictest.studies import (
    STUDIES,
    FoundValue,
    StopRunner,
    Study,
    StudyFindings,
    StudyQuantity,
    StudyResult,
    run_study,
)

Conduct = Callable[[str], StudyResult]


@pytest.fixture(scope="session")
def stop_runner() -> StopRunner:
    return StopRunner(jobs=2)


@pytest.fixture(scope="session")
def result(stop_runner: StopRunner) -> Conduct:
    """Run a study of the catalogue, or give what it came to."""
    return cache(lambda name: run_study(STUDIES[name], stop_runner))


@pytest.fixture
def made_up() -> StudyResult:
    """A study of three quantities: one holds, one misses, one has no band and was not found."""
    quantities = (
        StudyQuantity("time", "braking time", "s", "17.6 s", 16.5, 19.0, reason="ours"),
        StudyQuantity(
            "share", "[bold]share", "%", "below 2 %", upper=2.0, below=True, digits=2, reason="source"
        ),
        StudyQuantity("count", "actuations", digits=0),
    )
    figures = {
        "time": FoundValue(18.12, 17.9, 18.34),
        "share": FoundValue(2.0),
        "count": FoundValue(float("nan"), float("nan"), float("nan")),
    }
    findings = StudyFindings(
        figures, {"data": {"time_s": [0.0, 0.5], "what": ["a, b", None]}}, notes=("Made up.",)
    )
    study = Study("made-up", "A made-up study", "17.6 s", quantities, lambda stop_runner: findings)
    return StudyResult(study, findings)
