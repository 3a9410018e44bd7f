"""The rig on the bench, and what is applied to it over time."""

from collections.abc import Iterable, MutableSequence, Sequence
from dataclasses import dataclass
from typing import Any, NamedTuple

import numpy as np
from numpy.typing import NDArray

from uictest.core.physics import FILL, HOLD, VENT
from uictest.plans.scenario import COMPENSATION_SETTINGS, Case
from uictest.rig.assembly import assemble
from uictest.rig.model.parameters import PARAMETERS, Parameters
from uictest.rig.model.state import CAR, WHEELSET, Car, Wheelset
from uictest.rig.model.wheelset_parameters import WheelsetParameters


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


SETTINGS = tuple(COMPENSATION_SETTINGS)
"""Settings of the compensation, in the order of the records that compute them."""
NONE, HYSTERESIS, CYLINDER, FULL, THERMAL = range(len(SETTINGS))
MODULES = 2
LOADCELLS = 3


class BenchRig(NamedTuple):
    """Records of the rig on the bench.

    Attributes:
        car: record whose air supply feeds the modules.
        modules: with caliper, and without.
        computed: a module for each setting, which computes the force of the second module under it.
        settings: as many parameter records that differ in the setting of the compensation alone.
        wheelset_parameters: those of wheelset 1, whose module is on the bench.
        loadcell_errors: momentary errors of the three loadcells, N.
    """

    car: Car
    modules: Sequence[Wheelset]
    computed: Sequence[Wheelset]
    settings: Sequence[Parameters]
    wheelset_parameters: WheelsetParameters
    loadcell_errors: MutableSequence[float]


def clock_of(case: Case) -> Clock:
    """Return the base step and the controller cycle of a case."""
    step = float(case.scenario.simulation.time_step)
    return Clock(step, round(float(case.scenario.controller.cycle_time) / step))


def bench_rig(case: Case) -> BenchRig:
    """Return the rig of a case, its state zeroed."""
    inputs = assemble(case)
    car: Any = np.zeros(1, CAR)[0]
    modules: Any = np.zeros(MODULES, WHEELSET)
    computed: Any = np.zeros(len(SETTINGS), WHEELSET)
    loadcell_errors: Any = np.zeros(LOADCELLS)
    own = inputs.wheelset_parameters[0]
    return BenchRig(car, modules, computed, _settings(inputs.parameters), own, loadcell_errors)


def _settings(parameters: Any) -> Any:
    """Return the parameters once for each setting of the compensation; the valves obey the commands."""
    settings: Any = np.zeros(len(SETTINGS), PARAMETERS)
    settings[:] = parameters
    settings["wsp_active"] = 1
    uses = COMPENSATION_SETTINGS.values()
    settings["uses_hysteresis"] = [setting.hysteresis for setting in uses]
    settings["uses_cylinder_dynamics"] = [setting.pressure == "filter" for setting in uses]
    settings["uses_module_air"] = [setting.pressure == "air" for setting in uses]
    return settings
