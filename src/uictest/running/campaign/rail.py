"""The rail of stops that are no test by what their WSP made of them: the same stops with the WSP bypassed."""

from __future__ import annotations

from collections.abc import Sequence
from functools import cache

from uictest import rig
from uictest.controllers import DEFAULT
from uictest.judging import evaluation
from uictest.plans import scenario
from uictest.plans.scenario.yaml import Part


def with_rails(
    cases: Sequence[scenario.Case], results: Sequence[evaluation.CaseResult]
) -> list[evaluation.CaseResult]:
    """Return the results of a stop, or of the cars of a train, with the validity of the rail where asked.

    The stop is run again under its seed, with the WSP bypassed: of a train, that of every car.
    """
    asked = [evaluation.asks_for_rail(*each) for each in zip(cases, results, strict=True)]
    if not any(asked):
        return list(results)
    bypassed = [case.changed(_bypassed) for case in cases]
    if cases[0].train is not None:
        stops = rig.simulate_cars(bypassed, None)
    else:
        stops = [rig.simulate(case, None) for case in bypassed]
    return [
        evaluation.with_rail(result, case, stop.measures, stop.wheelset_measures) if wanted else result
        for wanted, case, result, stop in zip(asked, cases, results, stops, strict=True)
    ]


def _bypassed(resolved: scenario.Scenario) -> scenario.Scenario:
    """Return a scenario with the WSP bypassed; no program from outside runs where it would not act."""
    bypassed = scenario.with_wsp_bypassed(resolved)
    if resolved.controller.program is None:
        return bypassed
    own = {"cycle_time": resolved.controller.cycle_time}
    return bypassed.model_copy(update={"controller": _built_in().model_copy(update=own)})


@cache
def _built_in() -> Part:
    return scenario.load_part(f"controllers/{DEFAULT}")
