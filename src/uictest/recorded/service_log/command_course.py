"""The brake command of a recorded stop over time, by the pressure that was demanded or followed."""

from __future__ import annotations

from collections.abc import Iterator, Sequence
from typing import Any, Final, NamedTuple

import numpy as np
from numpy.typing import NDArray

from uictest.core.recording import BRAKE_COMMAND_TIME, TIME, Recording
from uictest.core.units import KILOMETRE_PER_HOUR
from uictest.plans.scenario import Scenario, load_share
from uictest.recorded.field_data import MapError, Preparation, RawChannel, UnusableError, prepare
from uictest.recorded.service_log.signals import SHOWN_BY

Array = NDArray[np.float64]
Kept = tuple[int, int, float]
"""First sample, the one after the last, and level of a stretch."""
_PRESSURES: Final = ("demanded_pressure", "brake_line_pressure")
_STEADY, _SHORTEST = 0.02, 0.6
"""Share of the full pressure within which it counts as kept, and s for which: less than position G fills in
that time; chosen."""
_HELD, _LEAST_HELD = 0.5 * KILOMETRE_PER_HOUR, 5.0
"""m/s within which a speed counts as kept by traction, and s for which; chosen."""
_LEAST_CHANGE: Final = 0.04
"""Share of the full pressure by which two commands differ: less is the reservoir's or noise; chosen."""
_RELEASED: Final = 0.04
"""Share of the full pressure below which the brake is released; chosen."""


class CommandCourse(NamedTuple):
    """Commands over time (s since the first, share of full service, position), by a channel.

    `known_by` is empty where no channel does: the command is then the one that was stated. `beyond` is the
    highest level kept, as a share of what the position with the most pressure gives.
    """

    steps: tuple[tuple[float, float, str], ...]
    known_by: str
    beyond: float = 0.0

    def as_written(self) -> Any:
        """Return the value of `brake.command`."""
        (_, share, _), *rest = self.steps
        if not rest:
            return f"{100.0 * share:.0f} %"
        position = self.steps[0][2]
        return [
            {"at": f"{at:g} s", "value": f"{100.0 * share:.0f} %"}
            | ({"position": p} if p != position else {})
            for at, share, p in self.steps
        ]


def command_course(recording: Recording, scenario: Scenario, late: float) -> CommandCourse:
    """Return the commands of a stop.

    A pressure that is kept is a command, rounded to 1 %; it was given when the pressure left the one before,
    less the dead time of the brake. A pressure above what the stated position gives is that of another one.

    Args:
        recording: of the stop, over the time since the trigger.
        scenario: its brake, and the command that was stated.
        late: time from the first command to the trigger, s.

    """
    brake = scenario.brake
    channels = recording.channels
    known_by = next((name for name in (*_PRESSURES, "brake_command") if name in channels), "")
    if not known_by or not np.isfinite(channels[known_by]).all():
        return CommandCourse(brake.commands, "")
    full = float(brake.system.positions[brake.position].maximum_pressure)
    full *= load_share(brake.system.load_valve, scenario.vehicle)
    by_state = known_by == "brake_command"
    levels = channels[known_by] * (float(brake.first_command) if by_state else 1.0 / full)
    dead_time = 0.0 if by_state else float(brake.system.positions[brake.position].dead_time)
    steps: list[tuple[float, float, str]] = []
    left = 0.0
    kept = list(_kept(levels, max(round(_SHORTEST / _raster(recording)), 2)))
    for begin, end, level in _with_turns(levels, kept):
        share, position = _command_of(level, scenario)
        if steps and position == steps[-1][2] and abs(share - steps[-1][1]) < _LEAST_CHANGE:
            left = recording[TIME][end - 1]
        elif steps or share > 0.0:
            at = round(max(left - dead_time + late, 0.0), 2) if steps else 0.0
            steps.append((at, share, position))
            left = recording[TIME][end - 1]
        else:
            left = recording[TIME][begin]
    if not steps:
        return CommandCourse(brake.commands, "")
    most = max(_shares_of_positions(scenario).values())
    return CommandCourse(tuple(steps), known_by, max(level for _, _, level in kept) / most)


def _raster(recording: Recording) -> float:
    return float(recording[TIME][1] - recording[TIME][0])


def _shares_of_positions(scenario: Scenario) -> dict[str, float]:
    """Return the pressure of each position as a share of the stated one's."""
    positions = scenario.brake.system.positions
    stated = float(positions[scenario.brake.position].maximum_pressure)
    return {name: float(each.maximum_pressure) / stated for name, each in positions.items()}


def _command_of(level: float, scenario: Scenario) -> tuple[float, str]:
    """Return share of full service and position that give a pressure, as a share of the stated position's."""
    position = scenario.brake.position
    if level > 1.0 + _LEAST_CHANGE:
        shares = _shares_of_positions(scenario)
        reaching = {name: share for name, share in shares.items() if level <= share * (1.0 + _LEAST_CHANGE)}
        if reaching:
            position = min(reaching, key=lambda name: reaching[name])
            level /= reaching[position]
    share = min(round(level, 2), 1.0)
    return (0.0 if share < _RELEASED else share), position


def _with_turns(levels: Array, kept: Sequence[Kept]) -> Iterator[Kept]:
    """Yield the kept levels, and between two of them one beyond both at which the next command came."""
    for k, stretch in enumerate(kept):
        if k:
            begin, end = kept[k - 1][1], stretch[0] + 1
            for place, sign in ((np.argmin(levels[begin:end]), 1.0), (np.argmax(levels[begin:end]), -1.0)):
                turn = float(levels[begin + int(place)])
                if min(sign * (kept[k - 1][2] - turn), sign * (stretch[2] - turn)) > _LEAST_CHANGE:
                    yield begin + int(place), begin + int(place) + 1, turn
        yield stretch


def held_speed(recording: Recording) -> tuple[float, float] | None:
    """Return speed, m/s, and duration, s, of the longest time in which the braked train keeps its speed."""
    width = max(round(_LEAST_HELD / _raster(recording)), 2)
    kept = list(_kept(recording["speed"], width, _HELD))
    if not kept:
        return None
    begin, end, speed = max(kept, key=lambda each: each[1] - each[0])
    duration = float(recording[TIME][end - 1] - recording[TIME][begin])
    return (speed, duration) if speed > _HELD else None


def _kept(levels: Array, width: int, steady: float = _STEADY) -> Iterator[Kept]:
    """Yield first sample, the one after the last, and median of every stretch in which a level is kept."""
    begin, count = 0, len(levels)
    while begin + width <= count:
        low, high = levels[begin : begin + width].min(), levels[begin : begin + width].max()
        end = begin + width
        if high - low > steady:
            begin += 1
            continue
        while end < count and max(high, levels[end]) - min(low, levels[end]) <= steady:
            low, high = min(low, levels[end]), max(high, levels[end])
            end += 1
        yield begin, end, float(np.median(levels[begin:end]))
        begin = end


def read_like(
    simulated: Recording, recorded: Recording, preparation: Preparation
) -> tuple[float, tuple[float, float]]:
    """Return the time from the command to its mark, s, and time and distance from there to standstill.

    A simulation is read as the record was: marked by the first of :data:`SHOWN_BY` that the record has, to
    the same standstill. A stated `trigger_lead` is in the record's time already.

    Raises ValueError where the simulation has no standstill.
    """
    since = 0.0
    for names in SHOWN_BY[preparation.trigger]:
        if any(name in recorded.channels for name in names):
            own = [
                simulated[name] for name in names if name in simulated.channels and name in recorded.channels
            ]
            shown = (
                np.fmax.reduce(own) > float(preparation.trigger_pressure) if own else np.zeros(1, dtype=bool)
            )
            if shown.any():
                since = max(float(simulated[TIME][int(np.argmax(shown))] - preparation.trigger_lead), 0.0)
            break
    time = simulated[TIME]
    channels = {name: RawChannel(name, "", time, simulated[name]) for name in ("speed", "distance")}
    try:
        stated = preparation.model_copy(update={"trigger": "stated"})
        read = prepare(channels, {BRAKE_COMMAND_TIME: f"{since} s"}, stated)
    except (MapError, UnusableError) as error:
        raise ValueError(f"its simulation: {error}") from error
    if read.standstill is None:
        raise ValueError("its simulation comes to no standstill")
    return since, read.standstill
