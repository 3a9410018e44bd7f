"""`--junitxml` where a command ends without results: its file says so, in place of one of an earlier run."""

from pathlib import Path
from xml.etree import ElementTree

import pytest

from ..report import junit_schema
from .conftest import STATED

HEAD = "schema: uictest/scenario/1\nname: {}\n"
STOP = HEAD.format("stop") + "initial_speed: 30 km/h\n"
STALE = '<testsuites><testsuite name="green" tests="0" failures="0" errors="0"/></testsuites>'


@pytest.fixture(params=["missing", "stale", "empty"])
def junit(request):
    """The file of `--junitxml`, which an earlier run may have left."""
    path = Path("junit.xml")
    if request.param != "missing":
        path.write_text(STALE if request.param == "stale" else "")
    return path


def errors_in(path):
    root = ElementTree.parse(path).getroot()
    junit_schema.check(root)
    assert [suite.get("errors") for suite in root] == [str(len(root.findall(".//testcase")))]
    return {case.get("name"): case.find("error").get("message") for case in root.iter("testcase")}


def test_every_invalid_file_is_a_testcase_in_error_whose_text_has_all_of_its_errors(call, junit):
    Path("speed.yaml").write_text(HEAD.format("a") + "initial_sped: 3\n")
    Path("syntax.yaml").write_text("schema: [\n")
    Path("valid.yaml").write_text(STOP)
    said = call("run", "speed.yaml", "syntax.yaml", "valid.yaml", "--junitxml", junit, code=4).err
    found = errors_in(junit)
    assert list(found) == ["speed.yaml", "syntax.yaml"]
    assert all(message.startswith(f"{name}:") for name, message in found.items())
    texts = [each.text for each in ElementTree.parse(junit).getroot().iter("error")]
    assert "\n".join(texts).splitlines() == said.splitlines()
    assert "speed.yaml:3:1: initial_sped: unknown key" in texts[0]


@pytest.mark.parametrize(
    ("arguments", "code", "name", "message"),
    [
        (("run", "stop.yaml", "-k", "nothing"), 5, "uictest run", "exit code 5: nothing selected"),
        (("run", "stop.yaml", "--repaet", "3"), 4, "uictest run", "No such option: --repaet"),
        (("run", "gone.yaml"), 4, "gone.yaml", "gone.yaml:1:1: no such file"),
        (("run", "stop.yaml", "--set", "seed"), 4, "--set", "--set:1:1: 'seed' is not a key and a value"),
        (("sweep", "stop.yaml"), 4, "stop.yaml", "stop.yaml:1:1: vary: nothing varies"),
        (("evaluate", "gone.csv"), 4, "uictest evaluate", "a recording does not say what was tested"),
        (("evaluate", "gone.csv", *STATED), 4, "uictest evaluate", "gone.csv"),
        (("selftest", "all"), 4, "uictest selftest", "Got unexpected extra argument"),
        (("controller", "check", "gone.py"), 4, None, "gone.py"),
    ],
)
def test_whatever_keeps_a_command_from_its_results_is_an_error(call, junit, arguments, code, name, message):
    Path("stop.yaml").write_text(STOP)
    call(*arguments, f"--junitxml={junit}", code=code)
    ((found, text),) = errors_in(junit).items()
    assert name in (None, found)
    assert message in text


def test_an_error_of_the_program_and_an_interrupt_are_told_too(call, junit, monkeypatch):
    for error, code, message in (
        (KeyboardInterrupt(), 2, "exit code 2: interrupted"),
        (ZeroDivisionError("x"), 3, "internal error: ZeroDivisionError: x"),
    ):

        def raises(*_, error=error):
            raise error

        monkeypatch.setattr("uictest.cli.commands.run.runs.load_cases_and_series", raises)
        call("run", "stop.yaml", "--junitxml", junit, code=code)
        assert errors_in(junit) == {"uictest run": message}


def test_its_folder_is_made_and_a_link_is_told_beside_the_reason(call):
    call("run", "gone.yaml", "-o", "reports", "--junitxml", "reports/junit.xml", code=4)
    assert list(errors_in(Path("reports/junit.xml"))) == ["gone.yaml"]
    Path("target.xml").write_text(STALE)
    Path("link.xml").symlink_to("target.xml")
    said = call("run", "gone.yaml", "--junitxml", "link.xml", code=4).err
    assert "gone.yaml:1:1: no such file" in said
    assert "cannot write link.xml: is a link" in said
    assert Path("target.xml").read_text() == STALE


@pytest.mark.parametrize("arguments", [("run",), ("run", "stop.yaml"), ("run", "gone.yaml")])
def test_a_file_that_holds_no_xml_is_never_replaced(call, arguments):
    Path("stop.yaml").write_text(STOP)
    Path("own.yaml").write_text("mine: true\n")
    call(*arguments, "--junitxml", "own.yaml", code=4)
    assert Path("own.yaml").read_text() == "mine: true\n"


def test_a_command_without_this_option_and_a_dry_run_leave_the_file_alone(call):
    Path("stop.yaml").write_text(STOP)
    Path("junit.xml").write_text(STALE)
    call("check", "stop.yaml", "--junitxml", "junit.xml", code=4)
    call("run", "stop.yaml", "--dry-run", "--junitxml", "junit.xml", code=0)
    assert Path("junit.xml").read_text() == STALE


@pytest.mark.parametrize("name", ["\udcff.xml", "a\0.xml", "x" * 300, "", "--junitxml"])
def test_a_name_that_no_file_can_have_changes_no_exit_code(call, name):
    call("run", "gone.yaml", "--junitxml", name, code=4)


@pytest.mark.parametrize("file", ["junit.xml", "out/junit.xml", "out/latest/other.xml"])
def test_it_is_written_where_it_is_wanted_and_as_in_the_reports(call, scenario, made_up, file):
    scenario("a", "tags: [fail]\n")
    call("run", "--junitxml", file, "-o", "out", code=1)
    assert ElementTree.parse(file).find("testsuite/testcase/failure") is not None
    assert Path("out/latest/junit.xml").read_text() == Path(file).read_text()
