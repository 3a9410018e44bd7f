"""Which of two variants of a stop is better, and whether numbers that nobody measured turn that."""

from __future__ import annotations

import json
from collections.abc import Iterator, Sequence
from itertools import chain, groupby
from typing import Any, Final, NamedTuple

from pydantic import TypeAdapter

from uictest import rig
from uictest.analysis.firmness import COMPARED
from uictest.core import envelope
from uictest.judging.evaluation import Firmness, to_json_form
from uictest.plans import scenario
from uictest.plans.scenario.yaml import nearest
from uictest.report import FirmPair
from uictest.running import campaign
from uictest.runs.errors import InvalidInputError
from uictest.runs.firmness import firmness_run, stops_of_pair
from uictest.runs.observer import Observer

_WRITTEN: Final = (
    *("numbers", "draws", "infeasible", "not_run", "seeds", "on_four_calipers"),
    *("calibrated_by", "without_range"),
)
"""What is written of a study besides the quantities: pairs have no outcome."""


class _Pair(NamedTuple):
    first: scenario.Case
    second: scenario.Case


def firm_pairs(
    cases: Sequence[scenario.Case], keys: Sequence[str], settings: campaign.RunSettings, observer: Observer
) -> Iterator[FirmPair]:
    """Yield for every variant of a stop how firm it is against the first one.

    Args:
        cases: of scenarios.
        keys: in whose values variants differ; all their other values are the same.
        settings: of the run: threads, isolation.
        observer: is called in this thread.

    Raises InvalidInputError where no two cases pair.
    """
    pairs = _pairs(cases, keys)
    with observer.compiling():
        run = [*chain(*pairs), *settings.calibration]
        rig.load_block([case.scenario.controller.program for case in run])
    stops = sum(stops_of_pair(*pair, settings) for pair in pairs)
    with observer.simulating(stops, unit="stops") as advance, firmness_run(settings, advance) as firm:
        for first, second in pairs:
            found = firm.of_pair(first, second)
            decided = {each.criterion for each in found.criteria}
            yield FirmPair(first.id, second.id, found, [each for each in COMPARED if each not in decided])


def _pairs(cases: Sequence[scenario.Case], keys: Sequence[str]) -> list[_Pair]:
    known = list(dict.fromkeys(key for case in cases for key in case.parameters))
    for key in keys:
        if key not in known:
            guess = nearest(key, known)
            hint = f"did you mean {guess!r}? " if guess else ""
            listed = ", ".join(known) or "nothing"
            raise InvalidInputError(
                f"--over: no case has a value of {key!r}; {hint}they differ in: {listed};"
                " name the variants with --set, as in --set controller=threshold,slip-band"
            )
    alike = sorted(cases, key=lambda case: _others(case, keys))
    groups = [list(group) for _, group in groupby(alike, key=lambda case: _others(case, keys))]
    pairs = [_Pair(group[0], other) for group in groups for other in group[1:]]
    if not pairs:
        raise InvalidInputError(f"--over: no two cases differ in {', '.join(keys)} alone")
    return pairs


def _others(case: scenario.Case, keys: Sequence[str]) -> tuple[tuple[str, str], ...]:
    others = ((key, value) for key, value in case.parameters.items() if key not in keys)
    return (("", str(case.path)), *others)


def firm_pairs_json(pairs: Sequence[FirmPair]) -> str:
    """Return pairs as a JSON document; a quantity `pass`es where the first stop comes to less."""
    form = {**envelope.head(envelope.RESULT, "firm-variants"), "pairs": list(map(_form, pairs))}
    return json.dumps(form, indent=2, allow_nan=False)


def _form(pair: FirmPair) -> dict[str, Any]:
    whole = to_json_form(TypeAdapter(Firmness), pair.firmness)
    study = {name: whole[name] for name in _WRITTEN if name in whole}
    sides = {"first": pair.first, "second": pair.second}
    return {**sides, "quantities": whole["criteria"], "undecided": list(pair.undecided), **study}
