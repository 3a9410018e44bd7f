"""What the jobs run, run here by the shell that the service would start: arguments, exit codes, files."""

import os
import re
import subprocess
from pathlib import Path
from xml.etree import ElementTree

import pytest

from .conftest import HANGING, REPOSITORY, SCENARIO, TOOLS, action, gitlab_component

_SCENARIOS = {0: "", 1: "expect: fail\n", 4: "brake: {command: 200 %}\n"}
"""Exit code -> what a scenario says that ends with it."""
_JENKINS_RUN = re.compile(r"script: '\.venv/bin/(uictest run [^']*)'")


def bash(script, **environment):
    """Run a script as GitHub and GitLab do: it ends at the first command that fails."""
    command = ["bash", "--noprofile", "--norc", "-eo", "pipefail", "-c", script]
    options = {"capture_output": True, "text": True, "check": False, "timeout": HANGING}
    return subprocess.run(command, **options, env={**os.environ, **environment})


def run_step():
    [step] = [step for step in action()["runs"]["steps"] if step.get("id") == "run"]
    return dict(step)


@pytest.mark.parametrize("code", _SCENARIOS)
def test_the_github_action_hands_on_the_exit_code(job, code):
    (job / "scenarios/stop.yaml").write_text(SCENARIO.format(name="stop", text=_SCENARIOS[code]), "utf-8")
    inputs = {"SCENARIOS": "scenarios", "OPTIONS": "--maxfail 3 --record none", "OUTPUT": "out"}
    done = bash(run_step()["run"], GITHUB_OUTPUT=str(job / "outputs"), **inputs)
    assert done.returncode == code, done.stderr
    assert (job / "outputs").read_text("utf-8") == f"exit-code={code}\n"
    assert ("::error" in done.stdout) == (code == 1)
    assert (job / "out" / "latest").exists() == (code != 4)


def step_named(name):
    [step] = [step for step in action()["runs"]["steps"] if step.get("name") == name]
    return step["run"]


def digest(sources, job):
    """Return what the action calls the state of its sources."""
    files = {"GITHUB_ACTION_PATH": str(sources), "GITHUB_OUTPUT": str(job / "digest")}
    (job / "digest").unlink(missing_ok=True)
    assert bash(step_named("Name the sources"), **files).returncode == 0
    return (job / "digest").read_text("utf-8")


def test_another_state_of_the_sources_has_another_wheel(job):
    sources = job / "sources"
    for name in ("src/a.py", "kernel/b.py", "scenarios/c.yaml", "pyproject.toml", "hatch_build.py"):
        (sources / name).parent.mkdir(parents=True, exist_ok=True)
        (sources / name).write_text("1", "utf-8")
    found = {digest(sources, job)}
    (sources / "src" / "__pycache__").mkdir()
    (sources / "src" / "__pycache__" / "a.pyc").write_text("1", "utf-8")
    assert {digest(sources, job)} == found
    for path in sorted(sources.rglob("*.*")):
        path.write_text("2", "utf-8")
        found.add(digest(sources, job))
    assert len(found) == 6


def test_the_github_action_builds_the_wheel_that_it_keeps_once(job):
    [cache] = [step["with"] for step in action()["runs"]["steps"] if "cache@" in step.get("uses", "")]
    assert all(name in cache["key"] for name in ("runner.os", "runner.arch", "steps.sources.outputs.digest"))
    said = job / "python.txt"
    python = job / "bin" / "python"
    made = f"mkdir -p {cache['path']}; : > {cache['path']}/uictest.whl"
    python.write_text(f'#!/bin/sh\necho "$3" >> {said}\n{made}\n', "utf-8")
    python.chmod(0o755)
    for _ in range(2):
        assert bash(step_named("Install uictest"), GITHUB_ACTION_PATH="/there").returncode == 0
    assert said.read_text("utf-8").split() == ["wheel", "install", "install"]


@pytest.mark.parametrize("folders", ["one two", "one\ntwo\n"], ids=["a line", "lines"])
def test_the_github_action_runs_several_folders(job, folders):
    (job / "scenarios").rename(job / "one")
    (job / "two").mkdir()
    (job / "two" / "again.yaml").write_text(SCENARIO.format(name="again", text=""), "utf-8")
    inputs = {"SCENARIOS": folders, "OPTIONS": "", "OUTPUT": "out"}
    done = bash(run_step()["run"], GITHUB_OUTPUT=str(job / "outputs"), **inputs)
    assert "PASSED: 2 cases: 2 pass" in done.stdout


def test_inputs_reach_the_shell_of_the_github_action_as_variables_only():
    steps = [step["run"] for step in action()["runs"]["steps"] if "run" in step]
    assert [step for step in steps if "${{" in step] == []


@pytest.mark.parametrize("code", _SCENARIOS)
def test_the_gitlab_component_ends_with_the_exit_code(job, code):
    (job / "scenarios/stop.yaml").write_text(SCENARIO.format(name="stop", text=_SCENARIOS[code]), "utf-8")
    _, jobs = gitlab_component(version="0.2.0", options="--record none")
    done = bash("\n".join(jobs["brake-rig"]["script"]))
    assert done.returncode == code, done.stderr
    kept = jobs["brake-rig"]["artifacts"]
    if code != 4:
        assert ElementTree.parse(kept["reports"]["junit"]).getroot().tag == "testsuites"
        assert all(Path(path).is_dir() for path in kept["paths"])


def test_the_jenkins_stage_runs_a_command_whose_codes_it_tells_apart(job):
    text = (REPOSITORY / "examples" / "ci" / "Jenkinsfile").read_text("utf-8")
    [command] = _JENKINS_RUN.findall(text)
    assert bash(command).returncode == 0
    assert ElementTree.parse("junit.xml").getroot().tag == "testsuites"
    (job / "scenarios/stop.yaml").write_text(SCENARIO.format(name="stop", text=_SCENARIOS[1]), "utf-8")
    assert bash(command).returncode == 1
    unstable, failed = text.index("if (code == 1)"), text.index("else if (code != 0)")
    assert unstable < text.index("unstable(") < failed < text.index("error(")


def test_scripts_have_no_shell_defects():
    _, jobs = gitlab_component(version="0.2.0")
    scripts = [step["run"] for step in action()["runs"]["steps"] if "run" in step]
    for script in [*scripts, "\n".join(jobs["brake-rig"]["script"])]:
        command = [TOOLS / "shellcheck", "--shell", "bash", "-"]
        done = subprocess.run(command, input=script, capture_output=True, text=True, check=False)
        assert done.stdout == ""
