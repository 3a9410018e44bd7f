"""The finished chunks of a sweep on disk: files whose names contain the digest of their content."""

from __future__ import annotations

import hashlib
import json
import re
from collections.abc import Iterator, Mapping, Sequence
from pathlib import Path
from typing import TYPE_CHECKING, Any, Final

from uictest import report
from uictest.core import files
from uictest.running.chunked.manifest import manifest_differences

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
        intact: set[int] = set()
        damaged: list[Path] = []
        for number, path in self._files():
            if _is_intact(path):
                intact.add(number)
            else:
                damaged.append(path)
                files.remove(self.folder, f"{CHUNKS}/{path.name}")
        return intact, damaged

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
        """Yield the rows of chunks, one chunk after the other. Raises MissingChunksError."""
        import pyarrow.parquet as pq

        paths = dict(self._files())
        missing = [number for number in numbers if number not in paths]
        if missing:
            listed = ", ".join(map(str, missing[:10]))
            raise MissingChunksError(f"{len(missing)} chunks are missing: {listed}")
        for number in numbers:
            with paths[number].open("rb") as file, pq.ParquetFile(file) as parquet:
                yield parquet.read(columns=None if columns is None else list(columns), use_threads=False)

    def merge(self, other: ChunkStore) -> tuple[int, list[Path]]:
        """Copy the intact chunks of another store of this sweep; return their number and the damaged files.

        Raises ChangedInputsError where the other store belongs to another sweep, OSError.
        """
        manifest = other.manifest()
        if manifest is None:
            raise ChangedInputsError(f"{other.folder} holds no sweep")
        changes = list(
            manifest_differences(self.manifest() or {}, manifest, ("in this sweep", "in the shard"))
        )
        if changes:
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
        paths = sorted((self.folder / CHUNKS).iterdir())
        matches = ((_NAME.fullmatch(path.name), path) for path in paths)
        return [(int(match[1]), path) for match, path in matches if match]

    def _discard(self) -> None:
        files.remove_listed(self.folder, report.SWEEP_RESULTS)  # other chunks will have another result
        for name in (MANIFEST, *(f"{CHUNKS}/{path.name}" for _, path in self._files())):
            files.remove(self.folder, name)


def _is_intact(path: Path) -> bool:
    match = _NAME.fullmatch(path.name)
    return match is not None and _digest(path.read_bytes()) == match[2]


def _digest(content: bytes) -> str:
    return hashlib.sha256(content).hexdigest()[:32]
