"""A stop of the independent rig, integrated by BDF of SciPy, which chooses step and order.

It begins anew after each stretch of time, and where a wheelset locks or is let go.
"""

from __future__ import annotations

import math
from dataclasses import dataclass
from typing import Any, Final

import numpy as np
from numpy.typing import NDArray

from studies.independent.equations import PLACES, TOLERANCES, Equations
from uictest import Case, Recording

Array = NDArray[np.float64]

_STRETCH: Final = 0.5
"""s; chosen."""
_CLEANING_STRETCH: Final = 0.05
"""Where the rail is cleaned, s; chosen: shorter than a wheelset takes to the place of the one before it."""
_SAMPLE: Final = 0.05
"""Between two samples, s; chosen."""
_RELATIVE: Final = 1e-8
_LONGEST: Final = 120.0
"""Of a stop, s."""


@dataclass(frozen=True, slots=True)
class IndependentStop:
    """What the independent rig gives: figures of the stop, and what it shows at the ends of stretches.

    Args:
        distance: from the brake command to the standstill of the body, m.
        time: likewise, s.
        air: taken from the reservoir, kg.
        energy_residual: energy that is not accounted for over that at the start.
        times: of the samples, s.
        speed: of the body, m/s.
        wheel_speeds: at the rims, m/s; one column per wheelset, as below.
        forces: of one pad, N.
        pressures: in the tanks, gauge, Pa.
    """

    distance: float
    time: float
    air: float
    energy_residual: float
    times: Array
    speed: Array
    wheel_speeds: Array
    forces: Array
    pressures: Array


def integrated(case: Case, stop: Recording) -> IndependentStop:
    """Integrate the stop of a case under the valve commands of its recording, a sample per cycle.

    Raises ValueError where the case has something that these equations do not know.
    """
    _refuse_unknown(case.scenario)
    equations = Equations(case, stop)
    time, y = 0.0, equations.start()
    first, samples, stands = _energy(equations, y), [(0.0, y)], False
    length = _STRETCH if case.scenario.rail.cleaning_in_force is None else _CLEANING_STRETCH
    while not stands and time < _LONGEST:
        end = length * (math.floor(time / length + 1e-6) + 1.0)
        passed, stands = _stretch(equations, time, end, y)
        samples += passed
        time, y = passed[-1]
        equations.remember(y)
    times, states = np.array([at for at, _ in samples]), np.array([state for _, state in samples])
    return IndependentStop(
        distance=float(y[0]),
        time=time,
        air=float(y[PLACES["consumed"]][0]),
        energy_residual=(_energy(equations, y) - first) / first,
        times=times,
        speed=states[:, 13],
        wheel_speeds=equations.radius * states[:, PLACES["rotation"]],
        forces=np.array([equations.clamping_force(state) for state in states]),
        pressures=np.array([equations.pressures(state) for state in states]) - equations.atmosphere,
    )


def _refuse_unknown(scenario: Any) -> None:
    brake = scenario.brake
    present = {
        "a course of brake.command": len(brake.commands) > 1,
        "brake.dynamic": brake.dynamic is not None,
        "brake.track": brake.track is not None,
        "brake.system.load_valve": brake.system.load_valve is not None,
        "until": scenario.until is not None,
        "drag": scenario.drag is not None,
        "faults": bool(scenario.faults),
        "sanders": bool(scenario.sanders),
        "rail.variation": scenario.rail.variation_in_force is not None,
    }
    unknown = [name for name, found in present.items() if found]
    if unknown:
        raise ValueError(f"the independent rig does not know {', '.join(unknown)}")


def _stretch(
    equations: Equations, time: float, end: float, y: Array
) -> tuple[list[tuple[float, Array]], bool]:
    """Integrate to the end of a stretch or to its first event; return samples, and whether it stands."""
    from scipy.integrate import solve_ivp

    equations.switch_compressor(y)
    solution: Any = solve_ivp(
        equations.rates,
        (time, end),
        y,
        method="BDF",
        rtol=_RELATIVE,
        atol=TOLERANCES[: len(y)],
        events=_events(equations),
        dense_output=True,
    )
    if solution.status < 0:
        raise RuntimeError(solution.message)
    last, y = float(solution.t[-1]), solution.y[:, -1].copy()
    between = _SAMPLE * np.arange(math.floor(time / _SAMPLE + 1e-6) + 1, math.ceil(last / _SAMPLE - 1e-6))
    standstill, *others = (len(times) > 0 for times in solution.t_events)
    for i, happened in enumerate(others):
        if happened:
            equations.locked[i] = not equations.locked[i]
            y[PLACES["rotation"]][i] = 0.0
    return [*((float(at), solution.sol(at)) for at in between), (last, y)], standstill


def _events(equations: Equations) -> list[Any]:
    """Return what comes to zero when the body stands, and when each wheelset locks or is let go."""

    def stands(_: float, y: Array) -> float:
        return float(y[13])

    def turns(i: int) -> Any:
        if equations.locked[i]:
            return lambda time, y: float(equations.rail_torque_beyond_brake(time, y)[i])
        return lambda _, y: float(y[PLACES["rotation"]][i])

    events: list[Any] = [stands, *(turns(i) for i in range(4))]
    for event, rising in zip(events, [False, *equations.locked], strict=True):
        event.terminal, event.direction = True, 1.0 if rising else -1.0
    return events


def _energy(equations: Equations, y: Array) -> float:
    """Return kinetic energy, that of springs and height, and what was lost since the brake command, J."""
    rate, stretched = y[13:26], equations.car.rows @ y[:13]
    kinetic = equations.car.masses @ rate**2 + equations.car.inertia * float(
        (y[PLACES["rotation"]] ** 2).sum()
    )
    springs = equations.car.stiffness @ stretched**2
    height = equations.weight_along_rail @ y[:13]
    lost = float(y[PLACES["contact_loss"]].sum() + y[PLACES["losses"]].sum())
    return float(0.5 * (kinetic + springs) + height + lost)
