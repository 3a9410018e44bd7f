"""Arguments that name nothing that can be read: a usage error, whichever command they are given to."""

from pathlib import Path

import pytest

from uictest.core.recording import parquet_bytes

from .conftest import rolling_train

LONG = "n" * 300
COMMANDS = {
    "run": ["run", "PATH"],
    "run of a series": ["run", "PATH.series.yaml"],
    "run, last failed": ["run", "scenarios", "--lf", "--dry-run", "-o", "PATH"],
    "run, baseline": ["run", "scenarios", "--baseline", "PATH"],
    "check": ["check", "PATH"],
    "list": ["list", "PATH"],
    "list, requirements": ["list", "--requirements", "--requirement-list", "PATH", "scenarios"],
    "evaluate": ["evaluate", "PATH", "--scenario", "scenarios/stop.yaml"],
    "evaluate, map": ["evaluate", "stop.parquet", "--scenario", "scenarios/stop.yaml", "--map", "PATH.yaml"],
    "export": ["export", "PATH", "--to", "csv"],
    "bench": ["bench", "PATH"],
    "report": ["report", "PATH"],
    "open": ["open", "PATH"],
    "open, output": ["open", "-o", "PATH"],
    "compare": ["compare", "PATH", "stop.parquet"],
    "controller check": ["controller", "check", "PATH"],
}
PATHS = {
    "too long": LONG,
    "below one too long": f"{LONG}/inner",
    "through a file": "file/inner",
    "through nothing": "/proc/none/inner",
    "in a circle": "circle",
}


@pytest.fixture(autouse=True)
def stop(workplace):
    Path("stop.parquet").write_bytes(parquet_bytes(rolling_train(0.1)))


@pytest.mark.parametrize("path", PATHS.values(), ids=PATHS)
@pytest.mark.parametrize("arguments", COMMANDS.values(), ids=COMMANDS)
def test_a_path_that_cannot_be_is_a_usage_error_before_anything_is_simulated(
    call, scenario, made_up, arguments, path
):
    scenario("stop")
    Path("file").touch()
    Path("circle").symlink_to("circle")
    answer = call(*(argument.replace("PATH", path) for argument in arguments))
    if answer.code == 0:  # no earlier run
        assert "--lf" in arguments
        return
    assert answer.code == 4, answer.err
    assert "internal error" not in answer.err
    assert made_up == []


@pytest.mark.parametrize(
    ("name", "arguments"),
    [
        ("results.json", ["run", "--baseline", "deep"]),
        ("manifest.json", ["compare", "deep", "deep"]),
        ("sweep.json", ["report", "deep"]),
    ],
)
def test_json_nested_deeper_than_it_can_be_read_is_a_usage_error(call, scenario, name, arguments):
    scenario("stop")
    Path("deep").mkdir()
    Path("deep", name).write_text("[" * 100_000)
    answer = call(*arguments, code=4)
    assert "internal error" not in answer.err


def test_an_error_of_the_machine_stays_one(call, scenario, monkeypatch):
    def full(*arguments, **options):
        raise OSError(28, "No space left on device", "reports/x")

    monkeypatch.setattr("uictest.runs.load_cases_and_series", full)
    scenario("stop")
    assert call("run", "-o", "reports").code == 3
