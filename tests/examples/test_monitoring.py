"""The PI controller that reports deviating wheelsets, and the script that counts the verdicts on it."""

import sys
from pathlib import Path

import pytest

from uictest.controllers import Config
from uictest.plans.faults import FAULT_KINDS
from uictest.plans.scenario import load

PI = Path(__file__).parents[2] / "examples" / "pi"
FAULTS = PI / "monitoring.yaml"
CYCLE = 0.01
A, B, WITHIN = 50.0 / 3.6, 0.3, 10.0
"""m/s, 1 and s: the largest that the rule allows."""


@pytest.fixture
def beside(monkeypatch):
    """The two modules, imported as the script does; no later test of a controller beside them finds them."""
    monkeypatch.syspath_prepend(str(PI))
    import monitored_pi
    import monitoring

    yield monitored_pi, monitoring
    for name in ("monitored_pi", "monitoring", "pi_wsp"):
        sys.modules.pop(name, None)


def monitor(monitored_pi):
    parameters = {name: entry["default"] for name, entry in monitored_pi.PARAMETERS.items()}
    return monitored_pi.Monitor(Config(4, CYCLE, 40.0, (0.43,) * 4, parameters)), parameters


def test_a_locked_wheelset_is_reported_within_the_rule_but_no_deviation_that_ends_or_is_small(beside):
    monitored_pi, _ = beside
    own, p = monitor(monitored_pi)
    cycles = 0
    while not own.reports:
        own.watch(0.0, True, 40.0)
        cycles += 1
    assert own.reports == 1 << monitored_pi.ROTATION
    assert cycles * CYCLE == pytest.approx(p["report_after"], abs=2 * CYCLE)
    assert p["report_after"] < WITHIN
    assert p["monitored_speed"] <= A
    assert p["monitored_share"] <= B
    own, p = monitor(monitored_pi)
    within = 40.0 - p["monitored_speed"] - p["monitored_share"] * 40.0 + 0.01
    for cycle in range(3000):
        own.watch(within if cycle % 400 == 0 else 0.0, True, 40.0)
    assert own.reports == 0


def test_the_timer_gives_the_brake_back_and_reports(beside):
    monitored_pi, _ = beside
    own, p = monitor(monitored_pi)
    commands = [own.limited((1, 1), slides=True) for _ in range(2000)]
    filled = [place for place, command in enumerate(commands) if command == monitored_pi.FILL]
    assert own.reports == 1 << monitored_pi.TIMER
    assert filled[0] * CYCLE == pytest.approx(p["longest_release"], abs=2 * CYCLE)
    assert len(filled) * CYCLE == pytest.approx(p["return_time"], abs=2 * CYCLE)


OF_OTHER_TRAINS = ("dynamic-brake", "track-brake", "sander", "train-speed")


def test_the_scenario_has_every_kind_of_fault_that_its_train_can_have(beside):
    """It has no motors, track brake, sand or second source; those concern no wheelset that turns."""
    kinds = {(case.scenario.faults[0].part, case.scenario.faults[0].kind) for case in load([FAULTS])}
    lacking = {key for key in FAULT_KINDS if key[0] in OF_OTHER_TRAINS}
    assert kinds == set(FAULT_KINDS) - lacking
    assert all(FAULT_KINDS[key].report == "none" for key in lacking)


def test_a_row_counts_stops_by_their_verdicts(beside):
    _, table = beside
    met = dict.fromkeys((*table.DUE, "no-false-report", "safety-timer", table.STANDS), ("pass", 0.0))
    late = met | {"rotation-reported": ("fail", 11.0), "fault-reported": ("fail", 11.0)}
    watched = [met | {"report-time": ("pass", time)} for time in (2.0, 0.5, 4.0)]
    watched += [late | {"report-time": ("inconclusive", None), "no-false-report": ("fail", 1.0)}]
    stops = {table.WATCHER: watched, "threshold": [late, met], "slip-band": [met]}
    assert table.row("a", stops) == ["a", "4", "3, 2.0 (4.0)", "1", "1", "-", "-", "1", "-"]


@pytest.mark.slow
def test_stops_without_a_fault_are_clean_as_the_page_states(beside, capsys):
    beside[1].main(PI / "monitoring-sound.yaml")
    assert "| none | 12 | - | - | - | - | - |" in capsys.readouterr().out
    page = (PI.parents[1] / "docs" / "faults.md").read_text("utf-8")
    assert "all 12 stops without a fault are clean" in " ".join(page.split())
