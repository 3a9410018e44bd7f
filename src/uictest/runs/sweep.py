"""A sweep from its lock to its published results."""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from dataclasses import dataclass, replace
from functools import partial
from pathlib import Path
from typing import NamedTuple

from uictest import controllers, report, rig
from uictest.analysis import summaries
from uictest.core import files
from uictest.judging import evaluation
from uictest.plans import scenario, sweeps
from uictest.running import campaign
from uictest.running.chunked import ChunkStore
from uictest.runs.batch import simulate_cases
from uictest.runs.errors import InvalidInputError
from uictest.runs.observer import Observer
from uictest.runs.sweep_chunks import SweepRequest, run_missing_chunks

_PATIENCE = 0.2
"""How long another process may hold the folder, s; chosen: one that only looks is gone sooner."""


@dataclass(frozen=True, slots=True)
class FinishedSweep:
    """A sweep whose results are written.

    Args:
        result: of the sweep.
        document: the text of sweep.json.
        content: what its reports show.

    """

    result: report.SweepResult
    document: str
    content: report.SweepContent


def run_sweep(request: SweepRequest, observer: Observer) -> FinishedSweep | None:
    """Run a sweep; chunks that are finished already are not run again.

    Returns the finished sweep, None where this run is one shard of several. Finished chunks are kept whatever
    is raised: InvalidInputError where the folder is in use or holds the chunks of other inputs, OSError,
    KeyboardInterrupt, MaxfailReached.
    """
    with (
        _locked(request.folder, shared=request.shard.count > 1 and not request.restart),
        rig.Workers() as workers,
    ):
        if request.in_process and any(sweeps.programs_of(request.selection.plan)):
            observer.foreign_in_process()
        in_children = replace(request, run_block=workers.run_block, run_train=workers.run_train)
        prepared = request if request.in_process else in_children
        try:
            store = ChunkStore(request.folder)
            if request.shard.count > 1:
                run_missing_chunks(prepared, store, observer)
                return None
            return publish(prepared, store, summarized_chunks(prepared, store, observer), observer)
        except KeyboardInterrupt:
            controllers.interrupt_turns()
            raise


def _locked(folder: Path, *, shared: bool) -> files.FolderLock:
    """Return the lock on the folder of a sweep; shards of the sweep share it."""
    files.make_folder(folder)
    if folder.is_symlink():
        raise InvalidInputError(
            f"{folder} is a link, and a sweep writes through none: name another output folder",
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


def summarized_chunks(request: SweepRequest, store: ChunkStore, observer: Observer) -> summaries.SweepSummary:
    """Run the chunks that are not finished; return what all come to, summarised while others run.

    Raises what :func:`run_missing_chunks` does.
    """
    options = request.pair, request.measures, request.reference
    with summaries.summarized(request.selection, store, *options, csv=request.writes_csv) as summary:
        run_missing_chunks(
            *(request, store, observer),
            summary.add_up_to,
            partial(report.load_sweep_formats, request.reports),
        )
        with files.writing(store.folder):
            files.begin_list(store.folder)
        return summary.result()


def publish(
    request: SweepRequest, store: ChunkStore, summary: summaries.SweepSummary, observer: Observer
) -> FinishedSweep:
    """Write the result of a summarised sweep and its reports. Raises OSError."""
    frontier = None if request.search is None else _frontier(request, summary, request.search, observer)
    worst = _run_worst(request, summary, store.folder)
    result = replace(summary.result, frontier=frontier, worst=worst.results, subjects=worst.subjects)
    if request.firm:
        result = replace(result, nominal=_nominal_with_firmness(request, observer))
    document = report.write_sweep_result(store.folder, result, request.selection.plan.file)
    # Read back, so that what is shown now is what `uictest report` shows of the folder later.
    content = replace(report.read_sweep(store.folder), traces=worst.traces)
    report.write_sweep_formats(store.folder, content, request.reports)
    store.remove_partial_files()
    return FinishedSweep(result, document, content)


class _WorstCases(NamedTuple):
    """The worst cases of a sweep: their results; their descriptions, and what is drawn of them, by id."""

    results: tuple[evaluation.CaseResult, ...]
    subjects: Mapping[str, report.CaseDescription]
    traces: Mapping[str, report.PlotTrace]


def _run_worst(request: SweepRequest, summary: summaries.SweepSummary, folder: Path) -> _WorstCases:
    """Run the worst cases again as their rows were, with explanations, and write their recordings.

    What is drawn of them is taken while others run. Raises OSError, and KeyboardInterrupt if interrupted.
    """
    cases = summaries.full_cases(request.selection.plan, summary.worst_indices, summary.surveyed)
    files.remove_listed(folder, f"{report.RECORDINGS}/*")
    traces: dict[str, report.PlotTrace] = {}

    def write_recording(case_run: campaign.CaseRun) -> None:
        result, samples = case_run.result, case_run.recording
        if samples is not None:
            report.write_recording(folder, result.id, samples)
            if report.draws_stops(request.reports):
                traces[result.id] = report.trace_of_stop(samples, result)

    recording = campaign.RecordingRequest("all")
    recording = recording._replace(every=min(recording.every, campaign.shortest_cycle(cases)))
    settings = _settings(request, cases, recording)
    if request.reference is not None:
        settings = replace(settings, domains=request.reference.domains_of(settings.parts))
    results = campaign.run_cases(cases, settings, on_case=write_recording).whole()
    return _WorstCases(tuple(results), campaign.descriptions_of(cases), traces)


def _frontier(
    request: SweepRequest,
    summary: summaries.SweepSummary,
    search: summaries.FrontierSearch,
    observer: Observer,
) -> report.Frontier:
    observer.searching(search.key)
    runner = request.runner()
    scans = search.run(
        summary.verdicts, lambda plan, indices: summaries.verdicts_of(plan, indices, runner, request.jobs)
    )
    return report.Frontier(search.key, tuple(scans))


def _nominal_with_firmness(request: SweepRequest, observer: Observer) -> tuple[evaluation.CaseResult, ...]:
    """Return the result of the case that is varied, of a train those of all cars, with how firm each is.

    Raises KeyboardInterrupt.
    """
    cases = _nominal_cases(request.selection.plan.base)
    settings = _settings(request, cases, campaign.RecordingRequest("none"))
    settings = replace(settings, firm=True, calibration=request.calibration)
    return tuple(simulate_cases(cases, settings, observer, unit="stops").whole())


def _nominal_cases(base: scenario.Case) -> list[scenario.Case]:
    """Return the case that is varied, of a train those of all cars."""
    train = base.train
    if train is None:
        return [base]
    return [
        replace(
            base,
            id=f"{train.train}[{scenario.CAR}={number}]",
            scenario=own,
            parameters={scenario.CAR: str(number)},
            train=replace(train, number=number),
        )
        for number, own in enumerate(train.scenarios, start=1)
    ]


def _settings(
    request: SweepRequest, cases: Sequence[scenario.Case], recording: campaign.RecordingRequest
) -> campaign.RunSettings:
    """Return how cases of a sweep are run one by one."""
    parts = campaign.parts_of_cases(cases)
    return campaign.RunSettings(request.jobs, recording, in_process=request.in_process, parts=parts)
