"""What brake tests on a full-scale rig found of leaf layers, beside the library's layer of leaves."""

from __future__ import annotations

from collections.abc import Iterator
from typing import Any, Final

import numpy as np

from studies.stop_runner import StopRunner
from studies.used_rail import used_rail
from uictest.units import KILOMETRE_PER_HOUR, KILONEWTON
from validation.cleaned_rail import adhesion_of
from validation.source import Comparison, Findings, Source

LAWS: Final = ("leaf-layer", "leaf-film")
ULTRA_LOW: Final = (0.0, 0.05)
SPEEDS: Final = (20, 80)
"""km/h; chosen, as those of the tests are not in the abstract."""
LOADS: Final = (40, 70)
"""Of a wheel, kN; chosen likewise."""
REMOVED: Final = {"a tenth": 0.1, "a quarter": 0.25, "half": 0.5}
"""Shares of the layer; chosen, as the abstract says *partially*."""
SET_AT_MOST: Final = 0.25
"""Share up to which the weight of `leaf-film` was set by these rows."""
BRAKINGS: Final = (1, 2, 3, 5)
"""On the same rail; chosen, as the abstract says *a number of*."""
BRAKED_FROM = 80
"""km/h."""
CREEPAGES: Final = np.geomspace(0.001, 0.5, 250)


def run(stop_runner: StopRunner) -> Findings:
    """Compare the layers as found at several speeds and loads, partly removed, and over several brakings."""
    return Findings(
        [each for law in LAWS for each in _of_law(stop_runner, law)],
        notes=(
            (
                "Highest F/Q of the creep curve; brakings are stops of the library's car from "
                f"{BRAKED_FROM} km/h with the default controller. *Low* has no number of its own in the "
                "abstract and is read as the ultra-low that it follows. A mixture in proportion, as "
                "`leaf-layer` is, leaves the ultra-low when two per cent are worn; the tests say that "
                "friction stayed low on a layer with gaps."
            ),
        ),
    )


def _of_law(stop_runner: StopRunner, law: str) -> Iterator[Comparison]:
    changes = {"rig.compensation": "thermal", "rail.condition": law, "initial_speed": f"{BRAKED_FROM} km/h"}
    rail = stop_runner.cases("slip-120", {**changes, "rail.friction": "null"})[0].scenario.rail.condition
    used = used_rail(stop_runner, "slip-120", {**changes, "rail.friction": f"{rail.friction:g}"}, seed=0)
    for speed in SPEEDS:
        for load in LOADS:
            label = f"{law} as found, {speed} km/h, {load} kN on the wheel"
            yield _row(f"adhesion, {label}", _highest(rail, speed, load, 0.0), fitted=True)
    for words, share in REMOVED.items():
        fitted = law == "leaf-film" and share <= SET_AT_MOST
        yield _row(f"adhesion, {words} of {law} removed", _highest(rail, SPEEDS[0], LOADS[0], share), fitted)
    for n in BRAKINGS:
        yield _row(f"mean deceleration of braking {n} on {law}, g", used.adhesions[n - 1], fitted=n == 1)


def _highest(rail: Any, speed: float, load: float, share: float) -> float:
    adhesion = adhesion_of(rail, speed * KILOMETRE_PER_HOUR, load * KILONEWTON, float(rail.friction))
    return max(adhesion(float(creepage), share) for creepage in CREEPAGES)


def _row(quantity: str, here: float, fitted: bool) -> Comparison:
    return Comparison(quantity, "", ULTRA_LOW, here, fitted=fitted, digits=3)


SOURCE = Source(
    name="leaf-layers",
    title="Leaf layers in brake tests on a full-scale rig",
    place=(
        "Lewis, Trummer, Six, Stow, Alturbeh, Bryce, Shackleton, Buckley-Johnstone, Tribology International"
        " 185 (2023) 108529; ultra-low as at most 0.05 in Buckley-Johnstone, Trummer, Voltr, Six, Lewis,"
        " Full-scale testing of low adhesion effects with small amounts of water: abstracts alone"
    ),
    kind="second-hand",
    fitted=(
        "Of both laws the friction as found, chosen in view of such words; of `leaf-film` the weight, by a"
        " layer of which a quarter is removed. The energy is chosen so that some ten stops wear the layer,"
        " without a number of this source"
    ),
    shows="Whether the layer is as slippery as those of the tests, and for how long.",
    does_not_show=(
        "How the layer forms, and how far it was worn: creepages, loads and the number of brakings are not in"
        " the abstract."
    ),
    run=run,
)
