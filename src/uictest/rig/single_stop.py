"""One stop: what the rig is given for it, the key of its sensors' noise, and what it leaves.

With the seed the key decides every draw. Neither the controller nor anything else of the rig has a part in
it, so that two controllers, two compensations or two topologies meet the same noise in the same stop.
"""

from __future__ import annotations

import zlib
from dataclasses import dataclass
from typing import Any, Final, NamedTuple

import numpy as np
from numpy.typing import NDArray

from uictest.controllers import Config, ControllerProgram, ResponseTimes
from uictest.core.ensemble import alike, rows_at
from uictest.rig.model.rail import FACTORS, FRICTIONS, PLACES, TIMES
from uictest.rig.model.trace import Trace

_OF_STOP: Final = ("initial_speed", "commanded_pressure", "static_wheel_load")
_OF_WHEELSETS: Final = ("wheel_radius", "brake_force", "reference_pad_friction")
_ALONG_TRACK: Final = slice(PLACES, FRICTIONS + 1)
_OVER_TIME: Final = slice(TIMES, FACTORS + 1)


def noise_keys(
    parameters: NDArray[Any], wheelset_parameters: NDArray[Any], rail: NDArray[np.float64]
) -> NDArray[np.int64]:
    """Return the noise keys of n stops: CRC-32 of initial speed, commanded pressure and wheel load, of each
    wheelset's radius, brake force and pad friction, and of the friction along the track and over time.

    Stops that differ in other values share their noise. So few values decide because any further one would
    change the noise of every stop.

    Args:
        parameters: records of :data:`~uictest.rig.model.parameters.PARAMETERS`, shape (n,).
        wheelset_parameters: of :data:`~uictest.rig.model.wheelset_parameters.WHEELSET_PARAMETERS`, (n, 4).
        rail: friction laws, shape (n, 4, points); points beyond those of a law do not count.
    """
    columns = [parameters[name][:, None] for name in _OF_STOP]
    columns += [wheelset_parameters[name] for name in _OF_WHEELSETS]
    values = np.concatenate(columns, axis=1)
    lengths = parameters["friction_points"], parameters["friction_times"]
    keys = np.zeros(len(values), np.int64)
    for stops in alike(lengths, len(values)):
        points, times = (int(length[stops[0]]) for length in lengths)
        of_law = rows_at(rail, stops)
        laws = of_law[:, _ALONG_TRACK, :points], of_law[:, _OVER_TIME, :times]
        rows = [rows_at(values, stops), *(law.reshape(stops.size, -1) for law in laws)]
        keys[stops] = _crc32_of_rows(np.concatenate(rows, axis=1))
    return keys


def _crc32_of_rows(rows: NDArray[np.float64]) -> list[int]:
    content, length = rows.tobytes(), rows.shape[1] * rows.itemsize
    return [zlib.crc32(content[first : first + length]) for first in range(0, len(content), length)]


def noise_key_text(parameters: np.void) -> str:
    """Return the key in a parameter record as results state it: eight hexadecimal digits."""
    return f"{int(parameters['noise_key']):08x}"


class StopInputs(NamedTuple):
    """What the rig is given for one stop.

    Attributes:
        parameters: record of :data:`~uictest.rig.model.parameters.PARAMETERS`.
        wheelset_parameters: four records of
            :data:`~uictest.rig.model.wheelset_parameters.WHEELSET_PARAMETERS`.
        rail: friction of the rail, the rows of :mod:`~uictest.rig.model.rail`, shape (4, n).
        program: what is loaded where the controller comes from outside, else None.
        config: what that controller is given before the stop, else None.
    """

    parameters: Any
    wheelset_parameters: Any
    rail: NDArray[np.float64]
    program: ControllerProgram | None = None
    config: Config | None = None


@dataclass(frozen=True)
class FinishedStop:
    """What a stop leaves: its measures, the final state and, if requested, the trace.

    Of a controller from outside also the version that it names, how it answered if cycles were paced by the
    clock, the version of the contract, and what it printed, where that is kept.
    """

    measures: Any
    wheelset_measures: Any
    car: Any
    wheelsets: Any
    trace: Trace
    controller_version: str = ""
    response_times: ResponseTimes | None = None
    contract: int = 1
    controller_output: str = ""


def rows_of_trace(parameters: Any, steps_per_sample: int) -> int:
    """Return the rows of the longest trace of a stop; 0 steps per sample: none."""
    if steps_per_sample == 0:
        return 0
    return int(parameters["cycles"] * parameters["steps_per_cycle"]) // steps_per_sample + 1
