"""Runs and recordings to compare."""

from __future__ import annotations

import dataclasses
from collections.abc import Callable, Mapping
from typing import Any

import numpy as np
import pytest

from uictest.core.measures import STOP_COLUMNS, WHEELSET_COLUMNS
from uictest.core.recording import Recording
from uictest.judging.evaluation import CaseResult, RepeatedStop, Repeats, Verdict
from uictest.report import CaseDescription, RunContent, RunManifest

FIGURES = dict.fromkeys(STOP_COLUMNS, float("nan")) | {
    "braking_distance_m": 465.0,
    "braking_time_s": 27.5,
    "mean_deceleration_mps2": 1.195,
    "minimum_deceleration_mps2": 0.9,
    "maximum_deceleration_mps2": 1.31,
    "reservoir_minimum_bar": 7.2,
    "air_consumed_nl": 180.0,
    "energy_residual": 1e-9,
    "air_residual": 1e-12,
    "air_energy_residual": 1e-12,
}
WHEELSET = {
    "maximum_slide": 0.02,
    "valve_actuations": 11,
    "maximum_clamping_force_n": 25e3,
    "air_vented_nl": 1.5,
}
VERDICT = Verdict("braking-distance", "validity", 465.0, "m", 440.0, 490.0, 25.0, "pass", "")


@pytest.fixture
def make_run() -> Callable[..., RunContent]:
    """A run of one case, its figures changed as asked."""

    def make(
        name: str = "run",
        case_id: str = "dry-120",
        outcome: str = "pass",
        verdict: str = "pass",
        friction: str = "0.3",
        **figures: float,
    ) -> RunContent:
        wheelset = dict.fromkeys(WHEELSET_COLUMNS, 0.0) | WHEELSET
        result = CaseResult(
            id=case_id,
            scenario="dry.yaml",
            parameters={},
            expect="pass",
            outcome=outcome,  # type: ignore[arg-type]
            criteria=(dataclasses.replace(VERDICT, status=verdict),),  # type: ignore[arg-type]
            measures=FIGURES | figures,
            wheelsets=(wheelset, wheelset),
        )
        manifest = RunManifest(seed=0, versions={"numba": "0.68.1"}, inputs={"dry.yaml": "a" * 64})
        subject = CaseDescription("", (), {"friction": friction})
        return RunContent(name, [result], manifest, subjects={case_id: subject})

    return make


@pytest.fixture
def make_recording() -> Callable[..., Recording]:
    """Ten seconds of braking; channels given replace those there are."""

    def make(interval: float = 0.1, end: float = 10.0, **channels: np.ndarray) -> Recording:
        time = np.arange(0.0, end + interval / 2, interval)
        own = {"time": time, "speed": 30.0 - time, "slide_1": np.sin(time)}
        units = {"time": "s", "speed": "m/s", "slide_1": "1"}
        return Recording({**own, **channels}, {**units, **{n: units.get(n, "1") for n in channels}}, {})

    return make


@pytest.fixture
def make_repeated() -> Callable[..., CaseResult]:
    """A case that was repeated under these seeds: the braking distance (m) of each stop."""

    def make(
        distances: Mapping[int, float],
        case_id: str = "slip",
        noise_key: str = "00c0ffee",
        **changes: Any,
    ) -> CaseResult:
        wheelset = dict.fromkeys(WHEELSET_COLUMNS, 0.0) | WHEELSET
        stops = tuple(
            RepeatedStop(
                seed, "pass", "", (), FIGURES | {"braking_distance_m": distance}, (wheelset, wheelset)
            )
            for seed, distance in distances.items()
        )
        result = CaseResult(case_id, "slip.yaml", {}, "pass", "pass", noise_key=noise_key)
        repeats = Repeats("all", stops)
        medians = stops[0].measures, stops[0].wheelsets
        return dataclasses.replace(
            result, measures=medians[0], wheelsets=medians[1], repeats=repeats, **changes
        )

    return make
