"""The PI controller that reports deviating wheelsets, and the script that judges its reports."""

import math
import sys
from pathlib import Path

import pytest

from uictest.controllers import Config

PI = Path(__file__).parents[2] / "examples" / "pi"
CYCLE = 0.01


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


def test_a_locked_wheelset_is_reported_within_the_rule(beside):
    monitored_pi, rule = beside
    own, p = monitor(monitored_pi)
    cycles = 0
    while not own.reports:
        own.watch(0.0, True, 40.0)
        cycles += 1
    assert own.reports == 1 << monitored_pi.ROTATION
    assert cycles * CYCLE == pytest.approx(p["report_after"], abs=2 * CYCLE)
    assert p["report_after"] < rule.WITHIN
    assert p["monitored_speed"] <= rule.A
    assert p["monitored_share"] <= rule.B


def test_a_deviation_that_ends_or_is_small_is_not_reported(beside):
    own, p = monitor(beside[0])
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


@pytest.mark.parametrize(
    ("wheel_speed", "reported_at", "place", "verdict"),
    [
        (0.0, 9.0, 1, "reported"),
        (0.0, 11.0, 1, "reported too late"),
        (0.0, math.inf, 1, "not reported"),
        (0.0, 9.0, 2, "wrongly reported: wheelset 3"),
        (40.0, math.inf, 1, "not required"),
        (40.0, 9.0, 1, "reported, not required"),
    ],
)
def test_reports_are_judged_by_the_true_speed(beside, wheel_speed, reported_at, place, verdict):
    stop = beside[1].Watched("brake cut-out")
    for second in range(21):
        stop.observe(float(second), wheel_speed, 40.0, (second >= reported_at) << place)
    assert stop.verdict == verdict


@pytest.mark.slow
def test_the_page_shows_what_the_script_prints(beside, capsys):
    beside[1].main(PI / "monitoring.yaml")
    assert capsys.readouterr().out in (PI.parents[1] / "docs" / "faults.md").read_text("utf-8")


def test_a_stop_reports_what_locks_and_nothing_without_a_fault(beside):
    _, rule = beside
    scenario = PI / "monitoring.yaml"
    cases = {rule.fault_of(case): case.id for case in rule.load([scenario])}
    sound = rule.watched(scenario, cases["none"], "none")
    assert sound.reports == {}
    fault = "vent-magnet open-circuit"
    assert rule.watched(scenario, cases[fault], fault).verdict == "reported"
