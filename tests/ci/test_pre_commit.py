"""The pre-commit hook, run by pre-commit in a project of somebody else."""

import os
import shutil
import subprocess
import sys

import pytest

from .conftest import HANGING, REPOSITORY, SCENARIO, made_of


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
