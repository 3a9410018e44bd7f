"""Stops, wheelsets, criteria and scenarios to judge, each with a sound default and what a test changes."""

from collections.abc import Callable
from importlib import resources
from pathlib import Path
from types import SimpleNamespace
from typing import Any

import numpy as np
import pytest
import yaml
from hypothesis import settings

from uictest.measures.records import STOP_MEASURES, WHEELSET_MEASURES
from uictest.scenario.parts.criteria import Criteria, Criterion
from uictest.scenario.parts.measures import MeasureDefinitions

# How long an example takes says nothing about it on a machine that others use as well.
settings.register_profile("untimed", deadline=None)
settings.load_profile("untimed")

KMH = 1 / 3.6
G = 9.80665


def _record(dtype: np.dtype, fields: dict[str, Any]) -> Any:
    records = np.zeros(1, dtype=dtype).view(np.recarray)
    for name, value in fields.items():
        records[name][0] = value
    return records[0]


def _stop(**changes: Any) -> Any:
    """A sound dry stop from 120 km/h within 465 m, in which no wheelset slid."""
    sound = {
        "initial_speed": 120 * KMH,
        "stopped": 1.0,
        "braking_time": 28.0,
        "braking_distance": 465.0,
        "end_time": 28.0,
        "end_distance": 465.0,
        "minimum_deceleration": 1.1,
        "maximum_deceleration": 1.4,
        "sliding_time": np.nan,
        "speed_after_sliding": np.nan,
        "reservoir_minimum_pressure": 7.2e5,
        "air_consumed": 0.1185,
        "energy_residual": 2e-6,
        "air_residual": -3e-14,
    }
    return _record(STOP_MEASURES, {**sound, **changes})


def _sliding_stop(deceleration: float = 0.07 * G, **changes: Any) -> Any:
    """A stop in which a wheelset slides after a second, from when on the train decelerates evenly (m/s2)."""
    speed = 33.0 - deceleration * np.arange(11.0)
    return _stop(**{"sliding_time": 1.0, "speed_after_sliding": speed, **changes})


def _wheelsets(*slides: float, **changes: Any) -> Any:
    """One wheelset per slide (the same above every train speed)."""
    records = np.zeros(len(slides), dtype=WHEELSET_MEASURES).view(np.recarray)
    for record, slide in zip(records, slides, strict=True):
        record.maximum_slide = slide
        record.maximum_slide_above[:] = slide
    for name, value in changes.items():
        records[name] = value
    return records


def _criterion(measure: str = "braking_distance", **fields: Any) -> Criterion:
    return Criterion.model_validate({"id": "tested", "layer": "validity", "measure": measure, **fields})


def _profile(*criteria: Criterion) -> Criteria:
    return Criteria(name="tested", criteria=criteria)


def _written(name: str, folder: str = "criteria") -> Any:
    file = resources.files("uictest.library") / folder / f"{name}.yaml"
    return yaml.safe_load(file.read_text("utf-8"))


def _shipped(name: str) -> Criteria:
    return Criteria.model_validate(_written(name))


def _scenario(*profiles: Criteria, condition: str = "dry", **changes: Any) -> Any:
    settings = {
        "wsp": "active",
        "position": "R",
        "command": 1.0,
        "gradient": 0.0,
        "expect": "pass",
        **changes,
    }
    return SimpleNamespace(
        rail=SimpleNamespace(condition=SimpleNamespace(name=condition), gradient=settings["gradient"]),
        rig=SimpleNamespace(wsp=settings["wsp"], topology="one-caliper"),
        brake=SimpleNamespace(position=settings["position"], command=settings["command"]),
        simulation=SimpleNamespace(maximum_duration=SimpleNamespace(text="60 s")),
        criteria=profiles,
        measures=MeasureDefinitions.model_validate(_written("standard", "measures")),
        expect=settings["expect"],
    )


def _case(scenario: Any) -> Any:
    return SimpleNamespace(
        id="slip-120[friction=0.10]",
        scenario=scenario,
        path=Path("scenarios") / "slip-120.yaml",
        parameters={"rail.friction": "0.10"},
    )


@pytest.fixture(scope="session")
def stop() -> Callable[..., Any]:
    return _stop


@pytest.fixture(scope="session")
def sliding_stop() -> Callable[..., Any]:
    return _sliding_stop


@pytest.fixture(scope="session")
def wheelsets() -> Callable[..., Any]:
    return _wheelsets


@pytest.fixture(scope="session")
def criterion() -> Callable[..., Criterion]:
    return _criterion


@pytest.fixture(scope="session")
def profile() -> Callable[..., Criteria]:
    return _profile


@pytest.fixture(scope="session")
def shipped() -> Callable[[str], Criteria]:
    return _shipped


@pytest.fixture(scope="session")
def written() -> Callable[[str], Any]:
    return _written


@pytest.fixture(scope="session")
def scenario() -> Callable[..., Any]:
    return _scenario


@pytest.fixture(scope="session")
def case() -> Callable[[Any], Any]:
    return _case
