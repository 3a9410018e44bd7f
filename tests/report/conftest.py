"""Results to report on."""

from __future__ import annotations

from collections.abc import Callable

import numpy as np
import pytest

from uictest.evaluation import CaseResult, Figures, Verdict, WheelsetFigures
from uictest.recording import Recording
from uictest.report import RunContent

HOSTILE = "\x1b[31m=cmd|'/c calc'!A1 [bold]x[/bold] <b>&\x00\u202e\n::error::"


@pytest.fixture
def hostile() -> str:
    """A text with terminal codes, formula, markup, XML, null, direction override and workflow command."""
    return HOSTILE


@pytest.fixture
def make_result() -> Callable[..., CaseResult]:
    """A stop at 120 km/h on a dry rail that passed, with whatever is to be different."""

    def make(**changes: object) -> CaseResult:
        content: dict[str, object] = {
            "id": "dry-120[command=90]",
            "scenario": "scenarios/dry/120.yaml",
            "parameters": {"brake.command": "90 %"},
            "expect": "pass",
            "outcome": "pass",
            "criteria": (verdict(),),
            "measures": FIGURES,
            "wheelsets": tuple(WheelsetFigures(0.02 * n, 0.0, n, 25e3, 1.5) for n in range(1, 5)),
            "duration": 0.25,
        }
        return CaseResult(**(content | changes))  # type: ignore[arg-type]

    return make


@pytest.fixture
def make_verdict() -> Callable[..., Verdict]:
    """A braking distance inside its limits, with whatever is to be different."""
    return verdict


@pytest.fixture
def make_content() -> Callable[..., RunContent]:
    """A finished run of the given results."""

    def make(*results: CaseResult, **changes: object) -> RunContent:
        manifest = {"command": ["uictest", "run"], "seed": None, "versions": {"uictest": "0.1.0"}}
        return RunContent(**({"name": "a-run", "results": results, "manifest": manifest} | changes))  # type: ignore[arg-type]

    return make


@pytest.fixture
def make_recording() -> Callable[..., Recording]:
    """A stop from 120 km/h at 1 m/s2 in which every wheelset slides by 40 % for a while and is vented."""

    def make(samples: int = 3401, **metadata: str) -> Recording:
        time = np.linspace(0.0, 34.0, samples)
        speed = np.clip(120 / 3.6 - time, 0.0, None)
        slide = np.where((time > 5.0) & (time < 15.0), 0.4, 0.0)
        channels = {"time": time, "distance": np.cumsum(speed) * 34.0 / samples, "speed": speed}
        units = {"time": "s", "distance": "m", "speed": "m/s"}
        channels |= {"brake_line_pressure": np.full(samples, 3.8e5), "reservoir_pressure": 8e5 - 1e3 * time}
        units |= {"brake_line_pressure": "Pa", "reservoir_pressure": "Pa"}
        for n in (1, 2, 3, 4):
            own = {
                "wheel_speed": (speed * (1.0 - slide), "m/s"),
                "slide": (slide, "1"),
                "adhesion": (np.full(samples, 0.1), "1"),
                "tank_pressure": (3.8e5 * (1.0 - slide), "Pa"),
                "clamping_force": (14e3 * (1.0 - slide), "N"),
                "valve_command": (np.where(slide > 0.0, 2.0, 0.0), "1"),
            }
            channels |= {f"{name}_{n}": samples_of for name, (samples_of, _) in own.items()}
            units |= {f"{name}_{n}": unit for name, (_, unit) in own.items()}
        return Recording(channels, units, {"case": "dry-120", **metadata})

    return make


FIGURES = Figures(465.25, 27.5, 1.195, float("nan"), 0.9, 1.31, 7.2, 180.0, 1e-5, 1e-12)


def verdict(**changes: object) -> Verdict:
    content: dict[str, object] = {
        "id": "braking-distance",
        "layer": "validity",
        "value": 465.25,
        "unit": "m",
        "lower": 440.0,
        "upper": 490.0,
        "margin": 24.75,
        "verdict": "pass",
        "reason": "",
        "definition": {"low_speed_cutoff": "30 km/h"},
    }
    return Verdict(**(content | changes))  # type: ignore[arg-type]
