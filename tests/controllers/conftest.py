"""Records that hold what the contract lets a controller see, and nothing else."""

from collections.abc import Callable
from types import ModuleType, SimpleNamespace
from typing import Any

import pytest

from uictest.controllers import slip_band, threshold
from uictest.scenario import load_part

CYCLE = 0.01


def _record(*fields: str) -> Any:
    """An object with these fields alone: reading or writing any other is an AttributeError."""
    return type("Record", (), {"__slots__": fields})()


class Bench:
    """A controller with its memory and four speed sensors."""

    def __init__(self, controller: ModuleType, parameters: Any, speed: float) -> None:
        self.controller = controller
        self.parameters = parameters
        self.car = _record(*(name for name, _ in controller.CAR_MEMORY))
        memory = [name for name, _ in controller.WHEELSET_MEMORY]
        self.wheelsets = [_record("measured_speed", "command", *memory) for _ in range(4)]
        controller.begin(self.car, self.wheelsets, speed)

    def commands(self, *speeds: float) -> list[int]:
        """Commands of one cycle in which the sensors read these speeds, m/s."""
        for wheelset, speed in zip(self.wheelsets, speeds, strict=True):
            wheelset.measured_speed = speed
        self.controller.decide(self.car, self.wheelsets, self.parameters)
        return [wheelset.command for wheelset in self.wheelsets]

    @property
    def reference(self) -> float:
        """The controller's estimate of the train's speed, m/s."""
        return float(getattr(self.car, self.controller.CAR_MEMORY[0][0]))


def _shipped(name: str) -> dict[str, Any]:
    return {key: float(value) for key, value in load_part(f"controllers/{name}") if isinstance(value, float)}


def _threshold(speed: float, **changes: float) -> Bench:
    fixed = {"cycle_time": CYCLE, "reference_deceleration": 1.8}
    return Bench(threshold, SimpleNamespace(**{**_shipped("threshold"), **fixed, **changes}), speed)


def _slip_band(speed: float) -> Bench:
    parameters = SimpleNamespace(
        cycle_time=CYCLE,
        lower_slide=0.08,
        upper_slide=0.20,
        band_reference_deceleration=1.8,
        band_minimum_speed=1.4,
    )
    return Bench(slip_band, parameters, speed)


@pytest.fixture(name="threshold_bench", scope="session")
def _threshold_bench() -> Callable[..., Bench]:
    """Build a bench with the threshold controller at a speed in m/s and changed parameters."""
    return _threshold


@pytest.fixture(name="slip_band_bench", scope="session")
def _slip_band_bench() -> Callable[..., Bench]:
    """Build a bench with the slip-band controller at a speed in m/s."""
    return _slip_band


@pytest.fixture(
    name="bench", params=[_threshold, _slip_band], ids=["threshold", "slip-band"], scope="session"
)
def _bench(request: pytest.FixtureRequest) -> Any:
    """Build a bench with either controller."""
    return request.param
