"""Foreign code runs in `run` and in nothing that only reads files."""

from __future__ import annotations

import os
import shutil
import subprocess
import zipfile
from collections.abc import Callable
from pathlib import Path
from typing import Any

import pytest

Call = Callable[..., Any]
Write = Callable[..., Path]

HEAD = "schema: uictest/scenario/1\nname: stop\ninitial_speed: 20 km/h\n"
SWEEP = "schema: uictest/sweep/1\nname: s\nscenario: stop.yaml\ngrid: {seed: [1, 2]}\n"
DESCRIPTION = '<?xml version="1.0"?><fmiModelDescription fmiVersion="2.0" modelName="wsp" version="1"/>'


def _library(path: Path, mark: Path) -> None:
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


def _fmu(path: Path, mark: Path) -> None:
    """Write an FMU whose binary creates a file as soon as it is loaded."""
    _library(path.parent / "inside.so", mark)
    with zipfile.ZipFile(path, "w") as archive:
        archive.writestr("modelDescription.xml", DESCRIPTION)
        archive.write(path.parent / "inside.so", "binaries/linux64/wsp.so")


@pytest.fixture(params=["python", "library", "fmu"])
def loaded(request: pytest.FixtureRequest, workplace: Path) -> Path:
    """The file that a controller creates once it is loaded; a scenario and a sweep use that controller."""
    mark = workplace / "loaded"
    if request.param == "python":
        (workplace / "wsp.py").write_text(f"open({str(mark)!r}, 'w').close()\nclass Wsp: ...\n")
        controller = "{python: wsp.py, class: Wsp}"
    elif request.param == "library":
        _library(workplace / "libwsp.so", mark)
        controller = "{library: libwsp.so}"
    else:
        _fmu(workplace / "wsp.fmu", mark)
        controller = "{fmu: wsp.fmu}"
    (workplace / "stop.yaml").write_text(f"{HEAD}controller: {controller}\n")
    (workplace / "s.sweep.yaml").write_text(SWEEP)
    return mark


@pytest.mark.parametrize(
    "command",
    [
        ["check", "stop.yaml"],
        ["check", "s.sweep.yaml"],
        ["list", "stop.yaml"],
        ["schema"],
        ["run", "stop.yaml", "--dry-run"],
        ["sweep", "s.sweep.yaml", "--dry-run"],
    ],
    ids=" ".join,
)
def test_what_reads_files_loads_no_controller(call: Call, loaded: Path, command: list[str]) -> None:
    assert call(*command).code == 0
    assert not loaded.exists()


@pytest.mark.parametrize("loaded", ["python", "library"], indirect=True)
def test_a_run_loads_it(call: Call, loaded: Path) -> None:
    """So that the tests above prove something; what is loaded here is no controller."""
    assert call("run", "stop.yaml").code == 3
    assert loaded.exists()
