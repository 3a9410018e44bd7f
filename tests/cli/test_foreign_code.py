"""Foreign code runs in `run` and in nothing that only reads files."""

import os
import shutil
import subprocess
import zipfile

import pytest

HEAD = "schema: uictest/scenario/1\nname: stop\ninitial_speed: 20 km/h\n"
SWEEP = "schema: uictest/scenario/1\nname: s\nextends: stop.yaml\nvary: {matrix: {seed: [1, 2]}}\n"
DESCRIPTION = '<?xml version="1.0"?><fmiModelDescription fmiVersion="2.0" modelName="wsp" version="1"/>'


def _library(path, mark):
    """Compile a library that creates a file as soon as it is loaded."""
    compiler = shutil.which(os.environ.get("CC", "gcc"))
    if compiler is None:
        pytest.skip("no C compiler")
    source = path.with_suffix(".c")
    source.write_text(
        "#include <stdio.h>\n"
        f'__attribute__((constructor)) static void load(void) {{ fclose(fopen("{mark}", "w")); }}\n'
    )
    subprocess.run([compiler, "-fPIC", "-shared", "-o", path, source], check=True)
    path.chmod(0o644)


def _fmu(path, mark):
    """Write an FMU whose binary creates a file as soon as it is loaded."""
    _library(path.parent / "inside.so", mark)
    with zipfile.ZipFile(path, "w") as archive:
        archive.writestr("modelDescription.xml", DESCRIPTION)
        archive.write(path.parent / "inside.so", "binaries/linux64/wsp.so")


READING = [
    ["check", "stop.yaml"],
    ["check", "s.sweep.yaml"],
    ["list", "stop.yaml"],
    ["list", "s.sweep.yaml"],
    ["schema"],
    ["run", "stop.yaml", "--dry-run"],
    ["sweep", "s.sweep.yaml", "--dry-run"],
]


@pytest.mark.parametrize("kind", ["python", "library", "fmu"])
def test_what_reads_files_loads_no_controller_and_a_run_does(call, workplace, kind):
    mark = workplace / "loaded"
    if kind == "python":
        (workplace / "wsp.py").write_text(
            f"open({str(mark)!r}, 'w').close()\nclass Wsp: ...\n"
            "PARAMETERS = {'share': {'default': 0.0, 'unit': '1'}}\n"
        )
        controller = "{python: wsp.py, class: Wsp, parameters: {share: 0.5}}"
    elif kind == "library":
        _library(workplace / "libwsp.so", mark)
        controller = "{library: libwsp.so}"
    else:
        _fmu(workplace / "wsp.fmu", mark)
        controller = "{fmu: wsp.fmu}"
    (workplace / "stop.yaml").write_text(f"{HEAD}controller: {controller}\n")
    (workplace / "s.sweep.yaml").write_text(SWEEP)
    for command in READING:
        assert call(*command).code == 0, command
        assert not mark.exists(), command
    if kind != "fmu":
        # So that the lines above prove something; what is loaded here is no controller.
        assert call("run", "stop.yaml").code == 3
        assert mark.exists()
