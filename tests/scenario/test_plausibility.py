"""Trains that cannot be, by what follows from their numbers; and real ones, which are no warning."""

import pytest

from uictest.plans import library
from uictest.plans.scenario import car_figures, plausible_spans

DISC = "brake.system.disc"
SYSTEM = "brake.system"
LOADCELL = "rig.sensors.loadcell"
NONSENSE = {
    "axle-load": [("vehicle.body.mass=3 t", 3.9075), ("vehicle.body.mass=150 t", 40.6575)],
    "wheel-radius": [("vehicle.wheelset.radius=860 mm", 860.0), ("vehicle.wheelset.radius=0.29 m", 290.0)],
    "braked-weight-percentage": [(f"{DISC}.pad_friction=0.9", 368.0), (f"{DISC}.pad_friction=0.09", 27.7)],
    "adhesion-demand": [(f"{DISC}.pad_friction=0.9", 0.3064)],
    "wheel-inertia": [("vehicle.wheelset.rotational_inertia=61 kg m2", 0.1783)],
    "clamping-force": [(f"{LOADCELL}.range=10 kN", 139.7), (f"{LOADCELL}.range=200 kN", 6.98)],
    "reservoir": [(f"{SYSTEM}.reservoir.volume=10 L", 0.7164)],
    "filling-time": [
        (f"{SYSTEM}.positions.R.fill_time=0.1 s", 0.2963),
        (f"{SYSTEM}.relay_valve.conductance=1e-9 m3/(s Pa)", 58.9),
    ],
    "disc-radius": [(f"{DISC}.mean_radius=0.578 m", 1.344)],
    "wheelbase": [("vehicle.bogie.half_wheelbase=2.5 m", 5.0), ("vehicle.bogie.half_wheelbase=0.6 m", 1.2)],
}
"""Each mistake and the value of the quantity, by hand from the numbers of intercity-180 and ep-disc."""
COACH = ("vehicle=manchester-benchmark",)
"""Iwnicki 1998: a coach of 44.5 t on wheels of 0.46 m."""
WAGON = (
    *("vehicle.body.mass=70.6 t", "vehicle.bogie.mass=2300 kg", "vehicle.wheelset.mass=1200 kg"),
    *("vehicle.wheelset.radius=0.46 m", "vehicle.wheelset.rotational_inertia=100 kg m2"),
    *("vehicle.bogie.half_wheelbase=0.9 m", "brake.system=distributor", "brake.position=G"),
    "vehicle.secondary.vertical_stiffness=2 MN/m",
)
"""A loaded freight wagon of 80 t on bogies Y25: wheels of 920 mm, 1.8 m apart; masses chosen."""
TRAM = (
    *("vehicle.body.mass=20 t", "vehicle.bogie.mass=2000 kg", "vehicle.wheelset.mass=900 kg"),
    *("vehicle.wheelset.radius=0.3 m", "vehicle.wheelset.rotational_inertia=35 kg m2"),
    *("vehicle.bogie.half_wheelbase=0.9 m", f"{DISC}.mean_radius=0.2 m"),
    *(
        f"{SYSTEM}.positions.R.maximum_pressure=3 bar",
        f"{SYSTEM}.positions.emergency.maximum_pressure=3.5 bar",
    ),
)
"""A light rail car of 27.6 t on wheels of 600 mm, which full service slows by 1.3 m/s2; chosen."""


@pytest.fixture
def figures(case):
    return lambda *overrides: car_figures(case(*overrides).scenario)


MISTAKES = [(name, *each) for name, mistakes in NONSENSE.items() for each in mistakes]


@pytest.mark.parametrize(("name", "override", "value"), MISTAKES)
def test_a_slip_of_the_pen_is_found_with_its_value(figures, name, override, value):
    found = {each.name: each for each in figures(override).implausible}
    assert found[name].value == pytest.approx(value, rel=2e-3)
    assert found[name].likely


def test_every_check_has_a_mistake_that_it_finds():
    assert set(NONSENSE) == set(plausible_spans())


@pytest.mark.parametrize("train", [COACH, WAGON, TRAM], ids=["coach", "wagon", "tram"])
@pytest.mark.parametrize("position", [(), ("brake.position=emergency",)])
def test_a_real_train_is_no_warning(figures, train, position):
    assert figures(*train, *position).implausible == ()


@pytest.mark.parametrize("vehicle", library.names("vehicles"))
@pytest.mark.parametrize("brake", library.names("brakes"))
@pytest.mark.parametrize("position", ["P", "R", "G", "emergency"])
def test_nothing_that_ships_is_a_warning(figures, vehicle, brake, position):
    overrides = (f"vehicle={vehicle}", f"brake.system={brake}", f"brake.position={position}")
    assert figures(*overrides).implausible == ()


def test_the_span_is_wide_at_both_ends(figures):
    """650 mm is a locomotive's radius; a millimetre more is none."""
    wheel = (
        "vehicle.wheelset.rotational_inertia=400 kg m2",
        "vehicle.wheelset.mass=3 t",
        f"{DISC}.mean_radius=0.4 m",
    )
    radius = "vehicle.wheelset.radius={} mm"
    assert figures(*wheel, radius.format(650)).implausible == ()
    assert [each.name for each in figures(*wheel, radius.format(651)).implausible] == ["wheel-radius"]


def test_lambda_agrees_with_what_labs_ask_of_the_same_stop(figures):
    """Position R: 440 to 490 m from 120 km/h on a dry rail (Lee and Kang 2015, quoting UIC 541-05).

    A train of 100 % takes about 700 m, of 0.826 m/s2 by the conversion model and about a second of build-up.
    Ours of 472 m lies between 100 % and the 190 to 205 % of 720 to 770 m from 160 km/h.
    """
    figure = figures().braked_weight_percentage
    assert 100.0 < figure < 190.0
    deceleration = 0.0075 * figure + 0.076
    speed = 120.0 / 3.6
    assert 440.0 < speed**2 / (2.0 * deceleration) + 0.5 * speed < 490.0


def test_figures_are_those_of_the_loaded_car_and_of_single_wheelsets(figures):
    loaded = figures("vehicle.payload=10 t", "vehicle.load=full")
    assert (loaded.mass_t, loaded.axle_load_t) == (pytest.approx(55.0), pytest.approx(13.75))
    found = figures("vehicle.wheelsets.3.wheel_radius=0.86 m").implausible
    assert [each.keys for each in found] == [("vehicle.wheelsets.3.wheel_radius",)]
