"""A case with other values of its numbers: the bits of a scenario that states them, the noise of the case."""

from functools import partial
from pathlib import Path
from types import SimpleNamespace

import numpy as np
import pytest

from uictest.analysis.firmness import Effort
from uictest.judging.evaluation import may_be_biased
from uictest.plans.scenario import load
from uictest.plans.scenario.yaml import parse_quantity
from uictest.plans.sweeps import ParameterValue, listed_column, numbers_without_range, ranged_numbers
from uictest.report.robustness import firmness_sentences
from uictest.rig import run_in_lanes
from uictest.running.campaign import run_cases
from uictest.running.chunked import VariedCase, many_stops
from uictest.running.chunked.table import biases_by_measure
from uictest.runs import firmness
from uictest.runs.firmness import FirmnessRun
from uictest.runs.scenario_files import InvalidInputError

VENT = "brake.system.wsp_valve.vent_conductance"
RADIUS = "vehicle.wheelset.radius"
SLIP = Path(__file__).parents[2] / "scenarios" / "slip-120.yaml"
SMALL = Effort(blocks=2, block=4, seeds=2, seeds_at_ends=1)


def short_stop(*changes):
    """Return a short sliding stop on the rig with four calipers."""
    stated = ("initial_speed=15 km/h", "rig.topology=four-caliper", "rail.friction=0.06", *changes)
    [case] = load([SLIP], [*stated, "criteria=uictest-stop"])
    return case


@pytest.fixture(scope="module")
def numbers():
    return {each.key: each for each in ranged_numbers(short_stop().scenario)}


def columns(numbers, count, **places):
    """Return the nominal value of every number in some stops, but for those at a place of their range."""
    values = {key: each.at(np.full(count, np.nan)) for key, each in numbers.items()}
    values |= {key: numbers[key].at(np.full(count, place)) for key, place in places.items()}
    return values | {"seed": listed_column([ParameterValue(str(k), k) for k in range(count)])}


def measures(results):
    # As text: a measure that was not reached is NaN, which equals nothing.
    return [f"{each.outcome} {each.measures} {each.wheelsets}" for each in results]


def at_ends(case, key):
    """The results of a case under seed 1 at both ends of the range of a number."""
    [number] = [each for each in ranged_numbers(case.scenario) if each.key == key]
    seeds = listed_column([ParameterValue("1", 1)] * 2)
    return VariedCase(case, [key]).results({key: number.at(np.array([0.0, 1.0])), "seed": seeds})


def sentences(firm):
    return list(firmness_sentences(SimpleNamespace(firmness=firm, outcome=firm.nominal)))


def test_nominal_values_give_the_stop_itself_under_each_seed(numbers):
    varied = VariedCase(short_stop(), list(numbers), jobs=2)
    cases = [short_stop(f"seed={seed}") for seed in range(3)]
    stated = [run_cases([case]).results[0] for case in cases]
    assert measures(varied.results(columns(numbers, 3))) == measures(stated)


def test_a_survey_gives_stops_of_1_ms_and_those_of_half_of_it_where_its_bias_may_decide(numbers):
    settings = columns(numbers, 12, **{VENT: 0.9})
    short, long = (
        VariedCase(short_stop(*step), list(numbers)).results(settings)
        for step in ((), ("simulation.time_step=1 ms",))
    )
    surveyed = VariedCase(short_stop(), list(numbers), survey=True).results(settings)
    biases = biases_by_measure()
    expected = [half if may_be_biased(one, biases) else one for half, one in zip(short, long, strict=True)]
    assert measures(surveyed) == measures(expected)
    assert measures(surveyed) != measures(short)


def test_only_stops_of_the_regular_step_are_surveyed_and_the_report_says_so():
    regular = FirmnessRun(1, effort=SMALL).of_case(short_stop())
    other = FirmnessRun(1, effort=SMALL).of_case(short_stop("simulation.time_step=0.25 ms"))
    assert (regular.in_survey_steps, other.in_survey_steps) == (True, False)
    told = [any("steps of 1 ms" in each for each in sentences(firm)) for firm in (regular, other)]
    assert told == [True, False]


@pytest.mark.parametrize("place", [0.0, 0.37, 1.0])
def test_a_drawn_value_gives_the_stop_of_a_scenario_that_states_its_text(numbers, place):
    [text] = numbers[VENT].at(np.array([place])).texts
    stated = run_cases([short_stop(f"{VENT}={text}")]).results
    varied = VariedCase(short_stop(), list(numbers)).results(columns(numbers, 1, **{VENT: place}))
    assert measures(varied) == measures(stated)


def test_a_number_that_would_change_the_noise_meets_that_of_the_case(numbers, monkeypatch):
    keys = []

    def simulate(parameters, *others):
        keys.extend(f"{key:08x}" for key in parameters["noise_key"])
        return run_in_lanes(parameters, *others)

    monkeypatch.setattr(many_stops, "ManyStops", partial(many_stops.ManyStops, simulate=simulate))
    VariedCase(short_stop(), list(numbers)).results(columns(numbers, 2, **{RADIUS: 0.0}))
    [nominal] = run_cases([short_stop()]).results
    [other] = run_cases([short_stop(f"{RADIUS}=0.42 m")]).results
    assert keys == [nominal.noise_key] * 2
    assert other.noise_key != nominal.noise_key


def test_values_that_do_not_fit_together_are_errors_and_the_others_are_not():
    case = short_stop("simulation.time_step=1 ms", "brake.system.wsp_valve.switching_delay=22 ms")
    key = "simulation.maximum_duration"
    durations = [ParameterValue(text, parse_quantity(text, "time")) for text in ("180 s", "1 s")]
    settings = {key: listed_column(durations), "seed": listed_column([ParameterValue("0", 0)] * 2)}
    possible, impossible = VariedCase(case, [key]).results(settings)
    assert possible.outcome != "error"
    assert (impossible.outcome, "maximum_duration" in impossible.reason) == ("error", True)


def test_a_case_is_as_firm_however_many_threads_there_are():
    case = short_stop()
    one, two = (FirmnessRun(jobs, effort=SMALL).of_case(case) for jobs in (1, 2))
    assert one == two
    assert one.draws == 8
    assert len(one.numbers) > 60
    assert not one.on_four_calipers


def test_a_calibrating_stop_without_any_of_the_varied_numbers_is_refused(monkeypatch):
    own = firmness.sweeps.ranged_numbers
    monkeypatch.setattr(
        firmness.sweeps, "ranged_numbers", lambda scenario: own(scenario) if scenario.seed == 0 else []
    )
    calibrating = [short_stop("seed=1")]
    with pytest.raises(InvalidInputError, match="has none of the numbers that vary"):
        FirmnessRun(1, effort=SMALL, calibration=calibrating).of_case(short_stop())
    assert FirmnessRun(1, effort=SMALL, calibration=[short_stop()]).of_case(short_stop()).calibrated


def test_draws_of_a_random_rail_meet_one_rail_each():
    varied = "rail.variation={spread: {value: 20 %, range: [10 %, 40 %]}, correlation_length: 10 m, "
    case = short_stop(f"{varied}left_right_correlation: 0.5}}")
    assert "rail.variation.spread" in {each.key for each in ranged_numbers(case.scenario)}
    seeds = []

    class Noted(FirmnessRun):
        def _study_stops(self, cases, numbers, judge, profiles):
            def noting(columns, of_stops):
                seeds.append(list(of_stops))
                return judge(columns, of_stops)

            return super()._study_stops(cases, numbers, noting, profiles)

    Noted(1, effort=SMALL).of_case(case)
    assert list(range(8)) in seeds
    seeds.clear()
    Noted(1, effort=SMALL).of_case(short_stop())
    assert [0] * 8 in seeds


def test_numbers_of_replaced_parts_are_not_varied_and_those_of_the_scenario_by_their_own_range(numbers):
    assert "rail.condition.friction" not in numbers
    assert "brake.system.positions.R.maximum_pressure" in numbers
    assert "brake.system.positions.G.maximum_pressure" not in numbers
    assert not any(key.startswith("controller") for key in numbers)
    friction = "rail.friction={value: 0.06, range: [0.05, 0.09]}"
    case = short_stop("rail.gradient={value: 0 permille, range: [-2 permille, 3 permille]}", friction)
    own = {each.key: each for each in ranged_numbers(case.scenario) if each.mark == "user"}
    assert own["rail.gradient"].nominal_place == pytest.approx(0.4)
    assert own["rail.friction"].nominal_place == pytest.approx(0.25)


def test_a_number_of_a_sander_is_varied_and_less_sand_is_laid():
    case = short_stop("sanders=[{wheelset: 1, rate: {value: 6 kg/min, range: [1 kg/min, 6 kg/min]}}]")
    assert "rail.sand.kept" in {each.key for each in ranged_numbers(case.scenario)}
    least, most = at_ends(case, "sanders.0.rate")
    assert most.measures["braking_distance_m"] < least.measures["braking_distance_m"]


def test_numbers_of_further_brakes_and_sanders_without_a_range_are_named():
    case = short_stop(
        "brake.track={attraction: {value: 100 kN, range: [80 kN, 120 kN]}, off_below: 5 km/h}",
        "sanders=[{wheelset: 1, rate: 6 kg/min}]",
    )
    assert numbers_without_range(short_stop().scenario) == ["rail.friction"]
    named = numbers_without_range(case.scenario)
    assert {"brake.track.off_below", "sanders.0.rate", "sanders.0.delay"} <= set(named)
    assert "brake.track.attraction" not in named
    firm = FirmnessRun(1, effort=SMALL).of_case(case)
    assert firm.without_range == tuple(named)
    assert f"not varied, as no range is stated: {', '.join(named)}" in sentences(firm)


PROFILE = "rail.friction={points: [{position: 0 m, friction: 0.06}, {position: 10 m, friction: %s}]}"
MOVED = PROFILE.replace("10 m", "{value: 10 m, range: [5 m, 20 m]}")


@pytest.mark.parametrize(
    ("changes", "drawn", "unranged"),
    [
        (["rail.friction=0.06"], [], ["rail.friction"]),
        (["rail.friction={value: 0.06, range: [0.05, 0.09]}"], ["rail.friction"], []),
        ([PROFILE % "0.07"], [], ["rail.friction"]),
        ([MOVED % "0.07"], [], ["rail.friction"]),
        ([PROFILE % "{value: 0.07, range: [0.05, 0.09]}"], ["rail.friction.points.1.friction"], []),
        (["rail.friction=null", "rail.condition=leaf-layer"], ["rail.condition.friction"], []),
        (["rail.friction=null", "rail.condition=dry"], [], ["rail.condition.friction"]),
    ],
)
def test_friction_scatters_from_draw_to_draw_where_a_range_says_so_and_else_is_named(
    changes, drawn, unranged
):
    case = short_stop(*changes)
    firm = FirmnessRun(1, effort=Effort(blocks=1, block=2, seeds=1, seeds_at_ends=1)).of_case(case)
    at_rail = [each.key for each in firm.numbers if each.key.endswith("friction") and "rail." in each.key]
    assert [key for key in at_rail if "recovered" not in key] == drawn
    assert list(firm.without_range) == unranged
    assert [each for each in sentences(firm) if "no range is stated" in each] == [
        f"not varied, as no range is stated: {key}" for key in unranged
    ]


def test_draws_of_the_friction_of_the_rail_are_stops_on_other_rails():
    """On the best rail of the range the wheels do not slide; on the worst they do."""
    case = short_stop("rail.friction={value: 0.06, range: [0.03, 0.3]}")
    worst, best = at_ends(case, "rail.friction")
    [stated] = run_cases([short_stop("rail.friction=0.03", "seed=1")]).results
    # Its noise is that of the case, so that it is not the very same stop.
    distance = stated.measures["braking_distance_m"]
    assert worst.measures["braking_distance_m"] == pytest.approx(distance, rel=0.05)
    assert worst.measures["braking_distance_m"] > 1.5 * best.measures["braking_distance_m"]
