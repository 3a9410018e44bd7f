import re
import sys

import numpy as np
import pytest

from uictest.core.recording.formats import (
    FORMATS,
    Dialect,
    MissingExtraError,
    UnreadableError,
    format_of,
    read_contents,
    writer_of,
)
from uictest.core.recording.formats.file_formats import (
    MOST_CHANNELS,
    MOST_VALUES,
    check_size,
    required_module,
)
from uictest.core.recording.formats.isolation import read_here
from uictest.core.recording.formats.layout import names_and_units_of

EXTRAS = {"mdf": "asammdf", "tdms": "nptdms"}


@pytest.mark.parametrize("name", FORMATS)
def test_what_is_written_is_read(name, written, recording):
    contents = read_here(name, written(name), Dialect())
    assert contents.metadata == recording.metadata
    [group] = contents.groups
    time = group.channels["time"] if group.time is None else group.time
    np.testing.assert_allclose(time, recording["time"], atol=1e-9)
    assert group.units["speed"] == "m/s"
    np.testing.assert_allclose(group.channels["speed"], recording["speed"], rtol=1e-9)


@pytest.mark.parametrize("name", FORMATS)
def test_magnets_and_every_bit_of_a_diagnosis_come_back(name, written, recording):
    [group] = read_here(name, written(name), Dialect()).groups
    np.testing.assert_array_equal(group.channels["diagnosis"], recording["diagnosis"])
    magnet = group.channels["vent_magnet_1"]
    states = np.where(recording["vent_magnet_1"] > 0, "on", "off") if magnet.dtype.kind == "U" else None
    np.testing.assert_array_equal(magnet, recording["vent_magnet_1"] if states is None else states)


@pytest.mark.parametrize("name", FORMATS)
def test_the_format_is_known_by_the_content(name, written):
    assert format_of(written(name)) == name


@pytest.mark.parametrize("name", FORMATS)
def test_a_process_of_its_own_reads_the_same(name, written):
    path = written(name)
    here, there = read_here(name, path, Dialect()), read_contents(path)
    assert there.metadata == here.metadata
    for one, other in zip(there.groups, here.groups, strict=True):
        assert one.units == other.units
        for channel in other.channels:
            np.testing.assert_array_equal(one.channels[channel], other.channels[channel])


def test_parquet_columns_as_other_programs_write_them(tmp_path):
    import pyarrow as pa
    import pyarrow.parquet as pq

    stamps = pa.array([None, 0, 50_000], pa.timestamp("us"))
    states = pa.array(["fill", "hold", "vent"])
    columns = {
        "stamps": stamps,
        "lasted": pa.array([0, 50, 100], pa.duration("ms")),
        "large": states.cast(pa.large_string()),
        "coded": states.dictionary_encode(),
        "count": pa.array([0, 1, 2**64 - 1], pa.uint64()),
    }
    pq.write_table(pa.table(columns), tmp_path / "foreign.parquet")
    [group] = read_here("parquet", tmp_path / "foreign.parquet", Dialect()).groups
    np.testing.assert_allclose(group.channels["stamps"], [np.nan, 0.0, 0.05])
    np.testing.assert_allclose(group.channels["lasted"], [0.0, 0.05, 0.1])
    assert list(group.channels["large"]) == list(group.channels["coded"]) == ["fill", "hold", "vent"]
    assert group.channels["count"][-1] == 2.0**64
    assert group.units == {"stamps": "s", "lasted": "s"}


def test_parquet_columns_of_one_name_are_refused(tmp_path):
    import pyarrow as pa
    import pyarrow.parquet as pq

    pq.write_table(pa.table([[0.0], [1.0]], names=["time", "time"]), tmp_path / "twice.parquet")
    with pytest.raises(UnreadableError, match="2 columns have the name 'time'"):
        read_here("parquet", tmp_path / "twice.parquet", Dialect())


@pytest.mark.parametrize("version", ["2.14", "3.30", "4.20"])
def test_other_versions_of_mdf_are_read(tmp_path, version):
    asammdf = pytest.importorskip("asammdf")
    path, time = tmp_path / "other.mdf", np.arange(5) * 0.1
    with asammdf.MDF(version=version) as mdf:
        mdf.append([asammdf.Signal(20.0 - time, time, name="speed", unit="m/s")])
        mdf.save(path.with_suffix(".mf4" if version > "4" else ".mdf"))
    (group,) = read_here("mdf", next(tmp_path.iterdir()), Dialect()).groups
    assert group.channels["speed"] == pytest.approx(20.0 - time)
    assert group.time == pytest.approx(time)


def test_mdf_opens_in_its_own_library(written):
    asammdf = pytest.importorskip("asammdf")
    with asammdf.MDF(written("mdf")) as mdf:
        assert mdf.version == "4.10"
        assert len(mdf.groups) == 1
        assert mdf.get("tank_pressure_1").unit == "Pa"
        assert sorted(set(mdf.get("valve_command_1").samples)) == [b"fill", b"hold", b"vent"]
        assert "case: small" in mdf.header.comment


def test_tdms_opens_in_its_own_library(written):
    nptdms = pytest.importorskip("nptdms")
    tdms = nptdms.TdmsFile.read(written("tdms"))
    channel = tdms["stop"]["speed"]
    assert tdms.properties["case"] == "small"
    assert channel.properties["unit_string"] == "m/s"
    assert channel.properties["wf_increment"] == pytest.approx(0.01)
    assert tdms["stop"]["valve_command_1"].properties["states"] == "0 = fill, 1 = hold, 2 = vent"


def test_mat_5_opens_in_its_own_library(written, recording):
    from scipy.io import loadmat

    variables = loadmat(written("mat"), simplify_cells=True)
    assert variables["units"]["speed"] == "m/s"
    np.testing.assert_array_equal(variables["speed"], recording["speed"])


def test_mat_7_3(tmp_path):
    h5py = pytest.importorskip("h5py")
    path = tmp_path / "record.mat"
    with h5py.File(path, "w", userblock_size=512) as file:
        for name in ("t", "v"):
            data = file.create_dataset(name, data=np.arange(10.0).reshape(1, 10))
            data.attrs["MATLAB_class"] = np.bytes_("double")
    with path.open("rb+") as raw:
        raw.write(b"MATLAB 7.3 MAT-file".ljust(124) + b"\x00\x02IM")
    contents = read_here("mat", path, Dialect())
    np.testing.assert_array_equal(contents.groups[0].channels["v"], np.arange(10.0))


@pytest.mark.parametrize("name", EXTRAS)
def test_a_missing_library_is_told_with_the_line_that_installs_it(
    name, written, recording, tmp_path, monkeypatch
):
    path = written(name)
    monkeypatch.setitem(sys.modules, EXTRAS[name], None)
    with pytest.raises(MissingExtraError, match=rf"pip install 'uictest\[{name}\]'"):
        read_here(name, path, Dialect())
    with pytest.raises(MissingExtraError):
        writer_of(name)(recording, tmp_path / "other")


def test_a_module_that_lacks_another_is_no_missing_extra(tmp_path, monkeypatch):
    (tmp_path / "broken_reader.py").write_text("import surely_not_there\n")
    monkeypatch.syspath_prepend(tmp_path)
    with pytest.raises(ModuleNotFoundError, match="surely_not_there"):
        required_module("broken_reader", "x")


def test_a_declared_dialect(tmp_path):
    path = tmp_path / "rig.txt"
    path.write_bytes("Prüfstand 7\n\nt;v;Zustand\ns;km/h;\n0,0;80,5;zu\n0,1;80,25;auf\n".encode("latin-1"))
    contents = read_here("csv", path, Dialect(";", ",", header_line=3, unit_line=4, encoding="latin-1"))
    [group] = contents.groups
    np.testing.assert_array_equal(group.channels["v"], [80.5, 80.25])
    assert list(group.channels["Zustand"]) == ["zu", "auf"]
    assert group.units == {"t": "s", "v": "km/h"}


def test_units_and_numbers_of_names_make_no_other_dialect(tmp_path):
    path = tmp_path / "twice.csv"
    path.write_text("v,v,\n1,2,3\n")
    assert list(read_here("csv", path, Dialect()).groups[0].channels) == ["v (1)", "v (2)", "column 3"]
    path = tmp_path / "names.csv"
    path.write_text("t,v;w;x\n0.0,80.5\n")
    assert list(read_here("csv", path, Dialect()).groups[0].channels) == ["t", "v;w;x"]


@pytest.mark.parametrize(
    ("text", "expected"),
    [
        ("speed [m/s]", ("speed", "m/s")),
        ("p (bar)", ("p", "bar")),
        ("plain", ("plain", "")),
        ("[m]", ("[m]", "")),
        ("a [b] c", ("a [b] c", "")),
    ],
)
def test_units_in_names(text, expected):
    assert names_and_units_of([text]) == [expected]


def test_sizes_are_bounded():
    check_size([(10, 10)])
    for shapes in ([(MOST_VALUES + 1,)], [(2,)] * (MOST_CHANNELS + 1), [(-1,)], [(2**62, 4)]):
        with pytest.raises(UnreadableError):
            check_size(shapes)


def test_the_same_recording_gives_the_same_text(written):
    path = written("csv")
    first = path.read_bytes()
    assert written("csv").read_bytes() == first
    assert first.startswith(b"# case: small\n# brake_command_time: 0 s\ntime [s],speed [m/s]")


@pytest.mark.parametrize(
    ("text", "dialect", "advice"),
    [
        (
            "t;v;p\n0,0;80,5;1\n",
            Dialect(),
            'be separated by \';\' with decimal commas: set csv: {delimiter: ";", decimal: ","}',
        ),
        ("# rig\n\nt;v\n0.0;80.5\n", Dialect(), "be separated by ';': set csv: {delimiter: \";\"}"),
        (
            "t\tv\n0,0\t80,5\n",
            Dialect(),
            'be separated by tabs with decimal commas: set csv: {delimiter: "\\t"',
        ),
        ("a\nt,v\n0.0,80.5\n", Dialect(";", header_line=2), "be separated by ',': set csv"),
    ],
)
def test_a_table_of_another_dialect_says_what_to_declare(tmp_path, text, dialect, advice):
    path = tmp_path / "table.csv"
    path.write_text(text)
    with pytest.raises(UnreadableError, match=f"seems to {re.escape(advice)}"):
        read_here("csv", path, dialect)
