"""Numbers with a plausible range: their draws have its distribution, around the nominal value or not."""

from pathlib import Path

import numpy as np
import pytest
from scipy import stats

from uictest.plans.scenario import load
from uictest.plans.scenario.yaml import Quantity, parse_quantity
from uictest.plans.sweeps import RangedNumber, drawn_ranges, load_sweep, ranged_numbers, sobol_blocks
from uictest.plans.sweeps.plan import saltelli_sample

SLIP = Path(__file__).parents[3] / "scenarios" / "slip-120.yaml"
BLOCKS, BLOCK = 8, 128


def ranged(low, high, prior, value, unit="N", kind="force"):
    """A number with a range and a prior."""
    ends = tuple(parse_quantity(f"{end} {unit}", kind) for end in (low, high))
    nominal = parse_quantity(f"{value} {unit}", kind)
    quantity = Quantity(float(nominal), nominal.text, nominal.unit, "chosen", ends, prior)
    return RangedNumber("number", quantity, "chosen", "for the test")


def distribution(low, high, prior):
    """The distribution that the words mean, by SciPy."""
    return stats.uniform(low, high - low) if prior == "uniform" else stats.loguniform(low, high)


def draws(number):
    """What the second of three numbers is in the draws of a study, in SI units."""
    return number.at(sobol_blocks(BLOCKS, BLOCK, 3, seed=0)[:, 1]).numbers


@pytest.mark.parametrize("prior", ["uniform", "log-uniform"])
@pytest.mark.parametrize(("low", "high"), [(95.0, 105.0), (50.0, 100.0), (30.0, 100.0), (1.0, 1000.0)])
def test_draws_have_the_stated_distribution_whatever_the_ends(low, high, prior):
    """Each 128th of the probability holds one draw of a block of 128: no other distribution has that."""
    drawn = draws(ranged(low, high, prior, 0.5 * (low + high)))
    expected = distribution(low, high, prior)
    places = np.floor(expected.cdf(drawn).reshape(BLOCKS, BLOCK) * BLOCK)
    assert (np.sort(places) == np.arange(BLOCK)).all()
    # No farther from the distribution than one such part, where the other one is up to half of all away.
    assert stats.kstest(drawn, expected.cdf).statistic <= 1.0 / BLOCK
    other = distribution(low, high, "uniform" if prior == "log-uniform" else "log-uniform")
    if high >= 2.0 * low:
        assert stats.kstest(drawn, other.cdf).statistic > 8.0 / BLOCK


def test_half_of_the_draws_lie_below_the_mean_of_the_ends_or_below_their_geometric_mean():
    uniform, logarithmic = (draws(ranged(20.0, 80.0, each, 40.0)) for each in ("uniform", "log-uniform"))
    assert np.median(uniform) == pytest.approx(50.0, rel=0.01)
    assert np.median(logarithmic) == pytest.approx(40.0, rel=0.01)


@pytest.mark.parametrize("prior", ["uniform", "log-uniform"])
def test_the_place_of_the_nominal_value_is_its_probability(prior):
    place = ranged(30.0, 120.0, prior, 60.0).nominal_place
    assert place == pytest.approx(distribution(30.0, 120.0, prior).cdf(60.0))


def test_a_number_is_drawn_in_the_unit_that_it_is_written_in():
    number = ranged(1.0, 100.0, "log-uniform", 6.0, "degC", "temperature")
    assert np.median(draws(number)) == pytest.approx(273.15 + 10.0, abs=0.5)  # in kelvin it were 320 K


def test_friction_and_shares_of_the_shipped_rail_are_uniform_and_times_and_rates_are_not():
    """By what they are: the decay of the wet rail differs by a factor of 4, its ratio by one of 3.3."""
    [case] = load([SLIP], [])
    priors = {each.key: each.value.prior for each in ranged_numbers(case.scenario)}
    uniform = {key for key, prior in priors.items() if prior == "uniform"}
    assert {"rail.condition.friction_ratio", "brake.system.disc.pad_friction"} <= uniform
    assert {"rig.caliper.load_friction", "vehicle.wheelset.radius"} <= uniform
    assert {
        "rail.condition.friction_decay",
        "brake.system.wsp_valve.vent_conductance",
        "brake.system.wsp_valve.switching_delay",
        "brake.system.positions.R.dead_time",
        "vehicle.primary.vertical_damping",
    } <= priors.keys() - uniform


def test_a_range_of_a_scenario_has_the_prior_that_it_states_and_a_reason():
    stated = "rail.friction={value: 0.06, range: [0.03, 0.12]%s}"
    for words, prior in (("", "uniform"), (", prior: log-uniform", "log-uniform")):
        [case] = load([SLIP], [stated % words])
        [number] = [each for each in ranged_numbers(case.scenario) if each.key == "rail.friction"]
        assert number.value.prior == prior
        assert (
            number.reason
            == {
                "uniform": "No value in the range is preferred",
                "log-uniform": "The order of magnitude is known: half and twice a value are as likely",
            }[prior]
        )


SHIPPED = sorted((Path(__file__).parents[3] / "scenarios").glob("*.sweep.yaml"))
TEXT = """\
sample:
  method: saltelli
  size: 8
  parameters:
    rail.friction: {uniform: [0.11, 0.15]}
    brake.command: {triangular: [80 %, 100 %, 100 %]}
    initial_speed: {normal: {mean: 30 km/h, deviation: 1 km/h, lower: 28 km/h, upper: 32 km/h}}
    rig.topology: {choice: [one-caliper, four-caliper]}
    vehicle.wheelsets.2.brake_force: {uniform: [90 %, 95 %]}
"""


def test_the_ends_are_those_of_the_draws(load):
    plan = load(TEXT)
    sample = saltelli_sample(plan)
    for each in drawn_ranges(plan):
        draw = sample.draws[sample.keys.index(each.key)]
        first, last = draw.values(np.array([0.0, 1.0]))
        assert (each.low, each.high) == (first.content, last.content)


def test_only_samples_for_sensitivities_have_ranges_that_lie_around_the_nominal_or_beside(load):
    inside = {each.key: each.contains_nominal for each in drawn_ranges(load(TEXT))}
    # A wheelset without a brake force of its own has the regular one.
    assert inside == {
        "rail.friction": False,
        "brake.command": True,
        "initial_speed": True,
        "vehicle.wheelsets.2.brake_force": False,
    }
    sentences = list(map(str, drawn_ranges(load(TEXT))))
    assert sentences[0] == "rail.friction: the scenario's own 0.1 lies OUTSIDE the range 0.11 .. 0.15"
    assert list(drawn_ranges(load(TEXT.replace("saltelli", "random")))) == []
    assert list(drawn_ranges(load())) == []


@pytest.mark.parametrize("path", SHIPPED, ids=[path.stem for path in SHIPPED])
def test_the_shipped_sensitivities_are_those_of_the_shipped_scenario(path):
    assert [str(each) for each in drawn_ranges(load_sweep(path)) if not each.contains_nominal] == []
