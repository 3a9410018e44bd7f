"""Controllers from outside: what a scenario may write, and what the messages say about the rest."""

import io
import zipfile
from collections.abc import Callable
from hashlib import sha256
from pathlib import Path

import pytest

from uictest.plans.scenario import Case, Diagnostic, load, values_in

Loaded = Callable[..., list[Case]]
Refused = Callable[..., tuple[Diagnostic, ...]]
Write = Callable[..., Path]

PROGRAM = b'__version__ = "1.2.0"\nclass Wsp: ...\n'


def _fmu(description: bytes) -> bytes:
    content = io.BytesIO()
    with zipfile.ZipFile(content, "w") as archive:
        archive.writestr("modelDescription.xml", description)
    return content.getvalue()


@pytest.mark.parametrize(
    ("controller", "key", "message", "hint"),
    [
        ("{pyton: wsp.py, class: Wsp}", "controller.pyton", "unknown key 'pyton'", "did you mean 'python'?"),
        ("{algoritm: threshold}", "controller.algoritm", "unknown key", "did you mean 'algorithm'?"),
        ("{parameters: {a: 1}}", "controller", "no controller is named", "one of python, library, fmu"),
        ("{slip_threshold: 5 km/h}", "controller", "no controller is named", "write `extends: threshold`"),
        ("{python: wsp.py}", "controller.class", "missing key 'class'", "Name of the class in that file."),
        ("{python: wsp.py, clss: Wsp}", "controller.clss", "unknown key 'clss'", "did you mean 'class'?"),
        (
            "{python: wsp.py, class: Wsp, connect: 'tcp://127.0.0.1:1'}",
            *("controller.connect", "by 'python' and by 'connect'", "keep one of them"),
        ),
        (
            "{extends: threshold, python: wsp.py, class: Wsp}",
            *("controller.python", "by 'algorithm' and by 'python'", "does not extend one that is built in"),
        ),
        ("{python: wps.py, class: Wsp}", "controller.python", "no such file: 'wps.py'", "'wsp.py'?"),
        ("{library: libabc.so}", "controller.library", "no such file: 'libabc.so'", "build it first"),
        ("{fmu: /tmp/wsp.fmu}", "controller.fmu", "is an absolute path", "write it relative"),
        ("{fmu: ../wsp.fmu}", "controller.fmu", "leads out of", "--trust"),
        ("{connect: '127.0.0.1:5025'}", "controller.connect", "is not an address", "tcp://HOST:PORT"),
        ("{connect: 'tcp://rig:70000'}", "controller.connect", "no port 70000", "from 1 to 65535"),
        ("{python: [wsp.py], class: Wsp}", "controller.python", "expected the path of a file", "relative"),
        (
            "{python: wsp.py, class: Wsp, time_limit: 5}",
            *("controller.time_limit", "has no unit", "`5 s` or `5 ms`"),
        ),
        (
            "{python: wsp.py, class: Wsp, parameters: {a: }}",
            *("controller.parameters.a", "expected a number", "leave the parameter out"),
        ),
        (
            "{python: wsp.py, class: Wsp, parameters: {a: [1e999]}}",
            *("controller.parameters.a", "JSON has no number inf", "write a finite number"),
        ),
        ("wsp.py", "controller", "no controller 'wsp.py'", "write `{python: wsp.py, class: NAME}`"),
        ("lib/libwsp.so", "controller", "no controller", "write `{library: lib/libwsp.so}`"),
        ("wsp.fmu", "controller", "no controller", "write `{fmu: wsp.fmu}`"),
        ("'tcp://rig:5025'", "controller", "no controller", 'write `{connect: "tcp://rig:5025"}`'),
    ],
)
def test_what_to_write_instead(
    refused: Refused, write: Write, head: str, controller: str, key: str, message: str, hint: str
) -> None:
    write("wsp.py", PROGRAM)
    diagnostics = {each.key: each for each in refused(f"{head}controller: {controller}\n")}
    assert message in diagnostics[key].message
    assert hint in diagnostics[key].hint
    assert diagnostics[key].line == 4


def test_a_file_is_identified_and_not_run(loaded: Loaded, write: Write, head: str) -> None:
    write("wsp.py", PROGRAM + b"raise SystemExit\n")
    (case,) = loaded(
        f"{head}controller: {{python: wsp.py, class: Wsp, parameters: {{gain: 2}}, free_parameters: true}}\n"
    )
    digest = sha256(PROGRAM + b"raise SystemExit\n").hexdigest()
    assert case.inputs["wsp.py"] == digest
    values = dict(values_in(case.scenario.controller))
    assert values["python",] == "wsp.py"
    assert values["class",] == "Wsp"
    assert values["sha256",] == digest
    assert values["version",] == "1.2.0"
    assert values["parameters", "gain"] == 2


def test_a_version_that_a_scenario_states_goes_before_that_of_the_file(
    loaded: Loaded, write: Write, head: str
) -> None:
    write("wsp.py", PROGRAM)
    (case,) = loaded(f"{head}controller: {{python: wsp.py, class: Wsp, version: 2.0-rc1}}\n")
    assert case.scenario.controller.version == "2.0-rc1"


@pytest.mark.parametrize(
    ("content", "version"),
    [
        (b"import os\n__version__: str = '3'\n", "3"),
        (b"__version__ = version = '4'\n", "4"),
        (b"__version__ = str(5)\n", None),
        (b"__version__ = 6\n", None),
        (b"__version__ = 'a\\x1b[31m'\n", None),
        (b"class Wsp:\n    __version__ = '7'\n", None),
        (b"this is no Python", None),
        (b"\x00", None),
    ],
)
def test_the_version_of_a_python_file_is_a_text_in_it(
    loaded: Loaded, write: Write, head: str, content: bytes, version: str | None
) -> None:
    write("wsp.py", content)
    (case,) = loaded(f"{head}controller: {{python: wsp.py, class: Wsp}}\n")
    assert case.scenario.controller.version == version


@pytest.mark.parametrize(
    ("content", "version"),
    [
        (_fmu(b'<?xml version="1.0"?><fmiModelDescription version="1.4" fmiVersion="2.0"/>'), "1.4"),
        (_fmu(b'<fmiModelDescription version="1.4"><ModelVariables>' + b" " * 10**6), "1.4"),
        (_fmu(b'<fmiModelDescription fmiVersion="3.0"/>'), None),
        (_fmu(b"<fmiModelDescription"), None),
        (_fmu(b"nothing"), None),
        (b"no archive", None),
        (_fmu(b'<fmiModelDescription version="1.4"/>')[:-9], None),
    ],
)
def test_the_version_of_an_fmu_is_that_of_its_description(
    loaded: Loaded, write: Write, head: str, content: bytes, version: str | None
) -> None:
    write("wsp.fmu", content)
    (case,) = loaded(f"{head}controller: {{fmu: wsp.fmu}}\n")
    assert case.scenario.controller.version == version


@pytest.mark.parametrize(
    ("controller", "label"),
    [
        ("{python: wsp.py, class: Wsp}", "Wsp"),
        ("{name: ours, python: wsp.py, class: Wsp}", "ours"),
        ("{library: build/libwsp.so}", "libwsp"),
        ("{fmu: wsp.fmu}", "wsp"),
        ("{connect: 'tcp://rig:5025'}", "tcp://rig:5025"),
    ],
)
def test_a_controller_without_a_name_is_called_after_its_program(
    loaded: Loaded, write: Write, head: str, controller: str, label: str
) -> None:
    for name in ("wsp.py", "build/libwsp.so", "wsp.fmu"):
        write(name, PROGRAM)
    (case,) = loaded(f"{head}controller: {controller}\n")
    assert case.scenario.controller.label == label


def test_a_file_of_several_cases_is_read_once(
    write: Write, head: str, monkeypatch: pytest.MonkeyPatch
) -> None:
    program, read = write("wsp.py", PROGRAM), []
    original = Path.read_bytes
    monkeypatch.setattr(Path, "read_bytes", lambda path: read.append(path.name) or original(path))
    controller = "controller: {python: wsp.py, class: Wsp, free_parameters: true}\n"
    cases = load([write("stop.yaml", f"{head}{controller}matrix: {{controller.parameters.a: [1, 2, 3]}}\n")])
    assert [case.scenario.controller.parameters["a"] for case in cases] == [1, 2, 3]
    assert read.count(program.name) == 1


def test_another_build_is_a_change_against_the_part_that_is_extended(write: Write, head: str) -> None:
    """The part at the root of `extends` has the SHA-256 of its own file."""
    from uictest.judging.evaluation import EffectiveParts

    write("one.py", PROGRAM)
    write("two.py", PROGRAM + b"# another\n")
    write("ours.yaml", "schema: uictest/controller/1\nname: ours\npython: one.py\nclass: Wsp\n")
    (case,) = load([write("stop.yaml", f"{head}controller: {{extends: ours.yaml, python: two.py}}\n")])
    part = EffectiveParts().of(case.scenario)["controller"]
    assert {each.key for each in part.changed} == {"controller.python", "controller.sha256"}
    changed = {each.key: each.library_value for each in part.changed}
    assert changed["controller.sha256"] == sha256(PROGRAM).hexdigest()
