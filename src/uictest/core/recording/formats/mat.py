"""MAT files: version 5 by scipy, version 7.3 (which is HDF5) by pymatreader."""

from __future__ import annotations

import io
import math
from collections.abc import Iterator, Mapping
from pathlib import Path
from typing import Any

import numpy as np

from uictest.core.recording.formats.file_formats import check_size, required_module
from uictest.core.recording.recording import Contents, Group, Recording, Samples

_EXTRA = "mat"
_HDF5 = b"\x89HDF\r\n\x1a\n"
_HDF5_OFFSET = 512
"""Bytes of MATLAB's own header before the HDF5 file."""
_DEEPEST = 8
"""Levels of structures that are searched for channels; chosen."""
_UNITS, _METADATA = "units", "metadata"


def read(path: Path) -> Contents:
    """Read every vector of numbers; fields of structures are named `structure.field`.

    Structures `units` and `metadata` of texts, as this program writes them, give units and metadata.
    Raises MissingExtraError without pymatreader where the file is of version 7.3; for a damaged file whatever
    the library raises.
    """
    variables = _read_hdf5(path) if _is_hdf5(path) else _read_version_5(path)
    own = {name: variables.pop(name, None) for name in (_UNITS, _METADATA)}
    skipped: dict[str, str] = {}
    vectors = dict(_vectors(variables, "", 0, skipped))
    units = _texts(own[_UNITS])
    lengths = dict.fromkeys(len(samples) for samples in vectors.values())
    groups = (_group({n: s for n, s in vectors.items() if len(s) == length}, units) for length in lengths)
    return Contents(tuple(groups), _texts(own[_METADATA]), skipped)


def encoded(recording: Recording) -> bytes:
    """Return a recording as version 5: a column vector per channel, `units` and `metadata`."""
    from scipy.io import savemat

    variables: dict[str, Any] = dict(recording.channels)
    variables[_UNITS] = recording.units
    variables[_METADATA] = recording.metadata
    content = io.BytesIO()
    savemat(content, variables, format="5", long_field_names=True, oned_as="column")
    return content.getvalue()


def _is_hdf5(path: Path) -> bool:
    with path.open("rb") as file:
        beginning = file.read(_HDF5_OFFSET + len(_HDF5))
    return beginning.startswith(_HDF5) or beginning[_HDF5_OFFSET:] == _HDF5


def _read_version_5(path: Path) -> dict[str, Any]:
    from scipy.io import loadmat, whosmat

    check_size(shape for _, shape, _ in whosmat(path))
    variables = loadmat(path, simplify_cells=True, chars_as_strings=True)
    return {name: value for name, value in variables.items() if not name.startswith("__")}


def _read_hdf5(path: Path) -> dict[str, Any]:
    pymatreader = required_module("pymatreader", _EXTRA)
    h5py = required_module("h5py", _EXTRA)

    shapes: list[tuple[int, ...]] = []

    def note(name: str, item: Any) -> None:
        if isinstance(item, h5py.Dataset):
            shapes.append(item.shape or ())

    with h5py.File(path, "r") as file:
        file.visititems(note)
    check_size(shapes)
    variables: dict[str, Any] = pymatreader.read_mat(path)
    return variables


def _vectors(
    variables: Mapping[str, Any], above: str, depth: int, skipped: dict[str, str]
) -> Iterator[tuple[str, Samples]]:
    for name, value in variables.items():
        full = f"{above}{name}"
        if isinstance(value, Mapping) and depth < _DEEPEST:
            yield from _vectors(value, f"{full}.", depth + 1, skipped)
            continue
        samples = _samples(value)
        if samples is None:
            skipped[full] = "holds no vector of numbers"
        else:
            yield full, samples


def _samples(value: Any) -> Samples | None:
    if not isinstance(value, np.ndarray | list | tuple):
        return None
    try:
        samples = np.asarray(value)
    except ValueError:
        return None
    is_vector = samples.size == math.prod(samples.shape) == max(samples.shape, default=0)
    if not is_vector or samples.size < 2 or samples.dtype.kind not in "biuf":
        return None
    return samples.astype(np.float64).ravel()


def _group(channels: dict[str, Samples], units: Mapping[str, str]) -> Group:
    return Group("", channels, {name: units[name] for name in channels if name in units})


def _texts(value: Any) -> dict[str, str]:
    return {str(k): str(v) for k, v in value.items()} if isinstance(value, Mapping) else {}
