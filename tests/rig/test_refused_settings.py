"""Settings that no rig can have are refused where the scenario is read."""

import pytest

from uictest.core.physics.air import LONGEST_DELAY_CYCLES
from uictest.plans.scenario import ScenarioErrors

TOO_LATE = f"{(LONGEST_DELAY_CYCLES + 1) * 10} ms"
PAYLOAD = "vehicle.payload=8 t"
VALVE = "brake.system.load_valve={empty_share: %s %%}"
AGAIN = "brake.command=[{at: 0 s, value: 60 %%}, {%s}]"
DRAG = "drag={speed: 60 km/h, duration: %s}"
MOTORS = "brake.dynamic={force: 60 kN, power: 1 MW, %s}"
SAND = "{wheelset: %s, rate: 2 kg/min}"
FIXED = f"sanders=[{SAND % 1}]"
MAGNETS = "brake.track={attraction: 100 kN, %s}"
FAILED = "faults=[{at: 0 s, part: %s, kind: failed}]"
BLOCKED = "faults=[{at: 0 s, wheelset: 2, part: sander, kind: blocked}]"
LOST = "faults=[{at: 20 km/h, wheelset: 1, part: speed-sensor, kind: lost}]"
REFUSED = [
    (["vehicle.load=full"], "this car has no payload"),
    ([PAYLOAD, "vehicle.load=9 t"], "more than the payload of 8 t"),
    ([PAYLOAD, "vehicle.load=laden"], "expected one of empty, full"),
    ([VALVE % 80], "no payload that the pressure could follow"),
    ([PAYLOAD, VALVE % 5], "5 %"),
    (["brake.command=[{at: 1 s, value: 60 %}]"], "times count from the first command"),
    (["brake.command=[{at: 0 s, value: 0 %}]"], "times count from the first command"),
    ([AGAIN % "at: 0 s, value: 80 %"], "0 s does not come after 0 s"),
    (["brake.command=[{at: 0 s, value: 60 %, position: Q}]"], "unknown brake position 'Q'"),
    (["brake.command=[{at: 0 s, value: 60}]"], "has no unit"),
    (["brake.command=[]"], "at least 1"),
    ([AGAIN % "at: 300 s, value: 80 %"], "ends after 180 s at the latest"),
    (["until=90 km/h"], "the stop begins at 80 km/h"),
    (["until=0 km/h"], "0 km/h"),
    (["drag={speed: 90 km/h, duration: 5 s}"], "comes to no higher speed"),
    (["until=30 km/h", LOST], "before 20 km/h"),
    ([DRAG % "10 s", "until=60 km/h"], "would end before 60 km/h is held"),
    (["drag={speed: 60 km/h}"], "duration"),
    ([DRAG % "200 s"], "cannot end within maximum_duration"),
    ([MOTORS % "fade_out: [5 km/h, 10 km/h]"], "10 km/h is not below 5 km/h"),
    ([MOTORS % "wheelsets: [1, 1]"], "wheelset 1 is named twice"),
    ([MOTORS % "wheelsets: [5]"], "wheelsets"),
    (["brake.dynamic={force: 60 kN}"], "power"),
    (["brake.dynamic={force: 60, power: 1 MW}"], "unit"),
    (["faults=[{at: 60 km/h, part: dynamic-brake, kind: failed}]"], "this car has no dynamic brake"),
    (["sanders=[{wheelset: 1}]"], "lays nothing"),
    ([f"sanders=[{SAND % 1}, {SAND % 1}]"], "wheelset 1 has two sanders"),
    ([f"sanders=[{SAND % 5}]"], "it must be at most 4"),
    (["sanders=[{wheelset: 1, rate: 2 kg/min, when: requested}]"], "built in asks for sand"),
    (["sanders=[{wheelset: 1, density: 7.5}]"], "g/m"),
    ([FIXED, BLOCKED], "wheelset 2 has no sander"),
    ([FIXED, "rig.wsp=bypassed"], "bypassed WSP never acts"),
    ([MAGNETS % "magnets: 3"], "3 magnets do not split over two bogies"),
    ([MAGNETS % "friction_speeds: [4 km/h, 9 km/h]"], "9 km/h is above 4 km/h"),
    (["brake.track={attraction: 100}"], "unit"),
    (["brake.track={magnets: 4}"], "attraction"),
    ([MAGNETS % "when: sometimes"], "emergency"),
    ([MAGNETS % "attracts: 1"], "attracts"),
    ([MAGNETS % "when: requested"], "no controller that is built in asks for the track brake"),
    ([FAILED % "track-brake"], "this car has no track brake"),
]
OUT_OF_RANGE = [
    ([f"brake.system.wsp_valve.switching_delay={TOO_LATE}"], "switching_delay"),
    (["simulation.time_step=0.01 ms", "rig.compensation=full"], "too short for the cylinder dynamics"),
]


@pytest.mark.parametrize(("settings", "message"), REFUSED)
def test_settings_that_cannot_be_are_refused(rig, settings, message):
    with pytest.raises(ScenarioErrors, match=message):
        rig.case(*settings)


@pytest.mark.parametrize(("settings", "message"), OUT_OF_RANGE)
def test_numbers_that_the_rig_cannot_hold_are_refused(rig, settings, message):
    with pytest.raises(ScenarioErrors, match=message):
        rig.parameters(*settings)
