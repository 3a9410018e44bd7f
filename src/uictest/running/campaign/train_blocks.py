"""What a thread runs in one go: a stop, the cars of a train, or many trains in lanes, with the same bits."""

from __future__ import annotations

from collections.abc import Iterator, Sequence
from typing import Final

from uictest import rig
from uictest.plans import scenario
from uictest.running.campaign.stop import (
    RecordingRequest,
    Stop,
    StopRun,
    interval_at_once,
    run_stop,
    run_train,
    run_trains,
    stops_together,
)

_MOST_TOGETHER: Final = 32
"""Trains that a thread simulates in one queue; chosen: four times what the widest registers hold."""

Block = Sequence[Sequence[Stop]]
"""Stops that run at once, one alone or those of the cars of a train; or several trains."""


def blocks_of(cases: Sequence[scenario.Case], request: RecordingRequest, jobs: int) -> Iterator[Block]:
    """Yield what each of so many threads runs in one go, in order of cases and seeds."""
    trains = sum(_fits(stops, request) for stops in stops_together(cases))
    # As many for each thread: at the end of the longest all others wait.
    rounds = -(-trains // (_MOST_TOGETHER * jobs))
    size = -(-trains // (rounds * jobs)) if trains else 1
    block: list[Sequence[Stop]] = []
    for stops in stops_together(cases):
        fits = _fits(stops, request)
        if block and (len(block) == size or not fits):
            yield tuple(block)
            block = []
        block.append(stops)
        if not fits:
            yield tuple(block)
            block = []
    if block:
        yield tuple(block)


def run_block(
    block: Block,
    request: RecordingRequest,
    run: rig.RunInputs | None = None,
    run_of_train: rig.RunTrain | None = None,
) -> list[StopRun]:
    """Simulate and judge what runs in one go.

    `run` runs stops of cars alone, see :func:`.run_stop`, and `run_of_train` those of trains.
    """
    if len(block) > 1:
        return run_trains(block, request)
    (stops,) = block
    if stops[0].case.train is not None:
        return run_train(stops, request, run_of_train)
    return [run_stop(stop, request, run) for stop in stops]


def _fits(stops: Sequence[Stop], request: RecordingRequest) -> bool:
    """Return whether stops can run in a lane: those of a train with built-in controllers, of which no samples
    are kept.
    """
    first = stops[0]
    is_in_train = first.case.train is not None and not first.case.is_from_outside
    return is_in_train and interval_at_once(first, request) is None
