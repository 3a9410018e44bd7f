"""What a sweep file may ask of its draws, and what is said of a request that is wrong."""

from pathlib import Path

import pytest

from uictest.plans.scenario import ScenarioErrors
from uictest.plans.scenario.parts.tail_requests import QuantileRequest
from uictest.plans.sweeps import load_sweep

SAMPLE = "sample: {method: %s, size: 4, parameters: {vehicle.body.mass: {uniform: [30 t, 34 t]}}}\n"
DRAWN = SAMPLE % "random"


@pytest.fixture
def load_on(load):
    """The plan of a sweep on a rail of this condition, whose file says the given text under `vary`."""
    stop = "schema: uictest/scenario/1\nname: stop\ninitial_speed: 30 km/h\nrail: {condition: %s}\n"
    return lambda condition, text: load(text, stop=stop % condition)


def test_one_request_or_a_list_of_them_and_k_dry_needs_nothing_but_a_sample(load_on):
    one = "{measure: mean_deceleration, levels: [0.1 %, 50 %]}"
    plan = load_on("wet", f"{DRAWN}quantiles: {one}\n")
    assert load_on("wet", f"{DRAWN}quantiles: [{one}]\n").quantiles == plan.quantiles
    (request,) = plan.quantiles
    assert (request.measure, request.levels, request.confidence) == (
        "mean_deceleration_mps2",
        (0.001, 0.5),
        0.95,
    )
    request = load_on("dry", DRAWN + "k_dry: {}\n").k_dry
    assert (request.measure, request.nominal, request.confidence) == (
        "developed_deceleration_mps2",
        None,
        0.95,
    )


def test_the_bound_lies_on_the_tail_unless_stated(load_on):
    request = QuantileRequest(measure="maximum_slide_3", levels=["1 %", "50 %", "99 %"])
    assert [request.side_of(level) for level in request.levels] == ["lower", "both", "upper"]
    stated = request.model_copy(update={"side": "upper"})
    assert {stated.side_of(level) for level in request.levels} == {"upper"}


@pytest.mark.parametrize(
    ("condition", "text", "expected"),
    [
        (
            "dry",
            "matrix: {brake.command: [80 %]}\nk_dry: {}\n",
            "6:3: vary.k_dry: the values of this sweep are",
        ),
        ("dry", SAMPLE % "sobol" + "k_dry: {}\n", "vary.k_dry: points of method sobol are not independent"),
        (
            "dry",
            SAMPLE % "latin-hypercube" + "quantiles: {measure: braking_time, levels: [1 %]}\n",
            "write `sample: {method: random, ...}`",
        ),
        ("wet", DRAWN + "k_dry: {}\n", "K_dry holds for dry rail; the rail condition is 'wet'"),
        ("dry", DRAWN + "matrix: {rail.condition: [dry, wet]}\nk_dry: {}\n", "the rail condition is 'wet'"),
        ("dry", DRAWN + "k_dry: {measure: braking_distance}\n", "is no deceleration in m/s2: its unit is m"),
        ("dry", DRAWN + "k_dry: {measure: initial_adhesion}\n", "such as mean_deceleration"),
        ("dry", DRAWN + "k_dry: {nominal: 1.2}\n", "write `1.2 m/s2`"),
        ("dry", DRAWN + "k_dry: {nominel: 1.2 m/s2}\n", "did you mean 'nominal'?"),
        (
            "wet",
            DRAWN + "quantiles: [{measure: mean_decelleration, levels: [1 %]}]\n",
            "vary.quantiles.0.measure: no measure 'mean_decelleration'",
        ),
        (
            "wet",
            DRAWN + "quantiles: {measure: mean_decelleration, levels: [1 %]}\n",
            "did you mean 'mean_deceleration'?",
        ),
        ("wet", DRAWN + "quantiles: {measure: braking_time, levels: [100 %]}\n", "it must be below 100 %"),
        ("wet", DRAWN + "quantiles: {measure: braking_time, levels: [0.01]}\n", "has no unit"),
        ("wet", DRAWN + "quantiles: {measure: braking_time, levels: 1 %}\n", "write `levels: [1 %]`"),
        (
            "wet",
            DRAWN + "quantiles: {measure: braking_time, levels: [1 %], side: left}\n",
            "expected one of lower, upper, both",
        ),
        ("wet", DRAWN + "quantiles: 7\n", "expected a mapping"),
    ],
)
def test_errors_say_where_and_what_is_accepted(load_on, condition, text, expected):
    with pytest.raises(ScenarioErrors) as caught:
        load_on(condition, text)
    assert expected in str(caught.value)
    assert str(caught.value).startswith("study.sweep.yaml:")


def test_a_sample_that_the_command_line_replaces_supports_nothing(load_on):
    load_on("dry", DRAWN + "k_dry: {}\n")
    with pytest.raises(ScenarioErrors, match="are listed, not drawn"):
        load_sweep(Path("study.sweep.yaml"), ["vehicle.body.mass=30 t,34 t"])
