"""`uictest identify`."""

import hashlib
import shutil
from pathlib import Path

import numpy as np
import pytest

from uictest.core.recording import ORIGIN, Recording, parquet_bytes, read_parquet
from uictest.plans.scenario import load_part
from uictest.rig.identification.lines import FittedLine, computed_force

STEP = 0.001
SQUEEZING, RELEASING = FittedLine(0.042, -1800.0), FittedLine(0.0475, -1650.0)


@pytest.fixture(scope="module")
def recorded(tmp_path_factory):
    """A caliper with known lines, whose cylinder lags 30 ms behind the tank."""
    corners = [(0, 0), (5, 4e5), (10, 0), (13, 3e5), (16, 0.5e5), (19, 4e5), (22, 0)]
    time = np.arange(round(corners[-1][0] / STEP) + 1) * STEP
    pressure = np.interp(time, *np.array(corners, dtype=float).T)
    lines = {
        "bc_squeezing": SQUEEZING,
        "bc_releasing": RELEASING,
        "wsp_squeezing": SQUEEZING,
        "wsp_releasing": RELEASING,
    }
    force = computed_force(pressure, np.zeros(len(time), bool), lines, 0.0, STEP, 0.0)
    channels = {
        "time": time,
        "cylinder_pressure_1": pressure / 1e5,
        "clamping_force_1": force / 1e3,
        "valve_command_1": np.zeros(len(time)),
        "measured_pressure_2": np.interp(time + 0.03, time, pressure) / 1e5,
    }
    units = {
        "time": "s",
        "cylinder_pressure_1": "bar",
        "clamping_force_1": "kN",
        "valve_command_1": "1",
        "measured_pressure_2": "bar",
    }
    path = tmp_path_factory.mktemp("recorded") / "record.parquet"
    path.write_bytes(parquet_bytes(Recording(channels, units)))
    return path


@pytest.fixture
def record(recorded, workplace):
    """The recording of that caliper in the working folder."""
    return Path(shutil.copy(recorded, workplace))


def read(path):
    from uictest.rig.identification.compensation_file import load_compensation

    return load_compensation(str(path))


def test_hysteresis_writes_a_compensation_with_provenance_and_marks(call, record, workplace, monkeypatch):
    command = "identify hysteresis record.parquet -o found.yaml"
    monkeypatch.setenv("SOURCE_DATE_EPOCH", "1767312000")
    answer = call(*command.split(), code=0)
    assert "bc loop width" in answer.out
    found = read(workplace / "found.yaml")
    assert (found.name, found.title) == ("record", "Compensation record")
    assert found.hysteresis.bc_squeezing.slope == pytest.approx(SQUEEZING.slope, rel=0.01)
    assert found.hysteresis.wsp_releasing.intercept == pytest.approx(RELEASING.intercept, abs=100.0)
    sha256 = hashlib.sha256(record.read_bytes()).hexdigest()
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
    known = read_parquet(record)
    record.write_bytes(parquet_bytes(Recording(known.channels, known.units, {ORIGIN: "test rig of ours"})))
    assert call(*command.split(), "--base", "found.yaml").code == 0
    provenance = read(workplace / "found.yaml").provenance
    assert "hysteresis date" not in provenance
    assert provenance["hysteresis record origin"] == "test rig of ours"


def test_cylinder_keeps_the_lines_of_its_base(call, record, workplace):
    assert call("identify", "hysteresis", "record.parquet", "-o", "found.yaml").code == 0
    lines = read(workplace / "found.yaml").hysteresis
    answer = call("identify", "cylinder", "record.parquet", "--base", "found.yaml", "-o", "found.yaml")
    assert answer.code == 0, answer.err
    assert "poles" in answer.out
    found = read(workplace / "found.yaml")
    assert found.hysteresis == lines
    assert found.sampling_time == pytest.approx(STEP)
    assert {"hysteresis command", "cylinder command"} <= set(found.provenance)
    sha256 = hashlib.sha256(record.read_bytes()).hexdigest()
    assert found.provenance["hysteresis record sha256"] == sha256
    assert found.provenance["cylinder record sha256"] == sha256


def test_a_largest_error_above_two_per_cent_is_warned_of(call, record, workplace):
    """Air that rings in a hose follows no lag of the third order, however small the rms error of all."""
    assert "four-caliper" not in call("identify", "cylinder", record).err
    recorded = read_parquet(record)
    ringing = recorded.channels["cylinder_pressure_1"].copy()
    bursts = np.flatnonzero(np.arange(ringing.size) % 2000 < 60)
    ringing[bursts] += 0.15 * np.sin(bursts * 0.3)  # bar, of 4
    path = workplace / "ringing.parquet"
    changed = {**recorded.channels, "cylinder_pressure_1": ringing}
    path.write_bytes(parquet_bytes(Recording(changed, recorded.units)))
    answer = call("identify", "cylinder", path)
    assert answer.code == 0
    [warning] = [line for line in answer.err.splitlines() if "largest error" in line]
    assert "above 2 %" in warning
    assert "judge with rig.topology: four-caliper" in warning


def test_a_result_is_never_silently_called_like_a_library_part(call, record, workplace):
    record.rename("Six Inch.parquet")
    command = ("identify", "hysteresis", "Six Inch.parquet", "-o", "other.yaml")
    call(*command, code=4, says="--name")
    assert not Path("other.yaml").exists()
    assert call(*command, "--name", "ours").code == 0
    assert read(workplace / "other.yaml").name == "ours"


def test_channels_may_have_other_names_and_come_from_csv(call, record, workplace):
    time = np.arange(0.0, 12.0, 0.005)
    pressure = 2.0 - 2.0 * np.cos(time)
    rows = "\n".join(
        f"{t:.3f},{p:.6f},{max(4.5 * p - 1.8, 0.0):.6f}" for t, p in zip(time, pressure, strict=True)
    )
    (workplace / "m.csv").write_text(f"time [s],BC [bar],F [kN]\n{rows}\n", "utf-8")
    answer = call("identify", "hysteresis", "m.csv", "--pressure", "BC", "--force", "F", "--wsp", "100..101")
    assert answer.code == 0, answer.err
    assert "4.5" in answer.out


@pytest.mark.parametrize(
    ("arguments", "told"),
    [
        (("hysteresis", "missing.parquet"), "no such file"),
        (("hysteresis", "record.parquet", "--force", "kraft"), "no channel 'kraft'"),
        (("cylinder", "record.parquet", "--input", "clamping_force_1"), "unit 'kN'"),
        (("hysteresis", "record.parquet", "--wsp", "3"), "--wsp"),
        (("hysteresis", "record.parquet", "--base", "seven-inch"), "six-inch"),
        (("cylinder", "record.parquet", "--input", "valve_command_1"), "unit '1'"),
        (("hysteresis", "record.parquet", "-o", "record.parquet", "--name", "x"), "the recording itself"),
        (("cylinder", "record.parquet", "-o", "x.yaml", "--name", "Our caliper"), "--name"),
        (
            ("cylinder", "record.parquet", "--input", "cylinder_pressure_1"),
            "--input and --output-channel both name 'cylinder_pressure_1'",
        ),
        (("hysteresis", "record.parquet", "--force", "valve_command_1"), "--force and --command both name"),
        (("hysteresis", "record.parquet", "--wsp", "0..inf"), "--wsp '0..inf'"),
        (("hysteresis", "record.parquet", "--acting-time", "nan"), "--acting-time"),
        (("hysteresis", "record.parquet", "--transition-time", "-1"), "--transition-time"),
    ],
)
def test_what_cannot_be_used_is_told_and_nothing_is_written(call, record, workplace, arguments, told):
    call("identify", *arguments, code=4, says=told)
    assert [path.name for path in workplace.iterdir()] == ["record.parquet"]


@pytest.mark.parametrize(
    ("channel", "change", "reason"),
    [
        ("time", lambda time: time * 1e12, "runs from 0 to 2.2e+13 s with a sample every 1e+09 s"),
        ("time", lambda time: time * 1e4, "is it in ms, not in s?"),
        ("measured_pressure_2", lambda p: p * 1e307, "reaches inf bar"),
        (
            "measured_pressure_2",
            lambda p: p * np.nan,
            "'measured_pressure_2' has 22001 samples that are not numbers",
        ),
        ("measured_pressure_2", lambda p: -p, "never above zero"),
        ("measured_pressure_2", lambda p: 4.0 - p, "does not follow from the tank pressure"),
        ("clamping_force_1", lambda force: 0.0 * force + 5.0, "the force varies by 0 N only"),
        (
            "clamping_force_1",
            lambda force: np.minimum(force, 3.0),
            "the force does not follow from the pressure",
        ),
        ("valve_command_1", lambda command: command + 7.3, "a valve command is 0 fill, 1 hold or 2 vent"),
    ],
)
def test_a_record_that_supports_nothing_is_refused_with_the_reason(
    call, record, workplace, channel, change, reason
):
    recording = read_parquet(record)
    channels = {**recording.channels, channel: change(recording[channel])}
    record.write_bytes(parquet_bytes(Recording(channels, recording.units)))
    kind = "cylinder" if channel == "measured_pressure_2" else "hysteresis"
    answer = call("identify", kind, "record.parquet", "-o", "found.yaml", code=4)
    assert answer.err.startswith("uictest: record.parquet: ")
    assert reason in answer.err
    assert "Warning" not in answer.err
    assert not (workplace / "found.yaml").exists()


def test_numbers_that_a_scenario_would_reject_are_not_written(call, record, workplace):
    recording = read_parquet(record)
    leading = np.roll(recording["cylinder_pressure_1"], -round(0.05 / STEP))
    force = np.maximum(4.5 * leading - 1.7, 0.0)
    record.write_bytes(
        parquet_bytes(Recording({**recording.channels, "clamping_force_1": force}, recording.units))
    )
    answer = call("identify", "hysteresis", "record.parquet", "-o", "found.yaml", code=4)
    assert "record.parquet: nothing written" in answer.err
    assert "found.yaml" in answer.err
    assert "the squeezing line must lie below the releasing line" in answer.err
    assert not (workplace / "found.yaml").exists()


def test_times_that_do_not_rise_are_refused(call, workplace):
    (workplace / "m.csv").write_text("time [s],BC [bar],F [kN]\n0,1,1\n0.1,1,1\n0.05,1,1\n")
    answer = call("identify", "hysteresis", "m.csv", "--pressure", "BC", "--force", "F", "--wsp", "0..1")
    assert answer.code == 4
    assert "does not rise: 0.05 s follows 0.1 s at sample 2" in answer.err


def test_two_names_of_one_signal_hold_no_dynamics(call, record):
    recording = read_parquet(record)
    channels = {**recording.channels, "measured_pressure_2": recording["cylinder_pressure_1"]}
    record.write_bytes(parquet_bytes(Recording(channels, recording.units)))
    call("identify", "cylinder", "record.parquet", code=4, says="the same, sample by sample")


def test_a_file_that_is_no_recording_is_refused(call, workplace):
    (workplace / "x.parquet").write_bytes(b"PAR1 and nothing else")
    call("identify", "cylinder", "x.parquet", code=4, says="x.parquet")


def test_a_record_of_another_tank_than_assumed_is_refused_with_what_to_write(call, workplace):
    """Its heat conductances would be wrong by a factor, with small errors."""
    assert (
        call("bench", "wsp-cycling", "--set", "brake.system.tank.volume=4 L", "-o", "four.parquet").code == 0
    )
    answer = call("identify", "air", "four.parquet", code=4)
    assert "brake.system.tank.volume 4 L, not 2 L; write --set 'brake.system.tank.volume=4 L'" in answer.err
