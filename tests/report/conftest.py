"""Results to report on."""

from __future__ import annotations

from collections.abc import Callable, Iterator, Mapping
from dataclasses import replace
from pathlib import Path
from typing import Any

import numpy as np
import pytest

from uictest.core.measures import STOP_COLUMNS, WHEELSET_COLUMNS
from uictest.core.recording import Recording
from uictest.judging.evaluation import CaseResult, Verdict
from uictest.report import RunContent, RunManifest
from uictest.report.sweep.folder import SweepContent
from uictest.report.sweep.result import read_sweep_document
from uictest.report.traces.trace import PlotTrace, trace_of

from .chromium import emulate, requests, started, written

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
            "wheelsets": tuple(map(_wheelset, range(1, 5))),
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
        manifest = RunManifest(command=("uictest", "run"), versions={"uictest": "0.1.0"})
        return RunContent(**({"name": "a-run", "results": results, "manifest": manifest} | changes))  # type: ignore[arg-type]

    return make


@pytest.fixture
def make_sweep(tmp_path: Path) -> Callable[..., SweepContent]:
    """A finished sweep over two parameters, with whatever is to be different in its findings."""

    def make(
        worst: tuple[CaseResult, ...] = (),
        text: str = "90 %",
        traces: Mapping[str, PlotTrace] | None = None,
        **findings: object,
    ) -> SweepContent:
        (tmp_path / "sweep").mkdir(exist_ok=True)
        manifest = {"file": f"scenarios/{text}.sweep.yaml", "versions": {"uictest": "0.1.0"}, "set": [text]}
        result = replace(read_sweep_document(_document(text) | findings), worst=worst)
        return SweepContent(tmp_path / "sweep", result, manifest, traces or {})

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


@pytest.fixture(scope="session")
def chromium() -> Iterator[Any]:
    """A browser for all tests of pages in this process."""
    browser = started()
    yield browser
    browser.quit()


@pytest.fixture
def browser(chromium: Any) -> Iterator[Any]:
    """The browser, as it starts: scripts allowed, light, its window wide, its logs read."""
    chromium.execute_cdp_cmd("Emulation.setScriptExecutionDisabled", {"value": False})
    chromium.execute_cdp_cmd("Emulation.clearDeviceMetricsOverride", {})
    emulate(chromium, scheme="light")
    for log in ("browser", "performance"):
        chromium.get_log(log)
    yield chromium
    assert [entry for entry in chromium.get_log("browser") if entry["level"] in ("SEVERE", "WARNING")] == []
    assert requests(chromium) == []


@pytest.fixture
def page(
    tmp_path: Path,
    make_content: Callable[..., RunContent],
    make_result: Callable[..., CaseResult],
    make_verdict: Callable[..., Verdict],
    make_recording: Callable[..., Recording],
) -> Path:
    """A run of three cases, one of them missed, all drawn."""
    distance = make_verdict(measure="braking_distance")
    results = [
        make_result(id="dry-120"),
        make_result(id="slip-120", scenario="scenarios/slip.yaml", outcome="invalid", criteria=(distance,)),
        make_result(id="wet-80", expect="fail", outcome="fail"),
    ]
    trace = trace_of(make_recording(sliding_time="5.0"))
    traces = {result.id: trace for result in results}
    return written(tmp_path, make_content(*results, traces=traces))


def _wheelset(n: int) -> dict[str, float]:
    own = {
        "maximum_slide": 0.02 * n,
        "valve_actuations": n,
        "maximum_clamping_force_n": 25e3,
        "air_vented_nl": 1.5,
    }
    return dict.fromkeys(WHEELSET_COLUMNS, 0.0) | own


FIGURES = dict.fromkeys(STOP_COLUMNS, float("nan")) | {
    "braking_distance_m": 465.25,
    "braking_time_s": 27.5,
    "mean_deceleration_mps2": 1.195,
    "minimum_deceleration_mps2": 0.9,
    "maximum_deceleration_mps2": 1.31,
    "reservoir_minimum_bar": 7.2,
    "air_consumed_nl": 180.0,
    "energy_residual": 1e-8,
    "air_residual": 1e-12,
    "air_energy_residual": 1e-12,
}


def verdict(**changes: object) -> Verdict:
    content: dict[str, object] = {
        "id": "braking-distance",
        "layer": "validity",
        "value": 465.25,
        "unit": "m",
        "lower": 440.0,
        "upper": 490.0,
        "margin": 24.75,
        "status": "pass",
        "reason": "",
        "definition": {"low_speed_cutoff": "30 km/h"},
    }
    return Verdict(**(content | changes))  # type: ignore[arg-type]


def _document(text: str) -> dict[str, Any]:
    """What sweep.json holds of four cases, one of which missed; `text` stands wherever a user's may."""
    outcomes = {"pass": 3, "fail": 1, "invalid": 0, "error": 0, "skipped": 0}
    counts = [("80 %", 2, outcomes | {"pass": 2, "fail": 0}), (text, 1, outcomes | {"pass": 1})]
    axes = {
        "rows": {"parameter": f"brake.{text}", "values": ["80 %", text]},
        "columns": {"parameter": "rail.friction", "values": ["0.10", "0.12"]},
    }
    index = {"value": 0.5, "low": 0.4, "high": 0.6}
    flips = [{"low": text, "high": "0.11", "met_at_low": False}]
    return {
        "schema": "uictest/result/2",
        "kind": "sweep",
        "name": text,
        "title": text,
        "cases": 4,
        "met": 3,
        "outcomes": outcomes,
        "missed": [{"id": f"lost[{text}]", "outcome": "invalid", "reason": text}],
        "rates": {
            f"brake.{text}": [
                {"value": value, "cases": 2, "met": met, "outcomes": each} for value, met, each in counts
            ]
        },
        "maps": [
            {"measure": "met", **axes, "means": [[1.0, 1.0], [0.0, 1.0]]} | _cells([[1, 1], [0, 1]]),
            {"measure": "braking_distance_m", **axes, "means": [[1.5, 2.5], [None, 3.5]]}
            | _cells([[1, 1], [0, 1]]),
        ],
        "sensitivities": [
            {"measure": "met", "circumstances": {text: text}, "key": text, "first": index, "total": index}
        ],
        "frontier": {
            "parameter": text,
            "stretches": [{"circumstances": {text: text}, "flips": flips, "note": text}],
        },
        "distributions": [
            {"measure": text, "unit": text, "cases": 4, "minimum": 1.0, "mean": 2.0, "maximum": 3.0}
            | {"edges": [1.0, 2.0, 3.0], "counts": {"pass": [2, 1], "fail": [0, 1]}}
        ],
        "trends": [
            {"parameter": f"brake.{text}", "values": ["80 %", "90 %"], "measure": text, "unit": text}
            | {"cases": [2, 1], "minimum": [1.0, 4.0], "mean": [2.0, 4.0], "maximum": [3.0, 4.0]}
        ],
        "worst": [],
        "subjects": {},
        "notes": [text],
    }


def _cells(met: list[list[int]]) -> dict[str, Any]:
    return {"met": met, "cases": [[1, 1], [1, 1]]}
