"""A recording fed to the accumulators sample by sample, and where their fields change meanwhile."""

from __future__ import annotations

from collections.abc import Collection, Iterator, Mapping, Sequence
from dataclasses import dataclass, field
from math import inf, isnan, nan
from types import SimpleNamespace
from typing import Any, Final, NamedTuple

import numpy as np
from numpy.typing import NDArray

from uictest.core.measures.contact import begin_contact, begin_utilisation, observe_contact
from uictest.core.measures.monitoring import observe_monitoring, reports_wheelset
from uictest.core.measures.records import END_SPEEDS, SLOW_TIMES, SPEED_CLASSES, WINDOW_SECONDS
from uictest.core.measures.train import (
    begin_build_up,
    begin_train,
    begin_window,
    keep_window,
    note_standstill,
    observe_build_up,
    observe_reservoir_margin,
    observe_train,
)
from uictest.core.measures.wheelset import (
    begin_slides,
    begin_slow_times,
    begin_wheelset,
    keep_slide,
    keep_slow_times,
    observe_reaction,
    observe_reference,
    observe_wheelset,
)
from uictest.core.physics import FILL, VENT

Array = NDArray[np.float64]
Channels = Mapping[str, Array]
Faults = tuple[Array, Array, Array, Array]
"""At every sample whether any has begun, shape (n,); whether a part of each wheelset has had one, whether its
speed sensor has one, and whether it has had one that is to be reported, shape (n, 4)."""
FAULT_COLUMNS: Final = 13
Cell = tuple[str, int, int | None]
"""A number in the records: field, number of the wheelset or 0 for the train, place where the field is a
table."""
_WHEELSETS: Final = (1, 2, 3, 4)
_WHEELS: Final = 2.0
"""Of a wheelset: adhesion and wheel load are those of one."""
_NONE_REQUIRED: Final = (0.0,) * len(_WHEELSETS)


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


@dataclass(frozen=True, slots=True)
class Replay:
    """The records of a stop while the samples of its recording pass, SI.

    They are plain objects: attributes of numpy records take ten times as long outside compiled code.

    Args:
        samples: of the recording.
        definition: how samples become measures.
        commanded_pressure: of the brake line, gauge, Pa.
        end: time of the first sample that is not fed, s.

    """

    samples: Samples
    definition: Any
    commanded_pressure: float
    end: float = inf
    train: Any = field(
        default_factory=lambda: SimpleNamespace(
            speed_after_sliding=[0.0] * (WINDOW_SECONDS + 1),
            reached_time=[0.0] * len(END_SPEEDS),
            half_slow_time=[0.0] * SLOW_TIMES,
        )
    )
    wheelsets: list[Any] = field(
        default_factory=lambda: [
            SimpleNamespace(maximum_slide_above=[0.0] * SPEED_CLASSES, slow_time=[0.0] * SLOW_TIMES)
            for _ in _WHEELSETS
        ]
    )

    def __post_init__(self) -> None:
        time, distance, speed, reservoir, line, *_ = self.samples.train[0].tolist()
        begin_train(self.train, time, distance, speed, reservoir)
        self.train.has_diagnosis = 1.0 if np.isfinite(self.samples.train[:, 7]).any() else nan
        begin_build_up(self.train, self.commanded_pressure, line)
        begin_utilisation(self.train)
        begin_window(self.train)
        begin_slow_times(self.train, self.wheelsets)
        for wheelset in self.wheelsets:
            begin_wheelset(wheelset)
            begin_contact(wheelset)
            begin_slides(wheelset)

    def pass_samples(self, fields: Collection[str] | None = None) -> Iterator[float]:
        """Feed the samples before the end, and yield the time of each; the first one has begun the records.

        Only `fields` need to hold their numbers afterwards; None: all of them.
        """
        train, definition = self.train, self.definition
        contacts, slides, pressures, tables, reports = (
            fields is None or not own.isdisjoint(fields)
            for own in (_OF_CONTACTS, _OF_SLIDES, _OF_PRESSURES, _TABLES, _OF_REPORTS)
        )
        fed = self.samples.before(self.end)
        faults = fed.faults[1:].tolist()
        samples = zip(fed.train[1:].tolist(), fed.wheelsets[1:].tolist(), strict=True)
        for k, (sample, own_samples) in enumerate(samples):
            time, distance, speed, reservoir, line, cylinder, reference_speed, diagnosis = sample
            for n, wheelset, own in zip(_WHEELSETS, self.wheelsets, own_samples, strict=True):
                wheel_speed, venting, force, temperature, tank, rail_work, loss, highest, *_ = own
                observe_wheelset(
                    wheelset, train, definition, n, time, speed, wheel_speed, venting, force, temperature
                )
                if contacts:
                    observe_contact(
                        wheelset, train, definition, time, speed, tank, line, rail_work, loss, highest
                    )
                if isnan(speed - wheel_speed):
                    # A lock before a gap and one after it need not be the same lock.
                    wheelset.lock = 0.0
                elif slides:
                    keep_slide(wheelset, wheelset, definition, speed)
            if pressures:
                observe_reservoir_margin(train, reservoir, cylinder)
                observe_build_up(train, definition, time, distance, speed, line)
            observe_train(train, definition, time, distance, speed, reservoir)
            if tables:
                self._keep_tables()
            if faults:
                self._observe_faults(faults[k], [own[2] for own in own_samples], reference_speed)
            if reports:
                self._observe_reports(diagnosis, own_samples, faults[k][-4:] if faults else _NONE_REQUIRED)
            yield time

    def numbers(self, cells: Sequence[Cell]) -> list[float]:
        """Return numbers in the records as they are now."""
        return [holder[key] for holder, key in self._places(cells)]

    def noted(self, cells: Sequence[Cell]) -> Array:
        """Let the samples pass, and return numbers of the records after each but the first, a row each."""
        places = self._places(cells)
        passed = self.pass_samples(fields={name for name, _, _ in cells})
        rows = [[holder[key] for holder, key in places] for _ in passed]
        return np.array(rows, np.float64).reshape(len(rows), len(cells))

    def _places(self, cells: Sequence[Cell]) -> list[tuple[Any, str | int]]:
        records = [vars(record) for record in (self.train, *self.wheelsets)]
        return [
            (records[n], name) if place is None else (records[n][name], place) for name, n, place in cells
        ]

    def stop_at(self, time: float, distance: float) -> None:
        """Feed the standstill of the train (s, m), the last of all samples."""
        reservoir = self.train.reservoir_minimum_pressure
        observe_train(self.train, self.definition, time, distance, 0.0, reservoir)
        self._keep_tables()
        note_standstill(self.train, True, time, distance)

    def _keep_tables(self) -> None:
        keep_window(self.train, self.train)
        keep_slow_times(self.train, self.wheelsets, self.train, self.wheelsets)

    def _observe_faults(self, faults: list[float], forces: list[float], reference_speed: float) -> None:
        begun, *of_wheelsets = faults
        if not begun:
            return
        train, definition = self.train, self.definition
        observe_reference(train, definition, reference_speed)
        largest = max(forces)
        for i, wheelset in enumerate(self.wheelsets):
            own = of_wheelsets[i], of_wheelsets[len(forces) + i], forces[i]
            observe_reaction(wheelset, train, definition, *own, largest)

    def _observe_reports(
        self, diagnosis: float, samples: list[list[float]], required: Sequence[float]
    ) -> None:
        bits = 0 if isnan(diagnosis) else int(diagnosis)
        for i, wheelset in enumerate(self.wheelsets):
            *_, shown_speed, fills = samples[i]
            own = reports_wheelset(bits, i), wheelset.faulty, required[i], shown_speed, fills
            observe_monitoring(wheelset, self.train, self.definition, *own)


_OF_CONTACTS: Final = frozenset({"slid_distance", "contact_energy", "exploited_work", "available_work"})
_OF_SLIDES: Final = frozenset({"maximum_slide_above"})
_OF_PRESSURES: Final = frozenset({"reservoir_margin", "rise_time", "build_up_time"})
_OF_REPORTS: Final = frozenset(
    {"deviation", "unfilled", "report_delay", "required_delay", "falsely_reported"}
)
_TABLES: Final = frozenset({"speed_after_sliding", "reached_time", "half_slow_time", "slow_time"})
"""Fields whose accumulators are left out where nobody asks for them: they take half of the time."""
