"""Short stops in a working folder of their own, run by the command and in Python."""

from pathlib import Path

import pytest

from uictest.cli.entry import execute


@pytest.fixture(autouse=True)
def workplace(tmp_path, monkeypatch):
    """A working folder of its own."""
    monkeypatch.chdir(tmp_path)
    monkeypatch.delenv("GITHUB_STEP_SUMMARY", raising=False)
    return tmp_path


@pytest.fixture
def write(workplace):
    """Write a short stop below scenarios/ of the working folder."""
    return write_stop


def write_stop(name="stop", text="", rail="{condition: wet, friction: 0.06}"):
    """Write a short stop below scenarios/, with more lines of YAML where a test wants them."""
    path = Path("scenarios", f"{name}.yaml")
    path.parent.mkdir(exist_ok=True)
    head = f"schema: uictest/scenario/1\nname: {name}\ninitial_speed: 30 km/h\n"
    path.write_text(f"{head}rail: {rail}\ncriteria: [uictest-stop]\n{text}")
    return path


@pytest.fixture
def command(capsys):
    """Call the program in this process and return its exit code; what it prints is dropped."""

    def call(*arguments):
        code = int(execute([str(argument) for argument in arguments]))
        capsys.readouterr()
        return code

    return call
