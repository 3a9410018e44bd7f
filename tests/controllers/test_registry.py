"""A controller is one module: found, offered to scenarios and run without a further edit."""

import sys

import numpy as np
import pytest

from uictest.controllers import CONTROLLERS, built_in, contract
from uictest.core.physics import VENT
from uictest.plans.scenario import ScenarioErrors, load
from uictest.plans.scenario.parts.controller import CONTROLLER_MODELS, _model
from uictest.rig import assemble
from uictest.rig.model import controller as choice
from uictest.rig.model.train import run_train
from uictest.rig.train_stop import run_to_end

MODULE = '''
from uictest.controllers import ControlledWheelset, Controller, ControllerParameters, TrainMemory
from uictest.controllers.contract import share
from uictest.core.physics import VENT


class Parameters(ControllerParameters):
    """Vent whatever happens."""

    lower_slide: float = share("Not used.")


def begin(train, wheelsets, speed):
    train.reference_speed = speed


def decide(train, wheelsets, parameters):
    for i in range(4):
        wheelsets[i].valve_command = VENT


CONTROLLER = Controller("always-vents", Parameters, TrainMemory, ControlledWheelset, begin, decide)
'''
STOP = "schema: uictest/scenario/1\nname: stop\ninitial_speed: 20 km/h\n"


def test_a_module_in_the_folder_is_a_controller(tmp_path, monkeypatch):
    (tmp_path / "always_vents.py").write_text(MODULE)
    (tmp_path / "stop.yaml").write_text(STOP)
    monkeypatch.setattr(built_in, "__path__", [*built_in.__path__, str(tmp_path)])
    controller = contract._built_in()["always-vents"]
    monkeypatch.delitem(sys.modules, "uictest.controllers.built_in.always_vents")
    model = _model(controller)
    assert model.__name__ == "AlwaysVentsController"
    assert {
        "cycle_time",
        "reference_deceleration",
        "minimum_speed",
        "lower_slide",
    } <= model.model_fields.keys()
    inputs = assemble(load([tmp_path / "stop.yaml"])[0])
    inputs.parameters.cycles, inputs.parameters.controller = 1, len(choice.CHOICES)
    monkeypatch.setattr(choice, "CHOICES", (*choice.CHOICES, controller))
    with np.errstate(invalid="ignore"):  # no air is drawn within one cycle
        finished = run_to_end(run_train, inputs)
    assert finished.wheelsets.valve_command.tolist() == [VENT] * 4


def test_every_controller_has_a_model_that_scenarios_choose_by_its_name():
    assert CONTROLLER_MODELS.keys() == CONTROLLERS.keys()
    for name, model in CONTROLLER_MODELS.items():
        assert model.__doc__ == CONTROLLERS[name].parameters.__doc__


def test_a_conflict_shows_values_as_the_user_wrote_them(tmp_path):
    path = tmp_path / "stop.yaml"
    path.write_text(STOP + "controller: {extends: threshold, hold_limit: 9 ms}\n")
    with pytest.raises(ScenarioErrors, match="9 ms is shorter than one controller cycle \\(10 ms\\)"):
        load([path])
