"""Every kind of fault, judged by `uictest-wsp-faults`: which criteria the shipped controller misses."""

import pytest

from uictest.plans.faults import FAULT_KINDS
from uictest.plans.scenario import load
from uictest.running import campaign

VALUES = {
    ("speed-sensor", "factor"): "50 %",
    ("speed-sensor", "offset"): "30 km/h",
    ("speed-sensor", "jumps"): "40 km/h",
    ("speed-sensor", "drop-out"): "20 %",
    ("speed-sensor", "missing-teeth"): "2",
    ("fill-valve", "blocked"): "70 %",
    ("vent-valve", "blocked"): "70 %",
    ("wsp-valve", "slow"): "200 ms",
    ("tank", "leak"): "5e-9 m3/(s Pa)",
    ("brake-line", "leak"): "2e-8 m3/(s Pa)",
    ("pressure-sensor", "offset"): "2 bar",
    ("pressure-sensor", "factor"): "50 %",
    ("controller", "silent"): "2 s",
    ("train-speed", "offset"): "30 km/h",
}
LOCKED = {"locked-wheels", "total-locked-time"}
"""The faulty wheelset itself is locked for longer than a second."""
WORN = LOCKED | {"wheelset-contact-energy"}
"""It is locked for as long as the train runs."""
MISSED = {
    # It follows the other wheelset of its bogie, which slides less.
    **dict.fromkeys(
        [("speed-sensor", kind) for kind in ("lost", "stuck", "factor", "offset", "jumps")], LOCKED
    ),
    # It locks often, and never for long.
    ("speed-sensor", "drop-out"): {"total-locked-time"},
    ("vent-valve", "blocked"): {"total-locked-time"},
    # It cannot be vented, or fills meanwhile.
    ("hold-magnet", "open-circuit"): WORN,
    ("fill-valve", "stuck-open"): WORN,
    ("vent-magnet", "open-circuit"): WORN,
    ("vent-valve", "stuck-closed"): WORN,
    # Nobody protects anything.
    ("controller", "silent"): WORN | {"sound-wheelsets-turn"},
}
"""Criteria that are missed; all others pass or do not apply."""
OPTIONAL = {
    "dynamic-brake": "{dynamic: {force: 60 kN, power: 1.6 MW}}",
    "track-brake": "{position: emergency, track: {attraction: 100 kN}}",
}
"""Brakes that a car need not have."""
NOT_OF_A_SENSOR = "brake-force-returns"


def result_of(write, text):
    [case] = load([write("stop.yaml", f"schema: uictest/scenario/1\nname: stop\n{text}")])
    return campaign.run_stop(campaign.Stop(case), campaign.RecordingRequest("none")).case_run.result


def judged(write, part, kind, controller="threshold"):
    """The stop from 80 km/h on a slippery rail with a fault of wheelset 2 from 3 s on."""
    own = "" if part in ("brake-line", "controller", "train-speed", *OPTIONAL) else ", wheelset: 2"
    brake = f"brake: {OPTIONAL[part]}\n" if part in OPTIONAL else ""
    brake += "sanders: [{wheelset: 2, density: 7.5 g/m}]\n" if part == "sander" else ""
    value = f", value: {VALUES[part, kind]}" if (part, kind) in VALUES else ""
    sensors = "{speed: {method: whole-teeth}, extends: standard}" if kind == "missing-teeth" else "standard"
    sensors = "{train_speed: {}, extends: standard}" if part == "train-speed" else sensors
    return result_of(
        write,
        "initial_speed: 80 km/h\n"
        f"rail: {{condition: wet, friction: 0.09}}\nrig: {{sensors: {sensors}}}\ncontroller: {controller}\n"
        f"{brake}criteria: [uictest-wsp-faults, uictest-stop]\n"
        f"faults: [{{at: 3 s, part: {part}, kind: {kind}{own}{value}}}]\n",
    )


@pytest.mark.parametrize(("part", "kind"), FAULT_KINDS, ids="-".join)
def test_the_shipped_controller_misses_what_a_valve_can_no_longer_do(write, part, kind):
    result = judged(write, part, kind)
    statuses = {each.id: each.status for each in result.criteria}
    assert {name for name, status in statuses.items() if status == "fail"} == MISSED.get((part, kind), set())
    applies = statuses[NOT_OF_A_SENSOR] != "not_applicable"
    assert applies == (part == "speed-sensor")
    for balance in ("energy-balance", "air-balance", "air-energy-balance"):
        assert statuses[balance] == "pass"


@pytest.mark.parametrize(
    ("faults", "status", "outcome"),
    [
        ("[]", "not_applicable", "pass"),
        ("[{at: 100 s, wheelset: 2, part: speed-sensor, kind: lost}]", "inconclusive", "inconclusive"),
    ],
)
def test_a_stop_in_which_no_fault_begins_shows_no_reaction(write, faults, status, outcome):
    result = result_of(write, f"initial_speed: 20 km/h\ncriteria: uictest-wsp-faults\nfaults: {faults}\n")
    judged = [each.status for each in result.criteria if each.layer != "rig"]
    assert judged == ["pass", status, status, status]
    assert result.outcome == outcome


def test_the_simplest_controller_misses_them(write):
    lost = judged(write, "speed-sensor", "lost", "slip-band")
    stuck = judged(write, "speed-sensor", "stuck", "slip-band")
    failed = [{each.id for each in result.criteria if each.status == "fail"} for result in (lost, stuck)]
    assert "sound-wheelsets-turn" in failed[0]
    assert "reference-not-captured" in failed[1]
