"""Distances of a sanded train: two of RSSB T1107 fitted, two computed from the fit.

To these two nothing is fitted, but kappa and the cap were chosen with an earlier model that had been compared
with all four: they are selected, not predicted.
"""

from __future__ import annotations

from collections.abc import Callable, Iterator, Mapping, Sequence
from dataclasses import dataclass, replace
from functools import partial
from typing import TYPE_CHECKING, Literal

import numpy as np

from studies.drawing import BLUE, INK, MUTED, ORANGE, WIDTH
from studies.quantity import NOT_ASKED, OwnBand, SourceBand, StudyQuantity, StudyValue
from studies.sanded_rig import rig_notes, rig_quantities, rig_table, stops_on_rig
from studies.sanded_train import SandedStop, Sander, SandLaw, bisect, stop
from studies.stop_runner import StopRunner
from studies.study import Study, StudyFindings, Table

if TYPE_CHECKING:
    from matplotlib.figure import Figure

SPEED = 55 * 0.44704
"""m/s: 55 mph, RSSB T1107."""
DEMAND = 0.9
"""m/s2, RSSB T1107."""
PUBLISHED = {"one_fixed": 800.0, "two_fixed": 650.0, "one_variable": 600.0, "two_variable": 400.0}
"""m, RSSB T1107; the train of 16 axles has adhesion 0.02 untreated and then needs more than 1200 m."""
FITTED = ("one_fixed", "two_variable")
UNTREATED_BOUND = 1200.0
FIRST_AXLE = 3
"""Of the first sander, RSSB T1107."""
FIXED_RATE = 2000 / 60
"""g/s: 2 kg/min; chosen, the source's rates are not known."""
DENSITY = 7.5
"""g/m at which a variable sander aims; chosen: the density of GM/RT2461."""
END_AT_MOST = 0.3
"""Adhesion of a dry rail, at most that of a sanded one; chosen."""
LIMIT = 500.0
"""g per device in 30 s below 140 km/h, tolerance included: CCS TSI."""
_NAMES = {key: key.replace("_", " ") + (" sanders" if "two" in key else " sander") for key in PUBLISHED}


@dataclass(frozen=True, slots=True)
class Choices:
    """What no source gives, fixed before the fit.

    Args:
        kept: kappa, share of the sand that a wheelset leaves.
        cap: largest rate of a variable sander, kg/min.
        second_axle: of the second sander.
    """

    kept: float = 0.8
    cap: float = 6.0
    second_axle: int = 7


VARIED: Sequence[Mapping[str, float]] = (
    {"kept": 0.6},
    {"kept": 0.95},
    {"cap": 4.0},
    {"cap": 8.0},
    {"second_axle": 5},
    {"second_axle": 11},
)
"""Ends of the ranges of the choices, chosen; the law is fitted anew at each."""


def arrangements(choices: Choices) -> dict[str, list[Sander]]:
    """Return the sanders of each published stop."""
    axles = (FIRST_AXLE, choices.second_axle)
    fixed = [Sander(axle, FIXED_RATE) for axle in axles]
    variable = [Sander(axle, choices.cap * 1000 / 60, DENSITY) for axle in axles]
    return {
        "one_fixed": fixed[:1],
        "two_fixed": fixed,
        "one_variable": variable[:1],
        "two_variable": variable,
    }


def fit(choices: Choices) -> SandLaw:
    """Fit the slope to the stop with one fixed sander and the end value to that with two variable ones.

    Each hardly depends on the other number, so that four rounds settle both. Where no end value reaches
    the published distance, the nearer end of its range is returned.
    """
    sanders = arrangements(choices)

    def distance(name: str, law: SandLaw) -> float:
        return stop(SPEED, DEMAND, law, sanders[name], choices.kept).distance

    law = SandLaw(slope=0.01, end=0.1)
    for _ in range(4):
        law = _settled(law, "slope", (0.002, 0.15), FITTED[0], distance)
        law = _settled(law, "end", (0.03, END_AT_MOST), FITTED[1], distance)
    return law


def _settled(
    law: SandLaw,
    number: Literal["slope", "end"],
    limits: tuple[float, float],
    target: str,
    distance: Callable[[str, SandLaw], float],
) -> SandLaw:
    """Return the law with the value of one number that gives the published distance of the target."""

    def with_value(value: float) -> SandLaw:
        return replace(law, slope=value) if number == "slope" else replace(law, end=value)

    return with_value(bisect(lambda value: distance(target, with_value(value)), *limits, PUBLISHED[target]))


@dataclass(frozen=True, slots=True)
class Fitted:
    """A fit under some choices, and the stop of each arrangement under it."""

    choices: Choices
    law: SandLaw
    stops: Mapping[str, SandedStop]

    def error(self, name: str) -> float:
        """Return the error of a distance, %."""
        return 100.0 * (self.stops[name].distance / PUBLISHED[name] - 1.0)


def fitted(choices: Choices) -> Fitted:
    """Fit the law under some choices and stop with every arrangement."""
    law = fit(choices)
    stops = {name: stop(SPEED, DEMAND, law, own, choices.kept) for name, own in arrangements(choices).items()}
    return Fitted(choices, law, stops)


def _quantities() -> Iterator[StudyQuantity]:
    yield StudyQuantity(
        "untreated",
        "distance without sand",
        "m",
        "not asked; RSSB T1107: more than 1200 m",
        status="by construction",
        band=SourceBand(lower=UNTREATED_BOUND, above=True, reason="RSSB T1107"),
        digits=0,
    )
    for name, published in PUBLISHED.items():
        target = name == FITTED[0]
        yield StudyQuantity(
            name,
            f"distance, {_NAMES[name]}",
            "m",
            f"not asked; RSSB T1107: {published:.0f} m",
            status="calibrated" if name in FITTED else "selected",
            band=OwnBand(lower=792.0, upper=808.0, reason="ours, 1 % about RSSB T1107") if target else None,
            digits=0,
        )
        yield StudyQuantity(
            f"{name}_error",
            f"error of that distance, {_NAMES[name]}",
            "%",
            NOT_ASKED,
            status="calibrated" if name in FITTED else "selected",
        )
    for name in ("one_fixed", "one_variable"):
        yield StudyQuantity(
            f"{name}_sand",
            f"sand of the device in its first 30 s, {_NAMES[name]}",
            "g",
            "not asked; CCS TSI: at most 400 + 100 g",
            status="selected",
            digits=0,
        )
    yield from rig_quantities(PUBLISHED, UNTREATED_BOUND)


def run(stop_runner: StopRunner) -> StudyFindings:
    """Fit the law under the choices and at the ends of their ranges; repeat the nominal stops on the rig."""
    nominal = Choices()
    fits = [fitted(nominal), *(fitted(replace(nominal, **change)) for change in VARIED)]  # type: ignore[arg-type]
    untreated = stop(SPEED, DEMAND, fits[0].law).distance
    on_rig = stops_on_rig(stop_runner, SPEED, fits[0].law, nominal.kept, arrangements(nominal))
    of_points = {"untreated": untreated, **{name: each.distance for name, each in fits[0].stops.items()}}
    of_rig = {f"rig_{curve}_{name}": on_rig.value(curve, name) for curve, name in on_rig.distances}
    return StudyFindings(
        {"untreated": StudyValue(untreated), **dict(_values(fits)), **of_rig},
        tables={"fits": _table(fits), "rig": rig_table(on_rig, of_points)},
        drawings={"sand": partial(draw, fits)},
        notes=(*_notes(fits), *rig_notes(on_rig, PUBLISHED)),
    )


def _values(fits: Sequence[Fitted]) -> Iterator[tuple[str, StudyValue]]:
    for name in PUBLISHED:
        yield name, _over([each.stops[name].distance for each in fits])
        yield f"{name}_error", _over([each.error(name) for each in fits])
    for name in ("one_fixed", "one_variable"):
        yield f"{name}_sand", _over([each.stops[name].sand_in_30_s[0] for each in fits])


def _over(values: Sequence[float]) -> StudyValue:
    """Return the value under the choices with its range over those of all fits."""
    return StudyValue(values[0], min(values), max(values))


def _notes(fits: Sequence[Fitted]) -> Iterator[str]:
    first = fits[0]
    yield (
        "A train of point axles: no wheel dynamics, WSP or build-up; cleaning is off. Chosen: "
        f"kappa {first.choices.kept:g} (0.6 to 0.95), cap {first.choices.cap:g} kg/min (4 to 8), second "
        f"sander at axle {first.choices.second_axle} (5 to 11), fixed rate 2 kg/min. Ranges: one of the "
        "first three at an end, and the law fitted anew."
    )
    yield (
        "Kappa and the cap were chosen with an earlier model that had been compared with all four "
        "distances; what is not fitted is therefore selected, not predicted."
    )
    reached = "" if first.law.end < 0.99 * END_AT_MOST else ", the end of its range"
    yield (
        f"Fitted to {_NAMES[FITTED[0]]} and {_NAMES[FITTED[1]]}: slope {first.law.slope:.4f} m/g, end value "
        f"{first.law.end:.3f}{reached}."
    )
    for name in PUBLISHED:
        if name not in FITTED:
            verdict = "within" if abs(first.error(name)) <= 10.0 else "outside"
            yield f"Not fitted, {_NAMES[name]}: {first.error(name):+.1f} %, {verdict} the wanted 10 %."
    spent = first.stops["one_fixed"].sand_in_30_s[0]
    yield (
        f"The limit of the CCS TSI is {LIMIT:g} g per device in 30 s. A fixed sander of 2 kg/min lays "
        f"{spent:.0f} g, and {DENSITY:g} g/m at this speed would spend the limit in "
        f"{LIMIT / (DENSITY * SPEED):.1f} s."
    )


def _table(fits: Sequence[Fitted]) -> Table:
    return {
        "kappa": [each.choices.kept for each in fits],
        "cap_kg_per_min": [each.choices.cap for each in fits],
        "second_axle": [each.choices.second_axle for each in fits],
        "slope_m_per_g": [round(each.law.slope, 5) for each in fits],
        "end_value": [round(each.law.end, 4) for each in fits],
        **{f"{name}_m": [round(each.stops[name].distance, 1) for each in fits] for name in PUBLISHED},
        **{f"{name}_error_percent": [round(each.error(name), 1) for each in fits] for name in PUBLISHED},
    }


def draw(fits: Sequence[Fitted], figure: Figure) -> None:
    """Draw the fitted laws, and each distance over the published one."""
    figure.set_size_inches(WIDTH, 2.8)
    left, right = figure.subplots(1, 2)
    densities = np.linspace(0.0, DENSITY, 101)
    for each in reversed(fits):
        colour = BLUE if each is fits[0] else MUTED
        left.plot(densities, each.law.adhesion(densities), color=colour, linewidth=0.9)
    left.set_xlabel("density, g/m")
    left.set_ylabel("adhesion, -")
    right.plot([350, 850], [350, 850], color=INK, linewidth=0.8)
    for name, published in PUBLISHED.items():
        low, high = (edge(each.stops[name].distance for each in fits) for edge in (min, max))
        colour = MUTED if name in FITTED else ORANGE
        right.plot([published] * 2, [low, high], color=colour, linewidth=0.9)
        right.plot(published, fits[0].stops[name].distance, "o", color=colour, markersize=4.0)
    right.set_xlabel("distance, RSSB T1107, m")
    right.set_ylabel("distance, point train, m")


STUDY = Study(
    "sand",
    "Distances of a sanded four-car train: two fitted, two not",
    "",
    tuple(_quantities()),
    run,
    position=114,
)
