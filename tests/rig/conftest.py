"""The rig for tests: cases, stops and traces from the library's defaults and what a test changes.

Nothing here depends on the values of the defaults beyond that they are those of a sensible car.
"""

from functools import cache
from pathlib import Path
from types import SimpleNamespace

import numpy as np
import pytest
from numpy.typing import NDArray

from uictest.controllers import CONTROLLERS
from uictest.core.record import layout_of
from uictest.judging.evaluation import evaluate_simulated
from uictest.plans.scenario import load
from uictest.rig.assembly import assemble
from uictest.rig.model.parameters import WHEELSET_PARAMETERS, Parameters, WheelsetParameters
from uictest.rig.model.state import BOGIE, CAR, WHEELSET
from uictest.rig.model.stop import start
from uictest.rig.model.trace import CAR_CHANNELS, WHEELSET_CHANNELS
from uictest.rig.simulation import simulate
from uictest.rig.train_stop import compiled_rig, run_to_end

Array = NDArray[np.float64]


def controller_in_c(step):
    """Source of a controller of contract version 2 with these statements as its step."""
    return f"""\
#define UICTEST_ABI_VERSION 2
#include "uictest_controller.h"
uint32_t uictest_abi_version(void) {{ return UICTEST_ABI_VERSION; }}
void *uictest_create(const uictest_config *config) {{ (void)config; static int any; return &any; }}
int32_t uictest_reset(void *controller) {{ (void)controller; return 0; }}
int32_t uictest_step(void *controller, const uictest_inputs *inputs, uictest_outputs *outputs)
{{
    (void)controller;
    {step}
    return 0;
}}
void uictest_destroy(void *controller) {{ (void)controller; }}
const char *uictest_last_error(void *controller) {{ (void)controller; return ""; }}
"""


class EveryParameter(Parameters, WheelsetParameters):
    """The parameters of a rig whose wheelsets are alike."""


class Rig:
    """Cases of one scenario, changed by ``key=value`` overrides and by fields of the parameter record."""

    def __init__(self, path):
        self.path = path
        self.stop = cache(self._stop)

    def case(self, *overrides):
        return load([self.path], list(overrides))[0]

    def parameters(self, *overrides, **fields):
        """Parameters and, beside them in one record, those of the first wheelset; and the rail."""
        inputs = self.inputs(*overrides, **fields)
        record = np.zeros(1, layout_of(EveryParameter, *(each.parameters for each in CONTROLLERS.values())))
        for source in (inputs.parameters, inputs.wheelset_parameters[0]):
            for name in source.dtype.names:
                record[name] = source[name]
        return record[0], inputs.rail

    def inputs(self, *overrides, **fields):
        """What the rig is given; fields of a wheelset are set in all four."""
        inputs = assemble(self.case(*overrides))
        for name, value in fields.items():
            own = name in WHEELSET_PARAMETERS.names
            (inputs.wheelset_parameters if own else inputs.parameters)[name] = value
        return inputs

    def _stop(self, *overrides, every=0, **fields):
        """Run a stop on the compiled rig; ``every`` is the number of steps between two samples."""
        inputs = self.inputs(*overrides, **fields)
        return run_to_end(compiled_rig(), inputs, every)

    def judged(self, *overrides):
        """Result of a simulated stop, and its criteria by id."""
        case = self.case(*overrides)
        stop = simulate(case)
        result = evaluate_simulated(case, stop.measures, stop.wheelset_measures)
        return result, {criterion.id: criterion for criterion in result.criteria}

    def columns(self, *overrides, every=20, **fields):
        """Trace of a stop by channel; a wheelset's channel has a column for each of the four."""
        trace = self.stop(*overrides, every=every, **fields).trace
        columns = {name: trace.train[name] for name, _ in CAR_CHANNELS}
        return columns | {name: trace.wheelsets[name] for name, _ in WHEELSET_CHANNELS}


class Bench:
    """A rig at the instant of the brake command, in plain numbers: quick to step in plain Python."""

    def __init__(self, parameters):
        self.p = SimpleNamespace(**{name: parameters[name].tolist() for name in parameters.dtype.names})
        self.car = self._blank(CAR)
        self.bogies = [self._blank(BOGIE) for _ in range(2)]
        self.wheelsets = [self._blank(WHEELSET) for _ in range(4)]
        start(self.car, self.bogies, self.wheelsets, self.p, [self.p] * 4)

    @staticmethod
    def _blank(layout):
        kinds = {name: field[0].kind for name, field in (layout.fields or {}).items()}
        return SimpleNamespace(**{name: 0 if kind == "i" else 0.0 for name, kind in kinds.items()})


@pytest.fixture(name="rig", scope="session")
def _rig(tmp_path_factory):
    path = tmp_path_factory.mktemp("rig") / "rig.yaml"
    path.write_text("schema: uictest/scenario/1\nname: rig\ninitial_speed: 80 km/h\n")
    return Rig(path)


@pytest.fixture(name="bench", scope="session")
def _bench():
    """Set up a rig in plain numbers from a parameter record."""
    return Bench


@pytest.fixture(name="scenarios", scope="session")
def _scenarios():
    """Every shipped case."""
    return load([Path(__file__).parents[2] / "scenarios"])
