"""Remove older runs: only what uictest wrote, is finished, and nothing else refers to as far as is known."""

from __future__ import annotations

import contextlib
import hashlib
import os
from collections.abc import Collection, Iterable, Iterator
from dataclasses import dataclass
from functools import cached_property
from pathlib import Path
from typing import NamedTuple

from uictest.core import files
from uictest.runs.history.listing import Kind, ListedRun, list_runs, started_in


class Pruned(NamedTuple):
    """The fate of a run beyond those that are kept: removed where `kept_because` is empty."""

    name: str
    kept_because: str = ""


@dataclass(frozen=True)
class _Reference:
    """A path that somebody refers to.

    Args:
        by: who refers to it.
        path: as it was given: the folder that it is relative to is not known of earlier runs.
        sha256: SHA-256 of the file there; empty where it is not known.

    """

    by: str
    path: Path
    sha256: str = ""

    def leads_into(self, folder: Path) -> bool:
        """Return whether the path leads to a run or into it. Raises OSError."""
        if self._resolved.is_relative_to(os.path.realpath(folder)):
            return True
        # Whatever it is relative to: no other folder has the name of a run.
        if started_in(folder.name) and folder.name in self.path.parts:
            return True
        # Of an absolute path, a manifest has the last name alone, and `latest` leads elsewhere by now.
        written = folder.rglob("*") if self.sha256 else ()
        alike = (file for file in written if file.name == self.path.name and file.is_file())
        return any(hashlib.sha256(file.read_bytes()).hexdigest() == self.sha256 for file in alike)

    @cached_property
    def _resolved(self) -> Path:
        # Links may lead in circles, and a damaged file holds any text.
        return Path(os.path.realpath(self.path)) if "\0" not in str(self.path) else self.path


def prune(
    parent: Path, kind: Kind, keep: int, written: str, referred: Collection[Path] = ()
) -> Iterator[Pruned]:
    """Remove the runs of a kind beyond the newest; yield what became of each, newest first.

    A run stays if it is the one just written or was written later, if it is incomplete or in use, if it
    holds a file that uictest did not write or has a name that somebody gave it, or if something refers to it:
    a link beside it, a path of `referred`, the baseline or the inputs of a run that stays.

    Args:
        parent: folder of all runs.
        kind: kind of the runs that count.
        keep: number of runs that stay, at least 1.
        written: name of the folder just written, which counts as the newest.
        referred: paths that the command line names.

    Raises:
        ValueError: `keep` is less than 1.
        OSError: the folder of all runs cannot be read.

    """
    if keep < 1:
        raise ValueError(f"at least 1 run stays, found {keep}")
    listing = list_runs(parent)
    others = [run for run in listing.runs if run.kind == kind and run.name != written]
    beyond = others[keep - 1 :]
    names = {run.name for run in beyond}
    references = [*_of_links(parent), *(_Reference("the command line", path) for path in referred)]
    for run in listing.runs:
        if run.name not in names:
            references += _of_run(run)
    newest = next((run.order for run in listing.runs if run.name == written), 0)
    for run in beyond:
        folder = parent / run.name
        reason = _why_kept(folder, run, references, newest) or _remove_run(folder)
        if reason and not folder.exists():  # another process removed it meanwhile
            continue
        if reason:
            references += _of_run(run)
        yield Pruned(run.name, reason)


def _why_kept(folder: Path, run: ListedRun, references: Iterable[_Reference], newest: int) -> str:
    """Return the reason for which a run stays; empty where it may go."""
    if not run.complete:
        return "it is incomplete"
    try:
        if by := next((each.by for each in references if each.leads_into(folder)), ""):
            return f"{by} refers to it"
        if run.order > newest > 0:  # two processes that end together would remove each other's run
            return "another process wrote it after this run"
        if started_in(folder.name) is None:
            return "somebody gave it this name, as to a baseline"
    except OSError as error:
        return f"it cannot be read: {error}"
    return ""


def _of_links(parent: Path) -> Iterator[_Reference]:
    """Yield every link in the folder of all runs; `latest` may be a text file."""
    for path in parent.iterdir():
        if path.is_symlink():
            yield _Reference(f"the link {path.name}", path)
    with contextlib.suppress(OSError, ValueError, RuntimeError):  # a link to itself is a RuntimeError
        if latest := files.latest_run(parent):
            yield _Reference("latest", latest)


def _of_run(run: ListedRun) -> list[_Reference]:
    """Return the paths that a run refers to: its baseline, and what it was computed from."""
    inputs = [_Reference(run.name, Path(name), sha256) for name, sha256 in run.inputs.items()]
    return [*inputs, *([_Reference(run.name, Path(run.baseline))] if run.baseline else [])]


def _remove_run(folder: Path) -> str:
    """Remove a folder; return why that was not possible, empty if it was."""
    try:
        files.remove_run(folder.parent, folder.name)
    except files.ForeignFileError as error:
        if not os.path.lexists(folder / str(error)):
            return f"it has no {error}"
        return f"it holds {error}, which uictest did not write"
    except files.FolderInUseError as error:
        return f"it is in use by {error}"
    except OSError as error:
        return f"it cannot be removed: {error.strerror or error}"
    return ""
