"""Sanders: balance of the sand on the rail, what decides when they lay it, and what it does."""

import numpy as np
import pytest

from uictest.plans.scenario import load
from uictest.rig.simulation import Coupling, run_coupled, simulate

WET = ("initial_speed=80 km/h", "rail.condition=wet", "rail.friction=0.05")
ALWAYS = "when: always, off_below: 0 km/h, delay: 0 s"
FIXED = f"sanders=[{{wheelset: 1, rate: 2 kg/min, {ALWAYS}}}]"
VARIABLE = f"sanders=[{{wheelset: 1, density: 7.5 g/m, rate: 60 kg/min, {ALWAYS}}}]"
TABLE = (0, 1, 2, 3, 4, 6, 8), (0, 0.112, 0.211, 0.299, 0.378, 0.509, 0.613)
"""g/m and the share of the way that they go."""
COUPLED = Coupling(distance=26.4)


def rolling(columns):
    """Samples after the last wheelset has reached what the nozzle has laid, until the train crawls."""
    return (columns["distance"] > 25.0) & (columns["speed"] > 3.0)


def test_a_fixed_sander_lays_its_rate_for_the_time_of_the_stop_a_variable_one_its_density(rig):
    stop = rig.stop(*WET, FIXED)
    laid, within = (stop.wheelset_measures[name] for name in ("sand_laid", "sand_in_30_s"))
    time = stop.measures.end_time
    assert laid[0] == pytest.approx(2.0 / 60.0 * time, abs=2.0 / 60.0 * 0.02)
    assert stop.wheelset_measures.longest_sanding[0] == pytest.approx(time, abs=0.02)
    assert time < 30.0
    assert within[0] == laid[0]
    assert laid[1:].tolist() == [0.0, 0.0, 0.0]
    assert np.isnan(rig.stop(*WET).wheelset_measures.sand_laid).all()
    variable = rig.stop(*WET, VARIABLE)
    expected = 0.0075 * variable.measures.end_distance
    assert variable.wheelset_measures.sand_laid[0] == pytest.approx(expected, abs=0.002)


def test_the_window_of_30_s_holds_30_s(rig):
    stop = rig.stop("initial_speed=120 km/h", "rail.condition=wet", "rail.friction=0.02", FIXED)
    assert stop.measures.end_time > 35.0
    assert stop.wheelset_measures.sand_in_30_s[0] == pytest.approx(1.0, rel=0.01)
    assert stop.wheelset_measures.sand_in_30_s[0] <= 1.0 + 2.0 / 60.0 * 0.0101


def test_density_behind_a_nozzle_is_rate_over_speed_and_each_wheelset_leaves_its_share(rig):
    columns = rig.columns(*WET, FIXED)
    distance, speed, met = columns["distance"], columns["speed"], columns["sand_density"]
    behind = np.array([0.0, 2.5, *(rig.parameters()[0].half_pivot_distance * 2.0 + np.array([0.0, 2.5]))])
    at = rolling(columns)
    for i in range(4):
        # The nozzle stood 0.3 m ahead of the first wheelset when it was over this place.
        then = np.interp(distance[at] - behind[i] - 0.3, distance, speed)
        expected = 0.8**i * 2.0 / 60.0 / then
        np.testing.assert_allclose(met[at, i], expected, rtol=0.02)


@pytest.mark.parametrize("kept", [0.0, 0.5, 1.0])
def test_a_variable_sander_gives_all_wheelsets_a_constant_density(rig, kept):
    columns = rig.columns(*WET, VARIABLE, f"rail.sand.kept={kept}")
    at = rolling(columns)
    for i in range(4):
        np.testing.assert_allclose(columns["sand_density"][at, i], 0.0075 * kept**i, rtol=1e-9, atol=1e-15)


def test_no_sand_is_lost_where_a_cycle_takes_a_train_further_than_a_wheelbase(rig):
    """At 250 km/h with 50 ms: 3.5 m, so that a ring is written and read over in one cycle."""
    overrides = ("initial_speed=250 km/h", "rail.condition=wet", "controller.cycle_time=50 ms", VARIABLE)
    cases = [rig.case(*overrides), rig.case(*overrides[:-1])]
    train = run_coupled(cases, COUPLED, steps_per_sample=100)
    for j, car in enumerate(train.cars):
        met, moved = car.trace.wheelsets["sand_density"], car.trace.train["distance"]
        at = (moved > 60.0) & (car.trace.train["speed"] > 3.0)
        expected = np.full((at.sum(), 4), 0.0075) * 0.8 ** np.arange(4 * j, 4 * j + 4)
        np.testing.assert_allclose(met[at], expected, rtol=1e-9)


def test_nozzles_add_to_what_lies_before_them(rig):
    one, other = (f"{{wheelset: {n}, density: 5 g/m, rate: 60 kg/min, {ALWAYS}}}" for n in (1, 3))
    columns = rig.columns(*WET, f"sanders=[{one}, {other}]")
    met = columns["sand_density"][rolling(columns)]
    np.testing.assert_allclose(met, np.array([1.0, 0.8, 1.64, 1.312]) * np.full(met.shape, 0.005), rtol=1e-9)


def test_a_variable_sander_reaches_its_density_only_where_its_rate_suffices(rig):
    columns = rig.columns(*WET, f"sanders=[{{wheelset: 1, density: 7.5 g/m, rate: 4 kg/min, {ALWAYS}}}]")
    met, speed = columns["sand_density"][:, 0], columns["speed"]
    fast = rolling(columns) & (speed > 10.0)
    np.testing.assert_allclose(met[fast], 4.0 / 60.0 / speed[fast], rtol=0.02)
    slow = rolling(columns) & (speed < 8.5)
    np.testing.assert_allclose(met[slow], 0.0075, rtol=1e-9)


@pytest.mark.parametrize(
    "rail",
    [(), ("rail.cleaning={energy: 5300 J/m, recovered_friction: 0.28, reach: 0.5 m, carry_over: 0.5}",)],
)
def test_friction_goes_a_share_of_the_way_from_what_is_cleaned(rig, rail):
    columns = rig.columns(*WET, VARIABLE, *rail)
    cleaned = 0.05 + columns["cleaned_share"] * (0.28 - 0.05)
    density = 1e3 * columns["sand_density"]
    share = np.interp(density, *TABLE)
    np.testing.assert_allclose(
        columns["friction"], cleaned + share * np.maximum(0.3 - cleaned, 0.0), rtol=1e-9
    )


def test_locked_wheels_on_sand_decelerate_by_the_mean_friction_of_the_wheelsets(rig):
    """m a = m g mean(mu0), where friction does not fall with slip; the same resistance is in both."""
    locked = ("rig.wsp=bypassed", "rail.condition.friction_decay=0 s/m", "rail.sand.friction=0.1")
    slowing = []
    for extra in ((), (VARIABLE,)):
        columns = rig.columns(*WET, *locked, *extra)
        at = (columns["speed"] > 10.0) & (columns["speed"] < 13.0)
        assert columns["wheel_speed"][at].max() < 1e-6
        slowing.append(-np.polyfit(columns["time"][at], columns["speed"][at], 1)[0])
    share = np.interp(7.5 * 0.8 ** np.arange(4), *TABLE)
    gained = 9.80665 * (share * (0.1 - 0.05)).mean()
    assert slowing[1] - slowing[0] == pytest.approx(gained, rel=0.01)


@pytest.mark.parametrize("rail", ["rail.friction=0.05", "rail.condition=wet-cleaning"])
def test_sand_that_does_nothing_keeps_every_bit_of_the_stop(rig, rail):
    names = [name for name in rig.stop().wheelset_measures.dtype.names if "sand" not in name]
    without, sanded = rig.stop(*WET, rail), rig.stop(*WET, rail, VARIABLE, "rail.sand.friction=0.001")
    assert without.measures.tobytes() == sanded.measures.tobytes()
    for name in names:
        assert without.wheelset_measures[name].tobytes() == sanded.wheelset_measures[name].tobytes()


def test_more_sand_shortens_a_slippery_stop_and_hardly_one_on_a_dry_rail(rig):
    dry = ("initial_speed=80 km/h", "rail.condition=dry")
    distance = rig.stop(*dry).measures.end_distance
    assert rig.stop(*dry, VARIABLE).measures.end_distance == pytest.approx(distance, rel=0.002)
    distances = [
        rig.stop(
            *WET, f"sanders=[{{wheelset: 1, density: {d} g/m, rate: 60 kg/min, {ALWAYS}}}]"
        ).measures.end_distance
        for d in (1, 4, 16)
    ]
    assert rig.stop(*WET).measures.end_distance > distances[0] > distances[1] > distances[2]


def test_a_blocked_sander_is_none_from_when_it_is_blocked(rig):
    fault = "faults=[{at: %s, wheelset: 1, part: sander, kind: blocked}]"
    blocked = rig.stop(*WET, VARIABLE, fault % "0 s")
    assert blocked.wheelset_measures.sand_laid[0] == 0.0
    assert blocked.measures.end_distance == rig.stop(*WET).measures.end_distance
    late = rig.columns(*WET, VARIABLE, fault % "5 s")
    assert late["sanding"][:, 0].tolist() == (late["time"] < 5.005).astype(float).tolist()


def test_a_demand_reaches_the_rail_after_the_delay_and_ends_below_a_speed(rig):
    columns = rig.columns(
        *WET, "sanders=[{wheelset: 2, rate: 2 kg/min, when: always, delay: 0.7 s, off_below: 20 km/h}]"
    )
    begins = columns["time"][np.argmax(columns["sanding"][:, 1] > 0.0)]
    assert begins == pytest.approx(0.71, abs=0.011)
    below = columns["time"][np.argmax(columns["speed"] < 20.0 / 3.6)]
    ends = columns["time"][columns["sanding"][:, 1] > 0.0][-1]
    assert ends == pytest.approx(below + 0.7, abs=0.03)


def test_wheels_that_do_not_slide_demand_no_sand(rig):
    sliding = "sanders=[{wheelset: 1, density: 7.5 g/m}]"
    dry = rig.stop("initial_speed=80 km/h", "rail.condition=dry", sliding)
    assert dry.wheelset_measures.sand_laid[0] == 0.0
    columns = rig.columns(*WET, sliding, every=1)
    acts = columns["valve_command"].max(axis=1) > 0.0
    first = columns["time"][np.argmax(acts)]
    begins = columns["time"][np.argmax(columns["sanding"][:, 0] > 0.0)]
    assert begins - first >= 0.2 + 0.5 - 0.011


def test_sand_of_one_car_is_met_by_the_next(rig):
    cases = [rig.case(*WET, VARIABLE), rig.case(*WET)]
    train = run_coupled(cases, COUPLED, steps_per_sample=20)
    met = train.cars[1].trace.wheelsets["sand_density"]
    at = (train.cars[1].trace.train["distance"] > 50.0) & (train.cars[1].trace.train["speed"] > 3.0)
    np.testing.assert_allclose(met[at], np.full((at.sum(), 4), 0.0075) * 0.8 ** np.arange(4, 8), rtol=1e-9)
    plain = run_coupled([rig.case(*WET)] * 2, COUPLED)
    assert train.cars[1].measures.end_distance < plain.cars[1].measures.end_distance


def test_a_car_of_a_train_records_the_sand_of_the_cars_before_it(tmp_path):
    path = tmp_path / "train.yaml"
    sander = "{wheelset: 3, density: 7.5 g/m, rate: 60 kg/min, when: always}"
    path.write_text(
        "schema: uictest/scenario/1\nname: sanded\ninitial_speed: 40 km/h\n"
        f"train: [{{sanders: [{sander}]}}, {{}}]\nrail: {{condition: wet, friction: 0.05}}\n"
    )
    first, second = (simulate(case, 0.1) for case in load([path]))
    assert first.recording["sand_density_1"].max() == 0.0
    assert second.recording["sand_density_1"].max() == pytest.approx(0.0075 * 0.8**2, rel=1e-9)
    assert second.wheelset_measures.sand_laid.tolist() == [0.0] * 4
    assert first.wheelset_measures.sand_laid[2] > 0.1


def test_a_sander_of_every_brake_waits_for_the_command_to_reach_its_car(rig):
    always = rig.case(*WET, "sanders=[{wheelset: 1, rate: 2 kg/min, when: always, delay: 0.2 s}]")
    piped = Coupling(distance=26.4, pipe_speed=52.8)  # half a second from car to car
    train = run_coupled([always] * 3, piped, steps_per_sample=1)
    for car, stop in enumerate(train.cars):
        laying = stop.trace.wheelsets["sanding"][:, 0] > 0.0
        assert stop.trace.train["time"][laying][0] == pytest.approx(0.2 + 0.5 * car, abs=0.0101)
