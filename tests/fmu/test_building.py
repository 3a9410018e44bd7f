"""The file of an FMU: valid, the same every time, and without anything of the machine that built it."""

import io
import json
import re
import shutil
import struct
import subprocess
import sys
import uuid
import zipfile
from pathlib import Path
from xml.etree import ElementTree

import pytest

from uictest import __version__
from uictest.api import fmu
from uictest.plans.scenario import load

fmpy = pytest.importorskip("fmpy", reason="the extra fmu is not installed")
VERSIONS = pytest.mark.parametrize("version", [2, 3])


@VERSIONS
def test_the_description_is_valid_and_says_what_other_tools_must_know(build, case, version):
    from fmpy.validation import validate_fmu

    assert validate_fmu(str(build(version))) == []
    assert fmu.build_fmu(case, version) == build(version).read_bytes()
    described = fmpy.read_model_description(str(build(version)))
    simulation, variables = described.coSimulation, described.modelVariables
    assert not simulation.canHandleVariableCommunicationStepSize
    assert not simulation.canBeInstantiatedOnlyOncePerProcess
    assert described.defaultExperiment.stepSize == "0.01"
    longest = float(case.scenario.simulation.maximum_duration)
    assert float(described.defaultExperiment.stopTime) == pytest.approx(longest)
    quantities = {"speed": "m/s", "pressure": "Pa", "distance": "m", "time": "s", "load": "N", "force": "N"}
    quantities["torque"] = "N.m"
    for variable in variables:
        quantity = variable.name.rstrip("_1234").rpartition("_")[2]
        assert variable.unit == quantities.get(quantity), variable.name
    units = {each.name: each.unit for each in variables}
    assert (units["wheel_speed_1"], units["cylinder_pressure_4"], units["distance"]) == ("m/s", "Pa", "m")
    inputs = {each.name: each.type for each in variables if each.causality == "input"}
    assert inputs == {f"{magnet}_{i}": "Boolean" for magnet in ("hold", "vent") for i in (1, 2, 3, 4)}
    [seed] = [each for each in variables if each.causality == "parameter"]
    largest = {2: 2**31 - 1, 3: 2**32 - 1}[version]
    assert (seed.name, int(seed.start), int(seed.min), int(seed.max)) == ("seed", 5, 0, largest)
    # Without a direct way from input to output a tool finds no algebraic loop.
    assert all(unknown.dependencies == [] for unknown in described.outputs)


def described(path):
    """Return the root of the model description as it is written."""
    with zipfile.ZipFile(path) as archive:
        return ElementTree.fromstring(archive.read("modelDescription.xml"))


@VERSIONS
def test_units_are_told_in_those_of_the_si_and_in_those_that_people_read(build, version):
    """1 N = 1 kg m/s2, 1 Pa = 1 N/m2; 1 m/s = 3.6 km/h, 1 Pa = 0.00001 bar."""
    units = list(described(build(version)).iter("Unit"))
    in_si = {
        str(unit.get("name")): {base: int(power) for base, power in unit.find("BaseUnit").attrib.items()}
        for unit in units
    }
    assert in_si == {
        "s": {"s": 1},
        "m": {"m": 1},
        "m/s": {"m": 1, "s": -1},
        "N": {"kg": 1, "m": 1, "s": -2},
        "N.m": {"kg": 1, "m": 2, "s": -2},
        "Pa": {"kg": 1, "m": -1, "s": -2},
    }
    shown = {
        (unit.get("name"), display.get("name")): float(display.get("factor", "nan"))
        for unit in units
        for display in unit.iter("DisplayUnit")
    }
    assert shown == {("m/s", "km/h"): 3.6, ("Pa", "bar"): 1e-5}


@VERSIONS
def test_every_function_of_co_simulation_is_exported_and_none_of_another_name(build, version, tmp_path):
    """As FMPy's header declares them: tools look all of them up."""
    import ctypes

    header = Path(fmpy.__file__).parent / "c-code" / f"fmi{version}FunctionTypes.h"
    text = header.read_text(errors="replace")
    declared = set(re.findall(rf"\b(fmi{version}\w+?)TYPE\b", text))
    of_model_exchange = {
        *("fmi2SetTime", "fmi2SetContinuousStates", "fmi2GetDerivatives", "fmi2GetEventIndicators"),
        *("fmi2GetContinuousStates", "fmi2GetNominalsOfContinuousStates", "fmi2CompletedIntegratorStep"),
        *("fmi2EnterContinuousTimeMode", "fmi2NewDiscreteStates", "fmi2EnterEventMode"),
    }
    path = extracted(build(version), tmp_path)
    library = ctypes.CDLL(str(path))
    missing = {name for name in declared if not hasattr(library, name)}
    assert len(declared) > 40
    assert missing == (of_model_exchange if version == 2 else set())
    if (tool := shutil.which("nm")) is None:
        pytest.skip("there is no nm here")
    command = [tool, "-D", "--defined-only", path]
    shown = subprocess.run(command, capture_output=True, text=True, check=True)
    names = [line.split()[-1] for line in shown.stdout.splitlines()]
    assert f"fmi{version}DoStep" in names
    assert [name for name in names if not name.startswith("fmi")] == []


def test_the_archive_is_the_same_on_every_machine(build, case):
    """Nothing of the machine is in it: no compression by its library, date, user's mode of access, folder."""
    with zipfile.ZipFile(build(2)) as archive:
        facts = {
            (each.compress_type, each.date_time, each.create_system, each.external_attr >> 16)
            for each in archive.infolist()
        }
        library = archive.read("binaries/win64/rig_stop.dll")
        content = b"".join(archive.read(name) for name in archive.namelist())
    assert facts == {(zipfile.ZIP_STORED, (1980, 1, 1, 0, 0, 0), 3, 0o644)}
    [header] = struct.unpack_from("<I", library, 0x3C)
    assert struct.unpack_from("<I", library, header + 8) == (0,)  # when it was linked
    for own in (str(Path.home()), str(Path.cwd()), str(case.path.parent), "/tmp/uictest"):
        assert own.encode() not in content
    tokens = [described(build(2)).get("guid", ""), described(build(3)).get("instantiationToken", "")]
    for token in tokens:
        assert str(uuid.UUID(token)) == token.strip("{}")
    assert tokens[0] != tokens[1]


@VERSIONS
def test_it_says_which_case_it_is(build, case, version):
    with zipfile.ZipFile(build(version)) as archive:
        page = archive.read("documentation/index.html").decode()
        facts = json.loads(archive.read("resources/case.json"))
    assert facts["case"] == "stop"
    assert facts["uictest"] == __version__
    assert sorted(facts["inputs"].values()) == sorted(case.inputs.values())
    assert "stop.yaml" in facts["inputs"]
    for text in ("A &lt;short&gt; stop", __version__, *case.inputs.values(), "0.05", "hold_1"):
        assert text in page


def test_an_fmu_refuses_the_description_of_another(build):
    token = fmpy.read_model_description(str(build(2))).guid.encode()
    other = build(2).with_name("other.fmu")
    with zipfile.ZipFile(build(2)) as archive, zipfile.ZipFile(other, "w") as changed:
        for name in archive.namelist():
            content = archive.read(name)
            is_description = name == "modelDescription.xml"
            changed.writestr(name, content.replace(token, b"{0}") if is_description else content)
    with pytest.raises(Exception, match="instantiate"):
        fmpy.simulate_fmu(str(other), stop_time=0.1)


def test_a_seed_beyond_the_integers_of_fmi_2_is_refused(case):
    [other] = load([case.path], seed=2**31)
    with pytest.raises(ValueError, match=r"seed 2147483648 is above 2147483647.*--set seed="):
        fmu.build_fmu(other, 2)
    assert zipfile.is_zipfile(io.BytesIO(fmu.build_fmu(other, 3)))


WITHOUT = """\
import sys
sys.modules["ziglang"] = None
from uictest.cli import main
sys.argv = ["uictest", *sys.argv[1:]]
main()
"""


@pytest.mark.parametrize("command", ["export-rig {} -o x.fmu", "export-controller threshold -o x.fmu"])
def test_no_compiler_is_needed(case, tmp_path, command):
    """Neither is the one that builds the libraries, which are there; what is written runs."""
    arguments = [sys.executable, "-c", WITHOUT, *command.format(case.path).split()]
    environment = {"PATH": "", "HOME": str(tmp_path), "CC": "no-such-compiler"}
    done = subprocess.run(arguments, cwd=tmp_path, env=environment, capture_output=True, text=True)
    assert (done.returncode, done.stderr) == (0, "")
    file = str(tmp_path / "x.fmu")
    assert len(fmpy.simulate_fmu(file, stop_time=0.1, step_size=0.01, output_interval=0.01)) > 1


def extracted(path, folder):
    """Unpack an FMU and return its library for this system."""
    with zipfile.ZipFile(path) as archive:
        archive.extractall(folder)
        [name] = [
            name for name in archive.namelist() if re.match("binaries/(linux64|x86_64-linux)/.*so", name)
        ]
    return folder / name


SOURCE = "int answer(void) { return 42; }\n"
KINDS = {"linux-x86_64": (b"\x7fELF", 18, 0x3E), "linux-aarch64": (b"\x7fELF", 18, 0xB7)}
"""First bytes of a library, and where its header says which processor it is for."""


@pytest.fixture(name="source")
def _source(tmp_path):
    path = tmp_path / "wsp.c"
    path.write_text(SOURCE)
    return path


def test_ziglang_compiles_for_every_system(source, monkeypatch):
    monkeypatch.delenv("CC", raising=False)
    pytest.importorskip("ziglang", reason="ziglang is not installed")
    libraries = fmu.compiled([source])
    assert libraries.keys() == fmu.SYSTEMS.keys()
    for system, (magic, place, machine) in KINDS.items():
        assert libraries[system].startswith(magic)
        assert libraries[system][place] == machine
    assert libraries["windows-x86_64"].startswith(b"MZ")


@pytest.mark.parametrize("named", ["by CC", "found"])
def test_without_ziglang_a_compiler_of_the_user_compiles_for_this_system(source, monkeypatch, named):
    compiler = shutil.which("cc")
    if compiler is None:
        pytest.skip("there is no cc here")
    if named == "found":
        monkeypatch.delenv("CC", raising=False)
        monkeypatch.setitem(sys.modules, "ziglang", None)
    else:
        monkeypatch.setenv("CC", compiler)
    assert list(fmu.compiled([source])) == [fmu.this_system()]


def test_without_a_compiler_it_says_what_to_install(source, monkeypatch, tmp_path):
    monkeypatch.setenv("PATH", str(tmp_path))
    monkeypatch.delenv("CC", raising=False)
    monkeypatch.setitem(sys.modules, "ziglang", None)
    with pytest.raises(
        fmu.CannotBuildError, match=r"no C compiler \(cc or gcc or clang\): pip install ziglang"
    ):
        fmu.compiled([source])


def test_a_compiler_that_fails_says_why(source, monkeypatch, tmp_path):
    broken = tmp_path / "broken-cc"
    broken.write_text("#!/bin/sh\necho 'cannot find crti.o' >&2\nexit 1\n")
    broken.chmod(0o755)
    monkeypatch.setenv("CC", str(broken))
    with pytest.raises(RuntimeError, match=r"^cannot find crti.o$"):
        fmu.compiled([source])


def test_a_machine_that_no_fmu_is_for_exports_no_library(monkeypatch):
    monkeypatch.setattr("platform.system", lambda: "Darwin")
    monkeypatch.setattr("platform.machine", lambda: "arm64")
    with pytest.raises(fmu.CannotBuildError, match="this machine is darwin-aarch64"):
        fmu.this_system()
