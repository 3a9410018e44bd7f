from dataclasses import replace
from pathlib import Path

import pytest

import uictest
from studies import stop_runner
from studies.stop_runner import StopRunner, seeded
from uictest import CaseResult
from uictest.plans.scenario import PASS, load

SHIPPED = Path(__file__).parents[2] / "scenarios"


@pytest.fixture
def runs(monkeypatch):
    """Let stops come out as their seed; the stops that were run, as id and seed."""
    done = []

    def judged(cases, jobs):
        assert len({case.id for case in cases}) == len(cases)
        done.extend((case.id, case.scenario.seed) for case in cases)
        return [case.scenario.seed for case in cases]

    monkeypatch.setattr(stop_runner, "_judged", judged)
    return done


def test_a_stop_is_run_once(runs):
    bench = StopRunner()
    cases = bench.cases("wet-80-command")
    first = bench.repeated(cases[:2], range(3))
    again = bench.repeated(cases, range(2, 5))
    assert [[*map(str, each.stops)] for each in first] == [["0", "1", "2"]] * 2
    assert [[*map(str, each.stops)] for each in again] == [["2", "3", "4"]] * 3
    assert len(runs) == len(set(runs)) == 6 + 7


def test_stops_of_the_same_id_or_noise_of_another_id_are_different_stops(runs):
    bench = StopRunner()
    cases = [bench.cases("slide-80", {"rig.compensation": setting})[0] for setting in ("none", "full")]
    assert cases[0].id == cases[1].id
    bench.repeated(cases, [0])
    assert len(runs) == 2
    bench.repeated([replace(cases[0], id="other")], [0])  # the id seeds the noise
    assert [name for name, _ in runs] == ["slide-80", "slide-80", "other"]


def test_a_stop_that_fails_is_no_result(monkeypatch):
    failed = CaseResult("slide-80", "", {}, PASS, "error", "the controller failed")
    monkeypatch.setattr(uictest, "run", lambda cases, **_: [failed])
    bench = StopRunner()
    with pytest.raises(RuntimeError, match="slide-80: the controller failed"):
        bench.repeated(bench.cases("slide-80"), [0])


def test_work_is_returned_in_order():
    assert StopRunner(jobs=3).map(lambda number: number**2, range(50)) == [n**2 for n in range(50)]


def test_another_seed_changes_nothing_but_the_seed():
    case = StopRunner().cases("slide-80")[0]
    other = seeded(case, 7)
    assert other.scenario.seed == 7
    assert other.scenario.model_copy(update={"seed": case.scenario.seed}) == case.scenario


@pytest.mark.parametrize(
    "name", ["slide-80", "slide-80-four-caliper", "wet-80-command", "dry-120", "slip-120"]
)
def test_studies_stop_on_the_rail_of_the_shipped_scenario(name):
    own = StopRunner().cases(name)
    shipped = load([SHIPPED / f"{name}.yaml"], ["rig.compensation=full"])
    for mine, theirs in zip(own, shipped, strict=True):
        for part in ("initial_speed", "brake", "rail", "rig", "vehicle"):
            assert getattr(mine.scenario, part) == getattr(theirs.scenario, part)
