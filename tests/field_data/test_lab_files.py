"""Text files as laboratories have them: read by their map, or refused with a remedy that reads them."""

import re
from datetime import datetime, timedelta

import numpy as np
import pytest
import yaml
from hypothesis import assume, given, strategies as st

from uictest.core.recording.formats import Cells, Dialect, read_contents, read_pieces
from uictest.core.recording.formats.isolation import read_here
from uictest.plans.scenario import ScenarioErrors
from uictest.recorded.field_data import MapError, UnusableError, load_map, select_channels, stop_in
from uictest.recorded.field_data.raw_channels import LONGEST_RECORD
from uictest.recorded.service_log.signals import pieces_of

STEP = 0.02
TIMES = STEP * np.arange(200)
SPEEDS = 80.0 - 3.6 * TIMES
BEGIN = datetime(2026, 5, 3, 23, 59, 58)
"""Two seconds before midnight."""


def number(value, decimal="."):
    """Return a number with three decimals."""
    return f"{value:.3f}".replace(".", decimal)


def a_map(path, text):
    """Return a channel map that extends the common names."""
    path.write_text(
        f"schema: uictest/channel-map/1\nname: lab\nextends: common-names\n{text}\n", encoding="utf-8"
    )
    return load_map(str(path))[0]


def read(path, channel_map):
    """Return the channels of a file as `evaluate` selects them."""
    return select_channels(read_here("csv", path, channel_map.dialect), channel_map)


def read_in_pieces(path, channel_map):
    """Return the channels of a file of one piece as `log` selects them."""
    (contents,) = read_pieces(path, channel_map.dialect)
    return select_channels(contents, channel_map, np.inf)


def table(path, rows, header="Zeit [s];v [km/h]"):
    """Write a table with semicolons."""
    path.write_text("\n".join([header, *map(";".join, rows)]) + "\n", encoding="utf-8")
    return path


PLAIN = [(number(t, ","), number(v, ",")) for t, v in zip(TIMES, SPEEDS, strict=True)]
SECTION = 'csv: {delimiter: ";", decimal: ","%s}'


@pytest.mark.parametrize("reads", [read, read_in_pieces])
@pytest.mark.parametrize(
    ("cell", "value", "settings"),
    [
        ("1.080,5", 1080.5, ', thousands: "."'),
        ("1 080,5", 1080.5, ', thousands: " "'),
        ("1\u00a0080,5", 1080.5, ', thousands: " "'),
        ("1\u202f080,5", 1080.5, ', thousands: " "'),
        ("1'080,5", 1080.5, """, thousands: "'" """),
        ("1\u2019080,5", 1080.5, """, thousands: "'" """),
        ("1.080", 1080.0, ', thousands: "."'),
        ("OVL", np.nan, ', missing: ["OVL"]'),
        ("∞", np.nan, ', missing: ["---", "∞"]'),
        ("#NV", np.nan, ', missing: ["#NV"]'),
    ],
)
def test_what_a_refusal_says_reads_the_cell(tmp_path, reads, cell, value, settings):
    rows = [(t, v, cell if k == 70 else "0,5") for k, (t, v) in enumerate(PLAIN)]
    path = table(tmp_path / "a.csv", rows, "Zeit [s];v [km/h];p_BC1 [mbar]")
    earlier = ', missing: ["---"]' if "---" in settings else ""
    with pytest.raises(MapError) as caught:
        reads(path, a_map(tmp_path / "map.yaml", SECTION % earlier))
    assert f"cylinder_pressure_1: 'p_BC1': line 72, column 3: {cell!r} is no number" in str(caught.value)
    advised = re.search(r"csv: (\{.*?\}) in the channel map", str(caught.value))[1]
    assert yaml.safe_load(advised) == yaml.safe_load("{" + settings.strip(", ") + "}")
    channel_map = a_map(tmp_path / "map.yaml", SECTION % settings)
    pressures = reads(path, channel_map)["cylinder_pressure_1"].samples
    np.testing.assert_allclose(np.delete(pressures, 70), 50.0)
    np.testing.assert_equal(pressures[70], value * 100.0)


@pytest.mark.parametrize("reads", [read, read_in_pieces])
def test_a_decimal_point_beside_decimal_commas_is_no_number(tmp_path, reads):
    channel_map = a_map(tmp_path / "map.yaml", SECTION % "")
    rows = [(t, "80.5" if k == 3 else v) for k, (t, v) in enumerate(PLAIN)]
    with pytest.raises(MapError, match=r"line 5, column 2: '80\.5' is no number: .*decimal: \"\.\""):
        reads(table(tmp_path / "a.csv", rows), channel_map)
    points = [(number(t)[:-1], v) for t, (_, v) in zip(TIMES, PLAIN, strict=True)]
    with pytest.raises(MapError, match=r"'0\.00' is no number"):
        reads(table(tmp_path / "a.csv", points), channel_map)


@pytest.mark.parametrize("cell", ["1_000", "0x10", "1e", "--1", "1,5,5", "1.0.5", "12.34", "1..5", "ten"])
def test_what_another_language_takes_for_a_number_is_none(cell):
    for cells in (Cells(), Cells(",", "."), Cells(",")):
        assert cells.is_text(cell) == (cells.column([cell]).texts is not None)
        assert cells.is_text(cell) or (cell == "12.34" and cells.column([cell]).numbers[0] == 12.34)


@given(
    value=st.floats(-1e9, 1e9),
    digits=st.integers(0, 6),
    decimal=st.sampled_from(".,"),
    thousands=st.sampled_from(["", ".", ",", "'", " "]),
    blanks=st.sampled_from(["", " "]),
)
def test_a_number_that_a_dialect_writes_is_read_as_it_was(value, digits, decimal, thousands, blanks):
    assume(thousands != decimal)
    plain = f"{value:,.{digits}f}"
    written = plain.translate({ord(","): thousands or None, ord("."): decimal})
    column = Cells(decimal, thousands).column([f"{blanks}{written}{blanks}", None, "NaN"])
    assert column.texts is None
    np.testing.assert_array_equal(column.numbers, [float(plain.replace(",", "")), np.nan, np.nan])


def test_both_readers_of_texts_read_the_same(tmp_path):
    cells = ["1,5", "1,#QNAN", "-", "nan", "-2,25e1", "+3", ",5", "7,", "NULL", "1.#QNAN"] * 20
    path = table(tmp_path / "a.csv", [(t, c) for (t, _), c in zip(PLAIN, cells, strict=True)])
    dialect = a_map(tmp_path / "map.yaml", SECTION % "").dialect
    (piece,) = read_pieces(path, dialect)
    whole = read_here("csv", path, dialect)
    assert whole.groups[0].channels["v"].dtype.kind == "f"
    for name in ("Zeit", "v"):
        np.testing.assert_array_equal(piece.groups[0].channels[name], whole.groups[0].channels[name])


CLOCKS = {
    "%d.%m.%Y %H:%M:%S.%f": lambda now: [f"{now:%d.%m.%Y %H:%M:%S}.{now.microsecond // 1000:03d}"],
    "%d.%m.%Y %H:%M:%S,%f": lambda now: [f"{now:%d.%m.%Y}", f"{now:%H:%M:%S},{now.microsecond // 1000:03d}"],
    "%H:%M:%S:%f": lambda now: [f"{now:%H:%M:%S}:{now.microsecond // 1000:03d}"],
    "%m/%d/%Y %I:%M:%S.%f %p": lambda now: [f"{now:%m/%d/%Y %I:%M:%S.%f %p}"],
}


@pytest.mark.parametrize("written", CLOCKS)
def test_dates_in_one_column_in_two_and_a_clock_alone_run_past_midnight(tmp_path, written):
    stamps = [CLOCKS[written](BEGIN + timedelta(seconds=float(t))) for t in TIMES]
    columns = ["Datum", "Uhrzeit"][-len(stamps[0]) :]
    rows = [(*stamp, v) for stamp, (_, v) in zip(stamps, PLAIN, strict=True)]
    path = table(tmp_path / "a.csv", rows, ";".join([*columns, "v [km/h]"]))
    text = f"time: {{source: [{', '.join(columns)}]}}\n" + SECTION % f', dates: "{written}"'
    channel_map = a_map(tmp_path / "map.yaml", text)
    np.testing.assert_allclose(read(path, channel_map)["speed"].time, TIMES, atol=1e-6)
    logged = read_in_pieces(path, channel_map)["speed"].time
    np.testing.assert_allclose(np.diff(logged), STEP, atol=1e-6)
    if "%d" in written:
        assert logged[0] == pytest.approx((BEGIN - datetime(1970, 1, 1)).total_seconds())


def test_a_date_that_is_written_otherwise_is_shown_with_the_way_that_reads_it(tmp_path):
    rows = [(f"{BEGIN + timedelta(seconds=k):%d/%m/%Y %H:%M:%S}", v) for k, (_, v) in enumerate(PLAIN)]
    path = table(tmp_path / "a.csv", rows, "Zeit;v [km/h]")
    with pytest.raises(MapError) as caught:
        read(path, a_map(tmp_path / "map.yaml", SECTION % ""))
    advised = re.search(r'csv: \{(dates: ".*")\} in the channel map', str(caught.value))[1]
    channel_map = a_map(tmp_path / "map.yaml", SECTION % f", {advised}")
    np.testing.assert_allclose(read(path, channel_map)["speed"].time, np.arange(200.0))


@pytest.mark.parametrize("times", [["0,00"] * 40, [""] * 40, None], ids=["stands", "empty", "none"])
def test_the_stated_interval_takes_the_place_of_a_column_of_times(tmp_path, monkeypatch, times):
    """Pieces of a file without times go on where the one before ended."""
    channel_map = a_map(tmp_path / "map.yaml", "time: {interval: 20 ms}\n" + SECTION % "")
    if times is not None:
        rows = [(time, v) for time, (_, v) in zip(times + [t for t, _ in PLAIN], PLAIN, strict=False)]
        path = table(tmp_path / "a.csv", rows)
    else:
        path = table(tmp_path / "a.csv", [(v,) for _, v in PLAIN], "v [km/h]")
    np.testing.assert_allclose(read(path, channel_map)["speed"].time, TIMES)
    if times is None:
        monkeypatch.setattr("uictest.core.recording.formats.pieces._BLOCK", 400)
        pieces = read_pieces(path, channel_map.dialect)
        times = [select_channels(piece, channel_map, np.inf)["speed"].time for piece in pieces]
        assert len(times) > 1
        np.testing.assert_allclose(np.concatenate(times), TIMES)


@pytest.mark.parametrize("reads", [read, read_in_pieces])
def test_remarks_blank_lines_and_delimiters_at_the_ends_keep_the_places(tmp_path, reads):
    """The remarks of LabVIEW may be left out."""
    channel_map = a_map(tmp_path / "map.yaml", SECTION % "")
    spoilt = [(t, "OVL" if k == 150 else v) for k, (t, v) in enumerate(PLAIN)]
    heading = "Zeit [s];v [km/h];Comment"
    ends = [[(*row, "") for row in rows] for rows in (PLAIN, spoilt)]
    for rows in ends:
        rows[3:3] = [()]
    for (sound, bad), head, line in (((PLAIN, spoilt), heading, 152), (ends, "Zeit [s];v [km/h]", 153)):
        assert len(reads(table(tmp_path / "a.csv", sound, head), channel_map)["speed"].samples) == len(PLAIN)
        with pytest.raises(ValueError, match=f"line {line}, column 2: 'OVL' is no number"):
            reads(table(tmp_path / "a.csv", bad, head), channel_map)


def test_a_text_late_in_a_log_is_placed_in_whatever_piece_it_lies(tmp_path, monkeypatch):
    rows = [(t, "OVL" if k == 150 else v, "0") for k, (t, v) in enumerate(PLAIN)]
    path = table(tmp_path / "a.csv", rows, "Zeit [s];v [km/h];BrakeCommand")
    with monkeypatch.context() as patch:
        patch.setattr("uictest.core.recording.formats.pieces._SAMPLED", 10)
        channel_map = a_map(tmp_path / "map.yaml", SECTION % "")
        told = r"line 152, column 2: 'OVL' is no number: .*missing: \[\"OVL\"\]"
        with pytest.raises(ValueError, match=told):
            list(read_pieces(path, channel_map.dialect))
        channel_map = a_map(tmp_path / "map.yaml", SECTION % ', missing: ["OVL"]')
        assert np.flatnonzero(np.isnan(read_in_pieces(path, channel_map)["speed"].samples)).tolist() == [150]
    monkeypatch.setattr("uictest.core.recording.formats.pieces._BLOCK", 500)
    channel_map = a_map(tmp_path / "map.yaml", SECTION % ', thousands: "."')
    with pytest.raises(MapError, match="line 152, column 2: 'OVL' is no number"):
        list(pieces_of(path, channel_map))
    monkeypatch.undo()
    path = table(tmp_path / "a.csv", [(t, "x" * 200 if k == 70 else v) for k, (t, v) in enumerate(PLAIN)])
    with pytest.raises(MapError, match=r"line 72, column 2: 'x{64}' is no number"):
        read_in_pieces(path, a_map(tmp_path / "map.yaml", SECTION % ""))


def test_names_are_used_as_they_stand_and_brackets_hold_a_unit_only_if_it_is_one(tmp_path):
    names = "t [s],v_axle[0],v_axle[1],v (roh) [km/h],slide [1],a[1],Druck (C1),Achse / 1"
    path = tmp_path / "a.csv"
    path.write_text(f"{names}\n0.0,1,2,3,4,5,6,7\n0.1,1,2,3,4,5,6,7\n")
    (group,) = read_here("csv", path, a_map(tmp_path / "map.yaml", "").dialect).groups
    kept = ["v_axle[0]", "v_axle[1]", "v (roh)", "slide", "a[1]", "Druck (C1)", "Achse / 1"]
    assert list(group.channels) == ["t", *kept]
    assert group.units == {"t": "s", "v (roh)": "km/h", "slide": "1"}


def test_a_rotational_speed_needs_the_radius_of_its_wheel(tmp_path):
    path = tmp_path / "a.csv"
    path.write_text("t [s],v [km/h],v1 [rpm]\n" + "".join(f"{t:.2f},72,415\n" for t in TIMES))
    with pytest.raises(MapError, match=r"'v1' is in rpm: .* as in wheel_radius: 0\.46 m"):
        read(path, a_map(tmp_path / "map.yaml", ""))
    channel_map = a_map(
        tmp_path / "map.yaml", "channels: {wheel_speed_1: {source: v1, wheel_radius: 0.46 m}}"
    )
    speeds = read(path, channel_map)["wheel_speed_1"].samples
    np.testing.assert_allclose(speeds, 415.0 / 60.0 * 2.0 * np.pi * 0.46)


def test_units_stand_in_the_names_of_parquet_columns_as_in_those_of_texts(tmp_path):
    import pyarrow as pa
    import pyarrow.parquet as pq

    columns = {"t [s]": TIMES, "v_train [km/h]": SPEEDS, "v_axle[0]": SPEEDS, "v_axle[1]": SPEEDS}
    path = tmp_path / "a.parquet"
    pq.write_table(pa.table(columns), path)
    channel_map = a_map(tmp_path / "map.yaml", 'channels: {wheel_speed_1: {source: "v_axle[0]", unit: km/h}}')
    (piece,) = read_pieces(path, channel_map.dialect)
    for contents in (read_contents(path), piece):
        channels = select_channels(contents, channel_map, LONGEST_RECORD.value)
        np.testing.assert_allclose(channels["speed"].samples, SPEEDS / 3.6)
        np.testing.assert_allclose(channels["wheel_speed_1"].samples, SPEEDS / 3.6)


@pytest.mark.parametrize(
    ("text", "told"),
    [
        ("channels: {speed: {interval: 20 ms}}", "interval: of `time` alone"),
        ("channels: {speed: {unit: km/h}}", "speed: no source"),
        ("time: {unit: s}", "write source: NAME, or interval: 20 ms"),
        ("channels: {wheel_load_1: {source: F, wheel_radius: 0.46 m}}", "wheel_load_1 is no speed"),
        ('csv: {dates: "%d", header: -1}', "-1 is out of range: it must be at least 0"),
    ],
)
def test_a_map_that_states_what_makes_no_sense_is_refused(tmp_path, text, told):
    dialect = a_map(tmp_path / "map.yaml", "csv: {header: 3, units: 4}").dialect
    assert (dialect.header_line, dialect.unit_line) == (3, 4)
    with pytest.raises(ScenarioErrors, match=re.escape(told)):
        a_map(tmp_path / "map.yaml", text)


@pytest.mark.parametrize("reads", [read, read_in_pieces])
@pytest.mark.parametrize("settings", ['missing: ["-999"]', 'missing: ["-999"], thousands: "."'])
def test_a_mark_that_is_a_number_is_compared_as_text(tmp_path, reads, settings):
    cells = {70: "-999", 71: "-999,0"}
    path = table(
        tmp_path / "a.csv",
        [(t, v, cells.get(k, "1")) for k, (t, v) in enumerate(PLAIN)],
        "Zeit [s];v [km/h];p",
    )
    text = "channels: {cylinder_pressure_1: {source: p, unit: bar}}\n" + SECTION % f", {settings}"
    pressures = reads(path, a_map(tmp_path / "map.yaml", text))["cylinder_pressure_1"].samples
    np.testing.assert_array_equal(pressures[69:72] / 1e5, [1.0, np.nan, -999.0])


@pytest.mark.parametrize("reads", [read, read_in_pieces])
def test_words_are_states_also_where_one_shows_late(tmp_path, reads, monkeypatch):
    """Not marks of missing samples; truth values are states without a word in the map."""

    def command(words, begin, text):
        rows = [(t, v, words[k >= begin]) for k, (t, v) in enumerate(PLAIN)]
        path = table(tmp_path / "a.csv", rows, "Zeit [s];v [km/h];BrakeCommand")
        channel_map = a_map(tmp_path / "map.yaml", text + SECTION % "")
        texts = {"BrakeCommand"}
        (contents,) = (
            [read_here("csv", path, channel_map.dialect)]
            if reads is read
            else read_pieces(path, channel_map.dialect, texts=texts)
        )
        return select_channels(contents, channel_map, np.inf)["brake_command"].samples

    for words in (("False", "True"), ("FALSE", "TRUE"), ("false", "true")):
        np.testing.assert_array_equal(command(words, 100, ""), [0.0] * 100 + [1.0] * 100)
    monkeypatch.setattr("uictest.core.recording.formats.pieces._SAMPLED", 10)
    text = "channels: {brake_command: {source: BrakeCommand, states: {FAULT: 1}}}\n"
    np.testing.assert_array_equal(command(("0", "FAULT"), 151, text), [0.0] * 151 + [1.0] * 49)


def test_a_record_of_one_sample_has_no_interval_and_an_unknown_encoding_is_told_its_byte(tmp_path):
    path = table(tmp_path / "a.csv", PLAIN[:1])
    with pytest.raises(UnusableError, match="fewer than two samples"):
        stop_in(path, a_map(tmp_path / "map.yaml", SECTION % ""))
    path.write_bytes(b"t [s];v\x81 [km/h]\n0,0;80,0\n0,1;79,0\n")
    with pytest.raises(ValueError, match="line 1, byte 8: 0x81 is not CP1252"):
        read_here("csv", path, Dialect(by_itself=True))


def test_a_clock_of_a_log_runs_on_past_midnight_between_pieces(tmp_path, monkeypatch):
    monkeypatch.setattr("uictest.core.recording.formats.pieces._BLOCK", 500)
    rows = [
        (f"{now:%H:%M:%S}.{now.microsecond // 1000:03d}", v, "0")
        for now, (_, v) in zip((BEGIN + timedelta(seconds=float(t)) for t in TIMES), PLAIN, strict=True)
    ]
    path = table(tmp_path / "a.csv", rows, "Zeit;v [km/h];BrakeCommand")
    channel_map = a_map(tmp_path / "map.yaml", SECTION % ', dates: "%H:%M:%S.%f"')
    times = [piece.channels["speed"].time for piece in pieces_of(path, channel_map)]
    assert len(times) > 2
    np.testing.assert_allclose(np.diff(np.concatenate(times)), STEP, atol=1e-6)
