"""Inputs of a bench test over time: demanded pressures and valve commands, as its recipe has them."""

from collections.abc import Iterable, Sequence
from dataclasses import dataclass, replace
from pathlib import Path

import numpy as np
from numpy.typing import NDArray

from uictest.core.physics import FILL, HOLD, VENT
from uictest.core.units import BAR
from uictest.plans.scenario import Case
from uictest.rig import identification
from uictest.rig.bench.recipe import (
    BenchTest,
    FileReplay,
    Input,
    Random,
    Rest,
    Stepwise,
    StopReplay,
    Triangular,
    WspCycling,
)
from uictest.rig.simulation import simulate


@dataclass(frozen=True, slots=True)
class Clock:
    """Base step in s and the number of steps in a controller cycle."""

    step: float
    steps_per_cycle: int

    @property
    def cycle_time(self) -> float:
        """Controller cycle, s."""
        return self.step * self.steps_per_cycle

    def cycles(self, duration: float) -> int:
        """Whole cycles in ``duration`` s, at least one."""
        return max(round(duration / self.cycle_time), 1)

    def times(self, cycles: int) -> NDArray[np.float64]:
        """End of every step in so many cycles, s; n x step, never accumulated."""
        return np.arange(1, cycles * self.steps_per_cycle + 1, dtype=np.float64) * self.step


@dataclass(frozen=True, slots=True, eq=False)
class BenchInput:
    """Demanded gauge pressure in Pa for each step, valve command for each controller cycle."""

    demanded_pressures: NDArray[np.float64]
    valve_commands: NDArray[np.int64]


def joined_inputs(inputs: Iterable[BenchInput]) -> BenchInput:
    """One input after the other."""
    parts = list(inputs)
    return BenchInput(
        np.concatenate([part.demanded_pressures for part in parts]),
        np.concatenate([part.valve_commands for part in parts]),
    )


def bypassed_input(times: Sequence[float], pressures: Sequence[float], clock: Clock) -> BenchInput:
    """A pressure given at times in s from 0 on, straight between them; the valves always fill."""
    cycles = clock.cycles(float(times[-1]))
    demanded_pressures = np.interp(clock.times(cycles), times, pressures)
    return BenchInput(demanded_pressures, np.full(cycles, FILL))


def stepwise_input(levels: Sequence[float], hold: float, clock: Clock) -> BenchInput:
    """Pressure levels in Pa, each demanded at once and for ``hold`` s."""
    cycles = clock.cycles(hold)
    demanded_pressures = np.repeat(np.asarray(levels, dtype=float), cycles * clock.steps_per_cycle)
    return BenchInput(demanded_pressures, np.full(cycles * len(levels), FILL))


def triangular_input(peaks: Sequence[float], floor: float, rate: float, clock: Clock) -> BenchInput:
    """Ramps from ``floor`` Pa up to each peak and down again, at ``rate`` Pa/s."""
    corners = [floor] + [pressure for peak in peaks for pressure in (peak, floor)]
    times = np.concatenate([[0.0], np.cumsum(np.abs(np.diff(corners)) / rate)])
    return bypassed_input(list(times), corners, clock)


def random_input(
    lowest: float, highest: float, interval: float, duration: float, seed: int, clock: Clock
) -> BenchInput:
    """Straight lines between pressures drawn evenly from a range, one every ``interval`` s."""
    count = max(round(duration / interval), 1)
    drawn = np.random.Generator(np.random.Philox(seed)).uniform(lowest, highest, count + 1)
    drawn[0] = 0.0
    return bypassed_input(list(np.arange(count + 1) * interval), list(drawn), clock)


def wsp_cycling_input(
    pressure: float,
    lead: float,
    cycles: int,
    vent: tuple[float, float],
    hold: tuple[float, float],
    fill: tuple[float, float],
    seed: int,
    clock: Clock,
) -> BenchInput:
    """A full application for ``lead`` s, then vent, hold and fill in turn as a WSP commands them.

    Each duration is drawn evenly from its range, in s. A hold follows every vent and every fill.
    """
    draw = np.random.Generator(np.random.Philox(seed)).uniform
    pieces = [np.full(clock.cycles(lead), FILL)]
    for _ in range(cycles):
        for command, span in ((VENT, vent), (HOLD, hold), (FILL, fill), (HOLD, hold)):
            pieces.append(np.full(clock.cycles(draw(*span)), command))
    commands = np.concatenate(pieces)
    return BenchInput(np.full(len(commands) * clock.steps_per_cycle, pressure), commands)


def recorded_input(
    times: NDArray[np.float64],
    pressures: NDArray[np.float64],
    commands: NDArray[np.float64] | None,
    clock: Clock,
) -> BenchInput:
    """A demand, straight between its samples, and the commands in force at the middle of each cycle."""
    start = float(times[0])
    cycles = clock.cycles(float(times[-1]) - start)
    demanded_pressures = np.interp(clock.times(cycles), times - start, pressures)
    if commands is None:
        return BenchInput(demanded_pressures, np.full(cycles, FILL))
    middles = (np.arange(cycles) + 0.5) * clock.cycle_time
    # A sample holds the command in force when it was taken, that is since the sample before it.
    at = np.searchsorted(times - start, middles, side="left")
    return BenchInput(demanded_pressures, commands[np.minimum(at, len(commands) - 1)].astype(np.int64))


def clock_of(case: Case) -> Clock:
    """Return the base step and the controller cycle of a case."""
    step = float(case.scenario.simulation.time_step)
    return Clock(step, round(float(case.scenario.controller.cycle_time) / step))


def bench_input(test: BenchTest) -> BenchInput:
    """Return demanded pressures and valve commands of a recipe; stops that it replays are simulated.

    Raises UnsuitableRecordError or OSError for a recording that cannot be used.
    """
    clock = clock_of(test.case)
    return joined_inputs(_segment(segment, test, clock) for segment in test.recipe.inputs)


def _segment(segment: Input, test: BenchTest, clock: Clock) -> BenchInput:
    match segment:
        case StopReplay():
            return _simulated_stop(segment, test.case, clock)
        case FileReplay():
            return _recorded_file(segment, test.folder, clock)
        case WspCycling():
            spans = segment.vent, segment.hold, segment.fill
            return wsp_cycling_input(
                segment.pressure, segment.lead, segment.cycles, *spans, segment.seed, clock
            )
        case Rest(duration=duration):
            return stepwise_input([0.0], duration, clock)
        case Stepwise(levels=levels, hold=hold):
            return stepwise_input(levels, hold, clock)
        case Triangular(peaks=peaks, floor=floor, ramp=ramp):
            return triangular_input(peaks, floor, BAR / ramp, clock)
        case Random(lowest=lowest, highest=highest):
            return random_input(lowest, highest, segment.interval, segment.duration, segment.seed, clock)


def _simulated_stop(segment: StopReplay, case: Case, clock: Clock) -> BenchInput:
    rail = case.scenario.rail.model_copy(update={"friction": segment.friction})
    brake = case.scenario.brake
    if segment.position is not None:
        brake = brake.model_copy(update={"position": segment.position})
    scenario = case.scenario.model_copy(update={"rail": rail, "brake": brake, "seed": segment.seed})
    recording = simulate(replace(case, scenario=scenario), clock.cycle_time).recording
    assert recording is not None
    commands = recording[f"valve_command_{segment.wheelset}"]
    return recorded_input(recording["time"], recording["demanded_pressure"], commands, clock)


def _recorded_file(segment: FileReplay, folder: Path, clock: Clock) -> BenchInput:
    names = {"pressure": segment.pressure}
    if segment.command is not None:
        names["command"] = segment.command
    channels = identification.read_record(folder / segment.file, names).channels
    return recorded_input(channels["time"], channels["pressure"], channels.get("command"), clock)
