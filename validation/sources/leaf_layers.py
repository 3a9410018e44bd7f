"""What brake tests on a full-scale rig found of leaf layers, beside the library's layer of leaves."""

from __future__ import annotations

from collections.abc import Iterator
from typing import Any, Final

import numpy as np

from studies.stop_runner import StopRunner
from studies.used_rail import used_rail
from uictest.units import KILOMETRE_PER_HOUR, KILONEWTON
from validation.cleaned_rail import adhesion
from validation.source import Comparison, Findings, Source

LAW: Final = "leaf-layer"
ULTRA_LOW: Final = (0.0, 0.05)
SPEEDS: Final = (20, 80)
"""km/h; chosen, as those of the tests are not in the abstract."""
LOADS: Final = (40, 70)
"""Of a wheel, kN; chosen likewise."""
REMOVED: Final = {"a tenth": 0.1, "a quarter": 0.25, "half": 0.5}
"""Shares of the layer; chosen, as the abstract says *partially*."""
BRAKINGS: Final = (1, 2, 3, 5)
"""On the same rail; chosen, as the abstract says *a number of*."""
BRAKED_FROM = 80
"""km/h."""
CREEPAGES: Final = np.geomspace(0.001, 0.5, 250)


def run(stop_runner: StopRunner) -> Findings:
    """Compare the layer as found at several speeds and loads, partly removed, and over several brakings."""
    changes = {"rig.compensation": "thermal", "rail.condition": LAW, "initial_speed": f"{BRAKED_FROM} km/h"}
    rail = stop_runner.cases("slip-120", {**changes, "rail.friction": "null"})[0].scenario.rail.condition
    used = used_rail(stop_runner, "slip-120", {**changes, "rail.friction": f"{rail.friction:g}"}, seed=0)
    return Findings(
        [
            *_found(rail),
            *_removed(rail),
            *(
                _row(f"mean deceleration of braking {n} on the same rail, g", used.adhesions[n - 1], n == 1)
                for n in BRAKINGS
            ),
        ],
        notes=(
            (
                "Highest F/Q of the creep curve; brakings are stops of the library's car from "
                f"{BRAKED_FROM} km/h with the default controller. *Low* has no number of its own in the "
                "abstract and is read as the ultra-low that it follows. Of friction 0.28 on a clean rail "
                f"and {rail.friction:g} on the layer, a mixture in proportion leaves the ultra-low when two "
                "per cent are worn; the tests say that friction stayed low on a layer with gaps."
            ),
        ),
    )


def _found(rail: Any) -> Iterator[Comparison]:
    for speed in SPEEDS:
        for load in LOADS:
            label = f"layer as found, {speed} km/h, {load} kN on the wheel"
            yield _row(f"adhesion, {label}", _highest(rail, speed, load, 0.0), fitted=True)


def _removed(rail: Any) -> Iterator[Comparison]:
    for words, share in REMOVED.items():
        yield _row(
            f"adhesion, {words} of the layer removed", _highest(rail, SPEEDS[0], LOADS[0], share), False
        )


def _highest(rail: Any, speed: float, load: float, share: float) -> float:
    motion = speed * KILOMETRE_PER_HOUR, load * KILONEWTON, float(rail.friction), share
    return max(adhesion(rail, float(creepage), *motion) for creepage in CREEPAGES)


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
        "Of `leaf-layer` the friction as found, chosen in view of such words. Its energy is chosen so that"
        " some ten stops wear the layer, without a number of this source"
    ),
    shows="Whether the layer is as slippery as those of the tests, and for how long.",
    does_not_show=(
        "How the layer forms, and how far it was worn: creepages, loads and the number of brakings are not in"
        " the abstract."
    ),
    run=run,
)
