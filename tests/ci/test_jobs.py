"""What the jobs run, run here by the shell that the service would start: arguments, exit codes, files."""

import os
import re
import subprocess
from pathlib import Path
from xml.etree import ElementTree

import pytest

import uictest

from .conftest import HANGING, REPOSITORY, SCENARIO, TOOLS, action, gitlab_component

_SCENARIOS = {0: "", 1: "expect: fail\n", 4: "brake: {command: 200 %}\n"}
"""Exit code -> what a scenario says that ends with it."""
_JENKINS_RUN = re.compile(r"script: '\.venv/bin/(uictest run [^']*)'")


def bash(script, **environment):
    """Run a script as GitHub and GitLab do: it ends at the first command that fails."""
    command = ["bash", "--noprofile", "--norc", "-eo", "pipefail", "-c", script]
    return subprocess.run(
        command,
        capture_output=True,
        text=True,
        check=False,
        timeout=HANGING,
        env={**os.environ, **environment},
    )


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


def cache_step():
    [cache] = [step["with"] for step in action()["runs"]["steps"] if "cache@" in step.get("uses", "")]
    return dict(cache)


def test_the_github_action_keeps_the_folder_in_which_the_program_puts_compiled_code(job):
    [installed] = [step for step in action()["runs"]["steps"] if step.get("id") == "installed"]
    files = {name: str(job / name) for name in ("GITHUB_OUTPUT", "GITHUB_ENV")}
    assert bash(installed["run"], HOME="/home/runner", **files).returncode == 0
    assert (job / "GITHUB_OUTPUT").read_text("utf-8") == f"version={uictest.__version__}\n"
    assert (job / "GITHUB_ENV").read_text("utf-8") == "UICTEST_CACHE=/home/runner/.cache/uictest\n"
    assert cache_step()["path"] == "~/.cache/uictest"


def test_a_job_restores_the_newest_code_of_its_kind_and_keeps_its_own():
    first = {
        "runner.os": "Linux",
        "runner.arch": "X64",
        "inputs.python-version": "3.12",
        "steps.installed.outputs.version": "0.3.0.dev0",
        "github.run_id": "17",
        "github.run_attempt": "1",
        "github.job": "rig",
    }
    key, restored = keys(first)
    assert key.startswith(restored)
    for name, other in (("run_id", "18"), ("run_attempt", "2"), ("job", "wsp")):
        later, restored_later = keys({**first, f"github.{name}": other})
        assert (later == key, restored_later) == (False, restored)
    for name, other in (
        ("runner.os", "Windows"),
        ("runner.arch", "ARM64"),
        ("inputs.python-version", "3.1"),
        ("steps.installed.outputs.version", "0.3.0"),
    ):
        assert not key.startswith(keys({**first, name: other})[1])


def keys(values):
    """Return the key under which a job keeps the cache, and the beginning of those that it restores."""
    filled = [
        re.sub(r"\$\{\{ (\S+) \}\}", lambda name: values[name[1]], cache_step()[key])
        for key in ("key", "restore-keys")
    ]
    return tuple(filled)


@pytest.mark.parametrize("folders", ["one two", "one\ntwo\n"], ids=["a line", "lines"])
def test_the_github_action_runs_several_folders(job, folders):
    (job / "scenarios").rename(job / "one")
    (job / "two").mkdir()
    (job / "two" / "again.yaml").write_text(SCENARIO.format(name="again", text=""), "utf-8")
    inputs = {"SCENARIOS": folders, "OPTIONS": "", "OUTPUT": "out"}
    done = bash(run_step()["run"], GITHUB_OUTPUT=str(job / "outputs"), **inputs)
    assert "2 cases: 2 pass" in done.stderr


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
