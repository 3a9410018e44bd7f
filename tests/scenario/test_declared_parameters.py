"""Declared parameters of controllers from outside: read as text, and held against what a file gives."""

import ast
import json

import pytest

from uictest.judging.evaluation import effective_parts
from uictest.plans.scenario import ScenarioErrors, load_controller, with_parameters

PYTHON = """
PARAMETERS = {
    "upper_slide": {"default": 0.15, "unit": "1", "range": [0, 1], "description": "vents above"},
    "cycles": {"default": 3, "unit": "1"},
    "mode": {"default": "fast"},
}
raise SystemExit  # it is read, not run
class Wsp: ...
"""
LISTED = (
    '{upper_slide: {default: 0.15, unit: "1", range: [0, 1]}, cycles: {default: 3, unit: 1},'
    " mode: {default: fast}}"
)
XML = """<fmiModelDescription fmiVersion="{version}"><TypeDefinitions>{types}</TypeDefinitions>
<ModelVariables>{variables}</ModelVariables></fmiModelDescription>"""
FMI2 = XML.format(
    version="2.0",
    types='<SimpleType name="Slide"><Real unit="1" min="0" max="1"/></SimpleType>',
    variables="""
<ScalarVariable name="upper_slide" causality="parameter">
<Real declaredType="Slide" start="0.15"/></ScalarVariable>
<ScalarVariable name="cycles" causality="parameter"><Integer start="3"/></ScalarVariable>
<ScalarVariable name="mode" causality="parameter"><String start="fast"/></ScalarVariable>
<ScalarVariable name="hold" causality="output"><Real/></ScalarVariable>""",
)
FMI3 = XML.format(
    version="3.0",
    types='<Float64Type name="Slide" unit="1" min="0" max="1"/>',
    variables="""
<Float64 name="upper_slide" causality="parameter" declaredType="Slide" start="0.15"/>
<Int32 name="cycles" causality="parameter" start="3"/>
<String name="mode" causality="parameter"><Start value="fast"/></String>
<Float64 name="table" causality="parameter" start="1 2 3"/>
<Float64 name="hold" causality="output"/>""",
)
CONTROLLERS = {
    "python": "python: wsp.py, class: Wsp",
    "part's list": f"python: plain.py, class: Wsp, declared_parameters: {LISTED}",
    "library": f"library: libwsp.so, declared_parameters: {LISTED}",
    "socket": f"connect: 'tcp://rig:5025', declared_parameters: {LISTED}",
    "FMI 2.0": "fmu: two.fmu",
    "FMI 3.0": "fmu: three.fmu",
}


@pytest.fixture
def programs(write, fmu):
    write("wsp.py", PYTHON.encode())
    write("plain.py", b"class Wsp: ...\n")
    write("libwsp.so", b"")
    write("two.fmu", fmu(FMI2))
    write("three.fmu", fmu(FMI3))


@pytest.mark.usefixtures("programs")
@pytest.mark.parametrize("controller", CONTROLLERS.values(), ids=CONTROLLERS.keys())
class TestEveryKind:
    def test_what_is_wrong_is_an_error_and_what_is_declared_is_accepted(
        self, refused, head, controller, loaded
    ):
        # A run with `uper_slide` passed with the default of the controller.
        (error,) = refused(f"{head}controller: {{{controller}, parameters: {{uper_slide: 0.1}}}}\n")
        assert (error.key, error.line) == ("controller.parameters.uper_slide", 4)
        assert "no parameter uper_slide" in error.message
        assert "upper_slide" in error.hint
        for given in ("1.5", "-0.1", "15 %", "true", "[0.1]"):
            (error,) = refused(f"{head}controller: {{{controller}, parameters: {{upper_slide: {given}}}}}\n")
            assert error.key == "controller.parameters.upper_slide"
            assert "out of range" in error.message or "expected a number" in error.message
            assert error.hint == ("accepted: 0 to 1" if "out of" in error.message else "write a bare number")
        given = "{upper_slide: 1, cycles: 4, mode: slow}"
        (case,) = loaded(f"{head}controller: {{{controller}, parameters: {given}}}\n")
        program = case.scenario.controller.program
        assert program is not None
        assert json.loads(program.parameters) == {"upper_slide": 1, "cycles": 4, "mode": "slow"}

    def test_axes_of_every_sort_are_checked(self, refused, head, controller):
        base = f"{head}controller: {{{controller}}}\n"
        wrong = "controller.parameters.uper_slide"
        for section in (
            f"matrix: {{{wrong}: [0.1, 0.2]}}",
            f"zip: {{{wrong}: [0.1], seed: [1]}}",
            f"include: [{{{wrong}: 0.1}}]",
        ):
            (error,) = refused(f"{base}{section}\n")
            assert (error.key, error.line) == (wrong, 5)
        (error,) = refused(base, f"{wrong}=0.05,0.3")
        assert (error.file, error.key) == ("--set", wrong)


@pytest.mark.usefixtures("programs")
def test_defaults_are_handed_over_and_shown(loaded, head):
    """The controller is given what the results name; whole numbers stay whole."""
    for name in ("python", "part's list", "library", "socket"):
        (case,) = loaded(f"{head}controller: {{{CONTROLLERS[name]}, parameters: {{cycles: 4}}}}\n")
        program = case.scenario.controller.program
        assert program is not None
        assert program.parameters == '{"upper_slide": 0.15, "cycles": 4, "mode": "fast"}'
        rows = {each.key: each for each in effective_parts(case.scenario)["controller"].parameters}
        shown = {
            key.rpartition(".")[2]: (row.value, row.unit, row.mark)
            for key, row in rows.items()
            if "parameters" in key
        }
        assert shown == {
            "upper_slide": (0.15, "1", "default"),
            "cycles": (4, "1", "user"),
            "mode": ("fast", "", "default"),
        }


@pytest.mark.usefixtures("programs")
def test_an_fmu_keeps_its_own_start_values_and_what_is_known_only_in_a_run_is_left_to_it(loaded, head):
    (case,) = loaded(f"{head}controller: {{fmu: two.fmu, parameters: {{cycles: 4}}}}\n")
    assert case.scenario.controller.parameters == {"cycles": 4}
    (case,) = loaded(f"{head}controller: {{library: libwsp.so, parameters: {{kp: 1}}}}\n")
    program = case.scenario.controller.program
    assert program is not None
    assert program.options["parameters"] == "asked"


@pytest.mark.usefixtures("programs")
@pytest.mark.parametrize("program", ["python: plain.py, class: Wsp", "connect: 'tcp://rig:1'"])
def test_where_nothing_is_declared_the_lines_to_write_are_shown(refused, loaded, head, program):
    given = "parameters: {kp: 0.5, mode: fast}"
    (error,) = refused(f"{head}controller: {{{program}, {given}}}\n")
    assert "declares no parameters, given: kp, mode" in error.message
    lines = "declared_parameters: {kp: {default: NUMBER, unit: UNIT}, mode: {default: TEXT}}"
    assert lines in error.hint
    lines = lines.replace("NUMBER", "0.5").replace("UNIT", "s").replace("TEXT", "fast")
    assert "free_parameters: true" in error.hint
    (case,) = loaded(f"{head}controller: {{{program}, {lines}}}\n")
    assert case.scenario.controller.parameters == {"kp": 0.5, "mode": "fast"}
    (case,) = loaded(f"{head}controller: {{{program}, {given}, free_parameters: true}}\n")
    assert case.scenario.controller.parameters == {"kp": 0.5, "mode": "fast"}


@pytest.mark.parametrize(
    ("declarations", "key", "message"),
    [
        ('{"kp": {"default": 1.0}}', "PARAMETERS.kp", "a number needs a unit"),
        ('{"kp": {"unit": "s"}}', "PARAMETERS.kp.default", "missing key 'default'"),
        ('{"kp": {"default": 1, "unit": "s", "rnage": [0, 1]}}', "PARAMETERS.kp.rnage", "unknown key"),
        ('{"kp": {"default": 1, "unit": "s", "range": [2, 0]}}', "PARAMETERS.kp.range", "its smallest"),
        ('{"kp": {"default": 3, "unit": "s", "range": [0, 2]}}', "PARAMETERS.kp.default", "out of range"),
        ('{"kp": {"default": gain(), "unit": "s"}}', "PARAMETERS", "'gain()' is no literal"),
        ('{"kp": {"default": 1e999, "unit": "s"}}', "PARAMETERS.kp.default", "JSON has no number inf"),
        ('{"kp": {"default": %s1, "unit": "s"}}' % ("1 + " * 900), "PARAMETERS", "is no literal"),
        ('{"kp": {"default": %s1, "unit": "s"}}' % ("-" * 900), "PARAMETERS", "is no literal"),
        ('{"kp": {"default": a%s, "unit": "s"}}' % (".a" * 900), "PARAMETERS", "is no literal"),
        ('{"kp": 1.0}', "PARAMETERS.kp", "expected a mapping"),
        ("[1]", "PARAMETERS", "expected a mapping"),
        ("{1: 2}", "PARAMETERS", "are texts"),
        ("{**other}", "PARAMETERS", "are texts"),
    ],
)
def test_declarations_that_cannot_be_read_name_the_line_of_the_program(
    refused, write, head, declarations, key, message
):
    write("wsp.py", f"class Wsp: ...\nPARAMETERS = {declarations}\n".encode())
    errors = refused(f"{head}controller: {{python: wsp.py, class: Wsp}}\n")
    error = next(each for each in errors if each.key == key)
    assert message in error.message
    assert (error.file, error.line) == ("wsp.py", 2)


@pytest.mark.parametrize("content", [b"'''\nPARAMETERS = no example\n'''\n", b"PARAMETERS: dict\n"])
def test_a_file_without_declarations_is_no_error_of_its_own(loaded, write, head, content):
    write("wsp.py", content + b"class Wsp: ...\n")
    assert loaded(f"{head}controller: {{python: wsp.py, class: Wsp}}\n")


@pytest.mark.parametrize("content", [b"PARAMETERS = (", b"\x00PARAMETERS"])
def test_the_declarations_of_a_file_that_is_no_python_are_no_error_of_their_own(
    refused, write, head, content
):
    write("wsp.py", content)
    (error,) = refused(f"{head}controller: {{python: wsp.py, class: Wsp}}\n")
    assert (error.file, error.key) == ("wsp.py", "")
    assert bool(error.excerpt) == (b"\0" not in content)


def test_of_a_large_file_only_the_declarations_are_parsed(write, head, refused, monkeypatch):
    parsed = []
    parse = ast.parse
    monkeypatch.setattr(ast, "parse", lambda text: (parsed.append(len(text)), parse(text))[1])
    rest = b"x = [1, 2, 3]\n" * 100_000
    write("wsp.py", rest + b'PARAMETERS = {"kp": {"default": gain(), "unit": "s"}}\n' + rest)
    (error,) = refused(f"{head}controller: {{python: wsp.py, class: Wsp}}\n")
    assert (error.file, error.line, error.column) == ("wsp.py", 100_001, 33)
    assert "'gain()' is no literal" in error.message
    assert max(parsed) < 100


def test_what_an_fmu_does_not_state_bounds_nothing(loaded, write, head, fmu):
    write("two.fmu", fmu(FMI2.replace('min="0" max="1"', 'min="NaN" max="1"')))
    (case,) = loaded(f"{head}controller: {{fmu: two.fmu, parameters: {{upper_slide: 0.5}}}}\n")
    assert case.scenario.controller.parameters == {"upper_slide": 0.5}
    for content in (b"no archive", fmu("<fmiModel"), fmu("nothing")):
        write("wsp.fmu", content)
        assert loaded(f"{head}controller: {{fmu: wsp.fmu, parameters: {{kp: 1}}}}\n")


@pytest.mark.usefixtures("programs")
def test_parameters_of_a_command_line_and_of_a_part_that_extends_another_are_checked_alike(
    write, head, refused
):
    write(
        "ours.yaml",
        f"schema: uictest/controller/1\nname: ours\nlibrary: libwsp.so\ndeclared_parameters: {LISTED}\n",
    )
    (error,) = refused(f"{head}controller: {{extends: ours.yaml, parameters: {{uper_slide: 0.1}}}}\n")
    assert error.hint == "did you mean upper_slide?"
    part = load_controller(
        str(write("ours.yaml", "schema: uictest/controller/1\npython: wsp.py\nclass: Wsp\n"))
    )
    assert with_parameters(part, {"cycles": 5}).parameters["cycles"] == 5
    with pytest.raises(ScenarioErrors, match="did you mean cycles"):
        with_parameters(part, {"cycle": 5})
