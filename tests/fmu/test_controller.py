"""A controller as an FMU gives the commands that it gives in process, and takes what it is given."""

import re
import shutil
import subprocess
import sys
import zipfile
from functools import cache
from pathlib import Path

import numpy as np
import pytest

from uictest import __version__, rig
from uictest.api import fmu
from uictest.controllers import ControllerError
from uictest.plans import templates
from uictest.plans.scenario import load, load_controller
from uictest.selftest import conformance
from uictest.selftest.conformance.bench import Bench

from ..stop_bits import stop_bits
from .conftest import Instance

fmpy = pytest.importorskip("fmpy", reason="the extra fmu is not installed")
VERSIONS = pytest.mark.parametrize("version", [2, 3])
STOP = """\
schema: uictest/scenario/1
name: stop
initial_speed: 40 km/h
rail: {condition: wet-cleaning, friction: 0.05}
seed: 5
"""
OWN = r"""
#include "uictest_controller.h"
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

static char reason[200] = "100 % lost";
static const char EXPECTED[] = "{\"gain\": 0.10000000000000001, \"s\\u00fc\\\"%d\": 2, \"on\": true,"
                               " \"mode\": \"so \\\"ft\\\"\"}";

uint32_t uictest_abi_version(void) { return UICTEST_ABI_VERSION; }
const char *uictest_version(void) { return "7.1"; }
const char *uictest_parameters(void)
{
    return "{\"gain\": {\"default\": 0.1, \"unit\": \"bar/s\", \"range\": [0, 2],"
           " \"description\": \"Of it\"}, \"s\\u00fc\\\"%d\": {\"default\": 2}, \"on\": {\"default\": true},"
           " \"mode\": {\"default\": \"so \\\"ft\\\"\"}, \"kept\": {}}";
}
void *uictest_create(const uictest_config *config)
{
    if (strstr(config->parameters, "\"mode\"") != NULL && strcmp(config->parameters, EXPECTED) != 0) {
        snprintf(reason, sizeof reason, "given %s", config->parameters);
        return NULL;
    }
    return malloc(1);
}
int32_t uictest_reset(void *controller) { return controller == NULL; }
int32_t uictest_step(void *controller, const uictest_inputs *inputs, uictest_outputs *outputs)
{
    (void)controller;
    outputs->diagnosis = 0xfffffff0u + (uint32_t)inputs->cycle;
    outputs->hold[3] = inputs->time == 0.01;
    return inputs->cycle == 3;
}
void uictest_destroy(void *controller) { free(controller); }
const char *uictest_last_error(void *controller) { (void)controller; return reason; }
"""
"""A controller that takes only its own defaults, each once, and fails in its fourth cycle."""


def library_of(source):
    """Compile a controller for this system; a test without a compiler is left out."""
    try:
        return fmu.compiled([source])[fmu.this_system()]
    except fmu.CannotBuildError as error:
        pytest.skip(str(error))


@pytest.fixture(autouse=True)
def temporary_folder(monkeypatch, tmp_path_factory):
    """FMUs stay unpacked until Python ends."""
    monkeypatch.setattr("tempfile.tempdir", str(tmp_path_factory.mktemp("unpacked")))


@pytest.fixture(scope="module")
def folder(tmp_path_factory):
    """What `uictest init controller --c` writes, built as it says, and a controller without a part."""
    folder = tmp_path_factory.mktemp("wsp")
    for name, text in templates.controller_files("c").items():
        (folder / name).write_text(text)
    make = shutil.which("make")
    if make is None or shutil.which("cc") is None:
        pytest.skip("there is no make or no cc here")
    subprocess.run([make, "-s"], cwd=folder, check=True)
    (folder / "own.c").write_text(OWN)
    (folder / "own.so").write_bytes(library_of(folder / "own.c"))
    return folder


@pytest.fixture(scope="module")
def exported(folder):
    """Write the FMU of a controller into the folder, once."""

    @cache
    def export(reference, version):
        there = folder / reference
        part = load_controller(str(there) if there.exists() else reference)
        path = folder / f"{Path(reference).stem}-{version}.fmu"
        path.write_bytes(fmu.build_controller_fmu(part, version).content)
        return path

    return export


@pytest.fixture
def own(exported):
    """Make instances of the controller that fails, and free them."""
    made = []

    def make(version):
        made.append(Instance(exported("own.so", version)))
        return made[-1]

    yield make
    for each in made:
        each.close()


@cache
def recorded(folder, controller):
    """Every channel of a stop, to the bit; one that has no rate of its own says what each cycle brought."""
    path = folder / "stop.yaml"
    path.write_text(f"{STOP}controller: {controller}\n")
    [case] = load([path])
    recording = rig.simulate(case, record_every=0.01, run=rig.run_in_process).recording
    assert recording is not None
    return {name: np.asarray(values).tobytes() for name, values in recording.channels.items()}


@VERSIONS
@pytest.mark.parametrize(
    ("controller", "settings"),
    [
        ("my-wsp.yaml", "{}"),
        ("my-wsp.yaml", "{parameters: {upper_slide: 0.3}, cycle_time: 20 ms}"),
        ("threshold", "{}"),
        ("slip-band", "{}"),
    ],
)
def test_a_stop_has_the_bits_of_the_controller_in_process(folder, exported, controller, settings, version):
    """The FMU is named without `variables`: all of them have the names that a scenario looks for."""
    others = settings[1:-1]
    there = recorded(folder, f"{{extends: {controller}, {others}}}" if others else controller)
    path = exported(controller, version)
    here = recorded(folder, f"{{fmu: {path.name}, {others}}}")
    common = there.keys() & here.keys()
    assert {"speed", "valve_command_1", "reference_speed"} <= common
    assert [name for name in sorted(common) if there[name] != here[name]] == []
    assert there != recorded(folder, "threshold" if controller != "threshold" else "slip-band")


TRAIN = f"{STOP}until: 36 km/h\ncriteria: uictest-rig\nexpect: skipped\ntrain: [{{}}, {{}}]\ncontroller: "


@cache
def figures(folder, controller):
    """What both cars of a train measure, to the bit, without what is noted of reports."""
    (folder / "train.yaml").write_text(f"{TRAIN}{controller}\n")
    stops = rig.simulate_cars(load([folder / "train.yaml"]), run=rig.run_train_in_process)
    return [stop_bits(stop.measures, stop.wheelset_measures) for stop in stops]


@VERSIONS
def test_every_car_of_a_train_has_an_instance_of_its_own(folder, exported, version):
    path = exported("slip-band", version)
    assert figures(folder, f"{{fmu: {path.name}}}") == figures(folder, "slip-band")


@VERSIONS
def test_an_fmu_that_can_be_instantiated_once_serves_one_car(folder, exported, version):
    path = folder / f"once-{version}.fmu"
    with zipfile.ZipFile(exported("slip-band", version)) as there, zipfile.ZipFile(path, "w") as here:
        for name in there.namelist():
            content = there.read(name)
            if name == "modelDescription.xml":
                once = b'canBeInstantiatedOnlyOncePerProcess="%s"'
                content = content.replace(once % b"false", once % b"true")
            here.writestr(name, content)
    told = rf"^car 2 \({path.name}\): {path.name} can be instantiated only once in a process"
    with pytest.raises(ControllerError, match=told):
        figures(folder, f"{{fmu: {path.name}}}")
    alone = recorded(folder, f"{{fmu: {path.name}}}")
    assert alone["speed"] == recorded(folder, "slip-band")["speed"]
    with Bench(conformance.subject_of("once", load_controller(str(path)))) as bench:
        answered = [len(driven.outputs) > 0 for driven in bench.beside_another().drives]
    assert answered == [True, False]


@VERSIONS
@pytest.mark.parametrize("controller", ["my-wsp.yaml", "own.so", "slip-band"])
def test_fmpy_finds_nothing_wrong(exported, controller, version):
    from fmpy.validation import validate_fmu

    assert validate_fmu(str(exported(controller, version))) == []


@VERSIONS
def test_declared_parameters_are_those_of_the_fmu(exported, version):
    def of(controller):
        described = fmpy.read_model_description(str(exported(controller, version)))
        parameters = [each for each in described.modelVariables if each.causality == "parameter"]
        return described.version, {each.name: each for each in parameters}

    stated, template = of("my-wsp.yaml")
    pause = template["pause"]
    assert (pause.start, pause.unit, float(pause.min), float(pause.max)) == ("0.5", "s", 0.0, 60.0)
    assert (template["upper_slide"].unit, template["cycle_time"].start, stated) == (None, "0.01", "0.1.0")
    stated, own = of("own.so")
    assert (own["gain"].unit, own["gain"].description, own["on"].start) == ("bar/s", "Of it", "true")
    assert (stated, {"mode", "kept"} & own.keys()) == ("7.1", set())
    stated, band = of("slip-band")
    assert stated == __version__
    assert (band["minimum_speed"].unit, float(band["minimum_speed"].max)) == ("m/s", 100 / 3.6)


@VERSIONS
def test_a_controller_is_given_its_parameters_and_says_why_it_fails(own, version):
    """It is created with every declared value, and its message has a percent sign, which C formats read."""
    instance = own(version)
    diagnoses = []
    for cycle in range(3):
        instance.fmu.doStep(cycle * 0.01, 0.01)
        reference = [instance.variables["diagnosis"].valueReference]
        value = (instance.fmu.getInteger if version == 2 else instance.fmu.getInt64)(reference)[0]
        diagnoses.append(value & 0xFFFFFFFF)
        assert (instance["hold_4"], instance["hold_1"]) == (cycle == 1, False)
    assert diagnoses == [0xFFFFFFF0, 0xFFFFFFF1, 0xFFFFFFF2]
    assert np.isnan(instance["reference_speed"])
    with pytest.raises(Exception, match="DoStep"):
        instance.fmu.doStep(0.03, 0.01)
    percent = "%%" if version == 2 else "%"  # a format, which this logger does not fill in
    assert instance.messages == [f"uictest_step failed: 100 {percent} lost"]
    instance.fmu.reset()
    instance.begin()
    instance.fmu.doStep(0.0, 0.01)


@VERSIONS
def test_what_it_cannot_do_is_an_error_with_its_reason(own, version):
    instance = own(version)
    for size, place in ((0.02, 0.0), (0.01, 0.05)):
        with pytest.raises(Exception, match="DoStep"):
            instance.fmu.doStep(place, size)
    with pytest.raises(Exception, match=r"GetFMU[sS]tate"):
        (instance.fmu.getFMUstate if version == 2 else instance.fmu.getFMUState)()
    instance.fmu.reset()
    setter = instance.fmu.setReal if version == 2 else instance.fmu.setFloat64
    with pytest.raises(Exception, match="Set"):
        setter([instance.variables["gain"].valueReference], [2.5])
    setter([instance.variables["gain"].valueReference], [2.0])
    with pytest.raises(Exception, match="ExitInitializationMode"):
        instance.begin()
    assert instance.messages[:4] == [
        "the communication step is 0.02 s; it must be the controller cycle, 0.01 s",
        "the communication point is 0.05 s; the last step ended at 0 s",
        "this FMU does not support the function",
        "gain is 2.5, expected a number from 0 to 2",
    ]
    assert instance.messages[4].startswith("uictest_create failed: given {")


def test_two_fmus_in_one_process_have_their_own_controllers(exported):
    first, second = Instance(exported("my-wsp.yaml", 2)), Instance(exported("slip-band", 2))
    for instance in (first, second):
        speeds = [instance.variables[f"wheel_speed_{i}"].valueReference for i in (1, 2, 3, 4)]
        instance.fmu.setReal(speeds, [30.0, 30.0, 27.0, 30.0])
        instance.fmu.doStep(0.0, 0.01)
    # A slide of 10 %: the one holds from 5 and vents from 15 %, the other from 8 and 20 %.
    assert first.four("hold") == second.four("hold") == [False, False, True, False]
    assert "lower_slide" in first.variables and first.description.guid != second.description.guid
    first.close()
    second.close()


def test_nothing_of_the_machine_is_in_it_and_the_same_gives_the_same_bytes(folder, exported):
    source = folder / "asserting.c"
    source.write_text(
        "#include <assert.h>\n" + OWN.replace("return malloc(1);", "assert(config); return malloc(1);")
    )
    (folder / "asserting.so").write_bytes(library_of(source))
    for reference in ("asserting.so", "my-wsp.yaml", "threshold"):
        path = exported(reference, 2)
        with zipfile.ZipFile(path) as archive:
            content = b"".join(archive.read(name) for name in archive.namelist())
        for own in (str(Path.home()), str(Path.cwd()), str(folder), "/tmp/uictest"):
            assert own.encode() not in content
    part = load_controller("threshold")
    assert fmu.build_controller_fmu(part, 2).content == exported("threshold", 2).read_bytes()


def test_what_its_user_should_know_is_noted(folder):
    library = folder / "noted.so"
    library.write_bytes((folder / "own.so").read_bytes() + str(folder).encode())
    notes = fmu.build_controller_fmu(load_controller(str(library)), 2).notes
    assert notes == (
        "the parameter mode is no number: it cannot be set in the FMU",
        (
            "the FMU is for linux-x86_64 alone; from its C sources, with ziglang installed, it is for"
            " linux-x86_64, windows-x86_64, linux-aarch64"
        ),
        f"the library holds the name of the folder {folder}: build it without -g, or use `strip -g`",
    )


@pytest.mark.parametrize(
    ("source", "reason"),
    [
        (OWN.replace("uictest_step(", "other("), "does not export uictest_step"),
        (OWN.replace('\\"gain\\"', '\\"hold_1\\"'), "the parameter hold_1 has the name of a variable"),
        (OWN.replace("[0, 2]", "[1, 2]"), "the default of gain: 0.1 is out of range"),
        (OWN.replace("return malloc(1)", "abort()"), "crashed with SIGABRT"),
    ],
)
def test_a_library_that_cannot_be_exported_says_why(tmp_path, source, reason):
    (tmp_path / "wsp.c").write_text(source)
    (tmp_path / "wsp.so").write_bytes(library_of(tmp_path / "wsp.c"))
    with pytest.raises((ControllerError, fmu.NotExportableError), match=reason):
        fmu.build_controller_fmu(load_controller(str(tmp_path / "wsp.so")), 2)


PAGE = Path(__file__).parents[2] / "docs" / "rig.md"


def test_the_loop_of_the_page_stops_the_train(build, tmp_path):
    program = re.search(r"# close_loop.py\n.*?(?=^```$)", PAGE.read_text("utf-8"), re.MULTILINE | re.DOTALL)
    assert program is not None
    (tmp_path / "rig.fmu").write_bytes(build(2).read_bytes())
    done = subprocess.run(
        [sys.executable, "-c", program[0]], cwd=tmp_path, capture_output=True, text=True, check=True
    )
    assert float(done.stdout.removesuffix(" m\n")) > 50.0
