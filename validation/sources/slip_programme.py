"""Distances of a programme of slip tests, second-hand: dry ones, and limits that wet ones must keep."""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from typing import Any, Final

from studies.stop_runner import StopRunner, measured
from uictest import CaseResult
from validation.source import Comparison, Findings, Source

RAILS: Final = ("wet", "wet-speed", "wet-cleaning", "wet-curves", "leaf-layer", "leaf-film")
COARSE: Final = tuple(range(40, 200, 20))
"""Frictions in thousandths among which the highest is sought at which the stop from 120 km/h is a test."""
FINE: Final = tuple(range(2, 20, 2))
"""Above the one that was found, the frictions among which it is sought again."""
SEEDS: Final = range(4)
EXTENSION: Final = 1.5
"""Largest distance of a wet stop from 160 km/h over that of the dry one."""


def run(stop_runner: StopRunner) -> Findings:
    """Compare the dry stops, then the wet ones on each rail at the highest friction that makes a test."""

    def stops(changes: Mapping[str, Any]) -> Sequence[CaseResult]:
        cases = stop_runner.cases("slip-120", {"rig.compensation": "thermal", **changes})
        return stop_runner.repeated(cases, SEEDS)[0].stops

    def largest(of: Sequence[CaseResult]) -> float:
        return max(measured(stop, "braking_distance_m") for stop in of)

    dry = {"rail.condition": "dry", "rail.friction": None}
    alone = {"brake.supply": "off"}
    r_160 = largest(stops({**dry, "initial_speed": "160 km/h"}))
    rr_160 = {**dry, "brake.position": "RR", "initial_speed": "160 km/h"}
    comparisons = [
        Comparison("R 120 dry", "m", (440.0, 490.0), largest(stops({**dry, **alone})), fitted=True),
        Comparison("P 120 dry", "m", (580.0, 620.0), largest(stops({**dry, **alone, "brake.position": "P"}))),
        Comparison("RR 160 dry", "m", (720.0, 770.0), largest(stops(rr_160)), fitted=True),
    ]
    chosen = {rail: _highest_valid_friction(stop_runner, rail) for rail in RAILS}
    no_tests = []
    for rail, friction in chosen.items():
        wet = {"rail.condition": rail, "rail.friction": friction}
        for title, changes, limit in (
            ("R 120 wet", alone, 700.0),
            ("P 120 wet", {**alone, "brake.position": "P"}, 730.0),
            ("R 160 wet", {"initial_speed": "160 km/h"}, EXTENSION * r_160),
        ):
            found = stops({**wet, **changes})
            if any(stop.test_validity == "not_valid" for stop in found):
                no_tests.append(f"{title} on {rail}")
            else:
                comparisons.append(
                    Comparison(f"{title}, {rail}", "m", (0.0, round(limit, 1)), largest(found))
                )
    frictions = ", ".join(f"{rail} {friction}" for rail, friction in chosen.items())
    return Findings(
        comparisons,
        notes=(
            (
                "The largest of four stops (seeds 0 to 3), from 120 km/h without supply of the reservoir. "
                "Wet stops with the controller `threshold`, each rail at the highest friction at which the "
                f"first stop from 120 km/h in R is a test (first phase below 0.08 g): {frictions}. No "
                f"tests there, and left out: {', '.join(no_tests) or 'none'}. From 160 km/h nothing says "
                "whether a stop is a test."
            ),
        ),
    )


def _highest_valid_friction(stop_runner: StopRunner, rail: str) -> str:
    """Return the highest friction at which the first stop is a test."""

    def valid(thousandths: Sequence[int]) -> list[int]:
        frictions = [f"{0.001 * each:.3f}" for each in thousandths]
        changes = {"rig.compensation": "thermal", "brake.supply": "off", "rail.condition": rail}
        cases = stop_runner.cases("slip-120", {**changes, "rail.friction": frictions})
        pairs = zip(thousandths, stop_runner.repeated(cases, SEEDS[:1]), strict=True)
        return [each for each, of_case in pairs if of_case.stops[0].test_validity == "valid"]

    coarse = valid(COARSE)
    highest = max([coarse[-1], *valid([coarse[-1] + step for step in FINE])])
    return f"{0.001 * highest:.3f}"


SOURCE = Source(
    name="slip-programme",
    title="A programme of slip tests of a single coach",
    place=(
        "programme of ten slip tests printed in Italian annexes on a site of shared theses; read "
        "second-hand, author and leaflet not named, very probably UIC 541-05 before 2016 (inferred)"
    ),
    kind="second-hand",
    fitted="Pressures of R and RR, each to its dry band",
    shows="Which laws of the rail bring a valid wet stop below the limits with this controller.",
    does_not_show=(
        "How good a controller is: the limits suppose a rail that recovers under sliding, and how much ours "
        "do is not known within a factor of two."
    ),
    run=run,
)
