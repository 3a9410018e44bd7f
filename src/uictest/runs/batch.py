"""Cases and series, simulated or recorded, to what reports show."""

from __future__ import annotations

from collections.abc import Callable, Collection, Iterable, Mapping, Sequence
from dataclasses import dataclass, field, replace
from pathlib import Path

from uictest import report, rig
from uictest.analysis import comparison, validation
from uictest.core import recording
from uictest.judging import evaluation, series as judging_series
from uictest.plans import scenario, series as series_plans
from uictest.running import campaign
from uictest.runs.drawing import TraceCollection
from uictest.runs.firmness import firmness_run, stops_of_case, stops_of_series
from uictest.runs.observer import Observer
from uictest.runs.scenario_files import read_reference

Keep = Callable[[str, recording.Recording], object]
"""Takes the id of a case and its recording."""
Note = Callable[[campaign.CaseRun, Sequence[report.Difference]], None]


@dataclass(frozen=True, slots=True)
class Batch:
    """Cases and series to run, and how.

    Args:
        cases: to run.
        series: to run behind the cases; each counts as one for `maxfail`.
        manifest: of the run.
        subjects: descriptions of all cases, those of series too, by id.
        settings: of all cases.
        baseline: to compare with, if any.
        drawn_first: ids of the cases whose stops a page draws before all others.
        judge: returns what a recorded case came to; None where cases are simulated.

    """

    cases: Sequence[scenario.Case]
    series: Sequence[series_plans.Series]
    manifest: report.RunManifest
    subjects: Mapping[str, report.CaseDescription]
    settings: campaign.RunSettings
    baseline: comparison.Baseline | None = None
    drawn_first: Collection[str] = ()
    judge: Callable[[scenario.Case], campaign.CaseRun] | None = None

    @property
    def all_cases(self) -> list[scenario.Case]:
        """All cases, those of series too."""
        return all_cases(self.cases, self.series)

    def content(
        self,
        results: Sequence[evaluation.CaseResult],
        judged: Sequence[judging_series.SeriesResult],
        name: str = "",
    ) -> report.RunContent:
        """Return what reports show of results of the cases and series, but for traces and the baseline."""
        return report.RunContent(
            name,
            results,
            self.manifest,
            complete=(len(results), len(judged)) == (len(self.cases), len(self.series)),
            subjects=self.subjects,
            series=judged,
            drawn_first=self.drawn_first,
        )


def all_cases(cases: Iterable[scenario.Case], planned: Iterable[series_plans.Series]) -> list[scenario.Case]:
    """Return cases and those of series."""
    return [*cases, *(case for each in planned for case in each.cases)]


def batch_of(
    cases: Sequence[scenario.Case],
    planned: Sequence[series_plans.Series],
    arguments: Sequence[str],
    seed: int | None,
    settings: campaign.RunSettings | None = None,
    *,
    validated: Path | None = None,
    baseline: comparison.Baseline | None = None,
    drawn_first: Collection[str] = (),
) -> Batch:
    """Return the batch of cases and series to simulate.

    Args:
        cases: to run.
        planned: series to run behind them.
        arguments: of the command line, which selects these.
        seed: that the command line gives to every case.
        settings: of the run; their parts and domains are found here.
        validated: the validation that says whether each case lies in its domain, in place of those that cases
            name.
        baseline: to compare with.
        drawn_first: ids of the cases whose stops a page draws before all others.

    Compensations are identified here, before any display: up to minutes. Raises InvalidInputError where a
    validation cannot be read.
    """
    everything = all_cases(cases, planned)
    references = _references(everything, validated)
    parts = campaign.parts_of_cases(everything)
    inputs = [*(case.inputs for case in everything), *(each.inputs for each in planned)]
    read = {name: digest for each in inputs for name, digest in each.items()}
    manifest = report.run_manifest(arguments, seed, read, len(everything), parts.values())
    of_validations = {each.file: each.sha256 for each in references.values()}
    return Batch(
        cases,
        planned,
        replace(manifest, inputs={**manifest.inputs, **of_validations}),
        campaign.descriptions_of(everything),
        replace(
            settings or campaign.RunSettings(),
            parts=parts,
            domains={case_id: each.domain_of(parts[case_id]) for case_id, each in references.items()},
        ),
        baseline,
        drawn_first,
    )


def _references(
    cases: Sequence[scenario.Case], validated: Path | None
) -> dict[str, validation.ValidationReference]:
    """Return the validation of each case that has one, by its id; each file is read once."""
    named = {case.id: validated or case.scenario.validated for case in cases}
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
    settings = batch.settings
    drawing = TraceCollection.of(
        *(batch.all_cases, settings.recording, batch.drawn_first),
        needed=draws_stops,
        recorded=batch.judge is not None,
    )

    def run(cases: Sequence[scenario.Case], note: Note, own: campaign.RunSettings) -> campaign.BatchResult:
        def hand_on(case_run: campaign.CaseRun) -> None:
            drawing.add(case_run)
            result = case_run.result
            if keep is not None and case_run.recording is not None and settings.recording.wants(result):
                keep(result.id, case_run.recording)
            note(case_run, batch.baseline.differences(result) if batch.baseline else ())

        if batch.judge is not None:
            return campaign.judge_cases(cases, batch.judge, settings, hand_on)
        return simulate_cases(cases, replace(own, recording=drawing.recording), observer, hand_on)

    done = run(batch.cases, observer.case, settings)
    missed = sum(not result.met for result in done.results)
    judged = SeriesBatch(interrupted=done.interrupted)
    if not done.interrupted:
        judged = run_series(
            batch.series,
            # A series is firm as a whole: of its cases it is not asked.
            lambda cases: run(cases, observer.case_of_series, replace(settings, maxfail=None, firm=False)),
            lambda each, result: _with_firmness(each, result, settings, observer),
            maxfail=None if settings.maxfail is None else settings.maxfail - missed,
            show=observer.series,
        )
    content = batch.content(done.results, judged.results, name)
    everything = campaign.BatchResult(content.all_results, judged.interrupted)
    content = replace(content, traces=drawing.finish(everything, settings.jobs))
    if batch.baseline is not None:
        content = replace(content, baseline=batch.baseline.compare(content))
    return BatchRun(content, judged.interrupted)


def simulate_cases(
    cases: Sequence[scenario.Case],
    settings: campaign.RunSettings,
    observer: Observer,
    on_result: Callable[[campaign.CaseRun], None] = lambda case_run: None,
    unit: str = "",
) -> campaign.BatchResult:
    """Run cases while an observer follows their stops; it counts them as `unit`s [default: what they are]."""
    if not cases:
        return campaign.BatchResult()
    if settings.in_process and any(case.scenario.controller.program for case in cases):
        observer.foreign_in_process()
    asked = {case.id: case for case in cases if settings.firm or case.scenario.firm}
    with observer.compiling():
        rig.compiled_stop()
        if asked:
            rig.load_block([case.scenario.controller.program for case in asked.values()])
    varied = sum(map(stops_of_case, asked.values()))
    stops = sum(case.scenario.repeat for case in cases) + varied
    unit = unit or ("stops" if stops > len(cases) else "cases")
    with observer.simulating(stops, unit=unit) as advance, firmness_run(settings, varied, advance) as firm:
        if asked:
            settings = replace(
                settings, firmness=lambda name: firm.of_case(asked[name]) if name in asked else None
            )
        return campaign.run_cases(cases, settings, on_result=on_result, on_stop=lambda: advance(1))


def _with_firmness(
    planned: series_plans.Series,
    result: judging_series.SeriesResult,
    settings: campaign.RunSettings,
    observer: Observer,
) -> judging_series.SeriesResult:
    """Return the result of a series, with how firm it is where that is asked and it was judged."""
    if not (settings.firm or planned.file.firm) or result.outcome in campaign.NOT_JUDGED:
        return result
    stops = stops_of_series(planned)
    with observer.compiling():
        rig.load_block([case.scenario.controller.program for case in planned.cases])
    with observer.simulating(stops, unit="stops") as advance, firmness_run(settings, stops, advance) as firm:
        return replace(result, firmness=firm.of_series(planned))


@dataclass(slots=True)
class SeriesBatch:
    """The series that were judged, and whether an interrupt ended them."""

    results: list[judging_series.SeriesResult] = field(default_factory=list)
    interrupted: bool = False


def run_series(
    planned: Sequence[series_plans.Series],
    run: Callable[[Sequence[scenario.Case]], campaign.BatchResult],
    complete: Callable[
        [series_plans.Series, judging_series.SeriesResult], judging_series.SeriesResult
    ] = lambda planned, result: result,
    *,
    maxfail: int | None,
    show: Callable[[judging_series.SeriesResult], None],
) -> SeriesBatch:
    """Run and judge series; after `maxfail` that are not as expected no further one is run.

    `complete` adds to a result what it takes further stops to say.

    A series whose stops an interrupt cut short is not judged.
    """
    batch = SeriesBatch()
    for each in planned:
        if maxfail is not None and sum(not result.met for result in batch.results) >= maxfail:
            break
        done = run(each.cases)
        if done.interrupted:
            batch.interrupted = True
            break
        batch.results.append(judging_series.judge_results(each, done.results))
        try:
            result = batch.results[-1] = complete(each, batch.results[-1])
        except KeyboardInterrupt:
            batch.interrupted = True
            break
        show(result)
    return batch
