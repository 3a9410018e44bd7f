"""FMUs of any form: one library in C, described as a test wants it."""

import hashlib
import re
import subprocess
import zipfile
from functools import partial
from pathlib import Path

import fmpy
import numpy as np
import pytest
from fmpy import fmi2, fmi3

from uictest.controllers import (
    EXCHANGE,
    OUTPUTS_AT,
    Config,
    ControllerError,
    ControllerProgram,
    open_controller,
)
from uictest.controllers.adapters.instance import STEP

from ....c_compiler import c_compiler

HERE = Path(__file__).parent
HEADERS = Path(fmpy.__file__).parent / "c-code"
CYCLE_TIME = 0.01
REAL = {2: "Real", 3: "Float64"}
PARAMETERS = ("fault", "at", "threshold", "late")


def numbered(name, first, causality, kind):
    """Four variables, one for each wheelset; a name without %d is one array of four."""
    if "%d" not in name:
        return {name: (100 + first, causality, kind, 4)}
    return {name.replace("%d", str(place + 1)): (first + place, causality, kind) for place in range(4)}


class FmuMaker:
    """Writes FMUs that all have one library."""

    def __init__(self, libraries, folder):
        self.libraries = libraries
        self.folder = folder

    def __call__(self, fmi=2, listed=None, **changes):
        """Write an FMU; ``changes`` are version, token, kind, about, interface, experiment, platform."""
        platform = changes.get("platform", fmpy.platform if fmi == 2 else fmpy.platform_tuple)
        path = self.folder / f"any{len(list(self.folder.iterdir()))}.fmu"
        with zipfile.ZipFile(path, "w") as archive:
            archive.writestr("modelDescription.xml", described(fmi, listed or self.variables(fmi), **changes))
            archive.writestr(f"binaries/{platform}/any{fmpy.sharedLibraryExtension}", self.libraries[fmi])
        return path

    @staticmethod
    def variables(
        fmi=2, *, speed="wheel_speed_%d", hold="hold_%d", vent="vent_%d", real="", magnet="Boolean", **more
    ):
        """The variables of an FMU: name -> value reference, causality, type, size of an array."""
        real = real or REAL[fmi]
        return {
            **numbered(speed, 0, "input", real),
            **numbered(hold, 21, "output", magnet),
            **numbered(vent, 25, "output", magnet),
            **{name: (31 + place, "parameter", REAL[fmi]) for place, name in enumerate(PARAMETERS)},
            **more,
        }


def described(fmi, listed, **changes):
    """The model description of an FMU."""
    token = "guid" if fmi == 2 else "instantiationToken"
    version, value = changes.get("version", f"{fmi}.0"), changes.get("token", "right")
    head = f'fmiVersion="{version}" modelName="any" {token}="{value}" {changes.get("about", "")}'
    kind, interface = changes.get("kind", "CoSimulation"), changes.get("interface", "")
    entries = "".join(entry(fmi, name, *each) for name, each in listed.items())
    return (
        f'<fmiModelDescription {head}><{kind} modelIdentifier="any" {interface}/>'
        f"{changes.get('experiment', '')}<ModelVariables>{entries}</ModelVariables><ModelStructure/>"
        "</fmiModelDescription>"
    )


def entry(fmi, name, reference, causality, kind, size=1):
    """One variable of a model description."""
    variability = {"parameter": "fixed", "independent": "continuous"}.get(causality, "discrete")
    common = f'name="{name}" valueReference="{reference}" causality="{causality}" variability="{variability}"'
    if fmi == 2:
        return f"<ScalarVariable {common}><{kind}/></ScalarVariable>"
    dimension = f'<Dimension start="{size}"/>' if size > 1 else ""
    return f"<{kind} {common}>{dimension}</{kind}>"


@pytest.fixture(scope="session")
def fmu_libraries(tmp_path_factory):
    """The library of any_fmu.c for each version of FMI."""
    folder = tmp_path_factory.mktemp("any")
    return {fmi: _library(c_compiler(), folder, fmi) for fmi in (2, 3)}


def _library(compiler, folder, fmi):
    source = HERE / "any_fmu.c"
    command = [compiler, "-O1", "-fPIC", "-shared", f"-DFMI={fmi}", f"-I{HEADERS}"]
    preprocessed = subprocess.run([*command, "-E", source], check=True, capture_output=True, text=True).stdout
    kind = fmi2.FMU2Slave if fmi == 2 else fmi3.FMU3Slave
    defined = set(re.findall(rf"(fmi{fmi}\w+)\([^;{{]*\)\s*{{", preprocessed))
    rest = [name for name in dir(kind) if name.startswith(f"fmi{fmi}") and name not in defined]
    unused = folder / f"unused{fmi}.c"
    unused.write_text("".join(f"int {name}() {{ return 3; }}\n" for name in rest))
    library = folder / f"any{fmi}.so"
    subprocess.run([*command, "-o", library, source, unused, "-lm"], check=True)
    return library.read_bytes()


@pytest.fixture
def make_fmu(fmu_libraries, tmp_path):
    """Write an FMU that is described as the test wants it."""
    return FmuMaker(fmu_libraries, tmp_path)


def opened_program(path, sha256, **options):
    parameters, cycle_time = options.pop("parameters", {}), options.pop("cycle_time", CYCLE_TIME)
    program = ControllerProgram("fmu", str(path), sha256, options=options)
    return open_controller(program, Config(4, cycle_time, 20.0, (0.46,) * 4, parameters))


@pytest.fixture
def open_program():
    """Open an FMU that was read with a SHA-256."""
    return opened_program


@pytest.fixture
def open_fmu():
    """Open an FMU with parameters and names of its variables."""

    def opened(path, parameters=None, **names):
        digest = hashlib.sha256(path.read_bytes()).hexdigest()
        return opened_program(path, digest, parameters=parameters or {}, variables=names)

    return opened


@pytest.fixture
def ask():
    """Ask a controller for its answer to four speeds; a failure is a ControllerError."""

    def asked(instance, *speeds, cycle=0, **more):
        exchange = np.zeros(1, EXCHANGE)[0]
        exchange["cycle"], exchange["time"], exchange["wheel_speed"] = cycle, cycle * CYCLE_TIME, speeds
        exchange["speed_valid"] = 1
        for name, value in more.items():
            exchange[name] = value
        address = exchange.__array_interface__["data"][0]
        if STEP(instance.step_address)(instance.handle, address, address + OUTPUTS_AT):
            raise ControllerError(instance.last_error())
        return exchange

    return asked


@pytest.fixture
def started(open_fmu, ask):
    """Open an FMU and reset it; what is returned asks it."""

    def begun(path, parameters=None, **names):
        instance = open_fmu(path, parameters, **names)
        instance.reset()
        return partial(ask, instance)

    return begun
