"""Controllers from outside: what a scenario may write, what is said of the rest, and their names in ids."""

import subprocess
import sys
from hashlib import sha256
from pathlib import Path

import pytest

from uictest.controllers import shown_version
from uictest.plans.scenario import fmu_description, load, values_in
from uictest.plans.scenario.programs import version_in
from uictest.plans.series import load_series
from uictest.plans.sweeps import load_sweep

from .conftest import refusals

PROGRAM = b'__version__ = "1.2.0"\nclass Wsp: ...\n'


@pytest.mark.parametrize(
    ("controller", "key", "message", "hint"),
    [
        ("{pyton: wsp.py, class: Wsp}", "controller.pyton", "unknown key 'pyton'", "did you mean 'python'?"),
        ("{algoritm: threshold}", "controller.algoritm", "unknown key", "did you mean 'algorithm'?"),
        ("{parameters: {a: 1}}", "controller", "no controller is named", "one of python, library, fmu"),
        ("{slip_threshold: 5 km/h}", "controller", "no controller is named", "write `extends: threshold`"),
        ("{python: wsp.py}", "controller.class", "missing key 'class'", "Name of the class in that file."),
        ("{python: wsp.py, class: Wps}", "controller.class", "wsp.py has no class 'Wps'", "mean 'Wsp'?"),
        ("{python: wsp.py, clss: Wsp}", "controller.clss", "unknown key 'clss'", "did you mean 'class'?"),
        ("{python: wps.py, class: Wsp}", "controller.python", "no such file: 'wps.py'", "'wsp.py'?"),
        ("{python: folders.py, class: Wsp}", "controller.python", "no such file", "mend the path"),
        ("{library: libabc.so}", "controller.library", "no such file: 'libabc.so'", "build it first"),
        ("{fmu: /tmp/wsp.fmu}", "controller.fmu", "is an absolute path", "write it relative"),
        ("{fmu: ../wsp.fmu}", "controller.fmu", "leads out of", "--trust"),
        ("{connect: '127.0.0.1:5025'}", "controller.connect", "is not an address", "tcp://HOST:PORT"),
        ("{connect: 'tcp://rig:70000'}", "controller.connect", "no port 70000", "from 1 to 65535"),
        ("{python: [wsp.py], class: Wsp}", "controller.python", "expected the path of a file", "relative"),
        ("wsp.py", "controller", "no controller 'wsp.py'", "write `{python: wsp.py, class: NAME}`"),
        ("lib/libwsp.so", "controller", "no controller", "write `{library: lib/libwsp.so}`"),
        ("wsp.fmu", "controller", "no controller", "write `{fmu: wsp.fmu}`"),
        ("'tcp://rig:5025'", "controller", "no controller", 'write `{connect: "tcp://rig:5025"}`'),
        *refusals("""\
{python: wsp.py, class: Wsp, connect: 'tcp://127.0.0.1:1'}
-> controller.connect | by 'python' and by 'connect' | keep one of them
{extends: threshold, python: wsp.py, class: Wsp}
-> controller.python | by 'algorithm' and by 'python' | does not extend one that is built in
{python: wsp.py, class: Wsp, time_limit: 5}
-> controller.time_limit | has no unit | `5 s` or `5 ms`
{python: wsp.py, class: Wsp, parameters: [1, 2]}
-> controller.parameters | expected a mapping, found a list | Handed to the controller
{python: wsp.py, class: Wsp, parameters: {a: }}
-> controller.parameters.a | expected a number | leave the parameter out
{python: wsp.py, class: Wsp, parameters: {a: [1e999]}}
-> controller.parameters.a | JSON has no number inf | write a finite number
"""),
    ],
)
def test_what_to_write_instead(refused, write, head, controller, key, message, hint):
    write("wsp.py", PROGRAM)
    Path("folder").mkdir()  # a folder is no file to name
    diagnostics = {each.key: each for each in refused(f"{head}controller: {controller}\n")}
    assert message in diagnostics[key].message
    assert hint in diagnostics[key].hint
    assert diagnostics[key].line == 4


@pytest.mark.parametrize(
    ("content", "place", "reason"),
    [
        ("class Wsp:\n    def step(self:\n", (2, 13), "SyntaxError: '(' was never closed"),
        ("class Wsp:\n    a = 1\n   b = 2\n", (3, 9), "IndentationError: unindent does not match"),
        ("class Wsp: ...\nreturn Wsp\n", (2, 1), "SyntaxError: 'return' outside function"),
    ],
)
def test_a_file_that_is_no_python_is_an_error_at_its_line(refused, write, head, content, place, reason):
    write("wsp.py", content)
    (error,) = refused(f"{head}controller: {{python: wsp.py, class: Wsp}}\n")
    assert (error.file, error.line, error.column) == ("wsp.py", *place)
    assert f"cannot be imported: {reason}" in error.message
    assert error.excerpt.splitlines()[0] == content.splitlines()[place[0] - 1]


def test_a_class_is_looked_for_among_those_of_the_file(refused, write, head):
    write("wsp.py", 'class Slow: ...\n@final\nclass Fast(Slow):\n    def Wsp(self): ...\ndef make(): "Wsp"\n')
    (error,) = refused(f"{head}controller: {{python: wsp.py, class: Wsp}}\n")
    assert (error.file, error.line, error.column) == ("stop.yaml", 4, 37)
    assert (error.message, error.hint) == ("wsp.py has no class 'Wsp'", "accepted: Fast, Slow")


@pytest.mark.parametrize(
    "content",
    [
        "from acme import Wsp\n",
        "import acme as Wsp\n",
        "from acme import *\n",
        "Wsp = made()\n",
        "globals()['W' + 'sp'] = type\n",
        "def make():\n    global Wsp\n    Wsp = type\n",
        "def __getattr__(name): ...\n",
        "if True:\n    class Wsp: ...\n",
        "class Wsp:\n    unknown_escape = '\\d'\n",
        "(" + "x = 1\n" * 22_000,  # large: nothing of it but the declarations is parsed
    ],
)
def test_a_class_that_only_a_run_can_tell_is_left_to_it(loaded, write, head, content):
    write("wsp.py", content)
    assert loaded(f"{head}controller: {{python: wsp.py, class: Wsp}}\n")


def test_a_file_is_identified_and_not_run(loaded, write, head):
    write("wsp.py", PROGRAM + b"raise SystemExit\n")
    (case,) = loaded(
        f"{head}controller: {{python: wsp.py, class: Wsp, parameters: {{gain: 2}}, free_parameters: true}}\n"
    )
    digest = sha256(PROGRAM + b"raise SystemExit\n").hexdigest()
    assert case.inputs["wsp.py"] == digest
    stated = {"python": "wsp.py", "class": "Wsp", "sha256": digest, "version": "1.2.0"}
    expected = {("parameters", "gain"): 2, **{(key,): value for key, value in stated.items()}}
    assert expected.items() <= dict(values_in(case.scenario.controller)).items()


def test_a_version_that_a_scenario_states_goes_before_that_of_the_file_which_may_have_none(
    loaded, write, head, fmu
):
    write("wsp.py", PROGRAM)
    (case,) = loaded(f"{head}controller: {{python: wsp.py, class: Wsp, version: 2.0-rc1}}\n")
    assert case.scenario.controller.version == "2.0-rc1"
    whole = fmu('<fmiModelDescription version="1.4"/>')
    for content, version in ((whole, "1.4"), (whole[:-9], None), (b"no archive", None)):
        write("wsp.fmu", content)
        (case,) = loaded(f"{head}controller: {{fmu: wsp.fmu}}\n")
        assert case.scenario.controller.version == version


@pytest.mark.parametrize(
    ("text", "version"),
    [
        ('import os\n__version__ = "1.2"\n', "1.2"),
        ('"""Text\n__version__ = "no"\n"""\n__version__: str = (\n    "4.2"  # ours\n)\nx = 1\n', "4.2"),
        ("'''\n__version__ = 'no'\n'''\n", ""),
        ('x = "\\"" # "\n__version__ = title = "7"\n', "7"),
        ("# '''\n__version__ = version = '3'\n", "3"),
        ("def f():\n    __version__ = '1'\n", ""),
        ("__version__ = '1' if x else '2'\n__version__ = '5'\n", "5"),
        ("__version__ = (\n__version__ = '6'\n", "6"),
        ("__version__ = 1\n", ""),
        ("__version__ = str(5)\n", ""),
        ("__version__ = 'a\\x1b[31m'\n", ""),
        ("__versions__ = '1'\n", ""),
        ("__version__ = '" + "9" * 100_000, ""),
        ("__version__ += '1'\n\x00", ""),
        ("this is no Python", ""),
    ],
)
def test_the_version_of_a_python_file_is_a_text_in_it(text, version):
    assert shown_version(version_in(text.encode())) == version


@pytest.mark.parametrize(
    ("description", "version"),
    [
        ('<?xml version="1.0"?><fmiModelDescription version="1.4" fmiVersion="2.0"/>', "1.4"),
        ('<fmiModelDescription version="1.4"><ModelVariables>' + " " * 10**6, ""),
        ('<fmiModelDescription fmiVersion="3.0"/>', ""),
        ("<fmiModelDescription", ""),
        ("nothing", ""),
        *(
            (f'<?xml version="1.0" encoding="{unknown}"?><fmiModelDescription version="2"/>', "")
            for unknown in ("x-unknown", "utf-7", "base64")
        ),
    ],
)
def test_the_version_of_an_fmu_is_that_of_its_description(fmu, description, version, tmp_path):
    path = tmp_path / "wsp.fmu"
    path.write_bytes(fmu(description))
    assert fmu_description.read_description(path).version == version


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
def test_a_controller_without_a_name_is_called_after_its_program(loaded, write, head, controller, label):
    for name in ("wsp.py", "build/libwsp.so", "wsp.fmu"):
        write(name, PROGRAM)
    (case,) = loaded(f"{head}controller: {controller}\n")
    assert case.scenario.controller.label == label


def test_a_file_of_several_cases_is_read_once(write, head, monkeypatch):
    program, read = write("wsp.py", PROGRAM), []
    original = Path.read_bytes
    monkeypatch.setattr(Path, "read_bytes", lambda path: read.append(path.name) or original(path))
    controller = "controller: {python: wsp.py, class: Wsp, free_parameters: true}\n"
    cases = load([write("stop.yaml", f"{head}{controller}matrix: {{controller.parameters.a: [1, 2, 3]}}\n")])
    assert [case.scenario.controller.parameters["a"] for case in cases] == [1, 2, 3]
    assert read.count(program.name) == 1


def test_another_build_is_a_change_against_the_part_that_is_extended(write, head):
    """The part at the root of `extends` has the SHA-256 of its own file."""
    from uictest.judging.evaluation import effective_parts

    write("one.py", PROGRAM)
    write("two.py", PROGRAM + b"# another\n")
    write("ours.yaml", "schema: uictest/controller/1\nname: ours\npython: one.py\nclass: Wsp\n")
    (case,) = load([write("stop.yaml", f"{head}controller: {{extends: ours.yaml, python: two.py}}\n")])
    part = effective_parts(case.scenario)["controller"]
    assert {each.key for each in part.changed} == {"controller.python", "controller.sha256"}
    changed = {each.key: each.library_value for each in part.changed}
    assert changed["controller.sha256"] == sha256(PROGRAM).hexdigest()


HANGS = ["-n", "1", "-r", "1", "import time; time.sleep(3600)"]
CRASHES = ["-n", "1", "-r", "1", "import os; os.abort()"]


@pytest.mark.parametrize("arguments", [HANGS, CRASHES], ids=["hangs", "crashes"])
def test_a_description_whose_reader_does_not_end_well_states_nothing(
    loaded, write, head, fmu, monkeypatch, arguments
):
    """It costs some time, never the program: who loads the FMU says why."""
    start = fmu_description.reading_process
    monkeypatch.setattr(
        fmu_description, "reading_process", lambda _, __, folder: start("timeit", arguments, folder)
    )
    monkeypatch.setattr(fmu_description, "_SECONDS", 0.5 if arguments is HANGS else 60.0)
    write("wsp.fmu", fmu('<fmiModelDescription version="1.4"/>'))
    (case,) = loaded(f"{head}controller: {{fmu: wsp.fmu, parameters: {{gain: 1}}}}\n")
    assert case.scenario.controller.version is None
    assert case.scenario.controller.parameters == {"gain": 1}


def test_an_fmu_is_described_by_another_process(write, head, fmu, tmp_path):
    """No parser of XML is even imported in the one that checks."""
    variable = '<ScalarVariable name="gain" causality="parameter"><Real start="1"/></ScalarVariable>'
    variables = f"<ModelVariables>{variable}</ModelVariables>"
    write("wsp.fmu", fmu(f"<fmiModelDescription version='1.4'>{variables}</fmiModelDescription>"))
    write("stop.yaml", f"{head}controller: {{fmu: wsp.fmu, parameters: {{gain: 2}}}}\n")
    program = (
        "import sys; from pathlib import Path; from uictest.plans.scenario import load\n"
        "[case] = load([Path('stop.yaml')]); controller = case.scenario.controller\n"
        "print(controller.version, controller.declared_parameters, 'xml.etree.ElementTree' in sys.modules)"
    )
    told = subprocess.run(
        [sys.executable, "-c", program], cwd=tmp_path, capture_output=True, text=True, check=True
    )
    assert told.stdout == "1.4 {} False\n"


def test_a_description_that_swells_when_it_is_read_costs_a_bounded_time(loaded, write, head, fmu):
    """Each entity holds ten of the one before: ten thousand million in the last one."""
    entities = "".join(f'<!ENTITY e{n + 1} "{f"&e{n};" * 10}">' for n in range(9))
    swelling = f'<!DOCTYPE d [<!ENTITY e0 "ten chars.">{entities}]><fmiModelDescription version="&e9;"/>'
    write("wsp.fmu", fmu(swelling))
    (case,) = loaded(f"{head}controller: {{fmu: wsp.fmu, parameters: {{gain: 1}}}}\n")
    assert case.scenario.controller.version is None


BOTH = "matrix: {controller: [v23/wsp.yaml, v24/wsp.yaml]}\n"


def _part(write, folder, program, name="name: wsp\n", more=""):
    """Write a controller; return the digits of its program."""
    program += "class Wsp: ...\n"
    write(f"{folder}/wsp.py", program.encode())
    write(f"{folder}/wsp.yaml", f"schema: uictest/controller/1\n{name}python: wsp.py\nclass: Wsp\n{more}")
    return sha256(program.encode()).hexdigest()[:8]


def _version(text):
    return f"__version__ = {text!r}\n"


@pytest.mark.parametrize(
    ("versions", "suffixes"),
    [
        (("2.3", "2.4"), ("2.3", "2.4")),
        (("2.4 beta/1", "2.4"), ("2.4beta1", "2.4")),
        (("2.3", "2.3"), None),
        (("2.3", ""), None),
        (("2.4/", "2.4"), None),  # the same in the characters of a file name
    ],
)
def test_programs_of_one_name_have_their_versions_or_digests(write, loaded, head, versions, suffixes):
    digests = [
        _part(write, folder, f"{_version(version)}# {folder}\n")
        for folder, version in zip(("v23", "v24"), versions, strict=True)
    ]
    ids = [case.id for case in loaded(head + BOTH)]
    assert ids == [f"stop[controller=wsp@{suffix}]" for suffix in suffixes or digests]


def test_a_comma_list_series_and_sweeps_name_them_alike(write, head):
    """`controller=v23/wsp.yaml,v24/wsp.yaml` was refused as the same id."""
    _part(write, "v23", _version("2.3"))
    _part(write, "v24", _version("2.4"))
    expected = ["controller=wsp@2.3", "controller=wsp@2.4"]
    stop = write("stop.yaml", head)
    cases = load([stop], ["controller=v23/wsp.yaml,v24/wsp.yaml"])
    assert [case.id for case in cases] == [f"stop[{each}]" for each in expected]
    include = "include: [{controller: v23/wsp.yaml}, {controller: v24/wsp.yaml}]\n"
    stops = "dry: {scenario: stop.yaml, set: {rail.condition: dry}}\nwet: {scenario: stop.yaml}\n"
    series = write("a.series.yaml", f"schema: uictest/series/1\nname: a\n{stops}{include}")
    assert [each.id for each in load_series(series)] == [f"a[{each}]" for each in expected]
    vary = "vary: {matrix: {controller: [v23/wsp.yaml, v24/wsp.yaml]}}\n"
    plan = load_sweep(
        write("a.sweep.yaml", f"schema: uictest/scenario/1\nname: a\nextends: stop.yaml\n{vary}")
    )
    assert [row[0].label for row in plan.groups[0].rows] == ["wsp@2.3", "wsp@2.4"]


def test_programs_in_ids_are_named_by_their_part_and_need_a_name_where_parameters_differ(
    write, refused, head, loaded
):
    for folder, more in (("v23", "parameters: {a: 1}\n"), ("v24", "parameters: {a: 2}\n")):
        _part(write, folder, "", more=f"{more}free_parameters: true\n")
    (error,) = refused(head + BOTH)
    assert "make the same case id" in error.message
    assert "give each a `name`" in error.hint
    _part(write, "v23", "", "name: ours\n")
    _part(write, "v24", "")
    cases = loaded(f"{head}matrix: {{controller: [v23/wsp.yaml, v24/wsp.yaml, threshold]}}\n")
    assert [case.id for case in cases] == [
        f"stop[controller={name}]" for name in ("ours", "wsp", "threshold")
    ]
