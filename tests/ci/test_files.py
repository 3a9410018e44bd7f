"""Files for CI services: each keeps to the schema of its service, and the pre-commit hook runs."""

import os
import shutil
import subprocess
import sys
from pathlib import Path

import pytest
import yaml
from pre_commit.clientlib import load_config, load_manifest

from .conftest import (
    HANGING,
    REPOSITORY,
    SCENARIO,
    TOOLS,
    blocks_of_page,
    gitlab_component,
    made_of,
    used_inputs,
)


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


def test_the_gitlab_component_is_a_pipeline_and_declares_the_inputs_that_it_uses(tmp_path):
    inputs, jobs = gitlab_component(version="0.2.0")
    file = tmp_path / "pipeline.yml"
    for content in (jobs, {"spec": {"inputs": inputs}}):
        file.write_text(yaml.safe_dump(content), "utf-8")
        assert errors(file, "vendor.gitlab-ci") == ""
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


def test_the_image_has_no_known_defect_no_root_and_is_built_of_every_file_of_the_package():
    command = [TOOLS / "hadolint", REPOSITORY / "Dockerfile"]
    done = subprocess.run(command, capture_output=True, text=True, check=False)
    assert (done.returncode, done.stdout) == (0, "")
    lines = (REPOSITORY / "Dockerfile").read_text("utf-8").splitlines()
    users = [line.split()[1] for line in lines if line.startswith("USER ")]
    assert users == ["1000"]
    assert any(f"--uid {users[0]}" in line for line in lines)
    ignored = (REPOSITORY / ".dockerignore").read_text("utf-8").splitlines()
    kept = {line[1:] for line in ignored if line[0] == "!"}
    assert kept == made_of()
    assert all(Path(REPOSITORY, name).exists() for name in kept)


def git(folder, *arguments):
    identity = ["-c", "user.name=t", "-c", "user.email=t@example.org", "-c", "commit.gpgsign=false"]
    command = ["git", *identity, *arguments]
    subprocess.run(command, cwd=folder, check=True, capture_output=True)


def commit_all(folder):
    """Make a folder a repository with one commit."""
    git(folder, "init", "-q")
    git(folder, "add", "--all")
    git(folder, "commit", "-q", "-m", "all")
    git(folder, "tag", "v1")


def hook(project):
    """Run the hook as `git commit` would."""
    command = [sys.executable, "-m", "pre_commit", "run", "--color", "never"]
    environment = {**os.environ, "PRE_COMMIT_HOME": str(project.parent / "pre-commit")}
    return subprocess.run(
        command, cwd=project, capture_output=True, text=True, check=False, timeout=HANGING, env=environment
    )


def project_with(folder, hooks, *, language):
    """Return a project whose configuration names the hook in the repository `hooks`."""
    folder.mkdir()
    entry = f"{{id: uictest-check, language: {language}}}"
    config = f"repos:\n  - repo: {hooks}\n    rev: v1\n    hooks: [{entry}]\n"
    (folder / ".pre-commit-config.yaml").write_text(config, "utf-8")
    (folder / "scenarios").mkdir()
    (folder / "scenarios" / "stop.yaml").write_text(SCENARIO.format(name="stop", text=""), "utf-8")
    commit_all(folder)
    return folder


def check_hook(project):
    """Add a broken scenario, then mend it, then change a file that is none."""
    scenario = project / "scenarios" / "new.yaml"
    scenario.write_text(SCENARIO.format(name="new", text="brake: {command: 200 %}\n"), "utf-8")
    git(project, "add", "--all")
    done = hook(project)
    assert done.returncode == 1, done.stdout + done.stderr
    assert "scenarios/new.yaml:4:18: " in done.stdout
    scenario.write_text(SCENARIO.format(name="new", text=""), "utf-8")
    git(project, "add", "--all")
    done = hook(project)
    assert (done.returncode, "Passed" in done.stdout) == (0, True), done.stdout + done.stderr
    git(project, "commit", "-q", "-m", "mended")
    (project / "notes.yaml").write_text("a: 1\n", "utf-8")
    git(project, "add", "--all")
    assert "Skipped" in hook(project).stdout


@pytest.mark.usefixtures("job")
def test_the_hook_checks_the_folder_of_scenarios(tmp_path):
    """With the program on the path: `language: system` makes no environment, so nothing is downloaded."""
    hooks = tmp_path / "hooks"
    hooks.mkdir()
    shutil.copy(REPOSITORY / ".pre-commit-hooks.yaml", hooks)
    commit_all(hooks)
    check_hook(project_with(tmp_path / "project", hooks, language="system"))


@pytest.mark.slow
def test_pre_commit_installs_what_the_hook_needs(tmp_path):
    """Downloads the dependencies. The repository has no more files than the image is built of."""
    hooks = tmp_path / "hooks"
    hooks.mkdir()
    shutil.copy(REPOSITORY / ".pre-commit-hooks.yaml", hooks)
    for name in made_of():
        copy = shutil.copytree if (REPOSITORY / name).is_dir() else shutil.copy
        copy(REPOSITORY / name, hooks / name)
    commit_all(hooks)
    check_hook(project_with(tmp_path / "project", hooks, language="python"))
