"""Compensations identified from the bench records of a module, and their errors along other records of it.

Everything is done as by `uictest identify` with its default options; a record that it refuses stays refused.
"""

from __future__ import annotations

from collections.abc import Callable, Iterator, Mapping, Sequence
from dataclasses import dataclass, field
from typing import Any

import numpy as np
from numpy.typing import NDArray

from uictest import Case, Recording
from uictest.rig import bench, identification
from uictest.units import PERCENT

Samples = NDArray[np.float64]
ACTING_TIME, TRANSITION_TIME = 2.0, 0.1
"""Defaults of `uictest identify hysteresis`, s."""
WAYS = ("nothing", "full", "thermal", "thermal_largest")
"""Ways to the pressure of the cylinder: the tank's as it is, the filter of `full`, the modelled air of
`thermal` identified for the mean square error and for the largest error."""


BOUND = 2.0
"""The paper's bound on the error of pressure, %."""


@dataclass(frozen=True, slots=True)
class WayErrors:
    """Largest errors along a record: pressure as read and true, % of a maximum; force, % of the largest.

    `beyond`: share of the time in which the error of pressure is :data:`BOUND` or more, %.
    """

    pressure_error: float
    true_pressure_error: float
    force_error: float
    beyond: float


@dataclass(frozen=True, slots=True)
class Fits:
    """What was identified; None where the identification refused, with its reason in `refusals`.

    Attributes:
        lines: of the four phases.
        cylinder: transfer function of `full`.
        air: numbers of `thermal`, for the mean and for the largest error.
        refusals: subject -> message.
        training: subject -> error on the held-out parts of the bench record, %.
    """

    lines: Mapping[str, Any] | None = None
    cylinder: Any = None
    air: Mapping[str, Any] = field(default_factory=dict)
    refusals: Mapping[str, str] = field(default_factory=dict)
    training: Mapping[str, float] = field(default_factory=dict)


def identified(hysteresis: Recording, pressure: Recording, case: Case) -> Fits:
    """Identify everything from the records of two bench tests; `case` is the rig as its owner knows it."""
    refusals: dict[str, str] = {}

    def attempt(subject: str, identify: Callable[[], Any]) -> Any:
        try:
            return identify()
        except identification.UnsuitableRecordError as error:
            refusals[subject] = str(error)
            return None

    lines = attempt("hysteresis", lambda: _lines(hysteresis))
    cylinder = attempt("full", lambda: _cylinder(pressure))
    mean = attempt("thermal", lambda: bench.identify_air(air_channels(pressure), case))
    air = {"thermal": mean, "thermal_largest": None}
    if mean is not None:
        air["thermal_largest"] = attempt(
            "thermal_largest",
            lambda: bench.identify_air(air_channels(pressure), case, starts_near=mean, largest=True),
        )
    found = {"hysteresis": lines and lines.largest_error, "full": cylinder and cylinder.largest_after}
    found |= {name: each and each.largest_after for name, each in air.items()}
    return Fits(
        lines and identification.all_four(lines.level_lines),
        cylinder and cylinder.transfer_function,
        air,
        refusals,
        {name: float("nan") if each is None else each / PERCENT for name, each in found.items()},
    )


def shipped(model: Any) -> Fits:
    """Return lines and air of a compensation of the library, which is for another module."""
    lines = {
        phase: identification.FittedLine(float(line.slope), float(line.intercept))
        for phase in ("bc_squeezing", "bc_releasing", "wsp_squeezing", "wsp_releasing")
        for line in [getattr(model.hysteresis, phase)]
    }
    return Fits(lines, air={"thermal": model.air})


def _lines(record: Recording) -> identification.HysteresisResult:
    found = identification.identify_hysteresis(
        record["time"],
        record["cylinder_pressure_1"],
        record["clamping_force_1"],
        acting(record),
        TRANSITION_TIME,
    )
    identification.require_force_fit(found)
    return found


def _cylinder(record: Recording) -> identification.CylinderResult:
    found = identification.identify_cylinder(
        record["time"], record["measured_pressure_2"], record["cylinder_pressure_1"]
    )
    identification.require_fit(found)
    return found


def acting(record: Recording) -> NDArray[np.bool_]:
    """Return when the WSP acts in a record."""
    return identification.wsp_acting_from_commands(record["time"], record["valve_command_1"], ACTING_TIME)


def air_channels(record: Recording) -> dict[str, Samples]:
    """Return the channels of a record by the names that the identification of the air gives them."""
    return {
        "time": record["time"],
        "tank": record["measured_pressure_2"],
        "cylinder": record["cylinder_pressure_1"],
        "line": record["brake_line_pressure"],
        "command": record["valve_command_1"],
    }


def errors(
    record: Recording, fits: Fits, case: Case, top: float, true_pressure: str = "tank_pressure_1"
) -> dict[str, WayErrors]:
    """Return the largest errors of each of :data:`WAYS` along a record; NaN where there is no compensation.

    Args:
        record: of the module's bench.
        fits: what was identified.
        case: the rig as its owner knows it.
        top: pressure that errors of pressure refer to, Pa.
        true_pressure: channel of the true pressure of the cylinder.
    """
    return {
        way: _errors(record, computed, fits, top, true_pressure)
        for way, computed in _pressures(record, fits, case)
    }


def _pressures(record: Recording, fits: Fits, case: Case) -> Iterator[tuple[str, Samples | None]]:
    """Yield each way with the pressure of the cylinder that it computes, Pa."""
    tank = record["measured_pressure_2"]
    yield "nothing", tank
    yield "full", None if fits.cylinder is None else fits.cylinder.output(tank)
    channels, time = air_channels(record), record["time"]
    model = bench.ModelledPressure(channels, case, float(time[-1] - time[0]) / (len(time) - 1))
    volume = float(case.scenario.brake.system.tank.volume)
    for way in ("thermal", "thermal_largest"):
        air = fits.air.get(way)
        yield way, None if air is None else model(unknowns(air, volume))


def unknowns(air: Any, tank_volume: float) -> Samples:
    """Return the numbers of an air as the model of its pressure takes them."""
    gap = air.closing_pressure - air.opening_pressure
    heat = air.tank_heat_conductance, air.caliper_heat_conductance
    return np.array([*heat, air.swept_volume / tank_volume, air.opening_pressure, gap], dtype=float)


def _errors(
    record: Recording, pressure: Samples | None, fits: Fits, top: float, true_pressure: str
) -> WayErrors:
    if pressure is None:
        return WayErrors(*[float("nan")] * 4)
    read, true = (
        np.abs(pressure - record[channel]) / top / PERCENT
        for channel in ("cylinder_pressure_1", true_pressure)
    )
    beyond = float(np.mean(read >= BOUND)) / PERCENT
    return WayErrors(float(read.max()), float(true.max()), _force_error(record, pressure, fits), beyond)


def _force_error(record: Recording, pressure: Samples, fits: Fits) -> float:
    if fits.lines is None:
        return float("nan")
    step, measured = float(record["time"][1] - record["time"][0]), record["clamping_force_1"]
    force = identification.computed_force(
        pressure, acting(record), fits.lines, TRANSITION_TIME, step, float(measured[0])
    )
    return float(np.abs(force - measured).max() / measured.max()) / PERCENT


def air_of(record: Recording, case: Case, least_mean: Any = None) -> Any:
    """Return the identified air, from `least_mean` on for the largest error; None where it is refused."""
    options: dict[str, Any] = {} if least_mean is None else {"starts_near": least_mean, "largest": True}
    try:
        return bench.identify_air(air_channels(record), case, **options)
    except identification.UnsuitableRecordError:
        return None


def pressure_errors(record: Recording, airs: Sequence[Any], case: Case, top: float) -> list[float]:
    """Return the largest error of the pressure that each air gives along a record, % of `top` Pa."""
    fits = [Fits(air={"thermal": air}) for air in airs]
    return [errors(record, each, case, top)["thermal"].pressure_error for each in fits]
