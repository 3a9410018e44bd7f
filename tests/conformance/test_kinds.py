"""Every check of controllers, for every kind: the same controllers that ship, as each kind may hold them."""

import re
import subprocess
import sys
from contextlib import contextmanager
from functools import partial
from pathlib import Path

import pytest

from uictest.controllers import HEADER
from uictest.controllers.adapters import python_class
from uictest.plans import templates
from uictest.plans.scenario import load_controller
from uictest.selftest import conformance
from uictest.selftest.conformance import CHECKS, bench as situations

from ..c_compiler import c_compiler

SOCKET = Path(__file__).parents[2] / "examples" / "socket"
SLOW = "cycle_time: 40 ms\ntime_limit: 60 s\n"
"""A quarter of the cycles, as for the other checks."""
SKIPPED = {
    "socket": {
        "same-beside-another": "a program at a socket need not serve two",
        "leaves-no-trace": "a program at a socket has a process of its own",
    },
    "fmu-2-once": {"same-beside-another": "a process can have only one"},
}
CONTRACT_2 = ("built-in", "fmu-2", "fmu-3", "fmu-2-once")
"""`threshold`; the others are what `uictest init controller` writes, in C and in Python."""


def part(folder, text):
    path = folder / "part.yaml"
    path.write_text(f"schema: uictest/controller/1\nname: part\n{text}{SLOW}", "utf-8")
    return load_controller(str(path))


def template(folder, language, program):
    """The part that a template writes, with another program."""
    for name, text in templates.controller_files(language).items():
        (folder / name).write_text(text, "utf-8")
    written = (folder / "my-wsp.yaml").read_text("utf-8")
    declared = written[written.find("declared_parameters") :] if language == "c" else ""
    return part(folder, f"{program}\n{declared}")


def compiled(folder, target, *sources_and_options):
    command = [c_compiler(), "-O2", "-ffp-contract=off", f"-I{HEADER.parent}", *sources_and_options]
    subprocess.run([*command, "-o", target, "-lm"], cwd=folder, check=True)


@contextmanager
def built_in(folder):
    path = folder / "part.yaml"
    path.write_text(
        "schema: uictest/controller/1\nname: part\nextends: threshold\ncycle_time: 40 ms\n", "utf-8"
    )
    yield load_controller(str(path))


@contextmanager
def python(folder):
    yield template(folder, "python", "python: my_wsp.py\nclass: MyWsp")


@contextmanager
def in_a_package(folder):
    """What a package registers is found beside the modules of the process and of its children."""
    template(folder, "python", "python: my_wsp.py\nclass: MyWsp")
    (folder / "acme-1.0.dist-info").mkdir()
    described = {"METADATA": "Metadata-Version: 2.1\nName: acme\nVersion: 1.0\n"}
    described["entry_points.txt"] = "[uictest.controllers]\nacme-wsp = my_wsp:MyWsp\n"
    for name, text in described.items():
        (folder / "acme-1.0.dist-info" / name).write_text(text, "utf-8")
    with pytest.MonkeyPatch.context() as patch:
        patch.syspath_prepend(str(folder))
        patch.setenv("PYTHONPATH", str(folder))
        python_class._registered_class.cache_clear()
        yield part(folder, "registered: acme-wsp\n")
    python_class._registered_class.cache_clear()
    sys.modules.pop("my_wsp", None)


@contextmanager
def library(folder):
    controller = partial(template, folder, "c", "library: libwsp.so")
    (folder / "libwsp.so").touch()
    controller()  # writes the source
    compiled(folder, "libwsp.so", "wsp.c", "-fPIC", "-shared")
    yield controller()


@contextmanager
def at_a_socket(folder):
    template(folder, "c", "library: wsp.c")
    compiled(folder, "wsp", SOCKET / "serve.c", "wsp.c")
    with subprocess.Popen([folder / "wsp", "0"], stdout=subprocess.PIPE, text=True) as program:
        assert program.stdout is not None
        port = re.findall(r"[0-9]+", program.stdout.readline())[-1]
        try:
            yield template(folder, "c", f"connect: tcp://127.0.0.1:{port}")
        finally:
            program.kill()


@contextmanager
def exported(folder, version, *, once=False):
    pytest.importorskip("fmpy", reason="the extra fmu is not installed")
    from uictest.api import fmu

    content = fmu.build_controller_fmu(load_controller("threshold"), version).content
    (folder / "wsp.fmu").write_bytes(once_in_a_process(content) if once else content)
    yield part(folder, "fmu: wsp.fmu\n")


def once_in_a_process(content):
    """The FMU as tools write it whose code has static variables."""
    import io
    import zipfile

    changed = io.BytesIO()
    flag = b'canBeInstantiatedOnlyOncePerProcess="%s"'
    with zipfile.ZipFile(io.BytesIO(content)) as there, zipfile.ZipFile(changed, "w") as here:
        for name in there.namelist():
            here.writestr(name, there.read(name).replace(flag % b"false", flag % b"true"))
    return changed.getvalue()


KINDS = {
    "built-in": built_in,
    "python": python,
    "registered": in_a_package,
    "library": library,
    "socket": at_a_socket,
    "fmu-2": partial(exported, version=2),
    "fmu-3": partial(exported, version=3),
    "fmu-2-once": partial(exported, version=2, once=True),
}


@pytest.fixture(scope="module", params=KINDS)
def kind(request):
    return request.param


@pytest.fixture(scope="module")
def findings(kind, tmp_path_factory):
    """What the checks found of a controller of a kind, by check."""
    with pytest.MonkeyPatch.context() as patch, KINDS[kind](tmp_path_factory.mktemp(kind)) as controller:
        patch.setattr(situations, "anything", partial(situations.anything, cycles=750))
        examination = conformance.examine(conformance.subject_of(kind, controller))
    return {each.id: each for each in examination.findings}


@pytest.mark.parametrize("check", CHECKS, ids=lambda check: check.id)
def test_every_kind_of_controller_goes_through_every_check(kind, findings, check):
    if check.contract > 1 and kind not in CONTRACT_2:
        assert check.id not in findings
        return
    finding = findings[check.id]
    if check.id in SKIPPED.get(kind, {}):
        assert (finding.status, finding.reason) == ("skipped", SKIPPED[kind][check.id])
    else:
        assert finding.status == "pass" or (check.advisory and finding.status == "warning"), finding.reason
