"""Every format: written, read, known by its content, and read block by block."""

import re
import sys

import numpy as np
import pytest
from hypothesis import given, strategies as st

from uictest.core.recording import Group
from uictest.core.recording.formats import (
    FORMATS,
    Dialect,
    MissingExtraError,
    UnreadableError,
    format_of,
    mdf,
    read_contents,
    read_pieces,
    tdms,
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
from uictest.core.recording.formats.pieces import in_step

EXTRAS = {"mdf": "asammdf", "tdms": "nptdms"}


@pytest.mark.parametrize("name", FORMATS)
def test_what_is_written_is_read_also_in_a_process_of_its_own(name, written, recording):
    """The format is known by the content; magnets and every bit of a diagnosis come back."""
    path = written(name)
    assert format_of(path) == name
    contents = read_here(name, path, Dialect())
    assert contents.metadata == recording.metadata
    [group] = contents.groups
    time = group.channels["time"] if group.time is None else group.time
    np.testing.assert_allclose(time, recording["time"], atol=1e-9)
    assert group.units["speed"] == "m/s"
    np.testing.assert_allclose(group.channels["speed"], recording["speed"], rtol=1e-9)
    np.testing.assert_array_equal(group.channels["diagnosis"], recording["diagnosis"])
    magnet = group.channels["vent_magnet_1"]
    states = np.where(recording["vent_magnet_1"] > 0, "on", "off") if magnet.dtype.kind == "U" else None
    np.testing.assert_array_equal(magnet, recording["vent_magnet_1"] if states is None else states)
    apart = read_contents(path)
    [other] = apart.groups
    assert (apart.metadata, other.units) == (contents.metadata, group.units)
    for channel in group.channels:
        np.testing.assert_array_equal(other.channels[channel], group.channels[channel])


def test_parquet_columns_as_other_programs_write_them_and_of_one_name_refused(tmp_path):
    import pyarrow as pa
    import pyarrow.parquet as pq

    states = pa.array(["fill", "hold", "vent"])
    columns = {
        "stamps": pa.array([None, 0, 50_000], pa.timestamp("us")),
        "lasted": pa.array([0, 50, 100], pa.duration("ms")),
        "large": states.cast(pa.large_string()),
        "coded": states.dictionary_encode(),
        "count": pa.array([0, 1, 2**64 - 1], pa.uint64()),
    }
    path = tmp_path / "foreign.parquet"
    pq.write_table(pa.table(columns), path)
    [group] = read_here("parquet", path, Dialect()).groups
    np.testing.assert_allclose(group.channels["stamps"], [np.nan, 0.0, 0.05])
    np.testing.assert_allclose(group.channels["lasted"], [0.0, 0.05, 0.1])
    assert list(group.channels["large"]) == list(group.channels["coded"]) == ["fill", "hold", "vent"]
    assert group.channels["count"][-1] == 2.0**64
    assert group.units == {"stamps": "s", "lasted": "s"}
    pq.write_table(pa.table([[0.0], [1.0]], names=["time", "time"]), path)
    with pytest.raises(UnreadableError, match="2 columns have the name 'time'"):
        read_here("parquet", path, Dialect())


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


def test_each_format_opens_in_its_own_library(written, recording):
    from scipy.io import loadmat

    asammdf, nptdms = pytest.importorskip("asammdf"), pytest.importorskip("nptdms")
    with asammdf.MDF(written("mdf")) as mdf:
        assert mdf.version == "4.10"
        assert len(mdf.groups) == 1
        assert mdf.get("tank_pressure_1").unit == "Pa"
        assert sorted(set(mdf.get("valve_command_1").samples)) == [b"fill", b"hold", b"vent"]
        assert "case: small" in mdf.header.comment
    tdms = nptdms.TdmsFile.read(written("tdms"))
    channel = tdms["stop"]["speed"]
    assert tdms.properties["case"] == "small"
    assert channel.properties["unit_string"] == "m/s"
    assert channel.properties["wf_increment"] == pytest.approx(0.01)
    assert tdms["stop"]["valve_command_1"].properties["states"] == "0 = fill, 1 = hold, 2 = vent"
    variables = loadmat(written("mat"), simplify_cells=True)
    assert variables["units"]["speed"] == "m/s"
    np.testing.assert_array_equal(variables["speed"], recording["speed"])


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


def test_a_declared_dialect_is_read_and_units_and_numbers_of_names_make_no_other(tmp_path):
    path = tmp_path / "rig.txt"
    path.write_bytes("Prüfstand 7\n\nt;v;Zustand\ns;km/h;\n0,0;80,5;zu\n0,1;80,25;auf\n".encode("latin-1"))
    contents = read_here("csv", path, Dialect(";", ",", header_line=3, unit_line=4, encoding="latin-1"))
    [group] = contents.groups
    np.testing.assert_array_equal(group.channels["v"], [80.5, 80.25])
    assert list(group.channels["Zustand"]) == ["zu", "auf"]
    assert group.units == {"t": "s", "v": "km/h"}
    tables = {"v,v,\n1,2,3\n": ["v (1)", "v (2)", "column 3"], "t,v;w;x\n0.0,80.5\n": ["t", "v;w;x"]}
    for text, names in tables.items():
        path.write_text(text)
        assert list(read_here("csv", path, Dialect()).groups[0].channels) == names
    plain, named = Dialect(), Dialect(";", header_line=2)
    comma, tab = 'csv: {delimiter: ";", decimal: ","}', 'csv: {delimiter: "\\t"'
    for text, dialect, advice in (
        ("t;v;p\n0,0;80,5;1\n", plain, f"be separated by ';' with decimal commas: set {comma}"),
        ("# rig\n\nt;v\n0.0;80.5\n", plain, "be separated by ';': set csv: {delimiter: \";\"}"),
        ("t\tv\n0,0\t80,5\n", plain, f"be separated by tabs with decimal commas: set {tab}"),
        ("a\nt,v\n0.0,80.5\n", named, "be separated by ',': set csv"),
    ):
        path.write_text(text)
        with pytest.raises(UnreadableError, match=f"seems to {re.escape(advice)}"):
            read_here("csv", path, dialect)


def test_units_in_names_bounded_sizes_and_the_same_text_for_the_same_recording(written):
    names = ["speed [m/s]", "p (bar)", "plain", "[m]", "a [b] c"]
    told = [("speed", "m/s"), ("p", "bar"), ("plain", ""), ("[m]", ""), ("a [b] c", "")]
    assert [names_and_units_of([name])[0] for name in names] == told
    check_size([(10, 10)])
    for shapes in ([(MOST_VALUES + 1,)], [(2,)] * (MOST_CHANNELS + 1), [(-1,)], [(2**62, 4)]):
        with pytest.raises(UnreadableError):
            check_size(shapes)
    first = written("csv").read_bytes()
    assert written("csv").read_bytes() == first
    assert first.startswith(b"# case: small\n# brake_command_time: 0 s\ntime [s],speed [m/s]")


FAST = 0.001


def blocks(name, interval, rows, count):
    """Yield a group whose samples are its times."""
    for k in range(count):
        time = interval * np.arange(k * rows, (k + 1) * rows)
        yield Group("", {name: time.copy()}, {}, time)


@given(st.sampled_from([0.1, 0.01, FAST]), st.integers(2, 400), st.integers(2, 500))
def test_every_part_has_the_samples_beside_it_and_no_row_is_lost(interval, rows, fast_rows):
    leading = blocks("speed", interval, rows, 3)
    lasts = 3 * rows * interval
    beside = blocks("pressure", FAST, fast_rows, int(lasts / FAST / fast_rows) + 1)
    parts = [contents.groups for contents in in_step([beside, leading], ["speed"])]
    np.testing.assert_array_equal(
        np.concatenate([own.channels["speed"] for own, _ in parts]), interval * np.arange(3 * rows)
    )
    for own, other in parts:
        inside = other.time[(other.time >= own.time[0]) & (other.time <= own.time[-1])]
        every = FAST * np.arange(round(own.time[-1] / FAST) + 1)
        np.testing.assert_array_equal(inside, every[(every >= own.time[0]) & (every <= own.time[-1])])


def test_a_fast_group_beside_a_slow_one_is_not_held_for_the_length_of_a_slow_block():
    slow, fast = blocks("speed", 0.1, 36_000, 1), blocks("pressure", FAST, 1000, 3600)
    held = [other.time.size for _, other in (each.groups for each in in_step([slow, fast], ["speed"]))]
    assert max(held) < 2 * 1000


def test_a_step_of_the_clock_by_years_takes_no_memory():
    time = np.array([0.0, 1.0, 8e8, 8e8 + 1.0])
    slow = iter([Group("", {"speed": time}, {}, time)])
    parts = in_step([slow, blocks("p", FAST, 9, 3)], ["speed"])
    sizes = [own.time.size for own, _ in (each.groups for each in parts)]
    assert sum(sizes) == 4


@pytest.mark.parametrize("count", [1, 2])
def test_groups_without_times_go_alone_only(count):
    groups = [iter([Group("", {f"speed{k}": np.zeros(3)}, {}, None)]) for k in range(count)]
    if count == 1:
        assert len(list(in_step(groups, ["speed0"]))) == 1
    else:
        with pytest.raises(UnreadableError, match="no times of its own"):
            list(in_step(groups, ["speed0"]))


@pytest.mark.parametrize("kind", ["tdms", "mdf"])
def test_blocks_know_their_first_row_where_the_file_has_no_times(tmp_path, monkeypatch, kind):
    samples, path = np.arange(60_000.0), tmp_path / f"a.{kind}"
    if kind == "tdms":
        nptdms = pytest.importorskip("nptdms")
        with nptdms.TdmsWriter(path) as writer:
            writer.write_segment([nptdms.ChannelObject("g", "v", samples)])
    else:
        asammdf = pytest.importorskip("asammdf")
        with asammdf.MDF() as file:
            file.append([asammdf.Signal(samples, 0.02 * samples, name="v")])
            path = file.save(tmp_path / "a.mf4")
    monkeypatch.setattr(tdms, "AT_ONCE", 7_000)
    monkeypatch.setattr(mdf, "AT_ONCE", 100_000)
    groups = [group for contents in read_pieces(path, Dialect()) for group in contents.groups]
    assert len(groups) > 1
    assert [group.first_row for group in groups] == [group.channels["v"][0] for group in groups]
