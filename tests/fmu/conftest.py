"""FMUs of the rig, built once for all tests, and driven through FMPy."""

import tempfile
from functools import cache
from types import SimpleNamespace

import pytest

from uictest.api import fmu
from uictest.plans.scenario import load

fmpy = pytest.importorskip("fmpy", reason="the extra fmu is not installed")
CYCLE = 0.01


class Instance:
    """One instance of an FMU of either version, with its variables by name."""

    def __init__(self, path, start_time=0.0, **options):
        self.messages = []
        self.description = fmpy.read_model_description(str(path))
        self.version = int(self.description.fmiVersion[0])
        self.variables = {each.name: each for each in self.description.modelVariables}
        self._folder = tempfile.TemporaryDirectory()
        fmpy.extract(str(path), unzipdir=self._folder.name)
        kind = fmpy.fmi2.FMU2Slave if self.version == 2 else fmpy.fmi3.FMU3Slave
        self.fmu = kind(
            guid=self.description.guid if self.version == 2 else self.description.instantiationToken,
            unzipDirectory=self._folder.name,
            modelIdentifier=self.description.coSimulation.modelIdentifier,
            instanceName="rig",
        )
        self._logger = self._callbacks()
        self.fmu.instantiate(**self._logger)
        self.begin(start_time, **options)

    def _callbacks(self):
        if self.version == 3:
            return {"logMessage": lambda environment, status, category, text: self._heard(text)}
        callbacks = fmpy.fmi2.fmi2CallbackFunctions()
        callbacks.logger = fmpy.fmi2.fmi2CallbackLoggerTYPE(
            lambda environment, name, status, category, text: self._heard(text)
        )
        return {"callbacks": callbacks}

    def _heard(self, text):
        self.messages.append(text.decode())

    def set_parameters(self, parameters):
        for name, value in parameters.items():
            setter = self.fmu.setInteger if self.version == 2 else self.fmu.setInt64
            setter([self.variables[name].valueReference], [value])

    def begin(self, start_time=0.0, late=False, **parameters):
        """Initialize it; parameters are set before, or `late`, in the initialization itself."""
        if not late:
            self.set_parameters(parameters)
        if self.version == 2:
            self.fmu.setupExperiment(startTime=start_time)
            self.fmu.enterInitializationMode()
        else:
            self.fmu.enterInitializationMode(startTime=start_time)
        if late:
            self.set_parameters(parameters)
        self.fmu.exitInitializationMode()
        self.start_time, self.steps = start_time, 0

    def __getitem__(self, name):
        variable = self.variables[name]
        number = variable.type in ("Real", "Float64")
        real = self.fmu.getReal if self.version == 2 else self.fmu.getFloat64
        value = (real if number else self.fmu.getBoolean)([variable.valueReference])[0]
        return value if number else bool(value)

    def four(self, name):
        return [self[f"{name}_{number}"] for number in (1, 2, 3, 4)]

    def set_all(self, **values):
        """Set inputs by name: numbers and truth values."""
        for name, value in values.items():
            truth = isinstance(value, bool)
            real = self.fmu.setReal if self.version == 2 else self.fmu.setFloat64
            (self.fmu.setBoolean if truth else real)([self.variables[name].valueReference], [value])

    def step(self, hold=(0,) * 4, vent=(0,) * 4, size=CYCLE):
        names = [f"{magnet}_{number}" for magnet in ("hold", "vent") for number in (1, 2, 3, 4)]
        references = [self.variables[name].valueReference for name in names]
        self.fmu.setBoolean(references, [bool(each) for each in (*hold, *vent)])
        self.fmu.doStep(self.start_time + self.steps * CYCLE, size)
        self.steps += 1

    def run(self, controller):
        """Step the stop to its end with a controller outside, and keep every output."""
        outputs = [name for name, each in self.variables.items() if each.causality == "output"]
        history = []
        while not self["ended"]:
            self.step(*controller.magnets(self.four("wheel_speed")))
            history.append(self["train_speed"])
        return SimpleNamespace(history=history, end={name: self[name] for name in outputs})

    def close(self):
        self.fmu.terminate()
        self.fmu.freeInstance()
        self._folder.cleanup()


@pytest.fixture(name="case", scope="session")
def _case(tmp_path_factory):
    """A stop on a rail so slippery that the controller has to work."""
    path = tmp_path_factory.mktemp("scenario") / "stop.yaml"
    head = "schema: uictest/scenario/1\nname: stop\ntitle: A <short> stop\ninitial_speed: 40 km/h\n"
    path.write_text(f"{head}rail: {{condition: wet-cleaning, friction: 0.05}}\nseed: 5\n")
    return load([path])[0]


@pytest.fixture(name="build", scope="session")
def _build(tmp_path_factory, case):
    """Write the FMU of the case in a version of FMI."""

    @cache
    def build(version):
        path = tmp_path_factory.mktemp("fmu") / f"rig{version}.fmu"
        path.write_bytes(fmu.build_fmu(case, version))
        return path

    return build


@pytest.fixture(name="instance")
def _instance(build):
    """Make instances that are freed at the end of the test."""
    made = []

    def make(version, **options):
        made.append(Instance(build(version), **options))
        return made[-1]

    yield make
    for each in made:
        each.close()
