"""The stops whose numbers are stored: each is simulated once, when it is first asked for."""

import hashlib
from collections.abc import Mapping
from pathlib import Path
from typing import Any, Final

import numpy as np

from uictest import rig
from uictest.plans import scenario

_FOLDER: Final = Path(__file__).parent / "stops"
Numbers = Mapping[str, str]
"""Name of a number -> its shortest text that reads back as the same bits."""


class KnownStops:
    """The stored stops and their simulations."""

    def __init__(self) -> None:
        self.cases = {case.id: case for case in scenario.load([_FOLDER])}
        self._stops: dict[str, rig.SimulatedStop] = {}

    def stop(self, name: str) -> rig.SimulatedStop:
        """Return a stop, simulated alone."""
        if name not in self._stops:
            self._stops[name] = rig.simulate(self.cases[name])
        return self._stops[name]

    def in_lanes(self) -> dict[str, Numbers]:
        """Return the numbers of all stops, simulated side by side in the lanes of a register."""
        inputs = [rig.assemble(case) for case in self.cases.values()]
        points = max(each.rail.shape[1] for each in inputs)
        batch = rig.run_in_lanes(
            np.array([each.parameters for each in inputs]),
            np.array([each.wheelset_parameters for each in inputs]),
            np.array([np.pad(each.rail, ((0, 0), (0, points - each.rail.shape[1]))) for each in inputs]),
        )
        stops = zip(self.cases, *batch, strict=True)
        return {name: numbers_of(train, wheelsets) for name, train, wheelsets in stops}


def numbers_of(train: Any, wheelsets: Any) -> Numbers:
    """Return every number of the measures of a stop and of its wheelsets as text."""
    numbers = {name: _text(train[name]) for name in train.dtype.names}
    for place, wheelset in enumerate(wheelsets, start=1):
        numbers |= {f"wheelset_{place}.{name}": _text(wheelset[name]) for name in wheelset.dtype.names}
    return numbers


def numbers_of_stop(stop: rig.SimulatedStop) -> Numbers:
    """Return every number of a simulated stop as text."""
    return numbers_of(stop.measures, stop.wheelset_measures)


def digest_of(numbers: Numbers) -> str:
    """Return the SHA-256 of numbers, whatever their order."""
    lines = (f"{name}={text}\n" for name, text in sorted(numbers.items()))
    return hashlib.sha256("".join(lines).encode()).hexdigest()


def inputs_digest(case: scenario.Case) -> str:
    """Return the SHA-256 of the records that the rig is given for a stop."""
    inputs = rig.assemble(case)
    records = inputs.parameters, inputs.wheelset_parameters, np.ascontiguousarray(inputs.rail)
    return hashlib.sha256(b"".join(record.tobytes() for record in records)).hexdigest()


def _text(number: Any) -> str:
    return " ".join(repr(float(each)) for each in np.ravel(number))
