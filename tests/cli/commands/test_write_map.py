"""`uictest evaluate FILE --write-map MAP`: one command, then the map reads the file."""

from pathlib import Path

import numpy as np
import pytest
import yaml

from ..conftest import results_of

SPEEDS = np.maximum(80.0 - 3.6 * np.maximum(np.arange(1262) * 0.02 - 2.0, 0.0), 0.0)
"""km/h every 20 ms: 2 s at 80 km/h, then 1 m/s2 to standstill, 246.9 m."""
SCENARIO = """schema: uictest/scenario/1
name: recorded
initial_speed: 80 km/h
brake: {command: 100 %, position: R}
rail: {condition: wet, friction: 0.1}
criteria: [uictest-stop]
"""


def _clock(k):
    return f"{12 + k // 180_000}:{k // 3000 % 60:02d}:{k // 50 % 60:02d},{20 * (k % 50):03d}"


def _seconds(k):
    return [f"{k / 50:.2f}".replace(".", ",")]


def _rows(first, decimal, separator, more=()):
    """Return a line for each sample: what `first` gives for its number, five equal speeds, and `more`."""
    for k, speed in enumerate(SPEEDS):
        cells = [*first(k), *[f"{speed:.3f}".replace(".", decimal)] * 5, *(each(k) for each in more)]
        yield separator.join(cells)


NAMES = "Geschwindigkeit [km/h];v1 [km/h];v2 [km/h];v3 [km/h];v4 [km/h]"
FILES = {
    "semicolon": (
        [
            "Prüfzug 7;;;;;",
            f"Zeit [s];{NAMES}",
            *_rows(lambda k: [f"{k / 50:.2f}".replace(".", ",")], ",", ";"),
        ],
        "cp1252",
    ),
    "date and clock": (
        [f"Datum;Uhrzeit;{NAMES}", *_rows(lambda k: ["3.5.2026", _clock(k)], ",", ";")],
        "utf-8",
    ),
    "clock": ([f"Uhrzeit;{NAMES}", *_rows(lambda k: [_clock(k)], ",", ";")], "utf-8-sig"),
    "units below": (
        [
            "t,v_train,v_axle[0],v_axle[1],v_axle[2],v_axle[3]",
            "ms,km/h,km/h,km/h,km/h,km/h",
            *_rows(lambda k: [str(20 * k)], ".", ","),
        ],
        "utf-8",
    ),
    "no units": (["t,v_train,v1,v2,v3,v4", *_rows(lambda k: [str(20 * k)], ".", ",")], "utf-16"),
    "marks and groups": (
        [
            f"Zeit [s];{NAMES};p_BC1 [mbar]",
            *_rows(
                _seconds,
                ",",
                ";",
                [lambda k: "OVL" if k == 1100 else f"{min(3800, 10 * k):,}".replace(",", ".")],
            ),
        ],
        "utf-8",
    ),
    "LabVIEW": (
        [
            "LabVIEW Measurement\t",
            "Separator\tTab",
            "***End_of_Header***\t",
            "Channels\t5",
            "Delta_X" + 5 * "\t0,020000",
            "***End_of_Header***\t",
            "X_Value\t" + NAMES.replace(";", "\t") + "\tComment",
            *_rows(lambda k: [""], ",", "\t"),
        ],
        "utf-8",
    ),
}


@pytest.fixture
def write_map(call, workplace):
    """Write a file and the map of it; return the text of the map and what was said."""
    Path("scn.yaml").write_text(SCENARIO)

    def write(lines, encoding="utf-8", name="a.txt", code=0):
        Path(name).write_bytes("\n".join(lines).encode(encoding))
        answer = call("evaluate", name, "--write-map", "lab.yaml", code=code)
        return Path("lab.yaml").read_text(encoding="utf-8") if code == 0 else "", answer

    return write


@pytest.mark.parametrize("name", FILES)
def test_the_map_that_is_written_reads_the_file(call, write_map, name):
    text, _ = write_map(*FILES[name])
    assert set(yaml.safe_load(text)["channels"]) >= {"speed", *(f"wheel_speed_{n}" for n in range(1, 5))}
    answer = call("evaluate", "a.txt", "--map", "lab.yaml", "--scenario", "scn.yaml", "--trigger", "2 s")
    distance = results_of()["cases"][0]["measures"]["braking_distance_m"]
    assert distance == pytest.approx(246.91, abs=0.005), (answer.err, text)


def test_what_is_guessed_what_is_open_and_other_lines_of_names_are_marked(write_map):
    lines, encoding = FILES["no units"]
    text, answer = write_map([line.replace("v1", "Rad 1") for line in lines], encoding)
    assert 'time: {source: "t", unit: ms}  # guessed: the file does not state the unit' in text
    assert '  speed: {source: "v_train", unit: km/h}  # guessed' in text
    assert "# not assigned: wheel_speed_1; needed for" in text
    assert '# not used: "Rad 1"' in text
    assert "lab.yaml: 6 guessed" in answer.out
    Path("lab.yaml").unlink()
    lines = [
        "Kanal 1;Kanal 2",
        "Zeit;v_Zug",
        "s;km/h",
        *(f"{k / 50:.2f};80,5".replace(".", ",") for k in range(50)),
    ]
    text, _ = write_map(lines)
    assert "header_line: 1  # guessed: or 2, which are as wide" in text


@pytest.mark.parametrize(("decimal", "thousands"), [(",", "."), (".", ",")])
def test_a_sign_in_large_numbers_alone_groups_digits(write_map, decimal, thousands):
    pressures = [lambda k: f"{min(3000, 10 * k):,}".replace(",", thousands)]
    rows = [";".join([str(20 * k), *["80"] * 5, pressures[0](k)]) for k in range(400)]
    text, _ = write_map([f"Zeit [ms];{NAMES};p_BC1 [mbar]", *rows])
    assert f'thousands: "{thousands}"  # guessed: it stands in numbers from 1{thousands}000 on alone' in text
    assert f'decimal: "{decimal}"' in text or decimal == "."


@pytest.mark.parametrize(
    ("names", "marked"),
    [
        ("t [s],v_soll [km/h],v1 [km/h]", 'speed: "v_soll"  # guessed: by its unit alone'),
        ("t [s],v [km/h],Hub [mm]", 'distance: "Hub"  # guessed: by its unit alone'),
        ("Lock [ms],v [km/h],v1 [km/h]", 'time: "Lock"  # guessed: by its unit alone'),
        ("t [s],v [km/h],MV1", 'valve_command_1: "MV1"  # guessed: 0 and 1 alone'),
    ],
)
def test_what_a_unit_or_its_values_alone_say_is_a_guess(write_map, names, marked):
    rows = [f"{0.1 * k + 0.05:.2f},{80 - 0.1 * k:.1f},{k % 2}" for k in range(50)]
    assert marked in write_map([names, *rows])[0]


def test_five_elements_of_an_array_are_no_wheelsets_and_a_letter_is_a_state(write_map):
    names = ",".join(["t [s]", "v [km/h]", *(f"v_axle[{k}]" for k in range(5)), "WSP1"])
    rows = [f"{0.1 * k:.1f},80,1,1,1,1,1,{'V' if k == 20 else 0}" for k in range(50)]
    text, _ = write_map([names, *rows])
    assert "wheel_speed" not in text.partition("# not assigned")[0]
    assert "missing" not in text


@pytest.mark.parametrize("samples", [25, 1262])
def test_segments_of_labview_are_to_be_divided(write_map, samples):
    lines = FILES["LabVIEW"][0][: 7 + samples]
    _, answer = write_map([*lines, *lines[3:]], name="a.lvm", code=4)
    assert f"line {len(lines) + 3} ends the header of another segment" in answer.err
