"""What every test of the package shares."""

import os
from collections.abc import Callable, Sequence
from pathlib import Path
from types import SimpleNamespace

import pytest
from hypothesis import settings

from uictest import rig, scenario
from uictest.controllers import CONTROLLERS
from uictest.physics import FILL, VENT
from uictest.record import fields_of

_LONGEST = (
    "rig/backends/test_lanes.py",
    "sweeps/running/test_judging.py",
    "docs/test_examples.py",
    "rig_fmu/test_stop.py",
    "fitting/test_cleaning.py",
    "fitting/test_one_slide.py",
    "rig/backends/test_compiled.py",
    "cli/commands/test_sweep.py",
    "cli/commands/test_controller.py",
)
"""Files that take longest. They begin first, lest one process works on them while the others are done."""

# How long an example takes says nothing about it on a machine that others use as well.
settings.register_profile("same", deadline=None, derandomize=True)
settings.register_profile("search", deadline=None, max_examples=1000)
# The suite tries the same examples everywhere, so that no run fails by chance; HYPOTHESIS_PROFILE=search
# tries others.
settings.load_profile(os.environ.get("HYPOTHESIS_PROFILE", "same"))


def pytest_collection_modifyitems(items: list[pytest.Item]) -> None:
    """Put the tests of the files that take longest first."""
    tests = Path(__file__).parent
    places = {tests / name: place for place, name in enumerate(_LONGEST)}
    items.sort(key=lambda item: places.get(item.path, len(places)))


class ControllerOutside:
    """The built-in controller of a case on records of its own, that only sees what a sensor shows."""

    def __init__(self, case: scenario.Case) -> None:
        inputs = rig.assemble(case)
        names = inputs.parameters.dtype.names
        self.parameters = SimpleNamespace(**{name: inputs.parameters[name].tolist() for name in names})
        self.controller = CONTROLLERS[case.scenario.controller.algorithm]
        self.train = SimpleNamespace()
        memory = fields_of(self.controller.wheelset_memory)
        self.wheelsets = [SimpleNamespace(**dict.fromkeys(memory, 0.0)) for _ in range(4)]
        self.controller.begin(self.train, self.wheelsets, self.parameters.initial_speed)

    def magnets(self, wheel_speeds: Sequence[float]) -> tuple[list[int], list[int]]:
        """Return the state of the holding and of the venting magnets for one cycle."""
        for wheelset, speed in zip(self.wheelsets, wheel_speeds, strict=True):
            wheelset.measured_speed, wheelset.speed_valid = speed, 1
        self.controller.decide(self.train, self.wheelsets, self.parameters)
        commands = [wheelset.valve_command for wheelset in self.wheelsets]
        return [int(each != FILL) for each in commands], [int(each == VENT) for each in commands]

    @property
    def reference_speed(self) -> float:
        """Its estimate of the train's speed, m/s."""
        return float(self.train.reference_speed)


@pytest.fixture(name="controller_outside", scope="session")
def _controller_outside() -> Callable[[scenario.Case], ControllerOutside]:
    """Put the controller of a case outside the rig."""
    return ControllerOutside
