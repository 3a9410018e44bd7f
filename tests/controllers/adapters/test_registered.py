"""Controllers of installed packages: a class."""

import json
import sys
from dataclasses import replace

import numpy as np
import pytest

from uictest import rig
from uictest.controllers import (
    Config,
    ControllerError,
    ControllerProgram,
    installed_version,
    open_controller,
)
from uictest.controllers.adapters import registered
from uictest.plans.scenario import ScenarioErrors, load, load_controller, with_parameters
from uictest.selftest.conformance.situations import anything

ENTRY_POINTS = """\
acme-class = acme_wsp.in_python:Acme
acme-broken = acme_wsp.broken:Anything
acme-declares = acme_wsp.declares:Acme
acme-number = acme_wsp.in_python:NUMBER
"""
PARAMETERS = 'PARAMETERS = {"gain": {"default": 2.0, "unit": "1"}}\n'
IN_PYTHON = """
from uictest.controllers import Outputs

NUMBER = 7


class Acme:
    def __init__(self, config):
        self.gain = config.parameters.get("gain", 0.0)

    def reset(self):
        self.cycles = 0

    def step(self, inputs):
        self.cycles += 1
        return Outputs(hold=[0] * 4, vent=[0] * 4, reference_speed=self.gain * self.cycles)
"""


@pytest.fixture(scope="module")
def _site(tmp_path_factory):
    """Install the package acme-wsp 2.1.0."""
    site = tmp_path_factory.mktemp("site")
    modules = site / "acme_wsp"
    modules.mkdir()
    describe(site / "acme_wsp-2.1.0.dist-info", "acme-wsp", ENTRY_POINTS)
    texts = {"__init__": "", "in_python": IN_PYTHON, "broken": "import no_such_module\n"}
    texts |= {"declares": IN_PYTHON + PARAMETERS}
    for name, text in texts.items():
        (modules / f"{name}.py").write_text(text, "utf-8")
    registered._loaded.cache_clear()
    yield site
    registered._loaded.cache_clear()


@pytest.fixture(autouse=True)
def _package(_site, monkeypatch):
    """Begin with the package on the path and none of its modules imported."""
    monkeypatch.syspath_prepend(str(_site))
    monkeypatch.setenv("PYTHONPATH", str(_site))
    yield
    for name in [name for name in sys.modules if name.partition(".")[0] == "acme_wsp"]:
        del sys.modules[name]


def describe(metadata, package, entry_points):
    metadata.mkdir(parents=True)
    version = metadata.name.removesuffix(".dist-info").partition("-")[2]
    text = f"Metadata-Version: 2.1\nName: {package}\nVersion: {version}\n"
    (metadata / "METADATA").write_text(text, "utf-8")
    (metadata / "entry_points.txt").write_text(f"[uictest.controllers]\n{entry_points}", "utf-8")


def test_its_part_has_name_and_version_of_the_package_which_is_not_imported():
    part = load_controller("acme-broken")
    assert (part.version, "acme_wsp" in sys.modules) == ("acme-wsp 2.1.0", False)
    assert opened("acme-class").version == load_controller("acme-class").version


def test_parameters_of_a_class_are_read_from_its_module_which_is_not_imported():
    part = load_controller("acme-declares")
    assert part.parameters == {"gain": 2.0}
    with pytest.raises(ScenarioErrors, match="did you mean gain"):
        with_parameters(part, {"gian": 1.0})
    assert "acme_wsp" not in sys.modules


def test_a_class_that_declares_nothing_takes_no_parameters_once_it_runs():
    program = ControllerProgram("registered", "acme-class", "", '{"gian": 1.0}', {"parameters": "asked"})
    config = Config(4, 0.01, 30.0, (0.46,) * 4, {"gian": 1.0})
    with pytest.raises(ControllerError, match=r"controller.parameters.gian: .*free_parameters: true"):
        open_controller(program, config)
    assert open_controller(replace(program, options={"parameters": "free"}), config)


def test_a_name_that_nobody_or_two_packages_registered_has_no_version(tmp_path, monkeypatch):
    assert installed_version("no-such") == ""
    describe(tmp_path / "other_wsp-1.0.dist-info", "other-wsp", "acme-class = other:Acme\n")
    monkeypatch.syspath_prepend(str(tmp_path))
    assert installed_version("acme-class") == ""
    assert installed_version("acme-number") == "acme-wsp 2.1.0"


def opened(name, **parameters):
    config = Config(4, 0.01, 30.0, (0.46,) * 4, parameters)
    return open_controller(ControllerProgram("registered", name, parameters=json.dumps(parameters)), config)


def stop(folder, controller):
    (folder / "stop.yaml").write_text(
        "schema: uictest/scenario/1\nname: stop\ninitial_speed: 60 km/h\n"
        f"rail: {{condition: wet, friction: 0.08}}\ncontroller: {controller}\n",
        "utf-8",
    )
    return load([folder / "stop.yaml"])[0]


def test_a_class_is_created_with_its_parameters():
    instance = opened("acme-class", gain=2.0)
    assert instance.version == "acme-wsp 2.1.0"
    instance.reset()
    outputs = rig.drive(instance, anything(0.01, 3).inputs, 0.01, rig.empty_exchange()).outputs
    assert outputs["reference_speed"].tolist() == [2.0, 4.0, 6.0]
    assert np.all(outputs["vent"] == 0)


def test_a_name_outside_the_library_is_that_of_a_package_which_is_not_imported(tmp_path):
    case = stop(tmp_path, "acme-class")
    assert case.scenario.controller.program.kind == "registered"
    assert case.scenario.controller.program.location == "acme-class"
    assert case.scenario.controller.version == "acme-wsp 2.1.0"
    case = stop(tmp_path, "{extends: acme-class, parameters: {gain: 3}}")
    assert json.loads(case.scenario.controller.program.parameters) == {"gain": 3}
    assert not [name for name in sys.modules if name.startswith("acme_wsp")]


def test_an_unknown_name_gets_a_hint_with_the_registered_ones(tmp_path):
    with pytest.raises(ScenarioErrors, match="did you mean 'acme-class'"):
        stop(tmp_path, "acme-clas")


@pytest.mark.parametrize(
    ("name", "message"),
    [
        ("acme-broken", "acme-broken of acme-wsp 2.1.0 cannot be imported: ModuleNotFoundError"),
        ("acme-number", "entry point acme-number of acme-wsp 2.1.0 is of type int; register a class$"),
        ("nobody", "no installed package has registered 'nobody'; registered: acme-broken, acme-class"),
    ],
)
def test_what_cannot_be_opened_says_why(name, message):
    with pytest.raises(ControllerError, match=message):
        opened(name)
