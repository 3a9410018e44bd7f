"""Rails whose whole creep curve changes, layers that earlier stops have worn, whose loss cleans."""

import math
import subprocess
import sys
import textwrap

import numpy as np
import pytest

from uictest.core.physics import contact_stiffness, creep_force, highest_creep_force
from uictest.core.rail_laws import LAWS
from uictest.rig.highest_creep import highest_creep_law

CURVES = ("rail.condition=wet-curves", "rail.friction=0.08")
LAYER = "rail.condition=leaf-layer"
FILM = "rail.condition=leaf-film"
BYPASSED = "rig.wsp=bypassed"
SHAPE = ("friction_ratio", "friction_decay", "reduction_adhesion", "reduction_slip")


def highest(force, slips):
    """Return the largest force, sought first at every twentieth slip, then around the largest of those."""
    coarse = [force(slip) for slip in slips[::20]]
    near = 20 * int(np.argmax(coarse))
    return max(force(slip) for slip in slips[max(near - 20, 0) : near + 21])


def bits(stop):
    return bytes(stop.measures.tobytes() + stop.wheelset_measures.tobytes())


def test_a_clean_rail_of_the_same_curve_changes_no_bit(rig):
    wet = rig.case("rail.condition=wet-cleaning").scenario.rail.condition
    same = ", ".join(f"{name}: {getattr(wet, name).text}" for name in SHAPE)
    rail = ("rail.condition=wet-cleaning", "rail.friction=0.08")
    assert bits(rig.stop(*rail, f"rail.condition.cleaning.clean_curve={{{same}}}")) == bits(rig.stop(*rail))


@pytest.mark.parametrize("rail", [CURVES, (LAYER,)])
@pytest.mark.parametrize("wsp", ["active", "bypassed"])
def test_a_rail_that_no_energy_cleans_gives_the_bits_of_its_own_curve(rig, rail, wsp):
    never = rig.stop(*rail, f"rig.wsp={wsp}", cleaning_response=0.0)
    assert bits(never) == bits(rig.stop(*rail, f"rig.wsp={wsp}", cleans_rail=0.0))


def test_the_loss_of_one_contact_cleans_as_half_of_that_of_a_wheelset(rig):
    energy = "rail.condition.cleaning.energy"
    of_contact = rig.stop(*CURVES, "rail.condition.cleaning.loss=contact", f"{energy}=2750 J/m")
    assert bits(of_contact) == bits(rig.stop(*CURVES, f"{energy}=5500 J/m"))
    assert bits(of_contact) != bits(rig.stop(*CURVES, f"{energy}=2750 J/m"))


@pytest.mark.parametrize("rail", [CURVES, (LAYER,)])
def test_energy_closes(rig, rail):
    for wsp in ("active", "bypassed"):
        assert abs(rig.stop(*rail, f"rig.wsp={wsp}").measures.energy_residual) < 1e-8


def test_what_earlier_stops_spent_is_what_the_first_wheelset_finds(rig):
    stop = rig.columns(LAYER, BYPASSED, "rail.condition.cleaning.spent=30 kJ/m")
    share = 1.0 - math.exp(-30.0 / 60.0)
    assert stop["cleaned_share"][0] == pytest.approx(np.full(4, share), abs=1e-9)
    assert stop["friction"][0] == pytest.approx(np.full(4, 0.05 + share * (0.28 - 0.05)), abs=1e-9)


def test_a_rail_that_keeps_half_of_it_shows_half(rig):
    half = ("rail.condition.cleaning.carry_over=0.5", "rail.condition.cleaning.spent=30 kJ/m")
    stop = rig.columns(LAYER, BYPASSED, *half)
    assert stop["cleaned_share"][0] == pytest.approx(np.full(4, 0.5 * (1.0 - math.exp(-0.5))), abs=1e-9)


def test_a_layer_stays_low_over_a_stop_and_wears_over_several(rig):
    """As leaf layers are reported to: no single stop wears it, and each later one is shorter."""
    columns = rig.columns(LAYER, "initial_speed=80 km/h")
    assert columns["friction"].max() < 0.5 * (0.05 + 0.28)
    worn = [
        rig.stop(LAYER, "initial_speed=80 km/h", f"rail.condition.cleaning.spent={kj} kJ/m")
        for kj in (1, 5, 10, 20)
    ]
    assert np.all(np.diff([each.measures.end_distance for each in worn]) < -10.0)


def test_the_whole_curve_goes_over_to_that_of_a_clean_rail(rig):
    p, _ = rig.parameters(*CURVES)
    final = rig.stop(*CURVES, BYPASSED).wheelsets
    for name in SHAPE:
        share = final["cleaned_share"]
        assert final[name] == pytest.approx(p[name] + share * (p[f"clean_{name}"] - p[name]), rel=1e-12)
    assert final["cleaned_share"].min() > 0.2


@pytest.mark.parametrize("share", [0.0, 0.1, 0.3, 0.5, 0.7, 0.9, 1.0])
def test_the_largest_force_between_both_curves_is_known_to_a_per_cent_and_a_half(rig, share):
    """Blended between those of both curves; exactly known at the ends, to the error of the fit there."""
    found = rig.case(*CURVES).scenario.rail.condition
    clean = found.cleaning.clean_curve
    curve = [
        float(getattr(found, name) + share * (getattr(clean, name) - getattr(found, name))) for name in SHAPE
    ]
    errors = []
    for speed in (5.0, 15.0, 33.0):
        for friction, load_ratio in ((0.06, 1.0), (0.12, 0.6), (0.25, 1.6)):
            load = load_ratio * float(found.contact.reference_wheel_load)
            stiffness = contact_stiffness(float(found.contact.creep_stiffness), load_ratio)
            slips = np.geomspace(1e-4, speed, 3000)
            law = (speed, load, stiffness, friction, *curve)
            exact = highest(lambda slip, law=law: creep_force(slip, *law)[0], slips)
            ends = [
                highest_creep_force(speed, load, friction, stiffness, scale, *coefficients)
                for scale, coefficients in map(highest_creep_law, (found, clean))
            ]
            errors.append((ends[0] + share * (ends[1] - ends[0])) / exact - 1.0)
    assert np.abs(errors).max() < 0.015


def test_a_film_that_counts_as_much_as_bare_rail_is_a_mixture(rig):
    film = rig.columns(FILM, BYPASSED, "rail.condition.cleaning.film.weight=1")
    mixture = rig.columns(LAYER, BYPASSED)
    assert film["friction"] == pytest.approx(mixture["friction"], rel=1e-9)


def test_a_film_stays_slippery_where_half_of_it_is_gone(rig):
    """With weights 1 and 25, half bare counts as 1 of 26, for the rail that a first wheelset finds."""
    spent = f"rail.condition.cleaning.spent={60.0 * math.log(2.0)} kJ/m"
    stop = rig.columns(FILM, BYPASSED, spent)
    assert stop["cleaned_share"][0] == pytest.approx(np.full(4, 1.0 / 26.0), rel=1e-9)
    assert stop["friction"][0] == pytest.approx(np.full(4, 0.05 + 0.23 / 26.0), rel=1e-9)


@pytest.mark.parametrize("law", list(LAWS))
def test_a_law_goes_from_the_rail_as_found_to_the_clean_one_and_never_back(law):
    numbers = [25.0] * len(LAWS[law].numbers)
    parts = [LAWS[law].clean_part(share, numbers) for share in np.linspace(0.0, 1.0, 101)]
    assert parts[0] == 0.0
    assert parts[-1] == 1.0
    assert np.all(np.diff(parts) > 0.0)
    settled = [LAWS[law].settled_share(loss, 1.0 / 5300.0, numbers) for loss in (0.0, 1e3, 1e4, 1e5)]
    assert settled == pytest.approx([-math.expm1(-loss / 5300.0) for loss in (0.0, 1e3, 1e4, 1e5)], rel=1e-12)


def test_two_laws_are_refused_and_a_new_law_is_one_module(tmp_path):
    """The module is found, its numbers are keys with unit and range, and the model calls its equations."""
    (tmp_path / "squared.py").write_text(
        textwrap.dedent("""
        from uictest.core.rail_laws.law import LawNumber, RailLaw, cleaned_by_energy

        def clean_part(share, numbers):
            return share * share * numbers[0]

        LAW = RailLaw("squared", "Squared.", cleaned_by_energy, clean_part,
                      {"length": LawNumber("length", "A length.", "1 mm", "1 m", lambda value: 2.0 * value)})
        """)
    )
    program = f"""
        from types import SimpleNamespace
        from uictest.core.rail_laws import laws
        laws.__path__.append({str(tmp_path)!r})
        from uictest.core.rail_laws import clean_part
        import uictest
        from uictest.rig import assemble

        def load(own):
            cleaning = f"{{{{energy: 1 kJ/m, recovered_friction: 0.3, reach: 1 m, carry_over: 1, {{own}}}}}}"
            return uictest.load("slip-120", set={{"rail.cleaning": cleaning}})[0]

        p = assemble(load("squared: {{length: 250 mm}}")).parameters
        print(clean_part(0.5, p))
        for own in ("squared: {{length: 2 m}}", "squared: {{length: 1 m}}, film: {{weight: 2}}"):
            try:
                load(own)
            except uictest.ScenarioErrors as error:
                print(error)
    """
    done = subprocess.run(
        [sys.executable, "-c", textwrap.dedent(program)], capture_output=True, text=True, check=True
    )
    assert done.stdout.startswith("0.125\n")  # 0.5^2 of twice a quarter
    assert "1 mm .. 1 m" in done.stdout or "at most 1 m" in done.stdout, done.stdout
    assert "two laws are named: 'film' and 'squared'" in done.stdout
