"""A recording fed to the measures by machine code, where a stop has been loaded together with it."""

from collections.abc import Callable, Sequence
from typing import Any

import numpy as np
from numpy.typing import NDArray

from uictest.core.measures import (
    STOP_MEASURES,
    WHEELSET_MEASURES,
    Cell,
    MeasureDefinition,
    Replay,
)
from uictest.core.record import fields_of
from uictest.rig.backends.machine_code import loaded_beside
from uictest.rig.backends.scalar import NOTE, RUN
from uictest.rig.model.parameters import PARAMETERS

_RECORDS = np.dtype([("train", STOP_MEASURES), ("wheelsets", WHEELSET_MEASURES, 4)])
_NUMBER = np.dtype("f8")


def noted_numbers(replay: Replay, cells: Sequence[Cell]) -> NDArray[np.float64]:
    """Let the samples pass as :meth:`.Replay.noted` does, compiled if a stop was run in this process."""
    note = _compiled()
    return replay.noted(cells) if note is None else _noted(note, replay, cells)


def pass_samples(replay: Replay) -> None:
    """Let all samples pass, compiled if a stop was run in this process."""
    note = _compiled()
    if note is not None:
        _noted(note, replay, ())
        return
    for _ in replay.pass_samples():
        pass


def _compiled() -> Callable[..., int] | None:
    return loaded_beside(RUN, NOTE)


def _noted(note: Callable[..., int], replay: Replay, cells: Sequence[Cell]) -> NDArray[np.float64]:
    samples = replay.samples.before(replay.end)
    records, parameters = np.zeros(1, _RECORDS), np.zeros(1, PARAMETERS)
    train, wheelsets = records["train"][0], records["wheelsets"][0]
    for name in fields_of(MeasureDefinition):
        parameters[name] = getattr(replay.definition, name)
    for own, record in zip((replay.train, *replay.wheelsets), (train, *wheelsets), strict=True):
        for name in record.dtype.names:
            record[name] = getattr(own, name)
    numbers = records.view(_NUMBER)
    places = np.array([_place(cell) for cell in cells], np.int64)
    noted = np.empty((len(samples.train) - 1, len(cells)))
    note(
        *(train, wheelsets, parameters[0], samples.train, samples.wheelsets, samples.faults),
        *(numbers, places, noted),
    )
    for own, record in zip((replay.train, *replay.wheelsets), (train, *wheelsets), strict=True):
        vars(own).update((name, record[name].tolist()) for name in record.dtype.names)
    return noted


def _place(cell: Cell) -> int:
    """Return where a number of the records lies among them all."""
    name, n, place = cell
    layout: Any = WHEELSET_MEASURES if n else STOP_MEASURES
    start = STOP_MEASURES.itemsize + (n - 1) * WHEELSET_MEASURES.itemsize if n else 0
    return int(start + layout.fields[name][1]) // _NUMBER.itemsize + (place or 0)
