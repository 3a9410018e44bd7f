"""The parts for CI services: files of the repository, and the program on the path as a job finds it."""

import os
import re
import sysconfig
import tomllib
from pathlib import Path

import pytest
import yaml

REPOSITORY = Path(__file__).parents[2]
TOOLS = Path(sysconfig.get_path("scripts"))
HANGING = 900.0
"""Seconds after which a test takes something for hanging: no machine is so busy that it takes this long."""
SCENARIO = "schema: uictest/scenario/1\nname: {name}\ninitial_speed: 30 km/h\n{text}"
_INPUT = re.compile(r"\$\[\[ inputs\.(\w+) \]\]")


def made_of():
    """Return the files and folders of the repository that the package is built from."""
    settings = tomllib.loads((REPOSITORY / "pyproject.toml").read_text("utf-8"))
    wheel = settings["tool"]["hatch"]["build"]["targets"]["wheel"]
    packed = {Path(name).parts[0] for name in (*wheel["packages"], *wheel["force-include"])}
    stated = {"pyproject.toml", settings["project"]["readme"], *settings["project"]["license-files"]}
    return packed | stated | {"hatch_build.py", "kernel"}  # the hook, and what it calls


@pytest.fixture
def job(tmp_path, monkeypatch):
    """The working folder of a job: one scenario, the program on the path, and a pip that installs nothing."""
    monkeypatch.chdir(tmp_path)
    (tmp_path / "scenarios").mkdir()
    (tmp_path / "scenarios" / "stop.yaml").write_text(SCENARIO.format(name="stop", text=""), "utf-8")
    pip = tmp_path / "bin" / "pip"
    pip.parent.mkdir()
    pip.write_text("#!/bin/sh\n", "utf-8")
    pip.chmod(0o755)
    path = [str(pip.parent), str(TOOLS), os.environ["PATH"]]
    monkeypatch.setenv("PATH", os.pathsep.join(path))
    monkeypatch.delenv("GITHUB_STEP_SUMMARY", raising=False)
    return tmp_path


def gitlab_component(**given):
    """Return the inputs that the GitLab component declares, and its jobs with inputs filled in."""
    text = (REPOSITORY / "templates" / "uictest" / "template.yml").read_text("utf-8")
    header, _, body = text.partition("\n---\n")
    inputs = yaml.safe_load(header)["spec"]["inputs"]
    values = {name: given.get(name, declared.get("default")) for name, declared in inputs.items()}
    return inputs, yaml.safe_load(_INPUT.sub(lambda match: values[match[1]], body))


def used_inputs():
    """Return the inputs that the jobs of the GitLab component use."""
    return set(_INPUT.findall((REPOSITORY / "templates" / "uictest" / "template.yml").read_text("utf-8")))


def action():
    """Return the GitHub action."""
    return yaml.safe_load((REPOSITORY / "action.yml").read_text("utf-8"))


def blocks_of_page():
    """Return the YAML files that docs/ci.md shows, by name."""
    page = (REPOSITORY / "docs" / "ci.md").read_text("utf-8")
    return dict(re.findall(r"^```yaml\n# (\S+)\n(.*?)^```$", page, re.MULTILINE | re.DOTALL))
