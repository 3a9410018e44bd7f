"""A run from its start to its published folder, and the folders of runs that users name."""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from dataclasses import replace
from datetime import UTC, datetime
from functools import partial
from pathlib import Path
from typing import Final, NamedTuple

from uictest import report
from uictest.core import envelope, files, recording
from uictest.running import campaign
from uictest.runs import history
from uictest.runs.batch import Batch, run_batch
from uictest.runs.observer import Observer
from uictest.runs.scenario_files import InvalidInputError

_PATIENCE: Final = 0.2
"""How long another process may hold the folder of a sweep or a search, s; chosen: one that only looks is gone
sooner."""


class Published(NamedTuple):
    """A run whose reports are written.

    Args:
        place: its folder.
        content: what the reports show.
        publication: what they were written from.
        interrupted: whether an interrupt ended the run.
        index_problem: why the index of all runs or `latest` was not written; empty if both were.

    """

    place: Path
    content: report.RunContent
    publication: report.Publication
    interrupted: bool = False
    index_problem: str = ""


def publish_batch(batch: Batch, output: Path, formats: Sequence[str], observer: Observer) -> Published | None:
    """Run a batch and publish its reports; after an interruption, those of the finished cases.

    Returns None, and writes nothing, if there are cases and none is finished. Raises OSError if the reports
    cannot be written, and removes those that were.
    """
    # The folder comes first: if it cannot be written, nothing should be simulated.
    with _new_run_folder(output, batch.manifest) as folder:
        recorded = batch.settings.recording._replace(
            keep_output=partial(report.write_controller_log, folder.path)
        )
        run = run_batch(
            batch._replace(settings=replace(batch.settings, recording=recorded)),
            observer,
            name=folder.name,
            draws_stops=not report.DRAWING.isdisjoint(formats),
            keep=partial(report.write_recording, folder.path),
        )
        if batch.all_cases and not run.content.all_results:
            return None
        publication = _write_reports(folder.path, run.content, formats)
        place = folder.publish()
    return Published(place, run.content, publication, run.interrupted, _update_index(place))


def publish_run(
    content: report.RunContent,
    recordings: Mapping[str, recording.Recording],
    output: Path,
    formats: Sequence[str],
) -> Published:
    """Write the reports of a run that is finished, and some recordings by id. Raises OSError."""
    with _new_run_folder(output, content.manifest) as folder:
        for case_id, samples in recordings.items():
            report.write_recording(folder.path, case_id, samples)
        named = replace(content, name=folder.name)
        publication = _write_reports(folder.path, named, formats)
        place = folder.publish()
    return Published(place, named, publication, index_problem=_update_index(place))


def _update_index(place: Path) -> str:
    """Name the newest run, and renew the list of all; return what was left as it is. Raises OSError."""
    return "; ".join(filter(None, [files.point_latest(place), history.refresh_index(place.parent)]))


def _new_run_folder(output: Path, manifest: report.RunManifest) -> files.RunFolder:
    return files.RunFolder(output, report.run_name(datetime.now(UTC), manifest))


def _write_reports(folder: Path, content: report.RunContent, formats: Sequence[str]) -> report.Publication:
    publication = report.publication_of_run(content, report.run_texts(content))
    report.publish(publication, (*report.IN_EVERY_RUN, *formats), folder)
    history.write_entry(folder, content)
    return publication


def holds_sweep(folder: Path) -> bool:
    """Return whether a folder is that of a sweep, finished or not."""
    from uictest.running import chunked  # which a run does not need

    try:
        manifest = chunked.ChunkStore(folder).manifest()
    except OSError:
        return False
    return envelope.is_of(manifest, envelope.MANIFEST, "sweep")


def why_no_run(folder: Path) -> str:
    """Return why a path is not a run, e.g. `there is no PATH`; empty if it looks like one."""
    if not folder.exists():
        return f"there is no {folder}"
    if not folder.is_dir():
        return f"{folder} is a file"
    if holds_sweep(folder):
        return f"{folder} holds a sweep"
    return "" if (folder / report.RESULTS).is_file() else f"{folder} holds no run: it has no {report.RESULTS}"


def run_folder(place: Path) -> Path:
    """Return the folder of a run; `latest` may be a text file that names it, where links are impossible."""
    if place.name == files.LATEST and not place.is_dir():
        return files.latest_run(place.parent) or place
    return place


def result_ids(content: report.RunContent, expression: str) -> frozenset[str]:
    """Return the ids of the cases of a finished run that an expression (`-k`) selects.

    Raises ExpressionError.
    """
    holds = campaign.parse(expression)
    names = {
        case.id: [case.id, Path(case.scenario).stem, *content.subject(case.id).tags]
        for case in content.all_results
    }
    return frozenset(case_id for case_id, words in names.items() if holds(campaign.mentioned_in(words)))


def locked_folder(folder: Path, *, shared: bool = False) -> files.FolderLock:
    """Return the lock on the folder of a sweep or a search, which is made; shards of a sweep share it.

    Raises InvalidInputError where another process works in it, or it is a link; OSError.
    """
    files.make_folder(folder)
    if folder.is_symlink():
        raise InvalidInputError(
            f"{folder} is a link, through which nothing is written: name another output folder",
            arguments=("output",),
        )
    try:
        with files.writing(folder):
            return files.FolderLock(folder.parent, folder.name, shared=shared, patience=_PATIENCE)
    except files.FolderInUseError as error:
        raise InvalidInputError(
            f"{folder} is in use by {error}: wait until it ends, or name another output folder",
            arguments=("output",),
        ) from error
