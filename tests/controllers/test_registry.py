"""A controller is one module: found, offered to scenarios and run without a further edit."""

import json
import math
import sys

import numpy as np
import pytest
from hypothesis import given, strategies as st

from uictest.controllers import CONTROLLERS, ControllerError, built_in, contract, stated_declarations
from uictest.core.physics.air import FILL, HOLD, VENT
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


def test_scenarios_choose_a_model_by_its_name_and_a_conflict_shows_values_as_written(tmp_path):
    assert CONTROLLER_MODELS.keys() == CONTROLLERS.keys()
    for name, model in CONTROLLER_MODELS.items():
        assert model.__doc__ == CONTROLLERS[name].parameters.__doc__
    path = tmp_path / "stop.yaml"
    path.write_text(STOP + "controller: {extends: threshold, hold_limit: 9 ms}\n")
    with pytest.raises(ScenarioErrors, match="9 ms is shorter than one controller cycle \\(10 ms\\)"):
        load([path])


def test_slide_chooses_the_command_and_the_reference_sinks_where_all_slide_together(slip_band_bench):
    """What this controller cannot do: the estimate falls at its bound although the train hardly slows."""
    for slide, command in ((0.05, FILL), (0.10, HOLD), (0.19, HOLD), (0.25, VENT)):
        controller = slip_band_bench(20.0)
        assert controller.commands(20.0, 20.0, 20.0 * (1.0 - slide), 20.0) == [FILL, FILL, command, FILL]
    controller = slip_band_bench(20.0)
    for _ in range(500):
        controller.commands(0.0, 0.0, 0.0, 0.0)
    assert controller.reference == pytest.approx(20.0 - 1.8 * 5.0)


JSON = st.recursive(
    st.none() | st.booleans() | st.floats() | st.integers() | st.text(max_size=3),
    lambda inner: st.lists(inner, max_size=3) | st.dictionaries(st.sampled_from("abc"), inner, max_size=3),
)


@pytest.mark.parametrize(
    ("text", "reason"),
    [
        ("[" * 100_000 + "]" * 100_000, "nested too deeply"),
        ('{{"gain": {{"default": {}1{}}}}}'.format("[" * 100_000, "]" * 100_000), "nested too deeply"),
        ('{"gain": {"default": NaN}}', "the default of gain: nan is no finite number"),
        ('{"gain": {"default": -Infinity, "unit": "s"}}', "the default of gain: -inf is no finite number"),
        ('{"gain": {"default": 1e999}}', "the default of gain: inf is no finite number"),
        ('{"gain": {"default": [1, NaN]}}', "the default of gain: nan is no finite number"),
        ('{"gain": {"default": 1, "range": [NaN, 2]}}', "the range of gain is nan to 2"),
        ('{"gain": {"default": 1, "range": [0, NaN]}}', "the range of gain is 0 to nan"),
        ('{"gain": {"default": 1, "range": [2, 0]}}', "the range of gain is 2 to 0"),
        ('{"gain": {"range": [2, 0]}}', "the range of gain is 2 to 0"),
        ('{"gain": {"default": 3, "range": [0, 2]}}', "gain: 3 is out of range; accepted: 0 to 2"),
        ('{"gain": {"default": 1, "range": [0, 1, 2]}}', "its parameters are not of the form"),
        ('{"gain": {"default": 1, "range": "ab"}}', "its parameters are not of the form"),
        ('{"gain": {"default": 1, "rnage": [0, 1]}}', "rnage"),
    ],
)
def test_what_is_no_declaration_is_told_with_the_form_and_the_parameter(text, reason):
    with pytest.raises(ControllerError) as caught:
        stated_declarations(text)
    assert reason in str(caught.value)
    assert '{"NAME": {"default": 1.0' in str(caught.value)


def test_a_range_may_be_open_and_a_default_of_any_kind():
    text = '{"a": {"default": 1, "range": [0, Infinity]}, "b": {"default": "x"}, "c": {"default": true}}'
    stated = stated_declarations(text)
    assert [each.default for each in stated.values()] == [1, "x", True]
    assert stated["a"].range == [0, math.inf]


@given(
    st.dictionaries(
        st.text(max_size=3),
        st.fixed_dictionaries({}, optional=dict.fromkeys(("default", "unit", "range", "description"), JSON)),
    )
    | JSON
)
def test_any_json_is_read_or_refused(value):
    try:
        stated_declarations(json.dumps(value))
    except ControllerError as error:
        assert "its parameters are not of the form" in str(error)
