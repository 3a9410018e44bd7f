"""Cases and series from simulation to what reports show."""

from __future__ import annotations

from collections.abc import Callable, Collection, Mapping, Sequence
from dataclasses import dataclass, field, replace
from pathlib import Path

from uictest import report
from uictest.analysis import comparison, validation
from uictest.core import recording
from uictest.judging import evaluation
from uictest.plans import scenario, series
from uictest.running import campaign
from uictest.runs.drawing import TraceCollection
from uictest.runs.observer import Observer
from uictest.runs.series_runs import SeriesBatch, run_series
from uictest.runs.validation.run import read_reference

Keep = Callable[[str, recording.Recording], object]
"""Takes the id of a case and its recording."""
Note = Callable[[campaign.CaseRun, Sequence[report.Difference]], None]


@dataclass(frozen=True, slots=True)
class Batch:
    """Cases and series to run, and how.

    Args:
        cases: to run.
        manifest: of the run.
        parts: of every case, those of series too, by its id.
        series: to run behind the cases.
        recording: the cases to record.
        jobs: number of threads.
        maxfail: number of cases and series not as expected after which no further one is run.
        in_process: whether controllers from outside run in this process.
        real_time: whether their cycles are paced by the clock.
        strict: whether a case is met only if all of its verdicts are settled, too.
        baseline: to compare with, if any.
        domains: whether cases, by id, lie in the domain of a validation; of those for which it was asked.
        drawn_first: ids of the cases whose stops a page draws before all others.

    """

    cases: Sequence[scenario.Case]
    manifest: report.RunManifest
    parts: campaign.PartsOfCases
    series: Sequence[series.Series] = ()
    recording: campaign.RecordingRequest = field(default_factory=campaign.RecordingRequest)
    jobs: int = 1
    maxfail: int | None = None
    in_process: bool = False
    real_time: bool = False
    strict: bool = False
    baseline: comparison.Baseline | None = None
    domains: Mapping[str, evaluation.DomainOfValidity] = field(default_factory=dict)
    drawn_first: Collection[str] = ()

    @property
    def all_cases(self) -> list[scenario.Case]:
        """All cases, those of series too."""
        return [*self.cases, *(case for each in self.series for case in each.cases)]

    @property
    def stops(self) -> int:
        """How many stops all the cases have."""
        return sum(case.scenario.repeat for case in self.all_cases)


def batch_of(
    cases: Sequence[scenario.Case],
    planned: Sequence[series.Series],
    arguments: Sequence[str],
    seed: int | None,
) -> Batch:
    """Return the batch of cases and series that `arguments` select; all else is as by default."""
    everything = [*cases, *(case for each in planned for case in each.cases)]
    parts = campaign.parts_of_cases(everything)
    manifest = report.run_manifest(
        arguments, seed, _inputs(everything, planned), len(everything), parts.values()
    )
    return Batch(cases, manifest, parts, planned)


def with_domains(batch: Batch, reference: validation.ValidationReference | None = None) -> Batch:
    """Return a batch whose results say whether each case lies in the domain of a validation.

    Args:
        batch: of cases, of which each may name a validation.
        reference: takes the place of those that the cases name.

    Raises InvalidInputError where a validation that a case names cannot be read.
    """
    references = _references(batch) if reference is None else {case.id: reference for case in batch.all_cases}
    domains = {case_id: each.domain_of(batch.parts[case_id]) for case_id, each in references.items()}
    read = {each.file: each.sha256 for each in references.values()}
    manifest = replace(batch.manifest, inputs={**batch.manifest.inputs, **read})
    return replace(batch, manifest=manifest, domains=domains)


def _references(batch: Batch) -> dict[str, validation.ValidationReference]:
    """Return the validation of each case that names one, by its id; each file is read once."""
    named = {case.id: case.scenario.validated for case in batch.all_cases}
    read = {path: read_reference(Path(path)) for path in dict.fromkeys(named.values()) if path is not None}
    return {case_id: read[path] for case_id, path in named.items() if path is not None}


@dataclass(frozen=True, slots=True)
class BatchRun:
    """What reports show of a batch, and whether an interrupt ended it."""

    content: report.RunContent
    interrupted: bool = False


def run_batch(
    batch: Batch, observer: Observer, *, name: str = "", draws_stops: bool = False, keep: Keep | None = None
) -> BatchRun:
    """Run and judge cases and series; after an interrupt, return those that are finished.

    Args:
        batch: to run.
        observer: is called in this thread.
        name: of the run.
        draws_stops: whether a report will draw stops.
        keep: takes the recordings of cases.
    """
    drawing = TraceCollection.of(batch.all_cases, batch.recording, batch.drawn_first, needed=draws_stops)
    simulation = _Simulation(batch, observer, drawing, keep)
    done = simulation.run(batch.cases, observer.case, batch.maxfail)
    judged = _run_series(batch, done, simulation)
    content = report.RunContent(
        name,
        done.results,
        batch.manifest,
        complete=(len(done.results), len(judged.results)) == (len(batch.cases), len(batch.series)),
        subjects=campaign.descriptions_of(batch.all_cases),
        series=judged.results,
        drawn_first=batch.drawn_first,
    )
    interrupted = done.interrupted or judged.interrupted
    everything = campaign.BatchResult(content.all_results, interrupted)
    content = replace(content, traces=drawing.finish(everything, batch.jobs))
    if batch.baseline is not None:
        content = replace(content, baseline=batch.baseline.compare(content))
    return BatchRun(content, interrupted)


@dataclass(frozen=True, slots=True)
class _Simulation:
    """Runs cases of a batch, and hands on what comes of them."""

    batch: Batch
    observer: Observer
    drawing: TraceCollection
    keep: Keep | None

    def run(
        self, cases: Sequence[scenario.Case], note: Note, maxfail: int | None = None
    ) -> campaign.BatchResult:
        """Run some cases of the batch."""
        if not cases:
            return campaign.BatchResult()

        def hand_on(case_run: campaign.CaseRun) -> None:
            self._keep(case_run)
            note(case_run, self._differences(case_run))

        with self.observer.simulating(cases) as advance:
            return campaign.run_cases(
                cases,
                jobs=self.batch.jobs,
                recording=self.drawing.recording,
                maxfail=maxfail,
                parts=self.batch.parts,
                domains=self.batch.domains,
                in_process=self.batch.in_process,
                real_time=self.batch.real_time,
                strict=self.batch.strict,
                on_result=hand_on,
                on_stop=advance,
            )

    def _keep(self, case_run: campaign.CaseRun) -> None:
        self.drawing.add(case_run)
        wanted = self.batch.recording.wants(case_run.result)
        if self.keep is not None and wanted and case_run.recording is not None:
            self.keep(case_run.result.id, case_run.recording)

    def _differences(self, case_run: campaign.CaseRun) -> Sequence[report.Difference]:
        baseline = self.batch.baseline
        return () if baseline is None else baseline.differences(case_run.result)


def _run_series(batch: Batch, done: campaign.BatchResult, simulation: _Simulation) -> SeriesBatch:
    """Run the series of a batch behind its cases, unless these end it."""
    missed = sum(not result.met for result in done.results)
    if done.interrupted or (batch.maxfail is not None and missed >= batch.maxfail):
        return SeriesBatch()
    return run_series(
        batch.series,
        lambda cases: simulation.run(cases, simulation.observer.case_of_series),
        maxfail=None if batch.maxfail is None else batch.maxfail - missed,
        show=simulation.observer.series,
    )


def _inputs(cases: Sequence[scenario.Case], planned: Sequence[series.Series]) -> Mapping[str, str]:
    read = [*(case.inputs for case in cases), *(each.inputs for each in planned)]
    return {name: digest for each in read for name, digest in each.items()}
