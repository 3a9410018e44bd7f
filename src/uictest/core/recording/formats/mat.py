"""MAT files of every version, by scipy and h5py: arrays, and structures of Simulink and ControlDesk."""

from __future__ import annotations

import contextlib
import io
import re
from collections.abc import Iterable, Iterator, Mapping
from pathlib import Path
from typing import Any, Final, NamedTuple

import numpy as np

from uictest.core.recording.formats.file_formats import check_size, distinct, required_module
from uictest.core.recording.recording import Contents, Group, Recording, Samples
from uictest.core.units import recorded_unit_size

_EXTRA = "mat"
_UNITS, _METADATA = "units", "metadata"
_EXPORTS: Final = {
    "timeseries": (
        "s.{field} = struct('time', {x}.Time, 'signals', struct('values', {x}.Data, 'label', '{field}'));"
    ),
    "Simulink.SimulationData.Dataset": (
        "for k = 1:numElements({x}), e = getElement({x}, k); s.(sprintf('e%d', k)) = struct('time',"
        " e.Values.Time, 'signals', struct('values', e.Values.Data, 'label', e.Name)); end;"
    ),
    "Simulink.SimulationOutput": "n = who({x}); for k = 1:numel(n), s.(n{{k}}) = get({x}, n{{k}}); end;",
    "timetable": (
        "s = table2struct(timetable2table({x}, 'ConvertRowTimes', false), 'ToScalar', true);"
        " s.time = seconds({x}.Properties.RowTimes - {x}.Properties.RowTimes(1));"
    ),
    "table": "s = table2struct({x}, 'ToScalar', true);",
    "datetime": "s.{field} = seconds({x} - {x}(1));",
    "duration": "s.{field} = seconds({x});",
    "string": "s.{field} = double(categorical({x}));",
    "categorical": "s.{field} = double({x});",
    "cell array": "for k = 1:numel({x}), s.(sprintf('{field}_%d', k)) = {x}{{k}}; end;",
    "sparse matrix": "s.{field} = full({x});",
}
"""Class of MATLAB -> the line that puts its numbers into a structure s of arrays."""
_SAVE: Final = "save('plain.mat', '-struct', 's')"


class _Unread(NamedTuple):
    """A value of which no numbers are read: its class in MATLAB, or its kind in words."""

    kind: str


class _Channel(NamedTuple):
    """A channel with the unit and the time that are stated beside it."""

    name: str
    samples: Samples
    unit: str
    time: Samples | None


def read(path: Path) -> Contents:
    """Read every array of real numbers; fields of structures are named `structure.field`.

    A matrix has a channel `name[k]` for each k, counted from one, across its longest dimension. Signals of
    Simulink and ControlDesk have the names and times that stand beside them. Structures `units` and
    `metadata` of texts, as this program writes them, give units and metadata.

    Raises MissingExtraError without h5py where the file is of version 7.3, UnreadableError where it declares
    too much; for a damaged file whatever the library raises.
    """
    from scipy.io.matlab import matfile_version

    version, _ = matfile_version(path)
    variables = _read_hdf5(path) if version == 2 else _read_by_scipy(path, version)
    units, metadata = (_texts_of_structure(variables.pop(name, None)) for name in (_UNITS, _METADATA))
    skipped: dict[str, str] = {}
    channels = _channels_of_to_file_block(variables) or [
        channel for name, value in variables.items() for channel in _channels_of(name, value, skipped)
    ]
    check_size(channel.samples.shape for channel in channels)
    return Contents(tuple(_groups_by_time(channels, units)), metadata, skipped)


def encoded(recording: Recording) -> bytes:
    """Return a recording as version 5: a column vector per channel, `units` and `metadata`."""
    from scipy.io import savemat

    variables: dict[str, Any] = dict(recording.channels)
    variables[_UNITS] = recording.units
    variables[_METADATA] = recording.metadata
    content = io.BytesIO()
    savemat(content, variables, format="5", long_field_names=True, oned_as="column")
    return content.getvalue()


def _read_by_scipy(path: Path, version: int) -> dict[str, Any]:
    """Return the variables of a file before 7.3; one by one from version 5, for scipy keeps one object."""
    from scipy.io import loadmat, matlab, whosmat

    with path.open("rb") as file:
        parts = [part for _, part in matlab.varmats_from_mat(file)] if version else [path]
    shapes: list[tuple[int, ...]] = []
    for part in parts:
        with contextlib.suppress(TypeError):  # scipy before 1.18, of an object
            shapes += [shape or () for _, shape, _ in whosmat(part)]
    check_size(shapes)
    variables: dict[str, Any] = {}
    for name, value in (item for part in parts for item in loadmat(part).items()):
        hidden = isinstance(value, matlab.MatlabOpaque) and "s0" in value.dtype.names  # scipy before 1.18
        if not name.startswith("__"):
            variables[value["s0"].item().decode() if hidden else name] = _from_scipy(value)
    return variables


def _from_scipy(value: Any) -> Any:
    """Return an array of real numbers, a text, a list of structures (of one, as a rule), or _Unread."""
    from scipy.io.matlab import MatlabFunction, MatlabObject, MatlabOpaque

    if isinstance(value, MatlabOpaque):
        kind = value["s2" if "s2" in value.dtype.names else "_Class"].item()
        return _Unread(kind.decode() if isinstance(kind, bytes) else str(kind))
    if isinstance(value, MatlabObject | MatlabFunction) or not isinstance(value, np.ndarray):
        is_function = isinstance(value, MatlabFunction)
        return _Unread(getattr(value, "classname", "function handle" if is_function else "sparse matrix"))
    if names := value.dtype.names:
        return [{name: _from_scipy(record[name]) for name in names} for record in value.ravel(order="F")]
    if value.dtype.kind == "U":
        return "\n".join(map(str, value.ravel()))
    unread = {"O": "cell array", "c": "complex array"}
    return _Unread(unread[value.dtype.kind]) if value.dtype.kind in unread else value


def _read_hdf5(path: Path) -> dict[str, Any]:
    h5py = required_module("h5py", _EXTRA)
    shapes: list[tuple[int, ...]] = []
    with h5py.File(path, "r") as file:
        file.visititems(lambda _, item: shapes.append(getattr(item, "shape", None) or ()))
        check_size(shapes)
        return {name: _from_hdf5(item) for name, item in file.items() if not name.startswith("#")}


def _from_hdf5(item: Any) -> Any:
    """Return a value of version 7.3 alike; its class is an attribute, its dimensions are reversed."""
    kind = str(np.asarray(item.attrs.get("MATLAB_class", "")).astype(str))
    if "MATLAB_object_decode" in item.attrs or "MATLAB_sparse" in item.attrs:
        return _Unread("sparse matrix" if "MATLAB_sparse" in item.attrs else kind)
    if not hasattr(item, "dtype"):
        columns = [[_from_hdf5(element) for element in _field_values(field)] for field in item.values()]
        return [dict(zip(item, record, strict=True)) for record in zip(*columns, strict=True)]
    if "MATLAB_empty" in item.attrs:
        return "" if kind == "char" else np.empty(0)
    if item.dtype.kind not in "biuf":
        return _Unread("complex array" if item.dtype.names else "cell array")
    content = np.asarray(item[()].T)
    if kind != "char":
        return content
    rows = np.atleast_2d(content).astype("<u2")
    return "\n".join(row.tobytes().decode("utf-16-le", "replace") for row in rows)


def _field_values(field: Any) -> list[Any]:
    """Return the values of a field; those of a structure array are references without a class."""
    is_list = getattr(field, "dtype", None) == np.dtype("O") and "MATLAB_class" not in field.attrs
    return [field.file[reference] for reference in field[()].ravel()] if is_list else [field]


def _channels_of_to_file_block(variables: Mapping[str, Any]) -> list[_Channel]:
    """Return the signals of Simulink's To File block: a file of one matrix, times in its first row."""
    name, matrix = next(iter(variables.items())) if len(variables) == 1 else ("", None)
    if not isinstance(matrix, np.ndarray) or matrix.ndim != 2 or not 1 < len(matrix) < matrix.shape[1]:
        return []
    time, *others = _channels_of_array(name, matrix, time=matrix[0].astype(np.float64))
    return others if np.all(np.diff(time.samples) > 0.0) else []


def _channels_of(name: str, value: Any, skipped: dict[str, str], **stated: Any) -> Iterator[_Channel]:
    """Yield the channels of a value; the unit and the time that are `stated` are those of an array."""
    match value:
        case [{"signals": [{"values": _}, *_]} as log]:
            yield from _channels_of_simulink(name, log, skipped)
        case [{"X": [{"Data": _}, *_], "Y": [{"Data": _}, *_]} as capture]:
            yield from _channels_of_controldesk(name, capture, skipped)
        case list():
            for expression, structure in _named_structures(name, value):
                for field, inner in structure.items():
                    yield from _channels_of(f"{expression}.{field}", inner, skipped)
        case np.ndarray() if value.size > 1:
            yield from _channels_of_array(name, value, **stated)
        case _Unread():
            line = _EXPORTS.get(value.kind, "copy its numbers into arrays of a structure s;")
            line = line.format(x=name, field=re.sub(r"\W+", "_", name).strip("_"))
            skipped[name] = f"is a MATLAB {value.kind}, which is not read; in MATLAB: {line} {_SAVE}"
        case _:
            skipped[name] = "is text" if isinstance(value, str) else "holds no series of numbers"


def _channels_of_array(
    name: str, values: Any, unit: str = "", time: Samples | None = None
) -> Iterator[_Channel]:
    """Yield the channels of an array: each has the length of `time`, else that of the longest dimension."""
    shape = values.shape
    axis = shape.index(len(time)) if time is not None and len(time) in shape else int(np.argmax(shape))
    columns = np.moveaxis(values, axis, 0).reshape((shape[axis], -1), order="F").T
    if time is not None and len(time) != shape[axis]:
        time = None
    for k, samples in enumerate(columns.astype(np.float64, order="C"), start=1):
        yield _Channel(f"{name}[{k}]" if len(columns) > 1 else name, samples, unit, time)


def _channels_of_simulink(name: str, log: Mapping[str, Any], skipped: dict[str, str]) -> Iterator[_Channel]:
    """Yield the channels of a Structure or a Structure With Time."""
    time = _as_vector(log.get("time"))
    for expression, signal in _named_structures(f"{name}.signals", log["signals"]):
        block = _as_text(signal.get("blockName")).rpartition("/")[2]
        label = _as_text(signal.get("label")) or block or f"{expression}.values"
        yield from _channels_of(label, signal["values"], skipped, time=time)


def _channels_of_controldesk(
    name: str, capture: Mapping[str, Any], skipped: dict[str, str]
) -> Iterator[_Channel]:
    """Yield the channels of an export of ControlDesk, each with the time that its `XIndex` counts."""
    sizes = [recorded_unit_size(_as_text(axis.get("Unit")) or "s", "s") for axis in capture["X"]]
    axes = zip(capture["X"], sizes, strict=True)
    times = [_as_vector(axis["Data"], size) if size else None for axis, size in axes]
    for expression, signal in _named_structures(f"{name}.Y", capture["Y"]):
        axis = int(np.ravel(signal["XIndex"])[0]) - 1 if len(times) > 1 else 0
        label, unit = _as_text(signal.get("Name")) or f"{expression}.Data", _as_text(signal.get("Unit"))
        yield from _channels_of(label, signal["Data"], skipped, unit=unit, time=times[axis])


def _named_structures(name: str, structures: list[dict[str, Any]]) -> Iterable[tuple[str, dict[str, Any]]]:
    """Return the structures of an array, each with its expression in MATLAB."""
    several = len(structures) > 1
    expressions = [f"{name}({k})" for k in range(1, len(structures) + 1)] if several else [name]
    return zip(expressions, structures, strict=False)


def _groups_by_time(channels: Iterable[_Channel], units: Mapping[str, str]) -> Iterator[Group]:
    """Yield groups of channels that have the same time, or none and the same length."""
    named: dict[str, _Channel] = {}
    by_time: dict[tuple[int, int], list[str]] = {}
    for channel in channels:
        name = distinct(channel.name, named)
        named[name] = channel
        by_time.setdefault((id(channel.time), len(channel.samples)), []).append(name)
    for names in by_time.values():
        stated = {name: unit for name in names if (unit := units.get(name) or named[name].unit)}
        yield Group("", {name: named[name].samples for name in names}, stated, named[names[0]].time)


def _as_vector(value: Any, size: float = 1.0) -> Samples | None:
    is_vector = isinstance(value, np.ndarray) and 1 < value.size == max(value.shape)
    return value.ravel() * size if is_vector else None


def _as_text(value: Any) -> str:
    return value.strip() if isinstance(value, str) else ""


def _texts_of_structure(value: Any) -> dict[str, str]:
    pairs = value[0].items() if isinstance(value, list) and value else ()
    return {name: text for name, text in pairs if isinstance(text, str)}
