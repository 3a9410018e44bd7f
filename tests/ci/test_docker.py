"""The image: its file has no known defect, and the build gets what it needs and nothing else."""

import subprocess
from pathlib import Path

from .conftest import REPOSITORY, TOOLS, made_of


def test_no_known_defect():
    command = [TOOLS / "hadolint", REPOSITORY / "Dockerfile"]
    done = subprocess.run(command, capture_output=True, text=True, check=False)
    assert (done.returncode, done.stdout) == (0, "")


def test_the_image_does_not_run_as_root():
    lines = (REPOSITORY / "Dockerfile").read_text("utf-8").splitlines()
    users = [line.split()[1] for line in lines if line.startswith("USER ")]
    assert users == ["1000"]
    assert any(f"--uid {users[0]}" in line for line in lines)


def test_the_build_gets_every_file_that_the_package_is_made_of():
    kept = {
        line[1:] for line in (REPOSITORY / ".dockerignore").read_text("utf-8").splitlines() if line[0] == "!"
    }
    assert kept == made_of()
    assert all(Path(REPOSITORY, name).exists() for name in kept)
