"""A recording whose samples are fed to the measures: the samples, and the records at the first of them."""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from math import inf, nan
from typing import Any, Final, NamedTuple

import numpy as np
from numpy.typing import NDArray

from uictest.core.measures.samples import STOP_MEASURES, WHEELSET_MEASURES
from uictest.core.measures.train import begin_train, begin_window, keep_window, note_standstill, observe_train
from uictest.core.measures.wheelset import begin_slides, begin_slow_times, begin_wheelset, keep_slow_times
from uictest.core.physics import FILL, VENT

Array = NDArray[np.float64]
Channels = Mapping[str, Array]
Faults = tuple[Array, Array, Array, Array]
"""At every sample whether any has begun, shape (n,); whether a part of each wheelset has had one, whether its
speed sensor has one, and whether it has had one that is to be reported, shape (n, 4)."""
FAULT_COLUMNS: Final = 13
Cell = tuple[str, int, int | None]
"""A number in the records: field, number of the wheelset or 0 for the train, index where the field is a
table."""
_WHEELSETS: Final = (1, 2, 3, 4)
_WHEELS: Final = 2.0
"""Of a wheelset: adhesion and wheel load are those of one."""
_RECORDS: Final = np.dtype([("train", STOP_MEASURES), ("wheelsets", WHEELSET_MEASURES, 4)])
_NUMBER: Final = 8
"""Bytes of a number of these records."""


class Samples(NamedTuple):
    """Samples of a recording; NaN where nothing was recorded.

    Args:
        train: time, distance, speed, pressures of reservoir and brake line, highest of the cylinder
            pressures, reference speed and diagnosis; shape (n, 8).
        wheelsets: of each one the speed, whether its valve is commanded to vent, clamping force, temperature
            of the disc surface, pressure of the tank, work of the rail, energy that the contacts turned into
            heat, the highest force that they could transmit, the speed that its sensor shows, and whether its
            valve is commanded to fill; shape (n, 4, 10).
        faults: whether any has begun, then what else :data:`Faults` hold, for one wheelset after the other;
            shape (n, 13), or (0, 13) where none were recorded.

    """

    train: Array
    wheelsets: Array
    faults: Array

    def before(self, end: float) -> Samples:
        """Return the samples before a time, s, of which the first is always one."""
        count = max(int(np.searchsorted(self.train[:, 0], end)), 1)
        return Samples(self.train[:count], self.wheelsets[:count], self.faults[:count])


def samples_of(
    channels: Channels, highest_force: Array | None = None, faults: Faults | None = None
) -> Samples:
    """Return the samples of a recording, SI; what is not among its channels is unknown.

    The work of the rail and the heat of the contacts are integrated by trapezoids; a gap adds none.
    `highest_force` is what both contacts of each wheelset could transmit, N, shape (n, 4).
    """
    time, speed = channels["time"], channels["speed"]
    unknown = np.full(len(time), np.nan)

    def of_train(name: str) -> Array:
        return np.asarray(channels.get(name, unknown), dtype=np.float64)

    def of_wheelsets(name: str) -> Array:
        return np.stack([of_train(f"{name}_{n}") for n in _WHEELSETS], axis=1)

    wheel_speed, command = of_wheelsets("wheel_speed"), _last_known(of_wheelsets("valve_command"))
    shown_speed = of_wheelsets("measured_speed") if "measured_speed_1" in channels else wheel_speed
    force = _WHEELS * of_wheelsets("adhesion") * of_wheelsets("wheel_load")
    train = [
        *map(of_train, ("time", "distance", "speed", "reservoir_pressure", "brake_line_pressure")),
        np.fmax.reduce(of_wheelsets("cylinder_pressure"), axis=1),
        of_train("reference_speed"),
        of_train("diagnosis"),
    ]
    wheelsets = [
        wheel_speed,
        np.where(command == VENT, 1.0, 0.0),
        *map(of_wheelsets, ("clamping_force", "disc_surface_temperature", "tank_pressure")),
        _integrated(force * speed[:, None], time),
        _integrated(force * (speed[:, None] - wheel_speed), time),
        np.full_like(force, np.nan) if highest_force is None else highest_force,
        shown_speed,
        np.where(command == FILL, 1.0, 0.0),
    ]
    return Samples(
        np.stack(train, axis=1),
        np.stack(wheelsets, axis=2),
        np.empty((0, FAULT_COLUMNS)) if faults is None else np.column_stack(faults),
    )


def _integrated(power: Array, time: Array) -> Array:
    steps = 0.5 * (power[1:] + power[:-1]) * np.diff(time)[:, None]
    return np.concatenate((np.zeros((1, power.shape[1])), np.cumsum(np.nan_to_num(steps), axis=0)))


def _last_known(command: Array) -> Array:
    """Return commands in which a gap keeps the state before it: one vent is not two."""
    known = np.where(np.isnan(command), 0, np.arange(len(command))[:, None])
    return np.take_along_axis(command, np.maximum.accumulate(known, axis=0), axis=0)


class Replay:
    """The records of a stop at its first sample; the rig lets the others pass.

    Attributes:
        samples: of the recording, up to the last that is fed.
        definition: how samples become measures.
        train: record of :data:`~uictest.core.measures.STOP_MEASURES`.
        wheelsets: four records of :data:`~uictest.core.measures.WHEELSET_MEASURES`.
        numbers: both again, as numbers one after the other.
    """

    def __init__(
        self, samples: Samples, definition: Any, commanded_pressure: float, end: float = inf
    ) -> None:
        """Begin the records.

        Args:
            samples: of the recording.
            definition: how samples become measures.
            commanded_pressure: of the brake line, gauge, Pa.
            end: time of the first sample that is not fed, s.
        """
        self.samples, self.definition = samples.before(end), definition
        records = np.zeros(1, _RECORDS)
        self.train: Any = records["train"][0]
        self.wheelsets: Any = records["wheelsets"][0].view(np.recarray)
        self.numbers: Array = records.view(np.float64)
        time, distance, speed, reservoir, line, *_ = self.samples.train[0].tolist()
        begin_train(self.train, time, distance, speed, reservoir, commanded_pressure, line)
        self.train.has_diagnosis = 1.0 if np.isfinite(self.samples.train[:, 7]).any() else nan
        begin_window(self.train)
        begin_slow_times(self.train, self.wheelsets)
        for wheelset in self.wheelsets:
            begin_wheelset(wheelset)
            begin_slides(wheelset)

    def stop_at(self, time: float, distance: float) -> None:
        """Feed the standstill of the train (s, m), the last of all samples."""
        reservoir = self.train.reservoir_minimum_pressure
        observe_train(self.train, self.definition, time, distance, 0.0, reservoir)
        keep_window(self.train, self.train)
        keep_slow_times(self.train, self.wheelsets, self.train, self.wheelsets)
        note_standstill(self.train, True, time, distance)

    def numbers_at(self, cells: Sequence[Cell]) -> list[float]:
        """Return numbers in the records as they are now."""
        values: list[float] = self.numbers[[index_of(cell) for cell in cells]].tolist()
        return values


def index_of(cell: Cell) -> int:
    """Return where a number of the records lies among :attr:`Replay.numbers`."""
    name, n, index = cell
    layout: Any = WHEELSET_MEASURES if n else STOP_MEASURES
    start = STOP_MEASURES.itemsize + (n - 1) * WHEELSET_MEASURES.itemsize if n else 0
    return int(start + layout.fields[name][1]) // _NUMBER + (index or 0)
