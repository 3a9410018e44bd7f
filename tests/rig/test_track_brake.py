"""The magnetic track brake: its force and distance, when it acts, what it leaves of wheel loads and rail."""

import numpy as np
import pytest
from scipy.integrate import quad

from uictest.core.measures.catalogue.deceleration import initial_adhesion
from uictest.plans.scenario import load
from uictest.rig.assembly import assemble
from uictest.rig.external.in_process import run_in_process
from uictest.rig.lanes import run_trains_in_lanes
from uictest.rig.simulation import run_coupled
from uictest.rig.train_assembly import Coupling, assemble_train

EMERGENCY = "brake.position=emergency"
AT_ONCE = "delay: 0 s, rise_time: 1 ms"
MAGNETS = "brake.track={attraction: 100 kN, magnets: 4, off_below: 50 km/h}"
TO_REST = "brake.track={attraction: 100 kN, magnets: 4}"
CONSTANT = f"brake.track={{attraction: 100 kN, magnets: 4, {AT_ONCE}, friction_speeds: [9 km/h, 9 km/h]}}"
QUICK = f"brake.track={{attraction: 100 kN, magnets: 4, {AT_ONCE}}}"
COASTING = (
    *("rig.wsp=bypassed", "rig.topology=four-caliper", EMERGENCY),
    (
        "vehicle.wheelsets={1: {brake_force: 0 %}, 2: {brake_force: 0 %}, 3: {brake_force: 0 %},"
        " 4: {brake_force: 0 %}}"
    ),
    "vehicle.running_resistance={constant: 0 N, linear: 0 N s/m, quadratic: 0 N s2/m2}",
)
"""Nothing but the magnets slows this car."""
SLIPPERY = ("rail.condition=wet", "rail.friction=0.08")
CLEANED = ("rail.condition=wet-cleaning", "rail.friction=0.2", "brake.command=20 %")
KMH = 1.0 / 3.6
TURNING = 4.0 * 123.0 / 0.43**2
"""Mass that the rotation of the wheelsets stands for, kg."""


def friction_at(speed):
    """The formula, written with speeds in km/h as it is published."""
    return 0.095 * (speed / KMH + 9.26) / (speed / KMH + 4.63)


def mass_of(rig):
    return rig.case().scenario.vehicle.total_mass + TURNING


def when_at(columns, speed):
    """Time and distance at which the train comes down to a speed in m/s, between two samples."""
    falling = columns["speed"][::-1]
    return tuple(float(np.interp(speed, falling, columns[name][::-1])) for name in ("time", "distance"))


def test_the_formula_gives_its_published_values():
    assert [friction_at(v * KMH) for v in (0, 50, 100)] == pytest.approx([0.19, 0.103, 0.099], abs=6e-4)


@pytest.mark.parametrize("friction", [0.3, 0.08, 0.02])
def test_a_car_of_45_t_is_slowed_by_088_mps2_at_105_kmh_on_any_rail(rig, friction):
    rail = ("rail.condition=wet", f"rail.friction={friction}")
    stop = rig.columns(*rail, EMERGENCY, "initial_speed=120 km/h", QUICK)
    at_105 = np.argmin(abs(stop["speed"] - 105 * KMH))
    assert rig.case().scenario.vehicle.total_mass == pytest.approx(45e3, rel=0.01)
    assert stop["track_brake_force"][at_105] / 45e3 == pytest.approx(0.88, rel=2e-3)


def test_constant_friction_gives_the_distance_of_constant_deceleration(rig):
    stop = rig.columns(*COASTING, "initial_speed=120 km/h", CONSTANT, "until=18 km/h")
    fast, slow = 110 * KMH, 20 * KMH
    (t_0, s_0), (t_1, s_1) = when_at(stop, fast), when_at(stop, slow)
    deceleration = 0.095 * 400e3 / mass_of(rig)
    assert t_1 - t_0 == pytest.approx((fast - slow) / deceleration, rel=1e-3)
    assert s_1 - s_0 == pytest.approx((fast**2 - slow**2) / (2.0 * deceleration), rel=1e-3)


def test_the_distance_follows_the_integral_of_friction_over_speed(rig):
    stop = rig.columns(*COASTING, "initial_speed=120 km/h", QUICK, "until=4 km/h")
    fast, slow = 110 * KMH, 5 * KMH
    (t_0, s_0), (t_1, s_1) = when_at(stop, fast), when_at(stop, slow)
    per_force = mass_of(rig) / 400e3
    time, _ = quad(lambda v: per_force / friction_at(v), slow, fast)
    distance, _ = quad(lambda v: v * per_force / friction_at(v), slow, fast)
    assert (t_1 - t_0, s_1 - s_0) == pytest.approx((time, distance), rel=1e-3)


@pytest.mark.parametrize("rail", [("rail.condition=dry",), SLIPPERY])
@pytest.mark.parametrize("wsp", ["active", "bypassed"])
@pytest.mark.parametrize(("brake", "open_part"), [(MAGNETS, 1e-9), (TO_REST, 4e-9)])
def test_energy_closes(rig, rail, wsp, brake, open_part):
    """To rest the force falls within some ms, which shakes the dampers: their loss is that of whole steps."""
    measures = rig.stop(*rail, f"rig.wsp={wsp}", EMERGENCY, "initial_speed=120 km/h", brake).measures
    assert abs(measures.energy_residual) < open_part
    finer = ("simulation.time_step=0.25 ms", f"rig.wsp={wsp}", EMERGENCY, "initial_speed=120 km/h")
    assert abs(rig.stop(*rail, *finer, brake).measures.energy_residual) < 1e-9


def test_its_energy_is_force_over_distance_and_its_time_that_of_the_force(rig):
    overrides = (EMERGENCY, "initial_speed=120 km/h", MAGNETS)
    stop, measures = rig.columns(*overrides, every=2), rig.stop(*overrides).measures
    work = np.trapezoid(stop["track_brake_force"] * stop["speed"], stop["time"])
    assert measures.track_brake_energy == pytest.approx(work, rel=1e-3)
    acts = stop["time"][stop["track_brake_force"] > 0.0]
    assert measures.track_brake_time == pytest.approx(acts[-1] - acts[0], abs=0.03)


def test_it_comes_after_its_delay_and_is_off_below_its_speed(rig):
    stop = rig.columns(EMERGENCY, "initial_speed=120 km/h", MAGNETS)
    force = stop["track_brake_force"]
    assert stop["time"][force > 0.0][0] == pytest.approx(1.0, abs=0.03)
    whole = (stop["time"] > 1.3) & (stop["speed"] > 50.5 * KMH)
    assert force[whole] == pytest.approx(400e3 * friction_at(stop["speed"][whole]), rel=1e-3)
    let_go, _ = when_at(stop, 50 * KMH)
    assert np.all(force[stop["time"] > let_go + 0.25] == 0.0)


def test_without_a_speed_it_acts_to_standstill_and_moves_nothing_that_stands(rig):
    stop = rig.columns(EMERGENCY, "initial_speed=40 km/h", TO_REST, every=1)
    assert rig.stop(EMERGENCY, "initial_speed=40 km/h", TO_REST).measures.stopped == 1.0
    assert stop["track_brake_force"].max() == pytest.approx(400e3 * friction_at(0.0), rel=0.01)
    assert stop["speed"][-1] > -0.01  # the springs recoil


def test_a_strong_brake_at_a_long_step_stays_stable(rig):
    strong = "brake.track={attraction: 500 kN, magnets: 4}"
    measures = rig.stop(EMERGENCY, "initial_speed=60 km/h", strong, "simulation.time_step=1 ms").measures
    assert measures.stopped == 1.0
    assert abs(measures.energy_residual) < 1e-6


def test_magnets_and_rail_carry_the_attraction(rig):
    """The loads of the wheels shift, and their sum is the weight whatever the attraction."""
    stop = rig.columns(EMERGENCY, "initial_speed=120 km/h", MAGNETS)
    weight = rig.case().scenario.vehicle.total_mass * 9.80665
    steady = (stop["time"] > 3.0) & (stop["speed"] > 60 * KMH)
    assert 2.0 * stop["wheel_load"].sum(axis=1)[steady] == pytest.approx(weight, rel=1e-3)


@pytest.mark.parametrize(
    ("position", "when", "acts"),
    [("R", "emergency", False), ("emergency", "emergency", True), ("R", "always", True)],
)
def test_it_acts_in_the_position_that_is_said(rig, position, when, acts):
    brake = f"brake.track={{attraction: 100 kN, when: {when}}}"
    stop = rig.stop("initial_speed=60 km/h", f"brake.position={position}", brake)
    assert (stop.measures.track_brake_energy > 0.0) == acts


def test_it_follows_the_course_of_the_command(rig):
    course = (
        "brake.command=[{at: 0 s, value: 60 %}, {at: 2 s, value: 100 %, position: emergency},"
        " {at: 5 s, value: 0 %}]"
    )
    stop = rig.columns("initial_speed=120 km/h", course, "simulation.maximum_duration=8 s", TO_REST)
    acts = stop["time"][stop["track_brake_force"] > 0.0]
    assert acts[0] == pytest.approx(3.0, abs=0.03)
    assert acts[-1] == pytest.approx(5.2, abs=0.03)


def test_a_car_of_a_train_gets_its_command_later(rig):
    case = rig.case(EMERGENCY, "initial_speed=30 km/h", TO_REST)
    coupling = Coupling(distance=25.0, pipe_speed=50.0)
    train = run_coupled([case, case], coupling, steps_per_sample=20)
    first, second = (each.trace.train for each in train.cars)
    begins = [each["time"][each["track_brake_force"] > 0.0][0] for each in (first, second)]
    assert begins[1] - begins[0] == pytest.approx(0.5, abs=0.02)


def test_a_failed_one_does_not_come_and_one_that_fails_lets_go(rig):
    overrides = (EMERGENCY, "initial_speed=120 km/h", MAGNETS)
    never = "faults=[{at: 0 s, part: track-brake, kind: failed}]"
    without, failed = rig.stop(*overrides[:2]), rig.stop(*overrides, never)
    assert failed.measures.track_brake_energy == 0.0
    assert failed.measures.end_distance == without.measures.end_distance
    later = rig.columns(*overrides, "faults=[{at: 90 km/h, part: track-brake, kind: failed}]")
    at_90, _ = when_at(later, 90 * KMH)
    assert np.all(later["track_brake_force"][later["time"] > at_90 + 0.25] == 0.0)


def test_what_the_magnets_slow_of_their_own_car_or_another_is_no_adhesion_of_wheels(rig):
    overrides = (*SLIPPERY, "initial_speed=120 km/h", TO_REST)
    stops = [rig.stop(*overrides, position).measures for position in ("brake.position=R", EMERGENCY)]
    assert initial_adhesion(stops[0], 3.0).unavailable_reason == ""
    assert "track brake acted" in initial_adhesion(stops[1], 3.0).unavailable_reason
    slippery = (*SLIPPERY, "initial_speed=60 km/h", EMERGENCY)
    never = "faults=[{at: 0 s, part: track-brake, kind: failed}]"
    without, with_one, failed = (rig.case(*slippery, *more) for more in ((), (TO_REST,), (TO_REST, never)))
    for cars, unavailable in (
        ([without, without], [False, False]),
        ([without, with_one, failed], [True, True, True]),
        ([without, failed], [False, False]),
    ):
        coupling = Coupling(distance=25.0)
        train = [each.measures for each in run_coupled(cars, coupling).cars]
        reasons = [initial_adhesion(each, 3.0).unavailable_reason for each in train]
        assert ["track brake" in reason for reason in reasons] == unavailable
        (lanes,) = run_trains_in_lanes([assemble_train(cars, coupling)])
        assert [each.tobytes() for each in lanes.measures] == [each.tobytes() for each in train]


def test_stops_without_one_have_neither_energy_nor_time(rig):
    measures = rig.stop(EMERGENCY).measures
    assert np.isnan([measures.track_brake_energy, measures.track_brake_time]).all()


def cleaning(share):
    return f"brake.track={{attraction: 100 kN, friction_speeds: [9 km/h, 9 km/h], cleaning: {share} %}}"


def test_the_trailing_wheelset_of_a_bogie_finds_what_its_magnets_have_cleaned(rig):
    """Behind the magnets 1 - (1 - C)(1 - m), with m = 1 - exp(-W / Wc) of a share of their work per metre."""
    overrides = (*CLEANED, EMERGENCY, "initial_speed=120 km/h", "rail.condition.cleaning.carry_over=1")
    without, cleaned = (rig.columns(*overrides, cleaning(share)) for share in (0, 5))
    p, _ = rig.parameters(*overrides, cleaning(5))
    magnets = 1.0 - np.exp(-0.05 * 0.095 * 200e3 * p["cleaning_response"])
    at = np.searchsorted(cleaned["time"], 2.5)
    before, after = without["cleaned_share"][at], cleaned["cleaned_share"][at]
    assert after[0] == pytest.approx(before[0], rel=0.02)
    assert 1.0 - after[1] == pytest.approx((1.0 - before[1]) * (1.0 - magnets), rel=0.01)
    assert 1.0 - after[3] == pytest.approx((1.0 - before[3]) * (1.0 - magnets) ** 2, rel=0.01)


def test_without_a_share_it_cleans_nothing(rig):
    overrides = (*CLEANED, EMERGENCY, "initial_speed=60 km/h")
    assert rig.stop(*overrides, cleaning(0)).measures.end_distance == pytest.approx(
        rig.stop(*overrides, cleaning(0), magnet_cleaning=1e-12).measures.end_distance, rel=1e-9
    )


def test_the_rail_of_the_next_car_is_what_the_magnets_have_left(rig):
    cases = [
        rig.case(*CLEANED, EMERGENCY, "initial_speed=60 km/h", "rail.condition.cleaning.carry_over=1", brake)
        for brake in (cleaning(20), "brake.track=null")
    ]
    coupling = Coupling(distance=25.0)
    shares = [
        run_coupled(pair, coupling, steps_per_sample=20).cars[1].trace.wheelsets["cleaned_share"]
        for pair in (cases, cases[1:] * 2)
    ]
    assert shares[0][:, 0].max() > shares[1][:, 0].max() + 0.1


CONTROLLER = """\
from uictest.controllers import Outputs
class Wsp:
    contract = 2
    def __init__(self, config): pass
    def reset(self): pass
    def step(self, inputs):
        asks = 100 <= inputs.cycle < 300
        return Outputs([0] * 4, [0] * 4, track_brake_request=int(asks))
"""


@pytest.fixture
def asked(tmp_path, monkeypatch):
    """The trace of a stop whose controller asks for the track brake from 1 to 3 s."""
    monkeypatch.chdir(tmp_path)
    (tmp_path / "wsp.py").write_text(CONTROLLER)

    def trace(track, *overrides):
        path = tmp_path / "stop.yaml"
        path.write_text(
            "schema: uictest/scenario/1\nname: stop\ninitial_speed: 100 km/h\n"
            f"brake: {{track: {track}}}\ncontroller: {{python: wsp.py, class: Wsp}}\n"
        )
        return run_in_process(assemble(load([path], list(overrides))[0]), 20).trace.train

    return trace


def test_it_acts_while_a_controller_asks_for_it_where_the_scenario_says_so(asked):
    """A request that is not heard stays what it was."""
    requested = f"{{attraction: 100 kN, when: requested, {AT_ONCE}}}"
    silent = "faults=[{at: 2 s, part: controller, kind: silent, value: 3 s}]"
    for overrides, end in (((), 3.0), ((silent,), 5.0)):
        train = asked(requested, *overrides)
        acts = train["time"][train["track_brake_force"] > 0.0]
        assert (acts[0], acts[-1]) == pytest.approx((1.0, end), abs=0.03)
    assert asked(requested, "rig.wsp=bypassed")["track_brake_force"].max() == 0.0
    train = asked("{attraction: 100 kN}")
    assert train["track_brake_force"].max() == 0.0
    assert train["track_brake_request"].max() == 1.0


def test_a_brake_without_the_position_in_which_it_acts_is_refused(tmp_path):
    (tmp_path / "own.yaml").write_text("schema: uictest/brake/1\nname: own\nextends: ep-disc\n")
    path = tmp_path / "stop.yaml"
    path.write_text(
        "schema: uictest/scenario/1\nname: stop\ninitial_speed: 80 km/h\n"
        "brake: {system: own.yaml, track: {attraction: 100 kN}}\n"
    )
    scenario = load([path])[0].scenario
    positions = {"R": scenario.brake.system.positions["R"]}
    brake = scenario.brake.model_copy(
        update={"system": scenario.brake.system.model_copy(update={"positions": positions})}
    )
    assert [each.message for each in brake.inconsistencies()] == [
        "this brake has no position 'emergency', in which alone the track brake acts"
    ]
