"""Series one after the other: when no further one is run, and what an interrupt leaves."""

from types import SimpleNamespace

import pytest

from uictest.core.units import KILOMETRE_PER_HOUR
from uictest.judging import series as judging_series
from uictest.plans.series import PlannedStop
from uictest.running import campaign
from uictest.runs.batch import run_series


@pytest.fixture(autouse=True)
def judged(monkeypatch):
    """Series without stops, which are met or not as they say."""
    monkeypatch.setattr(judging_series, "judge_results", lambda planned, results: planned)


def ran(met, maxfail=None, interrupted=None):
    """Run series that are met or not, of which one is interrupted; return the batch and what was shown."""
    planned = [
        SimpleNamespace(met=each, cases=[SimpleNamespace(id=number, train=None)])
        for number, each in enumerate(met)
    ]
    shown = []

    def run(cases):
        return campaign.BatchResult(cases, interrupted=cases[0].id == interrupted)

    return run_series(planned, run, maxfail=maxfail, show=shown.append), shown


@pytest.mark.parametrize(("maxfail", "run"), [(None, 5), (1, 2), (2, 4), (3, 5)])
def test_after_so_many_that_are_missed_no_further_one_is_run(maxfail, run):
    batch, shown = ran([True, False, True, False, True], maxfail)
    assert len(batch.results) == run
    assert shown == batch.results
    assert not batch.interrupted


def test_a_series_that_is_interrupted_is_not_judged_and_none_follows():
    batch, shown = ran([True] * 4, interrupted=2)
    assert (len(batch.results), len(shown), batch.interrupted) == (2, 2, True)


def test_a_series_is_shown_where_an_interrupt_ends_the_question_how_firm_it_is():
    def interrupt(planned, result):
        raise KeyboardInterrupt

    planned = [SimpleNamespace(met=True, cases=[], stops=()) for _ in range(2)]
    shown = []
    batch = run_series(
        planned, lambda cases: campaign.BatchResult(), interrupt, maxfail=None, show=shown.append
    )
    assert batch.interrupted
    assert batch.results == shown == planned[:1]


@pytest.mark.parametrize("speed", [30, 62.5, 80, 120, 155.25, 180, 350])
def test_the_speed_of_a_stop_has_the_digits_that_its_scenario_states(speed):
    case = SimpleNamespace(scenario=SimpleNamespace(initial_speed=speed * KILOMETRE_PER_HOUR))
    assert PlannedStop("wet", case).speed_kmh == speed
