"""`uictest bench`."""

import numpy as np
import pytest

from uictest.core.recording import ORIGIN, Recording, parquet_bytes, read_parquet

RECIPE = """\
schema: uictest/bench/1
name: short
inputs:
  - {kind: triangular, peaks: [2 bar], floor: 0 bar, ramp: 0.5 s}
"""


@pytest.fixture
def recipe(workplace):
    path = workplace / "short.yaml"
    path.write_text(RECIPE, "utf-8")
    return path


def test_a_recipe_leaves_a_recording_and_a_summary(call, recipe, workplace):
    answer = call("bench", "short.yaml", code=0)
    assert "largest error against module 1" in answer.out
    recording = read_parquet(workplace / "short.parquet")
    assert recording["clamping_force_1"].max() > 1000.0
    assert "sha256 of short.yaml" in recording.metadata
    assert recording.metadata[ORIGIN] == "simulated caliper"


def test_the_same_recipe_gives_the_same_recording(call, recipe, workplace):
    for name in ("a", "b"):
        assert call("bench", "short.yaml", "-o", f"{name}.parquet").code == 0
    assert (workplace / "a.parquet").read_bytes() == (workplace / "b.parquet").read_bytes()


def test_a_csv_is_written_for_a_name_in_csv(call, recipe, workplace):
    assert call("bench", "short.yaml", "-o", "short.csv").code == 0
    assert "tank_pressure_1 [Pa]" in (workplace / "short.csv").read_text("utf-8")


@pytest.mark.parametrize("suffix", ["csv", "parquet"])
def test_a_recorded_pressure_is_demanded(call, workplace, suffix):
    time = np.arange(0.0, 2.001, 0.01)
    demand = np.minimum(time, 1.0) * 2.0
    if suffix == "csv":
        rows = "\n".join(f"{t:.2f},{p:.3f}" for t, p in zip(time, demand, strict=True))
        (workplace / "demand.csv").write_text(f"time [s],demand [bar]\n{rows}\n", "utf-8")
    else:
        channels = {"time": time, "demand": demand}
        (workplace / "demand.parquet").write_bytes(
            parquet_bytes(Recording(channels, {"time": "s", "demand": "bar"}))
        )
    call("bench", "--trace", f"demand.{suffix}", "--pressure", "demand", "-o", "out.parquet", code=0)
    recording = read_parquet(workplace / "out.parquet")
    assert recording["demanded_pressure"][-1] == pytest.approx(2e5)
    assert recording["brake_line_pressure"][-1] == pytest.approx(2e5, rel=0.02)


def test_the_recipes_of_the_library_are_listed_with_its_parts(call):
    listed = set(call("library", "list", code=0).out.split())
    assert {f"benches/{name}" for name in ("stepwise", "triangular", "random", "wsp-cycling")} <= listed
