"""MAT files as MATLAB, Simulink and ControlDesk write them, of every version."""

import struct

import numpy as np
import pytest
from hypothesis import given, strategies as st
from scipy.io import loadmat, savemat

from uictest.core.recording.formats import Dialect, UnreadableError, read_contents
from uictest.core.recording.formats.file_formats import MOST_CHANNELS, format_of
from uictest.core.recording.formats.isolation import read_here

TIME = np.arange(30) * 0.1
SIGNALS = np.stack([20.0 - TIME, 19.0 - TIME, np.cos(TIME)], axis=1)
COLUMN = TIME[:, None]


class Unreadable:
    """An object of a class of MATLAB."""

    def __init__(self, name):
        self.name = name


def _element(kind, content):
    return struct.pack("<II", kind, len(content)) + content + bytes(-len(content) % 8)


def _matrix(kind, *parts):
    return _element(14, _element(6, struct.pack("<II", kind, 0)) + b"".join(parts))


def _object_of_version_5(name, value):
    """As MATLAB writes an object: name, type system, class, and references into a hidden variable."""
    references = np.array([0xDD000000, 2, 1, 1, 1, 1], "<u4")
    numbers = _matrix(
        13, _element(5, struct.pack("<ii", 6, 1)), _element(1, b""), _element(6, references.tobytes())
    )
    return _matrix(17, *(_element(1, text) for text in (name, b"MCOS", value.name.encode())), numbers)


def _as_scipy_writes_it(value):
    """A structure array, which a list of dictionaries is not to scipy."""
    if isinstance(value, dict):
        return {name: _as_scipy_writes_it(each) for name, each in value.items()}
    if not isinstance(value, list):
        return value
    array = np.empty(len(value), [(name, object) for name in value[0]])
    for k, each in enumerate(value):
        array[k] = tuple(map(_as_scipy_writes_it, each.values()))
    return array


def write_version_5(path, variables):
    plain = {name: value for name, value in variables.items() if not isinstance(value, Unreadable)}
    savemat(path, _as_scipy_writes_it(plain), oned_as="column", long_field_names=True)
    with path.open("ab") as file:
        for name, value in variables.items():
            if isinstance(value, Unreadable):
                file.write(_object_of_version_5(name.encode(), value))


def write_version_73(path, variables):
    h5py = pytest.importorskip("h5py")
    with h5py.File(path, "w", userblock_size=512) as file:
        for name, value in variables.items():
            _write_hdf5(h5py, file, name, value)
    with path.open("rb+") as raw:
        raw.write(b"MATLAB 7.3 MAT-file, Platform: GLNXA64".ljust(124) + b"\x00\x02IM")


def _write_hdf5(h5py, parent, name, value):
    kind = {dict: "struct", list: "struct", str: "char"}.get(type(value), "double")
    if isinstance(value, dict | list):
        item = parent.create_group(name)
        for field in value[0] if isinstance(value, list) else value:
            if isinstance(value, dict):
                _write_hdf5(h5py, item, field, value[field])
                continue
            stored = parent.file.require_group("#refs#")
            names = [f"{len(stored) + k}" for k in range(len(value))]
            for place, each in zip(names, value, strict=True):
                _write_hdf5(h5py, stored, place, each[field])
            references = np.array([[stored[place].ref] for place in names], h5py.ref_dtype)
            item.create_dataset(field, data=references, dtype=h5py.ref_dtype)
    elif isinstance(value, Unreadable):
        kind = value.name
        item = parent.create_dataset(name, data=np.array([[0xDD000000, 2, 1, 1, 1, 1]], "u4"))
        item.attrs["MATLAB_object_decode"] = np.int32(3)
    elif isinstance(value, str):
        item = parent.create_dataset(name, data=np.array([[ord(letter)] for letter in value], "u2"))
        item.attrs["MATLAB_int_decode"] = np.int32(2)
    elif np.size(value) == 0:
        item = parent.create_dataset(name, data=np.zeros(2, "u8"))
        item.attrs["MATLAB_empty"] = np.uint8(1)
    else:
        array = np.asarray(value)
        array = array[:, None] if array.ndim == 1 else np.atleast_2d(array)
        if array.dtype.kind == "c":
            array = array.astype("c16").view([("real", "f8"), ("imag", "f8")])
        item = parent.create_dataset(name, data=array.T)
    item.attrs["MATLAB_class"] = np.bytes_(kind)


@pytest.fixture(params=[write_version_5, write_version_73], ids=["5", "7.3"])
def read(request, tmp_path):
    """Write variables as one of the versions, and read them."""

    def written_and_read(variables):
        path = tmp_path / "export.mat"
        request.param(path, variables)
        assert format_of(path) == "mat"
        return read_here("mat", path, Dialect())

    return written_and_read


def channels_of(contents):
    return {name: samples for group in contents.groups for name, samples in group.channels.items()}


def test_vectors_of_any_orientation_and_type_are_channels_of_one_raster(read):
    kinds = {
        "row": TIME[None, :],
        "column": COLUMN,
        "integer": np.arange(30, dtype="i2"),
        "logical": TIME > 1,
    }
    [group] = read(kinds).groups
    assert set(group.channels) == set(kinds)
    assert all(samples.dtype == np.float64 for samples in group.channels.values())
    np.testing.assert_array_equal(group.channels["row"], TIME)
    np.testing.assert_array_equal(group.channels["logical"], TIME > 1)


def test_the_columns_of_a_matrix_belong_to_the_time_beside_it(read):
    [group] = read({"tout": COLUMN, "simout": SIGNALS}).groups
    assert (set(group.channels), group.time) == ({"tout", "simout[1]", "simout[2]", "simout[3]"}, None)
    np.testing.assert_array_equal(group.channels["simout[2]"], SIGNALS[:, 1])


def test_a_third_dimension_is_the_time_of_what_comes_before_counted_as_matlab_does(read):
    """MATLAB counts the elements of a matrix down its columns: A(2) is A(2, 1)."""
    cube = np.arange(120.0).reshape(2, 2, 30)
    channels = channels_of(read({"cube": cube, "row": SIGNALS.T[:, None, :]}))
    for k, (row, column) in enumerate([(0, 0), (1, 0), (0, 1), (1, 1)], start=1):
        np.testing.assert_array_equal(channels[f"cube[{k}]"], cube[row, column])
    np.testing.assert_array_equal(channels["row[3]"], SIGNALS[:, 2])


def test_a_structure_with_time_gives_labels_and_times(read):
    signals = {"values": SIGNALS, "dimensions": 3.0, "label": "v_wheel"}
    contents = read({"simout": {"time": COLUMN, "signals": signals, "blockName": "stop/To Workspace"}})
    [group] = contents.groups
    assert list(group.channels) == ["v_wheel[1]", "v_wheel[2]", "v_wheel[3]"]
    np.testing.assert_array_equal(group.time, TIME)


def test_signals_without_a_label_have_the_name_of_their_block_or_their_place(read):
    signals = [
        {"values": SIGNALS[:, :1], "label": "", "blockName": "stop/Speeds/Train speed"},
        {"values": SIGNALS[:, 1:2], "label": "", "blockName": ""},
        {"values": SIGNALS[:, 2:], "label": "v", "blockName": "stop/Out3"},
    ]
    contents = read({"yout": {"time": COLUMN, "signals": signals}})
    [group] = contents.groups
    assert list(group.channels) == ["Train speed", "yout.signals(2).values", "v"]
    contents = read({"yout": {"time": np.zeros((0, 0)), "signals": signals}})
    assert [group.time for group in contents.groups] == [None]


def test_structures_of_different_rasters_keep_their_own_times(read):
    slow = {"time": COLUMN[::2], "signals": {"values": SIGNALS[::2, 0], "label": "p"}}
    fast = {"time": COLUMN, "signals": {"values": SIGNALS[:, 0], "label": "v"}}
    again = {"time": COLUMN + 5.0, "signals": {"values": SIGNALS[:, 1], "label": "v"}}
    groups = read({"a_slow": slow, "b_fast": fast, "c_again": again}).groups
    assert [(list(group.channels), group.time[0]) for group in groups] == [
        (["p"], 0.0),
        (["v"], 0.0),
        (["v (2)"], 5.0),
    ]


def test_an_export_of_controldesk_gives_names_units_and_the_time_of_each_raster(read):
    path = '"Model Root"/"Speeds"/"v_train"'
    axes = [
        {"Name": "time", "Data": TIME[None, :], "Unit": "s"},
        {"Name": "t2", "Data": TIME[::3], "Unit": "ms"},
    ]
    signals = [
        {"Name": path, "Data": SIGNALS[:, 0][None, :], "Unit": "m/s", "XIndex": 1.0},
        {"Name": "p", "Data": SIGNALS[::3, 1], "Unit": "bar", "XIndex": 2.0},
        {"Name": "", "Data": SIGNALS[:, 2], "Unit": "", "XIndex": 1.0},
    ]
    first, second = read({"stop_007": {"X": axes, "Y": signals, "Description": "run 7"}}).groups
    assert list(first.channels) == [path, "stop_007.Y(3).Data"]
    assert (first.units, second.units) == ({path: "m/s"}, {"p": "bar"})
    np.testing.assert_array_equal(first.time, TIME)
    np.testing.assert_allclose(second.time, TIME[::3] * 1e-3)
    [group] = read({"stop": {"X": axes[0], "Y": signals[0]}}).groups
    assert list(group.channels) == [path]


def test_the_first_row_of_a_to_file_block_is_the_time_of_the_others_and_no_other_row(read):
    [group] = read({"ans": np.vstack([TIME, SIGNALS.T])}).groups
    assert list(group.channels) == ["ans[2]", "ans[3]", "ans[4]"]
    np.testing.assert_array_equal(group.time, TIME)
    np.testing.assert_array_equal(group.channels["ans[2]"], SIGNALS[:, 0])
    for first, others in ((TIME, {"t": TIME}), (-TIME, {})):  # there is another time; no row rises
        [group] = read({"data": np.vstack([first, SIGNALS.T]), **others}).groups
        assert group.time is None
        assert {"data[1]", "data[4]"} <= set(group.channels)


def test_structures_are_searched_and_what_is_no_series_is_skipped_with_a_reason(read):
    stop = {"v": TIME, "rig": {"p": [{"bar": TIME}, {"bar": 2 * TIME}]}, "title": "run 7", "mass": 40.0}
    contents = read({"stop": stop, "nothing": np.zeros((0, 0)), "z": TIME + 1j})
    channels = channels_of(contents)
    assert set(channels) == {"stop.v", "stop.rig.p(1).bar", "stop.rig.p(2).bar"}
    np.testing.assert_array_equal(channels["stop.rig.p(2).bar"], 2 * TIME)
    reasons = contents.skipped
    assert (reasons["stop.title"], reasons["stop.mass"]) == ("is text", "holds no series of numbers")
    assert reasons["nothing"] == "holds no series of numbers"
    assert reasons["z"].startswith("is a MATLAB complex array, which is not read; in MATLAB: ")


def test_cells_and_sparse_matrices_are_skipped_by_name(tmp_path):
    from scipy.sparse import csc_array

    path = tmp_path / "kinds.mat"
    savemat(path, {"v": TIME, "c": np.array([TIME, "text"], dtype=object), "few": csc_array(np.eye(4))})
    skipped = read_here("mat", path, Dialect()).skipped
    assert (
        "in MATLAB: for k = 1:numel(c), s.(sprintf('c_%d', k)) = c{k}; end; save('plain.mat', '-struct', 's')"
        in skipped["c"]
    )
    assert "in MATLAB: s.few = full(few);" in skipped["few"]


LINES = {
    "timeseries": "s.x = struct('time', x.Time, 'signals', struct('values', x.Data, 'label', 'x'));",
    "timetable": "s = table2struct(timetable2table(x, 'ConvertRowTimes', false), 'ToScalar', true);",
    "table": "s = table2struct(x, 'ToScalar', true);",
    "datetime": "s.x = seconds(x - x(1));",
    "duration": "s.x = seconds(x);",
    "string": "s.x = double(categorical(x));",
    "categorical": "s.x = double(x);",
    "Simulink.SimulationData.Dataset": "for k = 1:numElements(x), e = getElement(x, k);",
    "Simulink.SimulationOutput": "n = who(x); for k = 1:numel(n), s.(n{k}) = get(x, n{k}); end;",
    "MyCompany.Stop": "copy its numbers into arrays of a structure s;",
}


@pytest.mark.parametrize("kind", LINES)
def test_an_object_is_refused_by_its_class_with_the_line_that_exports_it(read, kind):
    reason = f"is a MATLAB {kind}, which is not read; in MATLAB: {LINES[kind]}"
    with pytest.raises(UnreadableError) as caught:
        read({"x": Unreadable(kind), "y": Unreadable(kind)})
    assert str(caught.value).startswith(f"no channel with samples; 'x' {reason}")
    assert str(caught.value).endswith("; also skipped: 'y'")
    skipped = read({"t": TIME, "x": Unreadable(kind)}).skipped
    assert skipped["x"].startswith(reason)
    assert skipped["x"].endswith("save('plain.mat', '-struct', 's')")


def test_no_reference_number_is_ever_a_channel_and_every_object_keeps_its_name(read):
    contents = read({"t": TIME, "speed": Unreadable("timeseries"), "v1": Unreadable("timeseries")})
    assert (set(channels_of(contents)), set(contents.skipped)) == ({"t"}, {"speed", "v1"})


def test_an_object_in_a_structure_is_named_by_its_expression(tmp_path):
    path = tmp_path / "bus.mat"
    write_version_73(path, {"bus": [{"v": Unreadable("timeseries")}] * 2, "t": TIME})
    skipped = read_here("mat", path, Dialect()).skipped
    assert "s.bus_2_v = struct('time', bus(2).v.Time, " in skipped["bus(2).v"]
    write_version_5(path, {"t": TIME})
    fields = struct.pack("<HHi", 5, 4, 8) + _element(1, b"v".ljust(8, b"\0"))
    shape = _element(5, struct.pack("<ii", 1, 1))
    inner = _object_of_version_5(b"", Unreadable("timeseries"))
    with path.open("ab") as file:
        file.write(_matrix(2, shape, _element(1, b"bus"), fields, inner))
    skipped = read_here("mat", path, Dialect()).skipped
    assert "s.bus_v = struct('time', bus.v.Time, " in skipped["bus.v"]


def _as_line_of_timeseries(samples):
    return {"x": {"time": COLUMN, "signals": {"values": samples, "label": "x"}}}


@pytest.mark.parametrize(
    ("saved", "names"),
    [
        (_as_line_of_timeseries(SIGNALS[:, :1]), ["x"]),
        (_as_line_of_timeseries(SIGNALS.T[:1][:, None, :]), ["x"]),
        (_as_line_of_timeseries(SIGNALS), ["x[1]", "x[2]", "x[3]"]),
        ({"e1": {"time": COLUMN, "signals": {"values": SIGNALS[:, :1], "label": "v_train"}}}, ["v_train"]),
        ({"e1": {"time": COLUMN, "signals": {"values": SIGNALS[:, :1], "label": ""}}}, ["e1.signals.values"]),
    ],
    ids=["vector", "scalar-in-3-d", "matrix", "dataset", "dataset-without-name"],
)
def test_what_the_line_for_logs_saves_is_read_with_its_time(read, saved, names):
    [group] = read(saved).groups
    assert list(group.channels) == names
    np.testing.assert_array_equal(group.time, TIME)
    np.testing.assert_array_equal(group.channels[names[0]], SIGNALS[:, 0])


def test_what_the_line_for_tables_saves_is_read_and_a_short_log_has_the_samples_of_its_time(read):
    [group] = read({"time": COLUMN, "speed": SIGNALS[:, :1], "force": SIGNALS[:, 1:]}).groups
    assert set(group.channels) == {"time", "speed", "force[1]", "force[2]"}
    log = {"time": np.array([0.0, 0.1]), "signals": {"values": SIGNALS[:2], "label": "v"}}
    [group] = read({"simout": log}).groups
    np.testing.assert_array_equal(group.channels["v[3]"], SIGNALS[:2, 2])


@pytest.mark.parametrize(("code", "kind"), [(0, "f8"), (10, "f4"), (30, "i2")])
@pytest.mark.parametrize("order", ["<", ">"])
def test_version_4_is_read_in_both_orders_of_bytes(tmp_path, order, code, kind):
    path = tmp_path / "old.mat"
    stored = {name: samples.astype(f"{order}{kind}") for name, samples in (("t", COLUMN), ("v", SIGNALS))}
    with path.open("wb") as file:
        for name, samples in stored.items():
            code_of_file = code + (0 if order == "<" else 1000)
            head = struct.pack(f"{order}5i", code_of_file, *samples.shape, 0, len(name) + 1)
            file.write(head + name.encode() + b"\0" + samples.tobytes(order="F"))
    np.testing.assert_array_equal(loadmat(path)["v"], stored["v"])
    assert format_of(path) == "mat"
    [group] = read_here("mat", path, Dialect()).groups
    np.testing.assert_array_equal(group.channels["v[3]"], stored["v"][:, 2])


@given(rows=st.integers(2, 40), columns=st.integers(1, 40), seed=st.integers(0, 99))
def test_every_number_of_a_matrix_has_its_place(tmp_path_factory, rows, columns, seed):
    """Column k, or row k of a matrix that is wider than high."""
    matrix = np.random.default_rng(seed).normal(size=(rows, columns))
    path = tmp_path_factory.mktemp("matrix") / "m.mat"
    savemat(path, {"m": matrix, "beside": "text"})
    channels = channels_of(read_here("mat", path, Dialect()))
    series = matrix.T if rows >= columns else matrix
    names = ["m"] if len(series) == 1 else [f"m[{k}]" for k in range(1, len(series) + 1)]
    assert list(channels) == names
    for name, samples in zip(names, series, strict=True):
        np.testing.assert_array_equal(channels[name], samples)


def test_a_limit_holds_for_the_columns_of_all_matrices_together(read):
    matrix = np.zeros((100, 100), "u1")
    with pytest.raises(UnreadableError, match=f"20100 channels; at most {MOST_CHANNELS} are read"):
        read({f"m{k}": matrix for k in range(201)})


def test_a_claim_of_size_is_refused_beside_objects(tmp_path):
    path = tmp_path / "claim.mat"
    write_version_5(path, {"x": Unreadable("table")})
    shape = _element(5, struct.pack("<ii", 10**5, 10**5))
    with path.open("ab") as file:
        file.write(_matrix(6, shape, _element(1, b"m"), _element(9, b"")))
    with pytest.raises(UnreadableError, match="values; at most"):
        read_here("mat", path, Dialect())


def test_a_process_of_its_own_names_objects_and_reads_logs(tmp_path):
    path = tmp_path / "log.mat"
    write_version_5(path, {"simout": {"time": COLUMN, "signals": {"values": SIGNALS, "label": "v"}}})
    [group] = read_contents(path).groups
    np.testing.assert_array_equal(group.time, TIME)
    write_version_5(path, {"speed": Unreadable("timeseries"), "v1": Unreadable("timeseries")})
    with pytest.raises(UnreadableError, match=r"'speed' is a MATLAB timeseries, .* also skipped: 'v1'"):
        read_contents(path)
