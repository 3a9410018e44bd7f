from __future__ import annotations

from dataclasses import replace
from pathlib import Path

import pytest

from studies import stop_runner
from studies.stop_runner import StopRunner, seeded
from uictest import rig
from uictest.plans.scenario import Case, load

SHIPPED = Path(__file__).parents[2] / "scenarios"


@pytest.fixture
def runs(monkeypatch: pytest.MonkeyPatch) -> list[tuple[str, int]]:
    """Let stops come out as their seed; the stops that were run, as id and seed."""
    done: list[tuple[str, int]] = []

    def stop(case: Case) -> int:
        done.append((case.id, case.scenario.seed))
        return case.scenario.seed

    monkeypatch.setattr(stop_runner, "_stop", stop)
    return done


def test_a_stop_is_run_once(runs: list[tuple[str, int]]) -> None:
    bench = StopRunner()
    cases = bench.cases("wet-80-command")
    first = bench.repeated(cases[:2], range(3))
    again = bench.repeated(cases, range(2, 5))
    assert [[*map(str, each.stops)] for each in first] == [["0", "1", "2"]] * 2
    assert [[*map(str, each.stops)] for each in again] == [["2", "3", "4"]] * 3
    assert len(runs) == len(set(runs)) == 6 + 7


def test_cases_of_the_same_id_are_different_stops(runs: list[tuple[str, int]]) -> None:
    bench = StopRunner()
    cases = [bench.cases("slide-80", f"rig.compensation={setting}")[0] for setting in ("none", "full")]
    assert cases[0].id == cases[1].id
    bench.repeated(cases, [0])
    assert len(runs) == 2


def test_the_id_seeds_the_noise_so_that_another_id_is_another_stop(runs: list[tuple[str, int]]) -> None:
    bench = StopRunner()
    case = bench.cases("slide-80")[0]
    bench.repeated([case, replace(case, id="other")], [0])
    assert [name for name, _ in runs] == [case.id, "other"]


def test_work_is_returned_in_order() -> None:
    assert StopRunner(jobs=3).map(lambda number: number**2, range(50)) == [n**2 for n in range(50)]


def test_another_seed_changes_nothing_but_the_seed() -> None:
    case = StopRunner().cases("slide-80")[0]
    other = seeded(case, 7)
    assert other.scenario.seed == 7
    assert other.scenario.model_copy(update={"seed": case.scenario.seed}) == case.scenario


@pytest.mark.parametrize(
    "name", ["slide-80", "slide-80-four-caliper", "wet-80-command", "dry-120", "slip-120"]
)
def test_studies_stop_on_the_rail_of_the_shipped_scenario(name: str) -> None:
    own = StopRunner().cases(name)
    shipped = load([SHIPPED / f"{name}.yaml"], ["rig.compensation=full"])
    for mine, theirs in zip(own, shipped, strict=True):
        for part in ("initial_speed", "brake", "rail", "rig", "vehicle"):
            assert getattr(mine.scenario, part) == getattr(theirs.scenario, part)


def test_stops_in_lanes_have_the_bits_of_stops_alone(stop_runner: StopRunner) -> None:
    """Rails with one point and with several, side by side."""
    step = "{interpolation: steps, points: [{position: 0 m, friction: 0.3}, {position: 90 m, friction: 0.1}]}"
    cases = [
        *stop_runner.cases("slide-80", "rail.friction=0.14,0.17"),
        *stop_runner.cases("slide-80", f"rail.friction={step}"),
    ]
    for case, stop in zip(cases, stop_runner.in_lanes(cases), strict=True):
        alone = rig.simulate(case)
        assert stop.measures.tobytes() == alone.measures.tobytes()
        assert stop.wheelset_measures.tobytes() == alone.wheelset_measures.tobytes()


def test_no_stops_in_lanes_are_none(stop_runner: StopRunner) -> None:
    assert stop_runner.in_lanes([]) == []
