"""The finished parts of a sweep on disk: each a file that says in its name what it must hold."""

from __future__ import annotations

import contextlib
import hashlib
import json
import re
from collections.abc import Iterator, Mapping, Sequence
from pathlib import Path
from typing import TYPE_CHECKING, Any, Final

from uictest.recording import write_bytes_atomic, write_text_atomic
from uictest.sweep.running.manifest import differences

if TYPE_CHECKING:
    import pyarrow as pa

MANIFEST: Final = "manifest.json"
PARTS: Final = "parts"
_NAME: Final = re.compile(r"([0-9]{6,})-([0-9a-f]{32})\.parquet")


class ChangedInputsError(Exception):
    """The parts on disk are those of other inputs; the message says which."""


class MissingChunksError(Exception):
    """Parts are not there; the message says which."""


class Store:
    """The folder of one sweep: its manifest, and one file per finished part."""

    def __init__(self, folder: Path) -> None:
        self.folder = folder

    def begin(self, manifest: Mapping[str, Any], *, restart: bool) -> None:
        """Take up the work on a sweep with this manifest.

        Raises:
            ChangedInputsError: there are parts of a sweep with another manifest, and `restart` is not set.
            OSError: the folder cannot be written.
        """
        (self.folder / PARTS).mkdir(parents=True, exist_ok=True)
        if restart:
            self._discard()
        kept = self.manifest()
        changed = [] if kept is None else list(differences(kept, manifest))
        if changed and self._files():
            raise ChangedInputsError("; ".join(changed))
        if kept is None or changed:
            self._discard()  # parts that nothing vouches for
            text = json.dumps(manifest, indent=2, ensure_ascii=False)
            write_text_atomic(self.folder / MANIFEST, f"{text}\n")

    def manifest(self) -> dict[str, Any] | None:
        """Return the manifest, None where there is none that can be read."""
        try:
            kept = json.loads((self.folder / MANIFEST).read_bytes())
        except (FileNotFoundError, ValueError):
            return None
        return kept if isinstance(kept, dict) else None

    def finished(self) -> tuple[set[int], list[Path]]:
        """Return the numbers of the parts that are whole, and the damaged files, which are removed."""
        whole: set[int] = set()
        damaged: list[Path] = []
        for number, path in self._files():
            if _is_whole(path):
                whole.add(number)
            else:
                damaged.append(path)
                path.unlink()
        return whole, damaged

    def holds_parts(self) -> bool:
        """Return whether there is a finished part, False where the folder cannot be read."""
        try:
            return bool(self._files())
        except OSError:
            return False

    def write(self, number: int, content: bytes) -> None:
        """Keep a part. Raises OSError."""
        write_bytes_atomic(self.folder / PARTS / f"{number:06d}-{_digest(content)}.parquet", content)

    def tables(self, numbers: Sequence[int], columns: Sequence[str] | None = None) -> Iterator[pa.Table]:
        """Yield the rows of parts, one part after the other. Raises MissingPartsError."""
        import pyarrow.parquet as pq

        paths = dict(self._files())
        missing = [number for number in numbers if number not in paths]
        if missing:
            listed = ", ".join(map(str, missing[:10]))
            raise MissingChunksError(f"{len(missing)} parts are not there: {listed}")
        for number in numbers:
            with paths[number].open("rb") as file, pq.ParquetFile(file) as parquet:
                yield parquet.read(columns=None if columns is None else list(columns), use_threads=False)

    def take(self, other: Store) -> tuple[int, list[Path]]:
        """Copy the whole parts of another store of the same sweep; return their number and the damaged files.

        Raises ChangedInputsError where it is of another sweep, OSError.
        """
        found = other.manifest()
        if found is None:
            raise ChangedInputsError(f"{other.folder} holds no sweep")
        if changed := list(differences(self.manifest() or {}, found, ("in this sweep", "in the share"))):
            raise ChangedInputsError(f"{other.folder}: {'; '.join(changed)}")
        paths = [path for _, path in other._files()]
        whole = [path for path in paths if _is_whole(path)]
        for path in whole:
            if not (self.folder / PARTS / path.name).exists():
                write_bytes_atomic(self.folder / PARTS / path.name, path.read_bytes())
        return len(whole), [path for path in paths if path not in whole]

    def tidy(self) -> None:
        """Remove what interrupted writers left behind."""
        for folder in (self.folder, self.folder / PARTS):
            for path in folder.glob(".partial-*"):
                path.unlink(missing_ok=True)

    def _files(self) -> list[tuple[int, Path]]:
        found = ((_NAME.fullmatch(path.name), path) for path in sorted((self.folder / PARTS).iterdir()))
        return [(int(match[1]), path) for match, path in found if match]

    def _discard(self) -> None:
        with contextlib.suppress(FileNotFoundError):
            (self.folder / MANIFEST).unlink()
        for _, path in self._files():
            path.unlink()


def _is_whole(path: Path) -> bool:
    match = _NAME.fullmatch(path.name)
    return match is not None and _digest(path.read_bytes()) == match[2]


def _digest(content: bytes) -> str:
    return hashlib.sha256(content).hexdigest()[:32]
