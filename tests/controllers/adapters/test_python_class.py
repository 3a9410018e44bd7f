"""Controllers in Python files: how a file becomes a module."""

import gc
import hashlib
import json
import sys
from dataclasses import replace
from itertools import count
from types import ModuleType

import numpy as np
import pytest

from uictest import rig
from uictest.controllers import Config, ControllerError, ControllerProgram, installed_version, open_controller
from uictest.controllers.adapters import python_class
from uictest.plans.scenario import ScenarioErrors, load, load_controller, with_parameters
from uictest.selftest.conformance.bench import anything

TEXT = """
from dataclasses import dataclass
from typing import ClassVar


@dataclass
class Wsp:
    config: object
    cycles: ClassVar[int] = 0

    def reset(self): ...
    def step(self, inputs): ...
"""


def program(path, name="Wsp"):
    path.write_text(TEXT, "utf-8")
    digest = hashlib.sha256(path.read_bytes()).hexdigest()
    return ControllerProgram("python", str(path), digest, options={"class": name})


@pytest.fixture(autouse=True)
def _forgotten(tmp_path, monkeypatch):
    """Begin without a module called wsp, and leave no module of the test behind."""
    monkeypatch.delitem(sys.modules, "wsp", raising=False)
    monkeypatch.setattr(sys, "path", list(sys.path))
    yield
    for name, module in list(sys.modules.items()):
        if str(getattr(module, "__dict__", {}).get("__file__")).startswith(str(tmp_path)):
            del sys.modules[name]


def test_a_file_takes_the_place_of_no_other_module_and_a_missing_class_is_named(tmp_path, config):
    (tmp_path / "other").mkdir()
    for path in (tmp_path / "json.py", tmp_path / "wsp.py", tmp_path / "other" / "wsp.py"):
        open_controller(program(path), config).close()
    assert sys.modules["json"] is json
    assert sys.modules["wsp"].__file__ == str(tmp_path / "wsp.py")
    with pytest.raises(ControllerError, match=r"^wsp\.py has no class 'Mine'; its classes: Wsp$"):
        open_controller(program(tmp_path / "wsp.py", "Mine"), config)


@pytest.fixture
def importing_elsewhere():
    """Let modules be imported whenever the garbage collector runs, which is at nearly every object."""
    numbers, thresholds, before = count(), gc.get_threshold(), set(sys.modules)

    def import_another(phase, info):
        name = f"imported_meanwhile_{next(numbers)}"
        sys.modules[name] = ModuleType(name)

    gc.callbacks.append(import_another)
    gc.set_threshold(1)
    yield
    gc.set_threshold(*thresholds)
    gc.callbacks.remove(import_another)
    for name in set(sys.modules) - before:
        del sys.modules[name]


@pytest.mark.usefixtures("importing_elsewhere")
def test_an_import_of_another_thread_is_no_error_of_a_controller(tmp_path, monkeypatch):
    monkeypatch.setattr(python_class, "_FOLDERS", set())
    python_class.check_imports(tmp_path / "wsp.py")
    python_class.check_imports(tmp_path / "other" / "wsp.py")


def test_looking_for_modules_imports_none(tmp_path, monkeypatch):
    class Lazy(ModuleType):
        def __getattr__(self, name):
            raise ImportError(f"{name} needs an extra")

    monkeypatch.setitem(sys.modules, "lazy_module_of_a_test", Lazy("lazy_module_of_a_test"))
    monkeypatch.setattr(python_class, "_FOLDERS", {tmp_path})
    python_class.check_imports(tmp_path / "other" / "wsp.py")


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
    python_class._registered_class.cache_clear()
    yield site
    python_class._registered_class.cache_clear()


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


def test_a_name_outside_the_library_is_that_of_a_package_which_is_not_imported(tmp_path):
    case = stop(tmp_path, "acme-class")
    assert case.scenario.controller.program.kind == "registered"
    assert case.scenario.controller.program.location == "acme-class"
    assert case.scenario.controller.version == "acme-wsp 2.1.0"
    case = stop(tmp_path, "{extends: acme-class, parameters: {gain: 3}}")
    assert json.loads(case.scenario.controller.program.parameters) == {"gain": 3}
    with pytest.raises(ScenarioErrors, match="did you mean 'acme-class'"):
        stop(tmp_path, "acme-clas")
    assert load_controller("acme-broken").version == "acme-wsp 2.1.0"
    part = load_controller("acme-declares")
    assert part.parameters == {"gain": 2.0}
    with pytest.raises(ScenarioErrors, match="did you mean gain"):
        with_parameters(part, {"gian": 1.0})
    assert not [name for name in sys.modules if name.startswith("acme_wsp")]
    assert opened("acme-class").version == load_controller("acme-class").version


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
