"""From a scenario to the numbers of the rig."""

from operator import itemgetter

import control
import numpy as np
import pytest
from scipy.signal import butter, lfilter

from uictest.core.physics.air import REFERENCE_DENSITY
from uictest.core.units import STANDARD_GRAVITY
from uictest.rig.assembly import ASSIGNMENTS, Assignment, RecordAssembler, assemble, friction_laws
from uictest.rig.brake_assembly import resampled_transfer_function
from uictest.rig.model.parameters import PARAMETERS, WHEELSET_PARAMETERS
from uictest.rig.model.rail import MARGIN, POINTS

from ..stop_bits import bits


def test_every_parameter_of_every_shipped_case_is_a_number(scenarios, rig):
    # A sander of a fixed rate has no largest density; a car of a train is assembled with its train.
    for case in (case for case in scenarios if case.train is None):
        parameters, wheelset_parameters, rail, *_ = assemble(case)
        endless = {name for name in PARAMETERS.names or () if name.startswith(("fault_", "sander_densities"))}
        finite = set(PARAMETERS.names or ()) - endless
        assert all(np.isfinite(parameters[name]).all() for name in finite)
        assert not any(np.isnan(parameters[name]).any() for name in endless)
        assert all(np.isfinite(wheelset_parameters[name]).all() for name in WHEELSET_PARAMETERS.names)
        assert np.isfinite(rail).all()


def test_a_record_does_not_depend_on_what_was_assembled_before(scenarios, rig):
    """What a scenario shares with the one before is not computed again, in whatever order they come."""

    def assembler():
        return RecordAssembler(PARAMETERS, ASSIGNMENTS, frozenset({"noise_key"}))

    base, other = rig.case().scenario, rig.case("rail.friction=0.09", "brake.command=70 %").scenario
    sharing = [base.model_copy(update={name: getattr(other, name)}) for name in ("rail", "brake", "vehicle")]
    cases = [*(case.scenario for case in scenarios if case.train is None), *sharing, base]
    alone = [assembler().record(scenario).tobytes() for scenario in cases]
    one = assembler()
    assert [one.record(scenario).tobytes() for scenario in cases] == alone
    assert [one.record(scenario).tobytes() for scenario in reversed(cases)] == alone[::-1]


def test_a_function_is_called_again_where_what_it_is_given_is_another_object():
    calls = []

    def set_both(parameters, first, second):
        calls.append((first, second))
        parameters.total = first + second

    arguments = tuple(itemgetter(k) for k in range(2))
    assembler = RecordAssembler(np.dtype([("total", "f8")]), [Assignment(set_both, arguments)], frozenset())
    one, two, three = 1001.5, 1002.5, 1003.5
    totals = [assembler.record(given)["total"][0] for given in ((one, two), (one, two), (three, two))]
    assert totals == [2004.0, 2004.0, 2006.0]
    assert calls == [(one, two), (three, two)]


def test_wheels_carry_the_weight_on_springs_of_all_axle_boxes_and_sides(rig):
    p = rig.parameters()[0]
    mass = p.body_mass + 2.0 * p.bogie_mass + 4.0 * p.wheelset_mass
    assert 8.0 * p.static_wheel_load == pytest.approx(mass * STANDARD_GRAVITY)
    # Vehicle files give one axle box and one side; the planar model has both in one.
    p = rig.parameters("vehicle=manchester-benchmark")[0]
    assert p.primary_longitudinal_stiffness == pytest.approx(2 * 31.391e6)
    assert p.secondary_vertical_stiffness == pytest.approx(2 * 430e3)


def test_valves_have_their_orifice_law_and_air_the_heat_capacities_of_an_ideal_gas(rig):
    p = rig.parameters(
        "brake.system.critical_pressure_ratio=0.4", "brake.system.laminar_pressure_ratio=0.98"
    )[0]
    assert (p.critical_ratio, p.subsonic_scale) == pytest.approx((0.4, 1.0 / 0.6))
    assert p.laminar_slope == pytest.approx(np.sqrt(1.0 - (0.58 / 0.6) ** 2) / 0.02)
    # Mayer: cp - cv = R; 718 and 1005 J/(kg K) for air.
    p = rig.parameters("brake.system.air.temperature=10 degC")[0]
    assert p.heat_capacity_pressure - p.heat_capacity_volume == pytest.approx(p.gas_constant)
    assert (p.heat_capacity_volume, p.heat_capacity_pressure) == pytest.approx((717.6, 1004.7), abs=0.1)
    assert p.air_coldness == pytest.approx(293.15 / 283.15)


@pytest.mark.parametrize("step", [0.25, 0.5])
def test_walls_give_off_heat_by_film_coefficient_and_surface(rig, step):
    """In a step; the module with a caliper has the balls besides the wall of a tank."""
    system = "brake.system"
    p = rig.parameters(
        f"simulation.time_step={step} ms",
        f"{system}.brake_line.surface=2 m2",
        f"{system}.brake_line.film_coefficient=50 W/(m2 K)",
        f"{system}.tank.surface=0.1 m2",
        f"{system}.tank.film_coefficient=40 W/(m2 K)",
        f"{system}.caliper_tank.ball_surface=0.2 m2",
        f"{system}.caliper_tank.film_coefficient=80 W/(m2 K)",
    )[0]
    exchanges = np.array([p.line_exchange, p.tank_exchange, p.caliper_tank_exchange])
    np.testing.assert_allclose(exchanges / (1e-3 * step), [100.0, 4.0, 20.0])


@pytest.mark.parametrize("step", [0.25, 0.5])
def test_modelled_air_is_that_of_a_tank_in_units_of_pressure(rig, step):
    """A kilogram at the temperature of the wall is worth R T / V; heat is worth (k - 1) / V of it."""
    model = "rig.compensation_model.air"
    p = rig.parameters(
        f"simulation.time_step={step} ms",
        f"{model}.tank_heat_conductance=4 W/K",
        f"{model}.caliper_heat_conductance=20 W/K",
        f"{model}.swept_volume=0.05 L",
        f"{model}.closing_pressure=0.4 bar",
        f"{model}.opening_pressure=0.3 bar",
    )[0]
    per_kilogram = p.gas_constant * p.air_temperature / p.tank_volume
    per_joule = (p.heat_capacity_ratio - 1.0) / p.tank_volume
    exchanges = np.array([p.modelled_tank_exchange, p.modelled_exchange])
    np.testing.assert_allclose(exchanges, 1e-3 * step * per_joule * p.air_temperature * np.array([4.0, 20.0]))
    conductances = np.array([p.modelled_fill_conductance, p.modelled_vent_conductance])
    valves = np.array([p.fill_conductance, p.vent_conductance])
    np.testing.assert_allclose(conductances, 1e-3 * step * per_kilogram * REFERENCE_DENSITY * valves)
    assert p.modelled_swept_share == pytest.approx(0.05e-3 / p.tank_volume)
    gauge = np.array([p.modelled_closing_pressure, p.modelled_opening_pressure]) - p.atmospheric_pressure
    np.testing.assert_allclose(gauge, [4e4, 3e4])


@pytest.mark.parametrize("step", [0.25, 0.5])
def test_caliper_is_stiffened_by_its_damping_within_a_step(rig, step):
    """Spring, dampings and contact side by side; friction adds to what squeezing feels of the contact."""
    overrides = (f"simulation.time_step={step} ms", "rig.caliper.load_friction=10 %")
    p = rig.parameters(*overrides)[0]
    caliper = rig.case(*overrides).scenario.rig.caliper
    damping = caliper.viscous_friction / (1e-3 * step)
    assert p.piston_damping == pytest.approx(damping)
    contact_damping = caliper.contact_friction / (1e-3 * step)
    assert p.contact_damping == pytest.approx(contact_damping)
    assert p.squeezing_stiffness == pytest.approx(1.1 * caliper.contact_stiffness + contact_damping)
    assert p.releasing_stiffness == pytest.approx(0.9 * caliper.contact_stiffness + contact_damping)
    free = caliper.spring_rate + damping
    assert p.free_compliance == pytest.approx(1.0 / free)
    assert p.squeezing_compliance == pytest.approx(1.0 / (free + p.squeezing_stiffness))
    assert p.releasing_compliance == pytest.approx(1.0 / (free + p.releasing_stiffness))


@pytest.mark.parametrize("step", [0.25, 0.5])
def test_a_force_changes_speed_rotation_and_slip_within_a_step(rig, step):
    p = rig.parameters(f"simulation.time_step={step} ms")[0]
    assert p.mass_response == pytest.approx(1e-3 * step / p.wheelset_mass)
    assert p.inertia_response == pytest.approx(1e-3 * step / p.rotational_inertia)
    assert p.slip_response == pytest.approx(p.mass_response + p.wheel_radius**2 * p.inertia_response)
    inverses = (
        p.inertia_response * p.inertia_stiffness,
        p.slip_response * p.slip_stiffness,
        p.reference_load * p.load_scale,
    )
    assert inverses == pytest.approx((1.0, 1.0, 1.0))


def test_pressures_are_absolute_but_for_the_demand(rig):
    p = rig.parameters("brake.command=80 %")[0]
    assert p.reservoir_pressure == pytest.approx(8e5 + p.atmospheric_pressure)
    assert p.commanded_pressure == pytest.approx(0.8 * rig.parameters()[0].commanded_pressure)


@pytest.mark.parametrize(("delay", "cycles", "steps"), [("0.5 ms", 0, 1), ("10 ms", 1, 0), ("64 ms", 6, 8)])
def test_switching_delay_is_cut_into_cycles_and_steps(rig, delay, cycles, steps):
    p = rig.parameters(f"brake.system.wsp_valve.switching_delay={delay}")[0]
    assert (p.valve_delay_cycles, p.valve_delay_steps) == (cycles, steps)


def test_quantities_per_step_follow_the_step(rig):
    coarse = rig.parameters("simulation.time_step=0.5 ms")[0]
    fine = rig.parameters("simulation.time_step=0.25 ms")[0]
    assert fine.steps_per_cycle == 2 * coarse.steps_per_cycle
    assert fine.valve_travel_per_step == pytest.approx(0.5 * coarse.valve_travel_per_step)
    assert fine.phase_change_per_step == pytest.approx(0.5 * coarse.phase_change_per_step)
    assert 20 * fine.valve_delay_cycles + fine.valve_delay_steps / 2 == pytest.approx(
        20 * coarse.valve_delay_cycles + coarse.valve_delay_steps
    )


@pytest.mark.parametrize("step", ["0.25 ms", "0.5 ms", "1 ms"])
def test_cylinder_is_stable_with_unity_gain_at_every_step(rig, step):
    """As far as double precision tells: steps at which it cannot tell 1e-4 are refused."""
    p = rig.parameters(f"simulation.time_step={step}")[0]
    system = control.tf([p.b0, p.b1, p.b2, p.b3], [1.0, p.a1, p.a2, p.a3], float(p.step))
    assert np.abs(system.poles()).max() < 1.0
    assert system.dcgain() == pytest.approx(1.0, abs=1e-4)


def test_friction_is_that_of_the_rail_condition_unless_given_and_its_steps_are_pairs_of_points(rig):
    assert friction_laws(rig.case("rail.condition=wet").scenario)[1, 0] == pytest.approx(0.30)
    assert friction_laws(rig.case("rail.friction=0.09").scenario)[1, 0] == pytest.approx(0.09)
    points = "[{position: 0 m, friction: 0.3}, {position: 150 m, friction: 0.1}]"
    case = rig.case("rail.condition=wet", f"rail.friction={{interpolation: steps, points: {points}}}")
    expected = [0.0, 150.0, 150.0], [0.3, 0.3, 0.1]
    np.testing.assert_array_equal(friction_laws(case.scenario)[:2], expected)


def test_cleaning_is_that_of_the_rail_condition_unless_given(rig):
    given = "rail.cleaning={energy: 10 kJ/m, recovered_friction: 0.3, reach: 2 m, carry_over: 0.25}"
    fields = ("cleans_rail", "cleaning_response", "recovered_friction", "cleaning_decay", "carry_over")
    wet, shipped, own = (
        [float(rig.parameters(*overrides)[0][name]) for name in fields]
        for overrides in (
            ("rail.condition=wet",),
            ("rail.condition=wet-cleaning",),
            ("rail.condition=wet-cleaning", given),
        )
    )
    assert wet == [0.0] * 5
    assert shipped == pytest.approx([1.0, 1.0 / 5300.0, 0.28, 2.0, 0.5])
    assert own == pytest.approx([1.0, 1e-4, 0.3, 0.5, 0.25])


def test_what_a_random_rail_takes_of_libm_is_rounded(rig):
    """The last bits of exponential and logarithm differ between machines."""
    p = rig.parameters("rail.condition=wet-varied")[0]
    assert p.variation_persistence == round(np.exp(-0.1), 12)
    # Of 20 %, left and right correlated by half, the mean varies by 20 % x sqrt(3 / 4).
    assert p.variation_log_spread == round(np.sqrt(np.log1p(0.03)), 12)


@pytest.mark.parametrize("vehicle", ["intercity-180", "manchester-benchmark", "crh380a"])
def test_the_memory_of_the_rail_reaches_from_each_wheelset_to_the_next(rig, vehicle):
    """Its ring holds the longest gap, and its points lie closer than the shortest."""
    p = rig.parameters(f"vehicle={vehicle}")[0]
    wheelbase = 2.0 * p.half_wheelbase
    gaps = np.array([wheelbase, 2.0 * p.half_pivot_distance - wheelbase])
    assert gaps.max() * p.rail_points_per_metre == pytest.approx(POINTS - MARGIN)
    assert gaps.min() * p.rail_points_per_metre > 1.0


SOCKET = "controller={connect: 'tcp://127.0.0.1:5025', free_parameters: true, parameters: {lower_slide: %s}}"


def test_the_digest_of_a_case_names_what_decides_its_stop(rig):
    def digest(*overrides, lower_slide=0.08):
        config = assemble(rig.case(SOCKET % lower_slide, *overrides)).config
        assert config is not None
        return str(config.case_sha256)

    own = digest()
    assert len(bytes.fromhex(own)) == 32
    assert digest("title=Another title", "expect=fail", "criteria=uictest-stop") == own
    assert digest("controller.connect=tcp://127.0.0.1:5026", "controller.time_limit=2 s") == own
    others = {
        digest(lower_slide=0.09),
        digest("initial_speed=81 km/h"),
        digest("rail.friction=0.09"),
        digest("vehicle.wheelsets.2.wheel_radius=0.42 m"),
        digest("seed=1"),
    }
    assert len(others | {own}) == 6


IDENTIFIED = 5e-4
LAGS = np.exp(-IDENTIFIED / np.array([30e-3, 8e-3, 3e-3]))
FILTERS = {
    "three lags": (np.poly(LAGS).sum() * np.array([0.4, 0.3, 0.2, 0.1]), np.poly(LAGS)),
    "oscillating": butter(3, 20.0, fs=1.0 / IDENTIFIED),
}
held = np.repeat(np.random.default_rng(8).normal(2e5, 1e5, 50), 40)


@pytest.mark.parametrize("kind", FILTERS)
@pytest.mark.parametrize("parts", [2, 5])
def test_finer_step_reproduces_the_response(kind, parts):
    """To any input that is held for the step of the identification, at each of its instants."""
    numerator, denominator = FILTERS[kind]
    b, a = resampled_transfer_function(list(numerator), list(denominator[1:]), IDENTIFIED, IDENTIFIED / parts)
    fine = lfilter(b, [1.0, *a], np.repeat(held, parts))
    np.testing.assert_allclose(fine[::parts], lfilter(numerator, denominator, held), rtol=1e-6, atol=1.0)


@pytest.mark.parametrize("kind", FILTERS)
def test_coarser_step_reproduces_the_response(kind):
    """To any input that is held for the coarser step."""
    numerator, denominator = FILTERS[kind]
    b, a = resampled_transfer_function(list(numerator), list(denominator[1:]), IDENTIFIED, 2.0 * IDENTIFIED)
    fine = lfilter(numerator, denominator, held)
    np.testing.assert_allclose(lfilter(b, [1.0, *a], held[::2]), fine[::2], rtol=1e-6, atol=1.0)


@pytest.mark.parametrize("kind", FILTERS)
@pytest.mark.parametrize("share", [0.25, 0.5, 2.0])
def test_constant_pressure_still_comes_out_as_it_went_in(kind, share):
    numerator, denominator = FILTERS[kind]
    b, a = resampled_transfer_function(list(numerator), list(denominator[1:]), IDENTIFIED, share * IDENTIFIED)
    assert sum(b) / (1.0 + sum(a)) == pytest.approx(1.0, rel=1e-6)


def test_coefficients_at_their_own_step_are_left_alone():
    numerator, denominator = [0.1, 0.2, 0.3, 0.4], [-0.1, 0.05, 0.0]
    assert resampled_transfer_function(numerator, denominator, IDENTIFIED, IDENTIFIED) == (
        numerator,
        denominator,
    )


FOUR = "rig.topology=four-caliper"
PAYLOAD = "vehicle.payload=8 t"
VALVE = "brake.system.load_valve={empty_share: 80 %}"


def test_a_loaded_car_has_a_heavier_body_of_the_same_radius_of_gyration_and_an_empty_one_its_own(rig):
    body = rig.case().scenario.vehicle.body
    mass = body.mass + 8000.0
    inertia = body.pitch_inertia * (mass / body.mass)
    heavier = (f"vehicle.body.mass={mass!r} kg", f"vehicle.body.pitch_inertia={inertia!r} kg m2")
    loaded = rig.stop(PAYLOAD, "vehicle.load=full", FOUR)
    assert bits(loaded) == bits(rig.stop(*heavier, FOUR))
    assert bits(rig.stop(PAYLOAD, "vehicle.load=8000 kg", FOUR)) == bits(loaded)
    for load in ("empty", "0 t"):
        assert bits(rig.stop(PAYLOAD, f"vehicle.load={load}", FOUR)) == bits(rig.stop(FOUR))


@pytest.mark.parametrize(("load", "share"), [("empty", 0.8), ("2 t", 0.85), ("full", 1.0)])
def test_the_pressure_is_linear_in_the_load_and_controllers_see_the_command(rig, load, share):
    full = rig.case().scenario.brake.system.positions["R"].maximum_pressure
    overrides = (PAYLOAD, VALVE, f"vehicle.load={load}", "brake.command=50 %", FOUR)
    demand = float(rig.columns(*overrides)["demanded_pressure"].max())
    assert demand == pytest.approx(0.5 * share * full, rel=1e-9)
    p, _ = rig.parameters(*overrides)
    assert p["commanded_pressure"] * p["demand_per_pressure"] == pytest.approx(0.5)


def test_a_valve_that_follows_the_mass_keeps_the_stopping_distance(rig):
    """Force follows the pressure beyond that of touching pads; its share is that of the masses."""
    scenario = rig.case().scenario
    caliper, mass = scenario.rig.caliper, scenario.vehicle.total_mass
    touching = caliper.preload + caliper.spring_rate * caliper.clearance + caliper.coulomb_friction
    lost = touching / caliper.piston_area / scenario.brake.system.positions["R"].maximum_pressure
    share = lost + (1.0 - lost) * mass / (mass + 8000.0)
    valve = f"brake.system.load_valve={{empty_share: {100.0 * share:.6f} %}}"
    empty, full = (
        rig.stop(PAYLOAD, valve, f"vehicle.load={load}", FOUR).measures.braking_distance
        for load in ("empty", "full")
    )
    assert full == pytest.approx(empty, rel=0.01)
    without = rig.stop(PAYLOAD, "vehicle.load=full", FOUR).measures.braking_distance
    assert without > 1.1 * rig.stop(FOUR).measures.braking_distance


def test_wheel_loads_carry_the_load_and_everything_balances(rig):
    stop = rig.stop(PAYLOAD, VALVE, "vehicle.load=full", FOUR, "rail.condition=wet", "rail.friction=0.1")
    assert abs(stop.measures.energy_residual) < 1e-9
    loads = rig.columns(PAYLOAD, "vehicle.load=full", FOUR)["wheel_load"]
    mass = rig.case().scenario.vehicle.total_mass + 8000.0
    assert np.median(loads.sum(axis=1)) == pytest.approx(mass * 9.80665 / 2.0, rel=1e-3)
