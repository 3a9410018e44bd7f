"""Find friction profiles with which the rig's stop agrees with four values of the real train's stop."""

from __future__ import annotations

import itertools
from collections.abc import Iterator
from dataclasses import dataclass, replace
from functools import partial
from typing import TYPE_CHECKING

import numpy as np

from uictest import rig
from uictest.recording import Recording
from uictest.scenario import Case, FrictionProfile
from uictest.studies.quantity import StudyQuantity, StudyValue
from uictest.studies.replay import CYCLE
from uictest.studies.stop_runner import StopRunner
from uictest.studies.study import Study, StudyFindings, Table, column
from uictest.units import KILOMETRE_PER_HOUR

if TYPE_CHECKING:
    from matplotlib.figure import Figure

REAL_TRAIN = {
    "braking_time": 17.6,
    "braking_distance": 197.0,
    "minimum_deceleration": 0.98,
    "maximum_deceleration": 1.52,
}
"""Stated by Lee and Kang (2015) of a stop from 80 km/h: s, m, m/s2, m/s2."""
_INITIAL_SPEED = 80.0 * KILOMETRE_PER_HOUR
TOLERANCES = {
    "braking_time": 0.35,
    "braking_distance": 4.0,
    "minimum_deceleration": 0.1,
    "maximum_deceleration": 0.1,
}
"""Chosen: 2 % of time and distance, and the possible effect of the unknown filter of the decelerations."""

LEVELS = (0.11, 0.12, 0.13, 0.14, 0.15, 0.16, 0.17, 0.18)
DRY = 0.30
"""No wheelset slides at this friction, whatever the pads: more friction changes nothing."""
BREAKS = (110.0, 140.0, 170.0)
"""Positions, m, at which the friction may change; a stop takes about 200 m."""
PAD_FACTORS = (1.0, 1.1, 1.2)
"""Factors on the pad friction of the rig: the paper does not give the brake force of the real train."""

_CAVEAT = (
    "Four figures do not determine a profile: friction, its place and the strength of the brake stand in for"
    " each other. The filter behind the paper's decelerations is not public."
)

QUANTITIES = (
    StudyQuantity("braking_time", "braking time of the closest stop", "s", "17.6 s"),
    StudyQuantity("braking_distance", "braking distance of the closest stop", "m", "197 m"),
    StudyQuantity("minimum_deceleration", "its least deceleration", "m/s2", "0.98 m/s2", digits=2),
    StudyQuantity("maximum_deceleration", "its greatest deceleration", "m/s2", "1.52 m/s2", digits=2),
    StudyQuantity("pad_factor", "its pad friction over the rig's", paper="ours", digits=2),
    StudyQuantity("profiles", "profiles tried", paper="ours", digits=0),
    StudyQuantity("consistent", "profiles that agree in all four figures", paper="ours", digits=0),
    StudyQuantity("agree_in_run", "profiles that agree in time and distance", paper="ours", digits=0),
)


@dataclass(frozen=True, slots=True)
class Profile:
    """Friction before and after a position (m; None: constant friction), and the factor on the pads."""

    before: float
    after: float
    place: float | None
    pad_factor: float

    def __str__(self) -> str:
        """Return the profile in words."""
        pads = f", pads x {self.pad_factor:g}"
        if self.place is None:
            return f"{self.before:g} everywhere{pads}"
        return f"{self.before:g} up to {self.place:g} m, {self.after:g} beyond{pads}"


def profiles() -> Iterator[Profile]:
    """Yield constant friction, and dry track before or after slippery track, with each factor on the pads."""
    for factor in PAD_FACTORS:
        yield from (Profile(level, level, None, factor) for level in (*LEVELS, DRY))
        for level, place in itertools.product(LEVELS, BREAKS):
            yield Profile(DRY, level, place, factor)
            yield Profile(level, DRY, place, factor)


def run(stop_runner: StopRunner) -> StudyFindings:
    """Simulate a stop on every profile, and select those that agree with the real train."""
    base = stop_runner.cases("slide-80")[0]
    tried = list(profiles())
    stops = stop_runner.map(_stop, [_on(base, profile) for profile in tried])
    misfits = [misfit(stop) for stop in stops]
    closest = int(np.argmin([max(each.values()) for each in misfits]))
    recording = stop_runner.recordings([_on(base, tried[closest])], CYCLE)[0]
    consistent = [k for k, each in enumerate(misfits) if max(each.values()) <= 1.0]
    in_run = [
        k for k, each in enumerate(misfits) if max(each["braking_time"], each["braking_distance"]) <= 1.0
    ]
    values = {name: StudyValue(float(stops[closest].measures[name])) for name in REAL_TRAIN}
    values["pad_factor"] = StudyValue(tried[closest].pad_factor)
    counts = {"profiles": len(tried), "consistent": len(consistent), "agree_in_run": len(in_run)}
    return StudyFindings(
        values | {name: StudyValue(float(count)) for name, count in counts.items()},
        tables={"profiles": _table(tried, stops, misfits, in_run), "closest-stop": _stop_table(recording)},
        drawings={"field-against-rig": partial(_draw, recording)},
        notes=(
            f"The closest stop: friction {tried[closest]}.",
            _delay_note(),
            *_agreement_notes([tried[k] for k in consistent], [tried[k] for k in in_run]),
            _CAVEAT,
        ),
    )


def _delay_note() -> str:
    """Return the note on the delay for which a constant deceleration gives the paper's time and distance.

    T = v / a + delay and D = v (T + delay) / 2.
    """
    delay = 2.0 * REAL_TRAIN["braking_distance"] / _INITIAL_SPEED - REAL_TRAIN["braking_time"]
    return (
        f"After a delay of {delay:.2f} s an even deceleration would take the paper's time and distance: less"
        " than a brake takes to build up, so the real train braked harder first than last."
    )


def misfit(stop: rig.SimulatedStop) -> dict[str, float]:
    """Return the difference of each measure of a stop from the real train's, in tolerances."""
    measures = {name: float(stop.measures[name]) for name in REAL_TRAIN}
    off = {name: abs(measures[name] - REAL_TRAIN[name]) / TOLERANCES[name] for name in REAL_TRAIN}
    return {name: value if np.isfinite(value) else float("inf") for name, value in off.items()}


def _agreement_notes(consistent: list[Profile], in_run: list[Profile]) -> Iterator[str]:
    for words, agreeing in (("all four figures", consistent), ("time and distance", in_run)):
        if not agreeing:
            yield f"No profile agrees in {words}."
            continue
        frictions = [mu for profile in agreeing for mu in (profile.before, profile.after)]
        pads = sorted({profile.pad_factor for profile in agreeing})
        constant = [f"{profile.before:g}" for profile in agreeing if profile.place is None]
        yield (
            f"Profiles that agree in {words}: {len(agreeing)}, with friction"
            f" {min(frictions):g} to {max(frictions):g} and pads x {pads[0]:g} to {pads[-1]:g};"
            f" constant friction among them: {', '.join(constant) or 'none'}."
        )


def _on(base: Case, profile: Profile) -> Case:
    scenario = base.scenario
    friction = FrictionProfile.model_validate(_points(profile))
    disc = scenario.brake.system.disc
    stronger = {"pad_friction": type(disc.pad_friction)(profile.pad_factor * disc.pad_friction, "", "1")}
    system = scenario.brake.system.model_copy(update={"disc": disc.model_copy(update=stronger)})
    changes = {
        "rail": scenario.rail.model_copy(update={"friction": friction}),
        "brake": scenario.brake.model_copy(update={"system": system}),
    }
    return replace(base, scenario=scenario.model_copy(update=changes))


def _points(profile: Profile) -> dict[str, object]:
    places = [0.0] if profile.place is None else [0.0, profile.place]
    values = (profile.before, profile.after)
    points = [{"position": f"{p:g} m", "friction": mu} for p, mu in zip(places, values, strict=False)]
    return {"points": tuple(points), "interpolation": "steps"}


def _stop(case: Case) -> rig.SimulatedStop:
    return rig.simulate(case)


def _table(
    tried: list[Profile], stops: list[rig.SimulatedStop], misfits: list[dict[str, float]], shown: list[int]
) -> Table:
    order = sorted(shown, key=lambda k: max(misfits[k].values()))
    columns: dict[str, list[object]] = {"profile": [str(tried[k]) for k in order]}
    units = {"braking_time": "s", "braking_distance": "m"}
    for name in REAL_TRAIN:
        columns[f"{name}_{units.get(name, 'mps2')}"] = [
            round(float(stops[k].measures[name]), 3) for k in order
        ]
    columns["misfit_in_tolerances"] = [round(max(misfits[k].values()), 3) for k in order]
    return columns


def _stop_table(recording: Recording) -> Table:
    return {
        "time_s": column(recording["time"], 1.0, 3),
        "distance_m": column(recording["distance"], 1.0, 3),
        "speed_kmh": column(recording["speed"], KILOMETRE_PER_HOUR, 3),
        **{
            f"wheel_speed_{n}_kmh": column(recording[f"wheel_speed_{n}"], KILOMETRE_PER_HOUR, 3)
            for n in (1, 2, 3, 4)
        },
    }


def _draw(recording: Recording, figure: Figure) -> None:
    axes = figure.add_subplot()
    for n in (1, 2, 3, 4):
        axes.plot(
            recording["time"], recording[f"wheel_speed_{n}"] / KILOMETRE_PER_HOUR, linewidth=0.7, alpha=0.7
        )
    axes.plot(recording["time"], recording["speed"] / KILOMETRE_PER_HOUR, color="black", label="rig")
    axes.axvline(
        REAL_TRAIN["braking_time"], color="tab:red", linestyle=":", label="standstill of the real train"
    )
    axes.set_xlabel("time since the brake command, s")
    axes.set_ylabel("speed, km/h")
    axes.legend()


STUDY = Study(
    "field-against-rig",
    "Field against rig: friction profiles that agree with the real train's stop from 80 km/h",
    "the real train took 17.6 s and 197 m at 0.98-1.52 m/s2; its rail is not described",
    QUANTITIES,
    run,
    position=120,
)
