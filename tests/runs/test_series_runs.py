"""Series one after the other: when no further one is run, and what an interrupt leaves."""

from __future__ import annotations

from types import SimpleNamespace
from typing import Any, cast

import pytest

from uictest.core.units import KILOMETRE_PER_HOUR
from uictest.judging import series as judging_series
from uictest.plans import series
from uictest.running import campaign
from uictest.runs.series_runs import SeriesBatch, run_series, speed_kmh


@pytest.fixture
def judged(monkeypatch: pytest.MonkeyPatch) -> None:
    """Series without stops, which are met or not as they say."""
    monkeypatch.setattr(judging_series, "judge_series", lambda planned, cases: planned)


def ran(
    met: list[bool], maxfail: int | None = None, interrupted: int | None = None
) -> tuple[SeriesBatch, list[Any]]:
    """Run series that are met or not, of which one is interrupted; return the batch and what was shown."""
    planned = [SimpleNamespace(met=each, cases=[number], stops=()) for number, each in enumerate(met)]
    shown: list[Any] = []
    batch = run_series(
        cast(Any, planned),
        lambda cases: campaign.BatchResult(interrupted=cases == [interrupted]),
        maxfail=maxfail,
        show=shown.append,
    )
    return batch, shown


@pytest.mark.usefixtures("judged")
@pytest.mark.parametrize(("maxfail", "run"), [(None, 5), (1, 2), (2, 4), (3, 5)])
def test_after_so_many_that_are_missed_no_further_one_is_run(maxfail: int | None, run: int) -> None:
    batch, shown = ran([True, False, True, False, True], maxfail)
    assert len(batch.results) == run
    assert shown == batch.results
    assert not batch.interrupted


@pytest.mark.usefixtures("judged")
def test_a_series_that_is_interrupted_is_not_judged_and_none_follows() -> None:
    batch, shown = ran([True] * 4, interrupted=2)
    assert (len(batch.results), len(shown), batch.interrupted) == (2, 2, True)


@pytest.mark.parametrize("speed", [30, 62.5, 80, 120, 155.25, 180, 350])
def test_the_speed_of_a_stop_has_the_digits_that_its_scenario_states(speed: float) -> None:
    stop = SimpleNamespace(speed=speed * KILOMETRE_PER_HOUR)
    assert speed_kmh(cast(series.PlannedStop, stop)) == speed
