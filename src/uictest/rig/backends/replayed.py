"""A recording fed to the measures by the kernel."""

from collections.abc import Sequence

import numpy as np
from numpy.typing import NDArray

from uictest.core.measures import (
    FAULT_COLUMNS,
    STOP_MEASURES,
    WHEELSET_MEASURES,
    Cell,
    MeasureDefinition,
    Replay,
    place_of,
)
from uictest.core.record import fields_of
from uictest.rig.kernel.arguments import Length, at
from uictest.rig.kernel.library import Entry, native_function
from uictest.rig.model.parameters import PARAMETERS

_ROWS, _NOTED = Length("rows"), Length("noted")
NOTE = Entry(
    "uictest.core.measures.noted_samples:note_samples",
    (
        *(at(STOP_MEASURES), at(WHEELSET_MEASURES, 4), at(PARAMETERS)),
        *(at("f8", _ROWS, 8), at("f8", _ROWS, 4, 10), at("f8", Length("faults"), FAULT_COLUMNS)),
        *(at("f8", Length("numbers")), at("i8", _NOTED), at("f8", _ROWS - 1, _NOTED)),
    ),
)


def noted_numbers(replay: Replay, cells: Sequence[Cell]) -> NDArray[np.float64]:
    """Let the samples pass, and return numbers of the records after each but the first, a row each."""
    parameters = np.zeros(1, PARAMETERS)
    for name in fields_of(MeasureDefinition):
        parameters[name] = getattr(replay.definition, name)
    places = np.array([place_of(cell) for cell in cells], np.int64)
    noted = np.empty((len(replay.samples.train) - 1, len(cells)))
    native_function(NOTE)(
        *(replay.train, replay.wheelsets, parameters[0], *replay.samples, replay.numbers, places, noted)
    )
    return noted


def pass_samples(replay: Replay) -> None:
    """Let all samples pass."""
    noted_numbers(replay, ())
