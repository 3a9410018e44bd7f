"""What files and texts hold, without what cannot be the same twice. For `same_outputs.py`."""

from __future__ import annotations

import hashlib
import io
import itertools
import re
import tempfile
import zipfile
from collections.abc import Iterator
from pathlib import Path
from typing import Final

REPOSITORY: Final = Path(__file__).resolve().parents[1]
SCRATCH: Final = "same-outputs-"
"""How the name of the temporary folder begins in which commands run."""
_TEMPORARY: Final = re.escape(str(Path(tempfile.gettempdir()).resolve()))

RULES: Final = tuple(
    (re.compile(pattern, re.MULTILINE), replacement)
    for pattern, replacement in (
        # Paths of the two trees, and of the folder in which commands run.
        (rf"{_TEMPORARY}/{SCRATCH}\w+/(?:tree|work)\b", "<path>"),
        (rf"{re.escape(str(REPOSITORY))}(?![\w.-])", "<path>"),
        # Times: in the name of a run, whose digest stays; and with a time of day.
        (r"\b20\d{6}T\d{6}Z", "<time>"),
        (r"\b20\d\d-\d\d-\d\d[T ]\d\d:\d\d(?::\d\d(?:\.\d+)?)?(?: UTC|Z|[+-]\d\d:\d\d)?", "<time>"),
        # Durations: of a run, in JUnit, of --durations.
        (r"\bin \d+\.\d+ ?s\b", "in <duration>"),
        (r'(?<= time=")\d+\.\d+(?=")', "<duration>"),
        (r"^ +\d+\.\d{3} s(?=  \S)", "<duration>"),
        # Durations of answers in `controller check`: table, JUnit, JSON, reason.
        (r"^(in-time +pass +)\S+ +", r"\1<duration>  "),
        (r"(?<=within the cycle\. )\S+(?=, at most 100 %)", "<duration>"),
        (r'("id": "in-time",\n(?:.*\n){2} *"value": )[-\d.e]+', r"\1<duration>"),
        (r"(?<= answers within )\S+ \S+, the longest \S+ \S+?(?=[\"<\n])", "<duration>"),
        # Lines that appear only where the machine is slow.
        (r"^uictest: \d+ of \d+ \w+ after [^\n]*\n", ""),
        # The program: its version, and the digest of its code in the manifest of a sweep.
        (r"(?<=\buictest )\d+\.\d+\.\d+(?:\.dev\d+)?\b", "<version>"),
        (r'(?<="program": ")[0-9a-f]{16}(?=")', "<digest>"),
        (r"(?<=^Provenance \| program \| )[0-9a-f]{16}\b", "<digest>"),
    )
)
"""What cannot be the same twice, and what stands for it; each as narrow as can be."""


def steady(text: str) -> str:
    """Return the text without what cannot be the same twice."""
    for pattern, replacement in RULES:
        text = pattern.sub(replacement, text)
    return text


def content(path: Path) -> str:
    """Return as text what a file or link holds, without what its container adds."""
    if path.is_symlink():
        return f"link to {path.readlink()}"
    if path.name == "SHA256SUMS":
        return "\n".join(_checked(line, path.parent) for line in path.read_text("utf-8").splitlines())
    return _content(path.name, path.read_bytes())


def _checked(line: str, folder: Path) -> str:
    """Return a line of SHA256SUMS with the word right or wrong in place of the digest."""
    digest, _, name = line.partition("  ")
    if not re.fullmatch("[0-9a-f]{64}", digest):
        return line
    right = hashlib.sha256((folder / name).read_bytes()).hexdigest() == digest
    return f"{'right' if right else 'wrong'}  {name}"


def _content(name: str, data: bytes) -> str:
    if name.endswith((".xlsx", ".fmu", ".zip")):
        cells = _cells(data) if name.endswith(".xlsx") else ()
        return "\n".join([*cells, *_members(data)])
    if name.endswith(tuple(_READERS)):
        return "\n".join(_READERS[f".{name.rpartition('.')[2]}"](io.BytesIO(data)))
    try:
        return data.decode("utf-8")
    except UnicodeDecodeError:
        return f"{len(data)} bytes, SHA-256 {hashlib.sha256(data).hexdigest()}"


def _members(data: bytes) -> Iterator[str]:
    with zipfile.ZipFile(io.BytesIO(data)) as archive:
        for name in archive.namelist():
            yield f"member {name}\n{_content(name, archive.read(name))}"


def _cells(data: bytes) -> Iterator[str]:
    import openpyxl

    for sheet in openpyxl.load_workbook(io.BytesIO(data)):
        for row in sheet.iter_rows(values_only=True):
            yield f"{sheet.title} | {' | '.join(map(str, row))}"


def _of_parquet(file: io.BytesIO) -> Iterator[str]:
    from pyarrow import parquet

    table = parquet.read_table(file)
    yield table.schema.to_string(truncate_metadata=False)
    yield from (f"{name}: {table[name].to_pylist()}" for name in table.column_names)


def _of_mf4(file: io.BytesIO) -> Iterator[str]:
    from asammdf import MDF

    with MDF(file) as recording:
        yield recording.header.comment  # its times are those of writing
        for signal in recording.iter_channels():
            yield f"{signal.name} {signal.unit} {signal.conversion}: {signal.samples.tolist()}"


def _of_tdms(file: io.BytesIO) -> Iterator[str]:
    from nptdms import TdmsFile

    recording = TdmsFile.read(file)
    yield str(dict(recording.properties))
    for channel in itertools.chain(*(group.channels() for group in recording.groups())):
        yield f"{channel.path} {dict(channel.properties)}: {channel[:].tolist()}"


def _of_mat(file: io.BytesIO) -> Iterator[str]:
    from scipy.io import loadmat

    for name, values in loadmat(file).items():
        if name == "__header__":
            values = values.partition(b", Created on")[0]
        yield f"{name}: {values.tolist() if hasattr(values, 'tolist') else values}"


_READERS: Final = {".parquet": _of_parquet, ".mf4": _of_mf4, ".tdms": _of_tdms, ".mat": _of_mat}
