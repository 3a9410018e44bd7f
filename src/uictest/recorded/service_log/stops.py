"""Every application of the brake in a log, and which of them are stops; these are cut out as recordings.

The log is read once, piece by piece, to find them, and the rows of what is over are forgotten. A second
reading, with all channels of the map, cuts them out.
"""

from __future__ import annotations

import hashlib
import json
from collections.abc import Iterator, Sequence
from dataclasses import dataclass
from pathlib import Path
from typing import NamedTuple

import numpy as np

from uictest.core import files, recording
from uictest.core.recording import BRAKE_COMMAND_TIME, SAMPLE_INTERVALS
from uictest.core.recording.formats import UnreadableError
from uictest.core.units import KILOMETRE_PER_HOUR
from uictest.recorded.field_data import CHANNEL_UNITS, ChannelMap, MapError
from uictest.recorded.service_log.course import Course, FileClock, in_order
from uictest.recorded.service_log.signals import WHEELS, Array, Before, Piece, Rows, pieces_of, rows_of

_NO_SIGNAL = "the brake signal is missing"


@dataclass(frozen=True, slots=True)
class FinderSettings:
    """Which applications of the brake are stops.

    Args:
        from_speed: least speed at which the brake is applied, m/s.
        to_speed: speed down to which the train must come, m/s; 0: standstill, below `standstill_speed`.

    """

    from_speed: float = 20.0 * KILOMETRE_PER_HOUR
    to_speed: float = 0.0


@dataclass(frozen=True, slots=True)
class LoggedEvent:
    """One application of the brake: a stop, or passed over with a reason.

    Args:
        file: in which it begins.
        row: sample in that file at which the brake is applied, from zero.
        time: recorded there, s.
        distance: from the beginning of the file by the speed, m.
        speed: at which the brake is applied, m/s.
        end_speed: at the end of the application, m/s.
        rows: first row and the one after the last of what belongs to it, over all files.
        begins_braked: whether the brake is applied from the first of these rows on.
        reason: why it is not a stop; empty for a stop.
        remarks: what is unusual about it: steps of the clock, running backwards.

    """

    file: Path
    row: int
    time: float
    distance: float
    speed: float
    end_speed: float
    rows: tuple[int, int]
    begins_braked: bool
    reason: str = ""
    remarks: tuple[str, ...] = ()


@dataclass(frozen=True, slots=True, eq=False)
class Log:
    """Stops of a log, and what was passed over, each in the order of the log.

    Args:
        files: of the log.
        first_rows: row with which each file begins, and the number of all rows.
        stops: found.
        passed_over: every other application of the brake.

    """

    files: Sequence[Path]
    first_rows: Sequence[int]
    stops: tuple[LoggedEvent, ...]
    passed_over: tuple[LoggedEvent, ...]


def find_stops(files: Sequence[Path], channel_map: ChannelMap, settings: FinderSettings | None = None) -> Log:
    """Return the stops in a log of one or several files, which follow each other, by their dates if all have.

    Raises UnreadableError, MissingExtraError, MapError, OSError.
    """
    finder = _Finder(settings or FinderSettings(), float(channel_map.preparation.standstill_speed))
    events: list[LoggedEvent] = []
    clocks = [FileClock(path) for path in files]
    for clock in clocks:
        finder.begin(clock.file)
        try:
            for rows in rows_of(clock.file, channel_map):
                events += finder.add(rows)
                clock.add(rows)
            clock.require_fine()
        except (UnreadableError, MapError) as error:
            raise type(error)(f"{clock.file}: {error}") from error
    events += finder.rest()
    stops = tuple(event for event in events if not event.reason)
    ordered = in_order(clocks, {event.file for event in stops})
    if ordered != list(files):
        return find_stops(ordered, channel_map, settings)
    first_rows = *(begin.row for begin in finder.begun), finder.rows
    return Log(files, first_rows, stops, tuple(event for event in events if event.reason))


class _Begin(NamedTuple):
    """Where a file begins in the log: its row, and the distance from the beginning of the log, m."""

    file: Path
    row: int
    distance: float = 0.0


class _Finder:
    """Finds events while a log is read, and holds its rows only as long as they may matter.

    An event is reported once no row that follows can change it: it is the same wherever a piece ends.
    """

    SETTLED = 15.0
    """s after its end, or after standstill, nothing that follows changes what an application was: more than
    an event has after it and a stuck speed before it; chosen."""
    LEAD = 15.0
    """s before an application in which nothing may be forgotten: more than an event has before it; chosen."""
    CALM = 2.0 * Course.SHORTEST_RELEASE
    """s after which it is known whether an application begins in a row; chosen."""
    LONGEST = 3600.0
    """s: a longer application without standstill is not a braking: its signal is stuck; chosen."""
    GROWTH = 0.3
    """Share by which the rows that are held grow before they are gone through again; chosen."""
    FEW = 1000
    """Rows that are gone through with every piece; chosen."""

    def __init__(self, settings: FinderSettings, standstill: float) -> None:
        self._settings, self._lowest = settings, max(settings.to_speed, standstill)
        self.begun: list[_Begin] = []
        self.rows = 0
        self._held, self._pending = Rows(*np.zeros((4, 0))), Rows(*np.zeros((4, 0)))
        self._before = Before()
        self._looked_at, self._released, self._stood = 0, 0, -1

    def begin(self, path: Path) -> None:
        """Begin a file."""
        self.begun.append(_Begin(path, self.rows))

    def add(self, rows: Rows) -> list[LoggedEvent]:
        """Return the events that are known once these rows are."""
        self._pending = self._pending.followed_by(rows)
        self.rows += len(rows.time)
        if not self.rows or len(self._pending.time) < self.GROWTH * (len(self._held.time) - self.FEW):
            return []
        course = self._held_course()
        events = list(self._settled_events(course, all_of_them=False))
        row = self._looked_at - self._before.row
        first = max(min(course.row_before(row, self.LEAD), row - course.ROWS_OF_SPEED), 0)
        self._held, self._before = self._held.from_row(first), course.before(first)
        return events

    def rest(self) -> list[LoggedEvent]:
        """Return the events at the end of the log."""
        return list(self._settled_events(self._held_course(), all_of_them=True)) if self.rows else []

    def _held_course(self) -> Course:
        self._held = self._held.followed_by(self._pending)
        self._pending = self._pending.from_row(len(self._pending.time))
        return Course(self._held, self._before)

    def _settled_events(self, course: Course, *, all_of_them: bool) -> Iterator[LoggedEvent]:
        """Yield the events that are known, and note up to which row all have been reported."""
        held = self._before.row
        self.begun = [
            begin._replace(distance=float(course.travelled[begin.row - held]))
            if held <= begin.row < self.rows
            else begin
            for begin in self.begun
        ]
        looked_at = course.row_before(-1, self.CALM)
        for first, end in course.applications():
            if held + first >= self._looked_at:
                if not all_of_them and not self._is_settled(course, first, end):
                    looked_at = min(looked_at, first)
                    break
                yield self._event_of_application(course, first, end)
            if self._stood >= 0:
                yield from self._restart_events(
                    course, max(self._stood - held, 0), end, all_of_them=all_of_them
                )
            self._released = held + end
        self._looked_at = max(self._looked_at, held + looked_at)

    def _is_settled(self, course: Course, first: int, end: int) -> bool:
        """Return whether no later row can change the event of an application."""
        now = course.clock[-1]
        if now - course.clock[first] >= self.LONGEST + self.SETTLED:
            return True
        stands = course.standstill(first, end, self._lowest)
        over = end if stands is None else stands
        return bool(over < len(course.clock) and now - course.clock[over] >= self.SETTLED)

    def _restart_events(
        self, course: Course, stood: int, end: int, *, all_of_them: bool
    ) -> Iterator[LoggedEvent]:
        """Yield an event where a train runs again with the brake applied since it stood in a row."""
        running = course.speed >= self._settings.from_speed
        running &= running[np.minimum(np.searchsorted(course.clock, course.clock + 1.0), len(running) - 1)]
        rows = stood + np.flatnonzero(running[stood:end])
        if len(rows) and (all_of_them or course.clock[-1] - course.clock[rows[0]] >= self.SETTLED):
            self._stood = -1
            first = int(rows[0])
            reason = "runs again with the brake still applied: its signal may be stuck or inverted"
            if course.unknown[first]:
                reason = _NO_SIGNAL
            yield self._logged_event(course, first, first, first, reason)

    def _event_of_application(self, course: Course, first: int, end: int) -> LoggedEvent:
        longest = course.row_after(first, self.LONGEST)
        too_long, end = end > longest, min(end, longest)
        rest = course.standstill(first, end, self._lowest)
        stop_row = end - 1 if rest is None else rest
        self._stood = -1 if rest is None else course.first_row + rest
        initial, final = course.speed_at(first), float(course.speed[stop_row])
        if course.unknown[first]:
            reason = _NO_SIGNAL
        elif rest is not None and initial >= self._settings.from_speed:
            reason = ""
        else:
            known = np.append(initial, course.speed[first : stop_row + 1])
            last = float(known[known > self._lowest][-1]) if initial > self._lowest else initial
            reason = self._rejection_reason(
                initial, final, last, recorded_to_end=course.is_whole(end), too_long=too_long
            )
        return self._logged_event(course, max(self._released - course.first_row, 0), first, stop_row, reason)

    def _logged_event(
        self, course: Course, begin_row: int, first: int, stop_row: int, reason: str
    ) -> LoggedEvent:
        rows = course.rows_of(first, stop_row, begin_row)
        begin = next(file for file in reversed(self.begun) if file.row <= course.first_row + first)
        return LoggedEvent(
            begin.file,
            course.first_row + first - begin.row,
            float(course.time[first]),
            float(course.travelled[first]) - begin.distance,
            course.speed_at(first),
            float(course.speed[stop_row]),
            (course.first_row + rows[0], course.first_row + rows[1]),
            rows[0] == first,
            reason,
            tuple(course.remarks(rows, first, stop_row)),
        )

    def _rejection_reason(
        self,
        initial_speed: float,
        final_speed: float,
        last_speed: float,
        *,
        recorded_to_end: bool,
        too_long: bool,
    ) -> str:
        """Return the reason for which an application of the brake is not counted as a stop.

        Speeds are in m/s; `last_speed` is the last known one above standstill.
        """
        kmh = KILOMETRE_PER_HOUR
        if not np.isfinite(initial_speed):
            return "the speed is not known when the brake is applied"
        if initial_speed <= self._lowest:
            return "without motion"
        if initial_speed < self._settings.from_speed:
            return f"from {initial_speed / kmh:.1f} km/h, below {self._settings.from_speed / kmh:g} km/h"
        if not too_long and not final_speed > self._lowest:
            return f"the speed is lost at {last_speed / kmh:.1f} km/h"
        if too_long:
            return (
                f"longer than {self.LONGEST / 60.0:g} min without standstill: the brake signal may be stuck"
            )
        if not recorded_to_end:
            return f"the recording ends or is interrupted at {final_speed / kmh:.1f} km/h"
        if final_speed > (1.0 - Course.HELD) * initial_speed:
            return f"drag braking: released at {final_speed / kmh:.1f} of {initial_speed / kmh:.1f} km/h"
        return f"released at {final_speed / kmh:.1f} km/h"


_SIGNED = ("speed", "distance", *WHEELS)


def write_stops(log: Log, channel_map: ChannelMap, folder: Path) -> dict[Path, str]:
    """Write every stop as Parquet, in SI under canonical names; return the files in order, with SHA-256.

    They take the place of earlier stops in the folder at once.

    Raises UnreadableError, MapError, OSError; ForeignFileError where the folder holds something else.
    """
    with files.replaced_folder(folder) as new:
        return {folder / name: digest for name, digest in _write_each_stop(log, channel_map, new)}


def _write_each_stop(log: Log, channel_map: ChannelMap, folder: Path) -> Iterator[tuple[str, str]]:
    """Write every stop, and yield the names of the files in order, with their SHA-256."""
    pending: dict[int, list[_Part]] = {}
    lead = float(channel_map.preparation.trigger_lead)
    following = 0
    for first, piece in _pieces_with_first_row(log, channel_map):
        end = first + len(piece)
        for k in range(following, len(log.stops)):
            begin, last = log.stops[k].rows
            if begin >= end:
                break
            pending.setdefault(k, []).append(
                _rows_of_piece(piece, slice(max(begin - first, 0), last - first))
            )
            if last <= end:
                name = f"stop-{k + 1:04d}.parquet"
                content = _parquet_bytes(pending.pop(k), log.stops[k], lead)
                files.write(folder, name, content)
                yield name, hashlib.sha256(content).hexdigest()
                following = k + 1
        if following == len(log.stops):
            break


class _Part(NamedTuple):
    """Channels of a part of a stop, and the intervals of those that had a time of their own, s."""

    channels: dict[str, Array]
    intervals: dict[str, float]


def _rows_of_piece(piece: Piece, rows: slice) -> _Part:
    channels = {name: channel.samples[rows].copy() for name, channel in piece.channels.items()}
    return _Part({"time": piece.channels["speed"].time[rows].copy(), **channels}, piece.intervals)


def _pieces_with_first_row(log: Log, channel_map: ChannelMap) -> Iterator[tuple[int, Piece]]:
    row = 0
    for path, end in zip(log.files, log.first_rows[1:], strict=True):
        for piece in pieces_of(path, channel_map):
            row += len(piece)
            if row > end:
                break
            yield row - len(piece), piece
        if row != end:
            raise UnreadableError(f"{path}: has changed since its stops were found")


def _concatenated_parts(parts: list[dict[str, Array]]) -> dict[str, Array]:
    """Return the channels of consecutive parts as one; NaN where a part lacks a channel."""
    names = dict.fromkeys(name for part in parts for name in part)
    blank = [np.full(len(part["time"]), np.nan) for part in parts]
    return {
        name: np.concatenate([part.get(name, none) for part, none in zip(parts, blank, strict=True)])
        for name in names
    }


def _runs_backwards(name: str, channels: dict[str, Array]) -> bool:
    """Return whether a channel counts backwards; pole wheels do not, even where the train runs so."""
    speed = "speed" if name == "distance" else name
    return name in _SIGNED and bool(np.nanmedian(np.append(channels[speed], 0.0)) < 0.0)


def _parquet_bytes(parts: list[_Part], event: LoggedEvent, lead: float) -> bytes:
    """Return a stop as a file; its clock is as recorded, steps included, which a recording could not hold.

    It states the brake command, `lead` before the brake is applied, unless it begins with the brake applied.
    """
    channels = _concatenated_parts([part.channels for part in parts])
    facts = {
        "source": event.file.name,
        "place": f"sample {event.row + 1}, {event.time:.12g} s, {event.distance:.6g} m",
        "remarks": "; ".join(event.remarks),
    }
    if intervals := {name: interval for part in parts for name, interval in part.intervals.items()}:
        facts[SAMPLE_INTERVALS] = json.dumps(intervals)
    if not event.begins_braked:
        facts[BRAKE_COMMAND_TIME] = f"{event.time - lead:.6f} s"
    units = {"time": "s", **CHANNEL_UNITS}
    signed = {name: -v if _runs_backwards(name, channels) else v for name, v in channels.items()}
    return recording.channels_bytes(signed, {name: units[name] for name in signed}, facts)
