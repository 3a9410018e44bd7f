"""The rig for tests: cases, stops and traces from the library's defaults and what a test changes.

Nothing here depends on the values of the defaults beyond that they are those of a sensible car.
"""

from collections.abc import Callable
from functools import cache
from pathlib import Path
from types import SimpleNamespace
from typing import Any

import numpy as np
import pytest
from numpy.typing import NDArray

from uictest.controllers import CONTROLLERS, DEFAULT
from uictest.rig.assembly import StopInputs, assemble
from uictest.rig.backends.compiled import translate
from uictest.rig.backends.finished_stop import FinishedStop, run_to_end
from uictest.rig.backends.native import compiled_stop
from uictest.rig.model.controller import begin
from uictest.rig.model.start import start
from uictest.rig.model.state import BOGIE, CAR, WHEELSET
from uictest.rig.model.trace import CAR_CHANNELS, WHEELSET_CHANNELS
from uictest.scenario import Case, load

Array = NDArray[np.float64]


class Rig:
    """Cases of one scenario, changed by ``key=value`` overrides and by fields of the parameter record."""

    def __init__(self, path: Path) -> None:
        self.path = path
        self.stop = cache(self._stop)

    def case(self, *overrides: str) -> Case:
        return load([self.path], list(overrides))[0]

    def parameters(self, *overrides: str, **fields: float) -> tuple[Any, Array]:
        parameters, rail, _ = assemble(self.case(*overrides))
        for name, value in fields.items():
            parameters[name] = value
        return parameters, rail

    def inputs(self, *overrides: str, **fields: float) -> StopInputs:
        """What the rig is given, with the controller that the overrides choose."""
        return StopInputs(*self.parameters(*overrides, **fields), assemble(self.case(*overrides)).controller)

    def _stop(self, *overrides: str, every: int = 0, **fields: float) -> FinishedStop:
        """Run a stop on the compiled rig; ``every`` is the number of steps between two samples."""
        inputs = self.inputs(*overrides, **fields)
        return run_to_end(compiled_stop(inputs.controller), inputs, every)

    def columns(self, *overrides: str, every: int = 20, **fields: float) -> dict[str, Array]:
        """Trace of a stop by channel; a wheelset's channel has a column for each of the four."""
        trace = self.stop(*overrides, every=every, **fields).trace
        columns = {name: trace.train[name] for name, _ in CAR_CHANNELS}
        return columns | {name: trace.wheelsets[name] for name, _ in WHEELSET_CHANNELS}


class Bench:
    """A rig at the instant of the brake command, in plain numbers: quick to step in plain Python."""

    def __init__(self, parameters: Any) -> None:
        self.p = SimpleNamespace(**{name: parameters[name].item() for name in parameters.dtype.names})
        self.car = self._blank(CAR)
        self.bogies = [self._blank(BOGIE) for _ in range(2)]
        self.wheelsets = [self._blank(WHEELSET) for _ in range(4)]
        begin_stop = translate(start, lambda function: function, {begin: CONTROLLERS[DEFAULT].begin})
        begin_stop(self.car, self.bogies, self.wheelsets, self.p)

    @staticmethod
    def _blank(layout: np.dtype[Any]) -> SimpleNamespace:
        kinds = {name: field[0].kind for name, field in (layout.fields or {}).items()}
        return SimpleNamespace(**{name: 0 if kind == "i" else 0.0 for name, kind in kinds.items()})


@pytest.fixture(name="rig", scope="session")
def _rig(tmp_path_factory: pytest.TempPathFactory) -> Rig:
    path = tmp_path_factory.mktemp("rig") / "rig.yaml"
    path.write_text("schema: uictest/scenario/1\nname: rig\ninitial_speed: 80 km/h\n")
    return Rig(path)


@pytest.fixture(name="bench", scope="session")
def _bench() -> Callable[[Any], Bench]:
    """Set up a rig in plain numbers from a parameter record."""
    return Bench


@pytest.fixture(name="scenarios", scope="session")
def _scenarios() -> list[Case]:
    """Every shipped case."""
    return load([Path(__file__).parents[2] / "scenarios"])
