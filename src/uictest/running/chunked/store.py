"""The folder of a sweep: its manifest, on which all its results depend, and one file per finished chunk."""

from __future__ import annotations

import hashlib
import json
import os
import platform
import re
from collections.abc import Iterator, Mapping, Sequence
from functools import cache
from importlib import metadata
from pathlib import Path
from typing import TYPE_CHECKING, Any, Final

from uictest import report
from uictest.core import envelope, files
from uictest.judging.evaluation import effective_parts
from uictest.plans import library
from uictest.plans.scenario import SURVEY
from uictest.report import named_parts
from uictest.running.chunked.chunk import CaseSelection
from uictest.running.chunked.table import SURVEY_TABLE

SOURCES: Final = ("core", "controllers", "plans", "judging", "rig", "running")
"""Rooms of the package that determine the result of a case."""
_PACKAGES: Final = ("uictest", "numpy", "scipy", "pyarrow")
_LIBRARY: Final = "library:"
_LABELS: Final = {"selected": "selection", "cases_in_a_part": "cases per chunk"}
"""Key -> the name that users know it by, where the two differ."""
_DIGESTS: Final = {"program": "the program itself", "cases_sha256": "the cases that the sweep file asks for"}
"""Key of a digest, which itself says nothing -> what it is of."""


def sweep_manifest(
    selection: CaseSelection, *, expression: str | None, overrides: Sequence[str], seed: int | None
) -> dict[str, Any]:
    """Return the manifest of a sweep, which does not depend on the machine.

    Files are named relative to the sweep file, so that the manifest is the same from every working folder;
    but `file`, which people and GitHub look up, is the path that the user gave.
    """
    plan = selection.plan
    folder = Path(plan.file).parent
    python = ".".join(platform.python_version_tuple()[:2])
    versions = {"python": python} | {name: metadata.version(name) for name in _PACKAGES}
    return {
        **envelope.head(envelope.MANIFEST, "sweep"),
        "sweep": plan.name,
        "title": plan.title,
        "file": plan.file,
        "scenario": _relative_to(folder, plan.base.path.as_posix()),
        "case": plan.base.id,
        "cases": selection.size,
        "cases_in_a_part": selection.chunk_size,
        "selected": expression,
        "set": list(overrides),
        "seed": seed,
        "parameters": list(plan.keys),
        "parts": named_parts([effective_parts(car.scenario) for car in plan.base.cars]),
        "cases_sha256": plan.cases_sha256,
        "inputs": {_relative_to(folder, name): digest for name, digest in plan.inputs.items()},
        **({"time_step": SURVEY} if plan.survey else {}),
        "versions": versions,
        "program": program_digest(),
    }


def manifest_differences(
    one: Mapping[str, Any], other: Mapping[str, Any], whose: tuple[str, str] = ("before", "now")
) -> Iterator[str]:
    """Yield the differences of two manifests in words; `whose` names the two manifests.

    The name of the sweep file does not count, and of its content only what says which cases there are. Of a
    manifest of another schema that is all: it says nothing in the words of today.
    """
    if old := next(filter(envelope.is_old, (one, other)), None):
        yield envelope.head_of(old)
        return
    for name in dict.fromkeys((*one, *other)):
        first, second = _entry_results_depend_on(one, name), _entry_results_depend_on(other, name)
        if first == second or name == "file":
            continue
        if isinstance(first, Mapping) and isinstance(second, Mapping):
            changed = (key for key in dict.fromkeys((*first, *second)) if first.get(key) != second.get(key))
            yield f"{name}: {', '.join(changed)}"
        elif name in _DIGESTS:
            yield _DIGESTS[name]
        else:
            label = _LABELS.get(name, name.replace("_", " "))
            yield f"{label}: {_list_in_words(first)} {whose[0]}, {_list_in_words(second)} {whose[1]}"


def _entry_results_depend_on(manifest: Mapping[str, Any], name: str) -> Any:
    """Return an entry as far as results depend on it: of the inputs all but the sweep file."""
    entry = manifest.get(name)
    if name != "inputs" or not isinstance(entry, Mapping):
        return entry
    return {key: digest for key, digest in entry.items() if key != Path(str(manifest.get("file"))).name}


def _list_in_words(value: Any) -> str:
    if value is None or value in ("", []):
        return "none"
    if not isinstance(value, list):
        return str(value)
    *others, last = map(str, value)
    return f"{', '.join(others)} and {last}" if others else last


def _relative_to(folder: Path, name: str) -> str:
    return name if name.startswith(_LIBRARY) else files.relative_path(Path(name), folder)


@cache
def program_digest() -> str:
    """Return a digest of the sources that determine the result of a case, and of the biases of a survey."""
    digest = hashlib.sha256(library.table(SURVEY_TABLE).encode())
    package = Path(__file__).parents[2]
    for name in SOURCES:
        for source in sorted((package / name).rglob("*.py")):
            digest.update(source.relative_to(package).as_posix().encode() + b"\0" + source.read_bytes())
    return digest.hexdigest()[:16]


if TYPE_CHECKING:
    import pyarrow as pa

MANIFEST: Final = "manifest.json"
CHUNKS: Final = "chunks"
_NAME: Final = re.compile(r"([0-9]{6,})-([0-9a-f]{32})\.parquet")


class ChangedInputsError(Exception):
    """The chunks on disk were computed from other inputs; the message names them."""


class MissingChunksError(Exception):
    """Chunks are missing; the message names them."""


class ChunkStore:
    """The folder of one sweep: its manifest, and one file per finished chunk."""

    def __init__(self, folder: Path) -> None:
        self.folder = folder

    def open(self, manifest: Mapping[str, Any], *, restart: bool) -> None:
        """Open the store for a sweep with this manifest; write the manifest where there is none yet.

        Raises:
            ChangedInputsError: there are chunks of a sweep with another manifest, and `restart` is not set.
            OSError: the folder cannot be written.
        """
        files.make_folder(self.folder / CHUNKS)
        if restart:
            self._discard()
        stored = self.manifest()
        changes = [] if stored is None else list(manifest_differences(stored, manifest))
        if changes and self._files():
            raise ChangedInputsError("; ".join(changes))
        if stored is None or changes:
            self._discard()  # chunks without a manifest cannot be trusted
        if stored != manifest:
            text = json.dumps(manifest, indent=2, ensure_ascii=False)
            files.write(self.folder, MANIFEST, f"{text}\n", listed=False)

    def manifest(self) -> dict[str, Any] | None:
        """Return the manifest, None where there is none that can be read."""
        try:
            manifest = json.loads((self.folder / MANIFEST).read_bytes())
        except (FileNotFoundError, ValueError, RecursionError):
            return None
        return manifest if isinstance(manifest, dict) else None

    def finished(self) -> tuple[set[int], list[Path]]:
        """Return the numbers of the intact chunks, and the damaged files, which are removed."""
        chunks = self._files()
        damaged = [path for _, path in chunks if not _is_intact(path)]
        for path in damaged:
            files.remove(self.folder, f"{CHUNKS}/{path.name}")
        return {number for number, path in chunks if path not in damaged}, damaged

    def has_chunks(self) -> bool:
        """Return whether there is a finished chunk, False where the folder cannot be read."""
        try:
            return bool(self._files())
        except OSError:
            return False

    def write(self, number: int, content: bytes) -> None:
        """Write a chunk. Raises OSError."""
        self._write(f"{number:06d}-{_digest(content)}.parquet", content)

    def tables(self, numbers: Sequence[int], columns: Sequence[str] | None = None) -> Iterator[pa.Table]:
        """Yield the rows of chunks, one chunk after the other, with some columns, None for all.

        Raises MissingChunksError.
        """
        import pyarrow.parquet as pq

        paths = dict(self._files())
        missing = [number for number in numbers if number not in paths]
        if missing:
            listed = ", ".join(map(str, missing[:10]))
            raise MissingChunksError(f"{len(missing)} chunks are missing: {listed}")
        for number in numbers:
            with paths[number].open("rb") as file, pq.ParquetFile(file) as parquet:
                yield parquet.read(columns, use_threads=False)

    def merge(self, other: ChunkStore) -> tuple[int, list[Path]]:
        """Copy the intact chunks of another store of this sweep; return their number and the damaged files.

        Raises ChangedInputsError where the other store belongs to another sweep, OSError.
        """
        manifest = other.manifest()
        if manifest is None:
            raise ChangedInputsError(f"{other.folder} holds no sweep")
        whose = ("in this sweep", "in the shard")
        if changes := list(manifest_differences(self.manifest() or {}, manifest, whose)):
            raise ChangedInputsError(f"{other.folder}: {'; '.join(changes)}")
        paths = [path for _, path in other._files()]
        intact = [path for path in paths if _is_intact(path)]
        for path in intact:
            if not (self.folder / CHUNKS / path.name).exists():
                self._write(path.name, path.read_bytes())
        return len(intact), [path for path in paths if path not in intact]

    def remove_partial_files(self) -> None:
        """Remove files that interrupted writers left."""
        for below in ("", CHUNKS):
            files.remove_partial_files(self.folder, below)

    def _write(self, name: str, content: bytes) -> None:
        files.write(self.folder, f"{CHUNKS}/{name}", content, listed=False)

    def _files(self) -> list[tuple[int, Path]]:
        chunks = self.folder / CHUNKS
        matches = map(_NAME.fullmatch, sorted(os.listdir(chunks)))  # noqa: PTH208 - paths sort slowly
        return [(int(match[1]), chunks / match[0]) for match in matches if match]

    def _discard(self) -> None:
        files.remove_listed(self.folder, report.RESULTS)  # other chunks will have another result
        for name in (MANIFEST, *(f"{CHUNKS}/{path.name}" for _, path in self._files())):
            files.remove(self.folder, name)


def _is_intact(path: Path) -> bool:
    match = _NAME.fullmatch(path.name)
    return match is not None and _digest(path.read_bytes()) == match[2]


def _digest(content: bytes) -> str:
    return hashlib.sha256(content).hexdigest()[:32]
