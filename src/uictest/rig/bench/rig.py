"""The rig on the bench: one module with a caliper, one that is a tank, and one brake line for both."""

from collections.abc import MutableSequence, Sequence
from typing import Any, NamedTuple

import numpy as np

from uictest.plans.scenario import COMPENSATION_SETTINGS, Case
from uictest.rig.assembly import assemble
from uictest.rig.bench.inputs import Clock
from uictest.rig.model.parameters import PARAMETERS, Parameters
from uictest.rig.model.state import CAR, WHEELSET, Car, Wheelset
from uictest.rig.model.wheelset_parameters import WheelsetParameters

SETTINGS = tuple(COMPENSATION_SETTINGS)
"""Settings of the compensation, in the order of the records that compute them."""
NONE, HYSTERESIS, CYLINDER, FULL, THERMAL = range(len(SETTINGS))
MODULES = 2
LOADCELLS = 3


class BenchRig(NamedTuple):
    """Records of the rig on the bench.

    Attributes:
        car: record whose air supply feeds the modules.
        modules: with caliper, and without.
        computed: a module for each setting, which computes the force of the second module under it.
        settings: as many parameter records that differ in the setting of the compensation alone.
        wheelset_parameters: those of wheelset 1, whose module is on the bench.
        loadcell_errors: momentary errors of the three loadcells, N.
    """

    car: Car
    modules: Sequence[Wheelset]
    computed: Sequence[Wheelset]
    settings: Sequence[Parameters]
    wheelset_parameters: WheelsetParameters
    loadcell_errors: MutableSequence[float]


def clock_of(case: Case) -> Clock:
    """Return the base step and the controller cycle of a case."""
    step = float(case.scenario.simulation.time_step)
    return Clock(step, round(float(case.scenario.controller.cycle_time) / step))


def bench_rig(case: Case) -> BenchRig:
    """Return the rig of a case, its state zeroed."""
    inputs = assemble(case)
    car: Any = np.zeros(1, CAR)[0]
    modules: Any = np.zeros(MODULES, WHEELSET)
    computed: Any = np.zeros(len(SETTINGS), WHEELSET)
    loadcell_errors: Any = np.zeros(LOADCELLS)
    own = inputs.wheelset_parameters[0]
    return BenchRig(car, modules, computed, _settings(inputs.parameters), own, loadcell_errors)


def _settings(parameters: Any) -> Any:
    """Return the parameters once for each setting of the compensation; the valves obey the commands."""
    settings: Any = np.zeros(len(SETTINGS), PARAMETERS)
    settings[:] = parameters
    settings["wsp_active"] = 1
    uses = COMPENSATION_SETTINGS.values()
    settings["uses_hysteresis"] = [setting.hysteresis for setting in uses]
    settings["uses_cylinder_dynamics"] = [setting.pressure == "filter" for setting in uses]
    settings["uses_module_air"] = [setting.pressure == "air" for setting in uses]
    return settings
