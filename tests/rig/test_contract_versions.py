"""Versions of the contract of controllers: what version 2 does to the dynamic brake, and that 1 stays.

Stops are run in this process; every kind of controller is opened as in any stop.
"""

import shutil
from pathlib import Path

import numpy as np
import pytest

from uictest.controllers import ControllerError
from uictest.plans.scenario import load
from uictest.rig.assembly import assemble
from uictest.rig.external.in_process import BlockInputs, run_block, run_in_process
from uictest.rig.simulation import simulate

from ..c_compiler import build_library
from ..stop_bits import bits, stop_bits
from .conftest import controller_in_c

SLIP_BAND = Path(__file__).parents[1] / "sweeps" / "controllers" / "slip_band.py"
SCENARIO = """\
schema: uictest/scenario/1
name: stop
initial_speed: 60 km/h
brake: {dynamic: {force: 60 kN, power: 1.6 MW}}
"""
SLIPPERY = "rail: {condition: wet, friction: 0.07}\n"
PYTHON = """\
from uictest.controllers import Outputs
class Wsp:
    contract = 2
    def __init__(self, config): pass
    def reset(self): pass
    def step(self, inputs):
        late = inputs.cycle >= 600
        answer = Outputs([0, 0, 0, int(late)], [0] * 4, dynamic_reduction=[0, float(late), 0, 0.25])
        {change}
        return answer
"""
C = controller_in_c("""\
outputs->hold[3] = inputs->cycle >= 600;
    outputs->dynamic_reduction[1] = inputs->cycle >= 600;
    outputs->dynamic_reduction[3] = 0.25;
    CHANGE""")


@pytest.fixture
def stop_of(tmp_path, monkeypatch):
    """What the rig is given for a stop with a controller; more lines of YAML say how it differs."""
    monkeypatch.chdir(tmp_path)

    def case(controller, extra="", scenario=SCENARIO):
        path = tmp_path / "stop.yaml"
        path.write_text(f"{scenario}{extra}controller: {controller}\n")
        return load([path])[0]

    return case


@pytest.fixture
def python(tmp_path):
    """Write the class, changed in its last line but one."""

    def written(change="pass", name="wsp.py", text=PYTHON):
        (tmp_path / name).write_text(text.format(change=change) if "{change}" in text else text)
        return f"{{python: {name}, class: Wsp}}"

    return written


@pytest.fixture
def library(tmp_path):
    """Compile the same in C."""

    def built(change="", name="libwsp.so", text=C):
        (tmp_path / "wsp.c").write_text(text.replace("CHANGE", change))
        build_library(tmp_path / name, tmp_path / "wsp.c")
        return f"{{library: {name}}}"

    return built


def test_a_reduction_takes_the_brake_of_its_wheelset_within_the_response_and_of_no_other(stop_of, python):
    """With a lag of 0.3 s, exp(-5) is left of it after 1.5 s; a hold does not drop the dynamic brake."""
    stop = run_in_process(assemble(stop_of(python())), 20)
    train, torque = stop.trace.train, stop.trace.wheelsets["dynamic_torque"]
    before, after = np.searchsorted(train["time"], [5.99, 7.5])
    share = torque[after] / torque[before]
    assert share[1] == pytest.approx(np.exp(-5.0), rel=0.05)
    # What each of the others gives is limited by the demand, and by how the train slows down meanwhile.
    assert share[0] == pytest.approx(share[2], rel=1e-3)
    assert share[0] > 0.9
    assert torque[after, 3] / torque[after, 0] == pytest.approx(0.75, rel=1e-3)
    assert abs(stop.measures.energy_residual) < 1e-9
    assert stop.car.dynamic_dropped == 0.0


def test_friction_makes_up_for_what_a_controller_takes_off(stop_of, python):
    """Dry, from the first cycle on without three of four motors: as a car with the fourth alone."""
    taken_off = "answer = Outputs([0] * 4, [0] * 4, dynamic_reduction=[1.0, 1.0, 1.0, 0.0])"
    alone = SCENARIO.replace("{force: 60 kN, power: 1.6 MW}", "{force: 15 kN, power: 0.4 MW, wheelsets: [4]}")
    stop = run_in_process(assemble(stop_of(python(taken_off))), 20).trace
    one_motor = run_in_process(assemble(stop_of("threshold", scenario=alone)), 20).trace
    for seconds in (4.0, 8.0):
        place = round(seconds / 0.01)
        assert stop.wheelsets["brake_torque"][place].sum() == pytest.approx(
            one_motor.wheelsets["brake_torque"][place].sum(), rel=0.01
        )
    assert stop.train["demanded_pressure"][400] > 0.6 * one_motor.train["demanded_pressure"].max()


def test_a_vented_caliper_comes_back_to_the_force_of_the_others(stop_of, python):
    """It squeezes anew, so the pressure that holds the force of the others would leave it a loop below."""
    vented = "answer = Outputs(*[[0, 0, 0, int(500 <= inputs.cycle < 550)]] * 2)"
    weak = SCENARIO.replace("60 kN, power: 1.6 MW", "24 kN, power: 400 kW")
    stop = run_in_process(
        assemble(stop_of(python(vented), "rig: {topology: four-caliper}\n", weak)), 20
    ).trace
    friction = stop.wheelsets["brake_torque"] - stop.wheelsets["dynamic_torque"]
    assert friction[540, 3] < 0.3 * friction[540, 2]
    assert friction[499, 3] == pytest.approx(friction[499, 2], rel=0.02)
    assert friction[800, 3] == pytest.approx(friction[800, 2], rel=0.02)


def test_what_it_is_given_is_what_the_motor_gives_and_the_load_of_an_axle(stop_of, python):
    shown = (
        "answer.reference_speed = [inputs.dynamic_brake[1], inputs.axle_load, inputs.brake_command,"
        " inputs.brake_demand][inputs.cycle % 4]"
    )
    case = stop_of(python(shown))
    inputs = assemble(case)
    stop = run_in_process(inputs, 20)
    seen = stop.trace.train["reference_speed"][1:]  # behind each cycle, of which the answer holds
    load_of_axle = case.scenario.vehicle.total_mass * 9.80665 / 4.0
    assert seen[1::4] == pytest.approx(load_of_axle)
    assert seen[2::4] == pytest.approx(1.0)
    assert seen[3] == 0.0  # the demand follows the command with the delays of the brake
    effort = seen[0::4]
    assert effort.max() <= 1.0
    assert effort[149] > 0.5
    assert effort[300:].max() < 1e-3


def test_requests_are_recorded_of_version_2_alone(stop_of, python):
    asking = "answer.sand_request, answer.track_brake_request = [0, 0, 1, 0], late"
    recording = simulate(stop_of(python(asking)), 0.1, run_in_process).recording
    time = recording["time"]
    assert set(recording["sand_request_3"]) == {1.0}
    assert set(recording["sand_request_1"]) == {0.0}
    assert np.array_equal(recording["track_brake_request"], (time > 6.0 + 1e-9).astype(float))
    assert np.array_equal(recording["dynamic_reduction_2"], (time > 6.0 + 1e-9).astype(float))
    of_version_1 = PYTHON.replace("    contract = 2\n", "").format(change="answer.dynamic_reduction = None")
    old = simulate(stop_of(python(text=of_version_1)), 0.1, run_in_process).recording
    added = {"track_brake_request", *(f"sand_request_{n}" for n in (1, 2, 3, 4))}
    assert recording.channels.keys() - old.channels.keys() == added


def test_a_sander_lays_sand_when_the_controller_of_a_car_asks_for_it(stop_of, python):
    sander = "sanders: [{wheelset: 3, rate: 2 kg/min, when: requested, delay: 0 s, off_below: 0 km/h}]\n"
    asking = "answer.sand_request = [1, 0, late, 0]"
    stop = run_in_process(assemble(stop_of(python(asking), sander)), 20)
    time, sanding = stop.trace.train["time"], stop.trace.wheelsets["sanding"]
    assert np.array_equal(sanding[:, 2], (time > 6.0 + 1e-9).astype(float))
    assert not sanding[:, [0, 1, 3]].any()
    assert stop.wheelset_measures.sand_laid[2] == pytest.approx(
        (stop.measures.end_time - 6.0) / 30.0, abs=0.02 / 30.0
    )


def test_a_library_gives_the_bits_of_the_class_alone_and_in_lanes(stop_of, python, library):
    case = stop_of(python(), SLIPPERY)
    expected = run_in_process(assemble(case))
    other = assemble(stop_of(library(), SLIPPERY))
    assert bits(run_in_process(other)) == bits(expected)
    stops = [other, assemble(stop_of("threshold", SLIPPERY)), assemble(case)]
    run = run_block(BlockInputs.of(stops))
    assert run.failures == ["", "", ""]
    for place in (0, 2):
        own = run.measures[place].tobytes() + run.wheelset_measures[place].tobytes()
        assert own == bits(expected)


def test_a_controller_of_version_1_has_the_bits_of_the_one_that_is_built_in(stop_of, tmp_path):
    """Beside a dynamic brake, which it loses."""
    shutil.copy(SLIP_BAND, tmp_path)
    built_in = run_in_process(assemble(stop_of("slip-band", SLIPPERY)))
    outside = run_in_process(assemble(stop_of("{python: slip_band.py, class: SlipBand}", SLIPPERY)))
    own, theirs = (stop_bits(each.measures, each.wheelset_measures) for each in (built_in, outside))
    assert theirs == own
    assert (outside.contract, outside.car.dynamic_dropped) == (1, 1.0)


NO_SHARE = r"^the reduction of the dynamic brake of wheelset 3 is %s, expected 0 to 1 \(cycle 650\)$"
AT = "if inputs.cycle == 650: "
IN_PYTHON = {
    f"{AT}answer.dynamic_reduction[2] = float('nan')": NO_SHARE % "nan",
    f"{AT}answer.dynamic_reduction[2] = 1.01": NO_SHARE % r"1\.01",
    f"{AT}answer.dynamic_reduction[2] = -1e-9": NO_SHARE % "-1e-09",
    f"{AT}answer.dynamic_reduction = [0.0]": r"dynamic_reduction has 1 values, expected 4 \(cycle 650\)$",
    f"{AT}answer.dynamic_reduction[2] = 'all'": r"dynamic_reduction\[2\] is 'all', expected a number",
    f"{AT}answer.sand_request = [0, 2, 0, 0]": r"sand_request\[1\] is 2, expected 0 or 1 \(cycle 650\)$",
    f"{AT}answer.dynamic_reduction[2] = 10**400": r"dynamic_reduction\[2\] is 1000+, expected a number",
    f"{AT}answer.sand_request = [[0, 1]] * 4": r"sand_request\[0\] is \[0, 1\], expected 0 or 1",
    f"{AT}answer.track_brake_request = 7": r"track_brake_request is 7, expected 0 or 1 \(cycle 650\)$",
    f"{AT}import numpy; answer.track_brake_request = numpy.ones(2)": r"track_brake_request is array\(",
    f"{AT}answer.diagnosis = '7'": r"diagnosis is '7', expected a whole number of 32 bits",
}
IN_C = {
    "outputs->dynamic_reduction[2] = 0.0 / 0.0;": NO_SHARE.replace("650", "0") % "-?nan",
    "outputs->sand_request[3] = 2;": r"^a request .* sand at wheelset 4 2, track brake 0 \(cycle 0\)$",
    "outputs->track_brake_request = -1;": r"^a request .*, track brake -1 \(cycle 0\)$",
    "((char *)(outputs + 1))[0] = 0;": r"^the controller wrote beyond its outputs \(cycle 0\)$",
}


@pytest.mark.parametrize(
    ("kind", "change"), [("python", each) for each in IN_PYTHON] + [("library", each) for each in IN_C]
)
def test_what_is_no_reduction_or_request_ends_the_stop(stop_of, kind, change, request):
    controller = request.getfixturevalue(kind)(change)
    with pytest.raises(ControllerError, match=(IN_PYTHON | IN_C)[change]):
        run_in_process(assemble(stop_of(controller)))


@pytest.mark.parametrize(
    ("before", "after", "message"),
    [
        ("    contract = 2\n", "", "dynamic_reduction belongs to contract version 2, and the controller is"),
        ("contract = 2", "contract = 3", "class Wsp is of contract version 3, expected 1 or 2"),
        ("contract = 2", "contract = '2'", "class Wsp is of contract version '2', expected 1 or 2"),
    ],
)
def test_a_version_that_is_not_stated_or_unknown_is_said(stop_of, python, before, after, message):
    controller = python(text=PYTHON.replace(before, after).replace("{change}", "pass"))
    with pytest.raises(ControllerError, match=message):
        run_in_process(assemble(stop_of(controller)))


C_1 = C.replace("return UICTEST_ABI_VERSION;", "return 1;").replace("outputs->dynamic_reduction", "0;//")
"""A library that says that it is of version 1, though its outputs are those of version 2."""
REQUESTS = ("outputs->sand_request[1] = 1;", "outputs->track_brake_request = 1;")


@pytest.mark.parametrize("request_of_version_2", REQUESTS)
def test_a_request_of_a_library_of_version_1_ends_the_stop(stop_of, library, request_of_version_2):
    controller = library(request_of_version_2, text=C_1)
    with pytest.raises(ControllerError, match=r"wrote beyond its outputs \(cycle 0\)$"):
        run_in_process(assemble(stop_of(controller)))
    run_in_process(assemble(stop_of(library(name="libquiet.so", text=C_1))))


@pytest.mark.parametrize("versions", ["1, 2", "2, 77"])
def test_a_library_is_of_the_version_that_it_has_stated_first(stop_of, library, versions):
    body = f"static int call; static const uint32_t versions[] = {{{versions}}}; return versions[call++ > 0];"
    controller = library(name=f"libasked{versions[0]}.so", text=C_1.replace("return 1;", body))
    stop = run_in_process(assemble(stop_of(controller)))
    assert stop.contract == int(versions[0])


PARTS = {
    "sander": (SCENARIO, "sanders: [{wheelset: 3, rate: 2 kg/min, when: requested}]\n"),
    "track brake": (SCENARIO.replace("1.6 MW}", "1.6 MW}, track: {attraction: 50 kN, when: requested}"), ""),
}


@pytest.mark.parametrize("part", PARTS)
def test_no_part_waits_for_a_request_that_a_controller_cannot_make(stop_of, python, part):
    """Neither in a stop alone nor in a block; a controller of version 2 need not ask."""
    scenario, further = PARTS[part]
    text = PYTHON.replace("    contract = 2\n", "").replace("{change}", "answer.dynamic_reduction = None")
    old = assemble(stop_of(python(text=text), further, scenario))
    message = f"keeps contract version 1 and can ask for no {part}, which the scenario has"
    with pytest.raises(ControllerError, match=message):
        run_in_process(old)
    assert message in run_block(BlockInputs.of([old])).failures[0]
    assert run_in_process(assemble(stop_of(python(), further, scenario))).contract == 2


def test_with_the_wsp_bypassed_nothing_is_taken_off(stop_of, python):
    stop = run_in_process(assemble(stop_of(python(), "rig: {wsp: bypassed}\n")), 20)
    assert not stop.trace.wheelsets["dynamic_reduction"].any()
    assert np.ptp(stop.trace.wheelsets["dynamic_torque"][700]) < 1.0


def test_a_silent_controller_keeps_its_reduction_and_then_loses_it(stop_of, python):
    fault = "faults: [{at: 6.5 s, until: 8 s, part: controller, kind: silent, value: 500 ms}]\n"
    stop = run_in_process(
        assemble(stop_of(python("answer.dynamic_reduction[1] *= inputs.time < 6.7"), fault)), 20
    )
    time, reduction = stop.trace.train["time"], stop.trace.wheelsets["dynamic_reduction"][:, 1]
    assert reduction[(time > 6.01) & (time < 7.0)].min() == 1.0
    assert reduction[time > 7.02].max() == 0.0
