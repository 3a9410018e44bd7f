"""Measures of many stops judged one after the other."""

from __future__ import annotations

from collections import namedtuple
from collections.abc import Sequence
from typing import Any

from uictest.evaluation import CaseResult, error_result, evaluate_simulated
from uictest.measures import STOP_MEASURES, WHEELSET_MEASURES
from uictest.sweep.running.assembling import Assembler, Block
from uictest.sweep.running.simulating import Measures

# Reading a field of a numpy record takes ten times as long as one of a tuple, and judging reads many.
_tuple_of: Any = namedtuple
_Stop = _tuple_of("_Stop", STOP_MEASURES.names)
_Wheelset = _tuple_of("_Wheelset", WHEELSET_MEASURES.names)


def judged(assembler: Assembler, block: Block, places: Sequence[int], measures: Measures) -> list[CaseResult]:
    """Return the results of all cases of a block; those not among the simulated `places` were refused."""
    stops = dict(zip(places, zip(*(each.tolist() for each in measures), strict=True), strict=True))
    return [_result(assembler, block, place, stops.get(place)) for place in range(len(block.ids))]


def _result(assembler: Assembler, block: Block, place: int, stop: Any) -> CaseResult:
    case = assembler.case(block, place)
    if stop is None:
        return error_result(case, block.refused[place])
    try:
        wheelsets = [_Wheelset(*wheelset) for wheelset in stop[1]]
        return evaluate_simulated(case, _Stop(*stop[0]), wheelsets, explain=False)
    except Exception as error:  # one case that cannot be judged is a row, never the end of the sweep
        return error_result(case, f"{type(error).__name__}: {error}")
