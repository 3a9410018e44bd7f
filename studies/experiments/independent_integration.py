"""The rig against its equations written a second time and integrated by a solver that picks its steps."""

from __future__ import annotations

from collections.abc import Iterator, Mapping, Sequence
from dataclasses import dataclass
from functools import partial
from typing import TYPE_CHECKING, Any

import numpy as np

from studies.drawing import INK, WHEELSET_COLOURS, WIDTH, title_and_legend
from studies.independent.integration import IndependentStop, integrated
from studies.quantity import NOT_ASKED, OwnBand, StudyQuantity, StudyValue
from studies.stop_runner import StopRunner, measured
from studies.study import Study, StudyFindings, Table
from uictest import Case, CaseResult, Recording
from uictest.units import BAR, KILONEWTON, PERCENT

if TYPE_CHECKING:
    from matplotlib.figure import Figure

Changes = Mapping[str, Any]

_EXACT: Changes = {
    "rig.topology": "four-caliper",
    **{f"rig.sensors.{kind}.gain_error": "0 %" for kind in ("pressure", "loadcell")},
    "rig.sensors.pressure.offset": "0 bar",
    "rig.sensors.pressure.noise": "1e-6 bar",
    "rig.sensors.pressure.resolution": "1e-6 bar",
    "rig.sensors.loadcell.offset": "0 N",
    "rig.sensors.loadcell.noise": "0.001 N",
    "rig.sensors.loadcell.resolution": "0.001 N",
}
"""Sensors whose errors the independent rig does not have, and a caliper in each module."""
_BYPASSED: Changes = {"rig.wsp": "bypassed"}
_LOCKED: Changes = {"brake.position": "R", "rail.friction": 0.09}
_COMPUTED: Changes = {"rig.topology": "one-caliper", "rig.compensation": "thermal"}
_STEP = {
    "interpolation": "steps",
    "points": [
        {"position": "0 m", "friction": 0.25},
        {"position": "50 m", "friction": 0.08},
        {"position": "120 m", "friction": 0.25},
    ],
}
BYPASSED: dict[str, tuple[str, Changes]] = {
    "dry": ("dry-120", {}),
    "dry, uphill": ("dry-120", {"initial_speed": "80 km/h", "rail.gradient": "10 permille"}),
    "dry, position G": ("dry-120", {"initial_speed": "60 km/h", "brake.position": "G"}),
    "dry, worn pads": ("dry-120", {"initial_speed": "80 km/h", "brake.system.disc.pad_friction": 0.32}),
    "dry, computed force": ("dry-120", {"initial_speed": "80 km/h", **_COMPUTED}),
    "locked": ("slide-80", _LOCKED),
    "locked, steep fall": (
        "slide-80",
        {**_LOCKED, "rail.condition.friction_ratio": 0.2, "rail.condition.friction_decay": "1 s/m"},
    ),
    "locked on a stretch": ("slide-80", {"brake.position": "R", "rail.friction": _STEP}),
    "locked, rail cleaned": (
        "slide-80",
        {"brake.position": "R", "rail.condition": "wet-cleaning", "rail.friction": 0.08},
    ),
}
"""Stops with the WSP bypassed: scenario and what is changed in it."""
_LEVEL: Changes = {"rail.friction": 0.12, "rail.condition.friction_ratio": 1}
LEVEL: dict[str, tuple[str, Changes]] = {
    "level friction": ("slide-80", _LEVEL),
    "level friction, computed force": ("slide-80", {**_LEVEL, **_COMPUTED}),
}
"""Stops with sliding whose friction does not fall with the slip: the commands of the valves are replayed."""
FALLING: dict[str, tuple[str, Changes]] = {"falling friction": ("slide-80", {})}
"""The same where it falls: the slides are unstable, a difference grows until the wheels do something else."""
STEPS = ("1 ms", "0.5 ms", "0.25 ms")
_STEP_STOP: tuple[str, Changes] = ("dry-120", {"initial_speed": "30 km/h", **_BYPASSED})
_APART = 0.1
"""Difference of the speed of a wheel from which on two stops are no longer the same slides, m/s; chosen."""


@dataclass(frozen=True, slots=True)
class Compared:
    """A stop of the rig and the independent one: differences of figures in %, largest ones of signals."""

    name: str
    case: Case
    rig: Recording
    independent: IndependentStop
    distance: float
    time: float
    air: float
    speed: float
    wheel_speed: float
    force: float
    pressure: float
    apart_at: float

    @property
    def residual(self) -> float:
        """Energy that the independent stop does not account for, millionths of that at the start."""
        return 1e6 * abs(self.independent.energy_residual)


def compared(name: str, case: Case, stop: CaseResult, rig: Recording) -> Compared:
    """Integrate a stop under the valve commands of the rig's, and compare them."""
    other = integrated(case, rig)
    density = 1.185 / 1e3  # kg per normal litre, ISO 8778
    off = {
        channel: np.array([_off(rig, f"{channel}_{n}", other, found[:, n - 1]) for n in range(1, 5)])
        for channel, found in (
            ("wheel_speed", other.wheel_speeds),
            ("clamping_force", other.forces),
            ("tank_pressure", other.pressures),
        )
    }
    apart = np.flatnonzero(off["wheel_speed"].max(axis=0) > _APART)
    return Compared(
        name,
        case,
        rig,
        other,
        distance=_percent(other.distance, measured(stop, "braking_distance_m")),
        time=_percent(other.time, measured(stop, "braking_time_s")),
        air=_percent(other.air / density, measured(stop, "air_consumed_nl")),
        speed=float(_off(rig, "speed", other, other.speed).max()),
        wheel_speed=float(off["wheel_speed"].max()),
        force=float(off["clamping_force"].max()),
        pressure=float(off["tank_pressure"].max()),
        apart_at=float(other.times[apart[0]]) if len(apart) else other.time,
    )


def _percent(value: float, reference: float) -> float:
    return (value / reference - 1.0) / PERCENT


def _off(rig: Recording, channel: str, other: IndependentStop, found: Any) -> Any:
    return np.abs(found - np.interp(other.times, rig["time"], rig[channel]))


def _quantities() -> Iterator[StudyQuantity]:
    def each(key: str, title: str, unit: str, upper: float | None, digits: int) -> StudyQuantity:
        band = None if upper is None else OwnBand(upper=upper, reason="ours")
        return StudyQuantity(key, title, unit, NOT_ASKED, status="predicted", band=band, digits=digits)

    for kind, words, bands in (
        ("bypassed", "WSP bypassed", (0.1, 0.1, 0.05, 0.02, 0.1, 0.5)),
        ("level", "sliding, level friction", (0.05, 0.05, 0.5, 0.02, 0.1, 1.0)),
    ):
        distance, time, air, speed, force, residual = bands
        yield each(f"{kind}_distance", f"distance, {words}, worst", "%", distance, 4)
        yield each(f"{kind}_time", f"time, {words}, worst", "%", time, 4)
        yield each(f"{kind}_air", f"air, {words}, worst", "%", air, 4)
        yield each(f"{kind}_speed", f"speed of the train, {words}, largest difference", "m/s", speed, 4)
        yield each(f"{kind}_wheel_speed", f"speed of a wheel, {words}, largest difference", "m/s", None, 3)
        yield each(f"{kind}_force", f"clamping force, {words}, largest difference", "kN", force, 4)
        yield each(f"{kind}_pressure", f"tank pressure, {words}, largest difference", "bar", None, 4)
        title = f"energy that the independent rig does not account for, {words}"
        yield each(f"{kind}_residual", title, "millionths", residual * 10.0, 2)
    yield each("falling_force", "clamping force, falling friction, largest difference", "kN", 0.1, 4)
    yield each("falling_distance", "distance, falling friction", "%", None, 1)
    yield each("falling_apart", "falling friction: a wheel is 0.1 m/s apart after", "s", None, 2)
    for step in STEPS:
        yield each(_step_key(step), f"distance of a dry stop from 30 km/h, steps of {step}", "mm", None, 2)
    title = "difference at half the step over that at the step: 0.5 of a method of first order"
    band = OwnBand(lower=0.4, upper=0.6, reason="ours")
    yield StudyQuantity("order", title, "", NOT_ASKED, status="predicted", band=band, digits=3)


def _step_key(step: str) -> str:
    return f"step_{step.removesuffix(' ms').replace('.', '_')}"


def run(stop_runner: StopRunner) -> StudyFindings:
    """Integrate every stop a second time."""
    bypassed = _all(stop_runner, BYPASSED, _BYPASSED)
    level, falling = _all(stop_runner, LEVEL, {}), _all(stop_runner, FALLING, {})
    steps = {step: _distance_off(stop_runner, step) for step in STEPS}
    values = {**_worst("bypassed", bypassed), **_worst("level", level)}
    values["falling_force"] = StudyValue(max(each.force for each in falling) / KILONEWTON)
    values["falling_distance"] = StudyValue(_largest(falling, "distance"))
    values["falling_apart"] = StudyValue(min(each.apart_at for each in falling))
    values |= {_step_key(step): StudyValue(off) for step, off in steps.items()}
    values["order"] = StudyValue(steps[STEPS[2]] / steps[STEPS[1]])
    return StudyFindings(
        values,
        tables={"stops": _table([*bypassed, *level, *falling])},
        drawings={"replayed": partial(draw, level[0], falling[0])},
        notes=(
            (
                "The independent rig shares with ours the reading of a scenario and, where the WSP acts, the "
                "commands of its valves; equations, integrator (BDF, relative tolerance 1e-8) and locking "
                "are written anew. The authors are the same."
            ),
            "Sensors have no errors here: the independent rig has none. Bands were set after the first run.",
            (
                "Where friction falls with the slip, a slide under given commands is unstable: the stops "
                "part, as two seeds do. Clamping forces do not depend on the slides, and agree to the end."
            ),
        ),
    )


def _all(stop_runner: StopRunner, stops: Mapping[str, tuple[str, Changes]], more: Changes) -> list[Compared]:
    named = [
        (name, stop_runner.cases(scenario, {**_EXACT, **changes, **more})[0])
        for name, (scenario, changes) in stops.items()
    ]
    return stop_runner.map(lambda each: _one(stop_runner, *each), named)


def _one(stop_runner: StopRunner, name: str, case: Case) -> Compared:
    (judged,) = stop_runner.repeated([case], [0])
    (recording,) = stop_runner.recordings([case])
    return compared(name, case, judged.stops[0], recording)


def _distance_off(stop_runner: StopRunner, step: str) -> float:
    """Return by how much the distance of a dry stop differs with a step of the rig, mm."""
    scenario, changes = _STEP_STOP
    (case,) = stop_runner.cases(scenario, {**_EXACT, **changes, "simulation.time_step": step})
    found = _one(stop_runner, step, case)
    return 1e3 * found.independent.distance / (1.0 + 1.0 / (found.distance * PERCENT))


def _worst(kind: str, stops: Sequence[Compared]) -> dict[str, StudyValue]:
    scales = {"wheel_speed": 1.0, "speed": 1.0, "force": KILONEWTON, "pressure": BAR, "residual": 1.0}
    shares = {f"{kind}_{name}": StudyValue(_largest(stops, name)) for name in ("distance", "time", "air")}
    return shares | {
        f"{kind}_{name}": StudyValue(max(getattr(each, name) for each in stops) / scale)
        for name, scale in scales.items()
    }


def _largest(stops: Sequence[Compared], name: str) -> float:
    return max(abs(float(getattr(each, name))) for each in stops)


def _table(stops: Sequence[Compared]) -> Table:
    return {
        "stop": [each.name for each in stops],
        "distance_m": [round(each.independent.distance, 4) for each in stops],
        "distance_difference_percent": [round(each.distance, 5) for each in stops],
        "time_difference_percent": [round(each.time, 5) for each in stops],
        "air_difference_percent": [round(each.air, 5) for each in stops],
        "speed_difference_mps": [round(each.speed, 5) for each in stops],
        "wheel_speed_difference_mps": [round(each.wheel_speed, 5) for each in stops],
        "force_difference_kn": [round(each.force / KILONEWTON, 5) for each in stops],
        "pressure_difference_bar": [round(each.pressure / BAR, 5) for each in stops],
        "energy_residual_millionths": [round(each.residual, 4) for each in stops],
        "apart_at_s": [round(each.apart_at, 2) for each in stops],
    }


def draw(level: Compared, falling: Compared, figure: Figure) -> None:
    """Draw the wheels of the stops with replayed commands: the rig's as lines, the others dashed."""
    figure.set_size_inches(WIDTH, 4.8)
    for axes, each in zip(figure.subplots(2, 1), (level, falling), strict=True):
        for n, colour in WHEELSET_COLOURS.items():
            axes.plot(each.rig["time"], each.rig[f"wheel_speed_{n}"], color=colour, linewidth=1.0)
            axes.plot(
                each.independent.times,
                each.independent.wheel_speeds[:, n - 1],
                color=INK,
                linewidth=0.7,
                linestyle=(0, (3, 3)),
                label="independent" if n == 1 else None,
            )
        axes.set_ylabel("speed of the wheels, m/s")
        title_and_legend(axes, each.name, 1)
    axes.set_xlabel("time, s")


STUDY = Study(
    "independent-integration",
    "The whole rig written and integrated a second time",
    "",
    tuple(_quantities()),
    run,
    position=117,
)
