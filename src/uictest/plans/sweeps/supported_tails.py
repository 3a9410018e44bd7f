"""Reject quantiles and K_dry that the cases of a sweep do not support."""

from __future__ import annotations

from collections.abc import Iterator
from typing import Final

from uictest.plans.scenario import CONDITION
from uictest.plans.scenario.yaml import ScenarioErrors, diagnose, quoted
from uictest.plans.sweeps.plan import Plan, SampledGroup, random_sample, scenarios_with_each
from uictest.plans.sweeps.sweep_file import SweepFile

DRY: Final = "dry"
"""Name of the rail condition that K_dry is defined for."""
_RANDOM: Final = "a quantile is bounded from independent draws: write `sample: {method: random, ...}`"


def reject_unsupported_tails(plan: Plan, file: SweepFile) -> None:
    """Raise ScenarioErrors where quantiles or K_dry lack a random sample, or K_dry a dry rail.

    The errors are reported at the keys of the file.
    """
    diagnostics = [
        diagnose(file.tree.entries[section].key, message, file.key(section), hint)
        for section, is_requested in (("quantiles", plan.quantiles), ("k_dry", plan.k_dry is not None))
        if is_requested
        for message, hint in _problems(plan, of_dry_rail=section == "k_dry")
    ]
    if diagnostics:
        raise ScenarioErrors(diagnostics)


def _problems(plan: Plan, *, of_dry_rail: bool) -> Iterator[tuple[str, str]]:
    """Yield what is wrong and what to write instead."""
    last = plan.groups[-1]
    if not isinstance(last, SampledGroup):
        yield "the values of this sweep are listed, not drawn", _RANDOM
    elif random_sample(plan) is None:
        yield f"points of method {last.method} are not independent of each other", _RANDOM
    if of_dry_rail:
        for name in dict.fromkeys(_conditions(plan)):
            if name != DRY:
                hint = "write `rail: {condition: dry}` in the scenario, and no other condition in the sweep"
                yield f"K_dry holds for dry rail; the rail condition is {quoted(name)}", hint


def _conditions(plan: Plan) -> Iterator[str]:
    """Yield the names of the rail conditions that the cases have."""
    yield from (scenario.rail.condition.name for scenario in scenarios_with_each(plan, CONDITION))
