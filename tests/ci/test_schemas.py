"""Every file keeps to the public schema of its service; the schemas come with check-jsonschema."""

import subprocess
import sys

import pytest
import yaml
from pre_commit.clientlib import load_config, load_manifest

from .conftest import REPOSITORY, blocks_of_page, gitlab_component, used_inputs


def errors(file, schema):
    command = [sys.executable, "-m", "check_jsonschema", "--builtin-schema", schema, str(file)]
    done = subprocess.run(command, capture_output=True, text=True, check=False)
    return done.stdout if done.returncode else ""


@pytest.mark.parametrize(
    ("name", "schema"),
    [("action.yml", "vendor.github-actions"), ("examples/ci/github.yml", "vendor.github-workflows")],
)
def test_github(name, schema):
    assert errors(REPOSITORY / name, schema) == ""


def test_the_gitlab_component_is_a_pipeline_once_its_inputs_are_given(tmp_path):
    _, jobs = gitlab_component(version="0.2.0")
    file = tmp_path / "pipeline.yml"
    file.write_text(yaml.safe_dump(jobs), "utf-8")
    assert errors(file, "vendor.gitlab-ci") == ""


def test_the_gitlab_component_declares_inputs(tmp_path):
    inputs, _ = gitlab_component(version="0.2.0")
    file = tmp_path / "header.yml"
    file.write_text(yaml.safe_dump({"spec": {"inputs": inputs}}), "utf-8")
    assert errors(file, "vendor.gitlab-ci") == ""


def test_the_inputs_of_the_gitlab_component_are_those_that_it_uses():
    inputs, _ = gitlab_component(version="0.2.0")
    assert set(inputs) == used_inputs()


@pytest.mark.parametrize("name", [name for name in blocks_of_page() if name != ".pre-commit-config.yaml"])
def test_files_on_the_page(name, tmp_path):
    file = tmp_path / "file.yml"
    file.write_text(blocks_of_page()[name], "utf-8")
    schema = "vendor.github-workflows" if name.startswith(".github/") else "vendor.gitlab-ci"
    assert errors(file, schema) == ""


def test_pre_commit(tmp_path):
    assert [hook["id"] for hook in load_manifest(str(REPOSITORY / ".pre-commit-hooks.yaml"))] == [
        "uictest-check"
    ]
    file = tmp_path / "config.yaml"
    file.write_text(blocks_of_page()[".pre-commit-config.yaml"], "utf-8")
    assert load_config(str(file))["repos"]
