"""Stops, wheelsets, criteria and scenarios to judge, each with a sound default and what a test changes."""

from importlib import resources
from pathlib import Path
from types import SimpleNamespace

import yaml

from uictest.judging.evaluation import SimulatedRepeat, evaluate, evaluate_repeats, judge
from uictest.plans.scenario import expectation_of
from uictest.plans.scenario.parts.criteria import Criteria, Criterion
from uictest.plans.scenario.parts.measures import MeasureDefinitions
from uictest.plans.scenario.yaml import parse_quantity

from ..measures.catalogue.conftest import wheelsets


def criterion(measure="braking_distance", **fields):
    return Criterion.model_validate({"id": "tested", "layer": "validity", "measure": measure, **fields})


def profile(*criteria):
    return Criteria(name="tested", criteria=criteria)


def written(name, folder="criteria"):
    file = resources.files("uictest.plans.library") / folder / f"{name}.yaml"
    return yaml.safe_load(file.read_text("utf-8"))


def shipped(name):
    return Criteria.model_validate(written(name))


def scenario(*profiles, condition="dry", **changes):
    settings = {
        "wsp": "active",
        "position": "R",
        "command": 1.0,
        "gradient": 0.0,
        "initial_speed": "120 km/h",
        "expect": "pass",
        **changes,
    }
    return SimpleNamespace(
        rail=SimpleNamespace(
            condition=SimpleNamespace(name=condition),
            gradient=parse_quantity(f"{1e3 * settings['gradient']:g} permille", "gradient"),
            cleaning_in_force=None,
        ),
        rig=SimpleNamespace(wsp=settings["wsp"], topology="one-caliper"),
        initial_speed=parse_quantity(settings["initial_speed"], "speed"),
        faults=(),
        brake=SimpleNamespace(
            position=settings["position"],
            first_command=settings["command"],
            commands=[(0.0, settings["command"], settings["position"])],
        ),
        until=None,
        drag=None,
        simulation=SimpleNamespace(maximum_duration=SimpleNamespace(text="60 s")),
        criteria=profiles,
        judged_by=profiles,
        measures=MeasureDefinitions.model_validate(written("standard", "measures")),
        expect=expectation_of(settings["expect"]),
        requirements=(),
        test_case=None,
    )


def case(scenario):
    return SimpleNamespace(
        id="slip-120[friction=0.10]",
        scenario=scenario,
        path=Path("scenarios") / "slip-120.yaml",
        parameters={"rail.friction": "0.10"},
        train=None,
    )


def verdict_of(criterion, measures, records=None, coverage=None):
    """Judge a stop by one criterion."""
    records = wheelsets(0.1, 0.1, 0.1, 0.1) if records is None else records
    (verdict,) = judge(scenario(profile(criterion)), measures, records, coverage=coverage)
    return verdict


def evaluate_stops(scenario, *stops, rule="all"):
    """Judge a case whose stops under seeds 0, 1, ... have these measures of the stop and of the wheelsets."""
    scenario.outcome_of_repeats = rule
    together = case(scenario)
    repeats = [
        SimulatedRepeat(seed, evaluate(together, *records, detail="status"), *records)
        for seed, records in enumerate(stops)
    ]
    return evaluate_repeats(together, repeats)
