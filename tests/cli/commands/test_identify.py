"""`uictest identify`, and what leads to it: `uictest bench` and `uictest fit`."""

import hashlib
import json
from pathlib import Path

import numpy as np
import pytest

from uictest.core.recording import ORIGIN, Recording, parquet_bytes, read_parquet
from uictest.plans.scenario import load, load_part
from uictest.rig import simulate
from uictest.rig.identification.compensation_file import load_compensation

from ..conftest import CALIPER_LINES, caliper

STEP = 0.001
RECORD = Path("record.parquet")
FOUND = Path("found.yaml")


@pytest.fixture(autouse=True)
def record(workplace):
    """The recording of a caliper with known lines, whose cylinder lags 30 ms behind the tank."""
    return change()


def change(path=RECORD, metadata=None, **channels):
    """Write that recording, some of whose channels are functions of what they were."""
    recorded = caliper()
    changed = {name: make(recorded[name]) for name, make in channels.items()}
    recording = Recording({**recorded.channels, **changed}, recorded.units, metadata or {})
    Path(path).write_bytes(parquet_bytes(recording))
    return path


def test_hysteresis_writes_a_compensation_with_provenance_and_marks(call, monkeypatch):
    command = "identify hysteresis record.parquet -o found.yaml"
    monkeypatch.setenv("SOURCE_DATE_EPOCH", "1767312000")
    assert "bc loop width" in call(*command.split(), code=0).out
    found = load_compensation(str(FOUND))
    assert (found.name, found.title) == ("record", "Compensation record")
    squeezing, releasing = (CALIPER_LINES[name] for name in ("bc_squeezing", "wsp_releasing"))
    assert found.hysteresis.bc_squeezing.slope == pytest.approx(squeezing.slope, rel=0.01)
    assert found.hysteresis.wsp_releasing.intercept == pytest.approx(releasing.intercept, abs=100.0)
    sha256 = hashlib.sha256(RECORD.read_bytes()).hexdigest()
    assert found.provenance["hysteresis date"] == "2026-01-02"
    assert found.provenance["hysteresis command"].startswith(f"uictest {command}")
    assert found.provenance["hysteresis record sha256"] == sha256
    assert found.provenance["hysteresis record origin"] == "recorded, origin not stated"
    source = found.sources[found.hysteresis.bc_squeezing.slope.source]
    assert source.mark == "identified"
    for part in ("record.parquet", sha256, f"uictest {command}", "largest"):
        assert part in source.text
    assert found.sources[found.hysteresis.wsp_acting_time.source].mark == "chosen"
    library = load_part("compensations/six-inch")
    assert tuple(found.cylinder.numerator) == tuple(library.cylinder.numerator)
    monkeypatch.delenv("SOURCE_DATE_EPOCH")
    # Facts of an earlier identification do not stay; the origin of a record is what its file states.
    change(metadata={ORIGIN: "test rig of ours"})
    call(*command.split(), "--base", "found.yaml", code=0)
    provenance = load_compensation(str(FOUND)).provenance
    assert "hysteresis date" not in provenance
    assert provenance["hysteresis record origin"] == "test rig of ours"


def test_cylinder_keeps_the_lines_of_its_base(call):
    call("identify", "hysteresis", RECORD, "-o", FOUND, code=0)
    lines = load_compensation(str(FOUND)).hysteresis
    assert "poles" in call("identify", "cylinder", RECORD, "--base", FOUND, "-o", FOUND, code=0).out
    found = load_compensation(str(FOUND))
    assert found.hysteresis == lines
    assert found.sampling_time == pytest.approx(STEP)
    assert {"hysteresis command", "cylinder command"} <= set(found.provenance)
    sha256 = hashlib.sha256(RECORD.read_bytes()).hexdigest()
    assert found.provenance["hysteresis record sha256"] == sha256
    assert found.provenance["cylinder record sha256"] == sha256


def test_a_largest_error_above_two_per_cent_is_warned_of(call):
    """Air that rings in a hose follows no lag of the third order, however small the rms error of all."""
    assert "four-caliper" not in call("identify", "cylinder", RECORD).err

    def ringing(pressure):
        bursts = np.flatnonzero(np.arange(pressure.size) % 2000 < 60)
        pressure = pressure.copy()
        pressure[bursts] += 0.15 * np.sin(bursts * 0.3)  # bar, of 4
        return pressure

    answer = call("identify", "cylinder", change(cylinder_pressure_1=ringing), code=0)
    [warning] = [line for line in answer.err.splitlines() if "largest error" in line]
    assert "above 2 %" in warning
    assert "judge with rig.topology: four-caliper" in warning


def test_a_result_is_never_silently_called_like_a_library_part_nor_written_over_its_record(call):
    RECORD.rename("Six Inch.parquet")
    command = ("identify", "hysteresis", "Six Inch.parquet", "-o")
    call(*command, "other.yaml", code=4, says="--name")
    assert not Path("other.yaml").exists()
    call(*command, "other.yaml", "--name", "ours", code=0)
    assert load_compensation("other.yaml").name == "ours"
    call(*command, "Six Inch.parquet", "--name", "ours", code=4, says="the recording itself")
    assert read_parquet(Path("Six Inch.parquet"))["time"].size == 22_001


def test_a_record_with_other_names_or_another_tank_needs_it_to_be_said(call):
    time = np.arange(0.0, 12.0, 0.005)
    pressure = 2.0 - 2.0 * np.cos(time)
    rows = "\n".join(
        f"{t:.3f},{p:.6f},{max(4.5 * p - 1.8, 0.0):.6f}" for t, p in zip(time, pressure, strict=True)
    )
    Path("m.csv").write_text(f"time [s],BC [bar],F [kN]\n{rows}\n", "utf-8")
    names = ("--pressure", "BC", "--force", "F", "--wsp", "100..101")
    assert "4.5" in call("identify", "hysteresis", "m.csv", *names, code=0).out
    tank = ("--set", "brake.system.tank.volume=4 L")
    call("bench", "wsp-cycling", *tank, "-o", "four.parquet", code=0)
    says = "brake.system.tank.volume 4 L, not 2 L; write --set 'brake.system.tank.volume=4 L'"
    call("identify", "air", "four.parquet", code=4, says=says)


SAME = caliper()["cylinder_pressure_1"]


@pytest.mark.parametrize(
    ("channel", "make", "reason"),
    [
        ("time", lambda time: time * 1e12, "runs from 0 to 2.2e+13 s with a sample every 1e+09 s"),
        ("time", lambda time: time * 1e4, "is it in ms, not in s?"),
        ("measured_pressure_2", lambda p: p * 1e307, "reaches inf bar"),
        ("measured_pressure_2", lambda p: p * np.nan, "has 22001 samples that are not numbers"),
        ("measured_pressure_2", lambda p: -p, "never above zero"),
        ("measured_pressure_2", lambda p: 4.0 - p, "does not follow from the tank pressure"),
        ("measured_pressure_2", lambda p: SAME, "the same, sample by sample"),
        ("clamping_force_1", lambda force: 0.0 * force + 5.0, "the force varies by 0 N only"),
        ("clamping_force_1", lambda force: np.minimum(force, 3.0), "does not follow from the pressure"),
        ("valve_command_1", lambda command: command + 7.3, "a valve command is 0 fill, 1 hold or 2 vent"),
        (
            "clamping_force_1",
            # Numbers that a scenario would reject.
            lambda force: np.maximum(4.5 * np.roll(SAME, -round(0.05 / STEP)) - 1.7, 0.0),
            "the squeezing line must lie below the releasing line",
        ),
    ],
)
def test_a_record_that_supports_nothing_is_refused_with_the_reason(call, channel, make, reason):
    change(**{channel: make})
    kind = "cylinder" if channel == "measured_pressure_2" else "hysteresis"
    answer = call("identify", kind, RECORD, "-o", FOUND, code=4, says=reason)
    assert "uictest: record.parquet: " in answer.err
    assert "Warning" not in answer.err
    assert not FOUND.exists()


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


def test_a_recipe_leaves_a_summary_and_the_same_recording_each_time_or_a_csv(call, recipe, workplace):
    answer = call("bench", "short.yaml", code=0)
    assert "largest error against module 1" in answer.out
    recording = read_parquet(workplace / "short.parquet")
    assert recording["clamping_force_1"].max() > 1000.0
    assert "sha256 of short.yaml" in recording.metadata
    assert recording.metadata[ORIGIN] == "simulated caliper"
    for name in ("a", "b"):
        assert call("bench", "short.yaml", "-o", f"{name}.parquet").code == 0
    assert (workplace / "a.parquet").read_bytes() == (workplace / "b.parquet").read_bytes()
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


WET = "rail: {condition: wet, friction: 0.07}\ncriteria: [uictest-stop]\n"


def simulated(scenario, recording):
    """Simulate a scenario and write its recording."""
    [case] = load([scenario])
    Path(recording).write_bytes(parquet_bytes(simulate(case, record_every=0.01).recording))


@pytest.fixture
def recorded(scenario):
    simulated(scenario("real", WET), "stop.parquet")
    return scenario("guess", WET.replace("0.07", "0.12"))


def test_a_fit_leaves_a_scenario_that_runs_and_keeps_steps_and_pads_and_settings(call, recorded):
    answer = call("fit", "stop.parquet", "--scenario", recorded, code=0)
    assert answer.out.startswith("friction everywhere: 0.07")
    [folder] = Path("reports").iterdir()
    assert sorted(path.name for path in folder.iterdir()) == [
        "SHA256SUMS",
        "fit.json",
        "guess-fitted.yaml",
        "overlay.csv",
        "overlay.svg",
    ]
    [fitted] = load([folder / "guess-fitted.yaml"])
    assert fitted.scenario.rail.friction == pytest.approx(0.07, rel=0.03)
    document = json.loads((folder / "fit.json").read_text())
    assert document["determined"] is True
    assert document["agreement"]["simulated_distance"] == pytest.approx(
        document["agreement"]["recorded_distance"], rel=0.1
    )
    arguments = ("--break", "10 m", "--pads", "--set", "brake.command=95 %")
    assert call("fit", "stop.parquet", "--scenario", recorded, *arguments, "-o", "again").code == 0
    [fitted] = load(list(Path("again").glob("*/guess-fitted.yaml")))
    assert [float(point.position) for point in fitted.scenario.rail.friction.points] == [0.0, 10.0]
    assert float(fitted.scenario.brake.command) == pytest.approx(0.95)


def test_a_record_that_cannot_tell_exits_1(call, scenario):
    path = scenario("dry", "rail: {condition: dry}\n")
    simulated(path, "stop.parquet")
    answer = call("fit", "stop.parquet", "--scenario", path, code=1)
    assert "at least" in answer.out
