"""Cases and series, simulated or recorded, to what reports show."""

from __future__ import annotations

from collections.abc import Callable, Collection, Iterable, Mapping, Sequence
from contextlib import ExitStack
from dataclasses import dataclass, field, replace
from functools import partial
from pathlib import Path
from typing import NamedTuple

from uictest import report, rig
from uictest.analysis import comparison
from uictest.core import recording
from uictest.judging import evaluation, series as judging_series
from uictest.plans import scenario, series as series_plans
from uictest.running import campaign
from uictest.runs.observer import Observer, available_processors
from uictest.runs.scenario_files import implausible_trains, references_of

Keep = Callable[[str, recording.Recording], object]
"""Takes the id of a case and its recording."""
Show = Callable[[campaign.CaseRun, Sequence[report.Difference]], None]
"""Takes a finished case, and its differences from the baseline."""


class Batch(NamedTuple):
    """Cases and series to run, and how.

    Args:
        cases: to run.
        series: series to run after the cases; each counts as one for `maxfail`.
        manifest: manifest of the run.
        subjects: descriptions of all cases, those of series too, by id.
        settings: settings of all cases.
        baseline: to compare with, if any.
        drawn_first: ids of the cases whose stops a page draws before all others.
        judge: returns what a recorded case came to; None where cases are simulated.
        passed_over: what was found and is not judged, a sentence with the reason each.
        together: returns what the results of a log or a programme show together; without an observer, where a
            run was cut short, without further stops. Raises KeyboardInterrupt.
    """

    cases: Sequence[scenario.Case]
    series: Sequence[series_plans.Series]
    manifest: report.RunManifest
    subjects: Mapping[str, report.CaseDescription]
    settings: campaign.RunSettings
    baseline: comparison.Baseline | None = None
    drawn_first: Collection[str] = ()
    judge: Callable[[scenario.Case], campaign.CaseRun] | None = None
    passed_over: Sequence[str] = ()
    together: Callable[[Sequence[evaluation.CaseResult], Observer | None], report.Campaign] | None = None

    @property
    def all_cases(self) -> list[scenario.Case]:
        """All cases, those of series too."""
        return all_cases(self.cases, self.series)

    def content(
        self,
        results: Sequence[evaluation.CaseResult],
        judged: Sequence[judging_series.SeriesResult],
        name: str = "",
        *,
        interrupted: bool = False,
    ) -> report.RunContent:
        """Return the content of reports on the cases and series, without traces and the baseline."""
        return report.RunContent(
            *(name, results, self.manifest),
            complete=not interrupted and (len(results), len(judged)) == (len(self.cases), len(self.series)),
            subjects=self.subjects,
            series=judged,
            drawn_first=self.drawn_first,
            passed_over=self.passed_over,
        )


def all_cases(cases: Iterable[scenario.Case], planned: Iterable[series_plans.Series]) -> list[scenario.Case]:
    """Return cases and those of series."""
    return [*cases, *(case for one in planned for case in one.cases)]


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
    """Return the batch of cases and series to simulate; `baseline` and `drawn_first` as of :class:`Batch`.

    Args:
        cases: to run.
        planned: series to run after them.
        arguments: arguments of the command line, which selects these.
        seed: seed that the command line gives to every case.
        settings: settings of the run; their parts and domains are found here.
        validated: the validation that says whether each case lies in its domain, in place of those that cases
            name.

    Compensations are identified here, before any display: up to minutes. Raises InvalidInputError where a
    validation cannot be read, and ScenarioErrors for implausible trains if the settings are strict.
    """
    everything = all_cases(cases, planned)
    if settings is not None and settings.strict and (implausible := implausible_trains(everything)):
        raise scenario.ScenarioErrors(implausible)
    references = references_of(everything, validated)
    parts = campaign.parts_of_cases(everything)
    cars = {case.id: scenario.car_figures(case.scenario) for case in everything}
    settings = settings or campaign.RunSettings()
    read_for: Sequence[scenario.Case | series_plans.Series] = (*everything, *settings.calibration, *planned)
    read = {name: digest for loaded in read_for for name, digest in loaded.inputs.items()}
    manifest = report.run_manifest(arguments, seed, read, len(everything), parts.values())
    domains = {case_id: reference.domain_of(parts[case_id]) for case_id, reference in references.items()}
    of_validations = {reference.file: reference.sha256 for reference in references.values()}
    return Batch(
        cases,
        planned,
        replace(manifest, inputs={**manifest.inputs, **of_validations}),
        campaign.descriptions_of(everything),
        replace(settings, parts=parts, domains=domains, cars=cars),
        baseline,
        drawn_first,
    )


class BatchRun(NamedTuple):
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
        name: name of the run.
        draws_stops: whether a report will draw stops.
        keep: takes the recordings of cases.
    """
    settings = batch.settings
    recorded = batch.judge is not None
    drawing = TraceCollection(
        batch.all_cases,
        settings.recording,
        needed=draws_stops,
        repeatable=recorded or are_repeatable(batch.all_cases),
        drawn_first=batch.drawn_first,
        recorded=recorded,
    )
    runner = _CaseRunner(batch, observer, drawing, keep)
    done = runner.run(batch.cases, settings, observer.case)
    judged: campaign.BatchResult[judging_series.SeriesResult]  # not evaluated: few runs have series
    judged = campaign.BatchResult(interrupted=done.interrupted)
    if not done.interrupted:
        missed = sum(not result.met for result in done.results)
        of_series = replace(settings, maxfail=None, firm=False)  # asked of a series as a whole
        judged = run_series(
            batch.series,
            lambda cases: runner.run(cases, of_series, observer.case_of_series),
            lambda one, result: _with_firmness(one, result, settings, observer),
            maxfail=None if settings.maxfail is None else settings.maxfail - missed,
            show=observer.series,
        )
    together, interrupted = _together(batch, done.results, observer, interrupted=judged.interrupted)
    content = batch.content(done.results, judged.results, name, interrupted=interrupted)
    traces = drawing.finish(content.all_results, settings.jobs, interrupted=interrupted)
    content = replace(content, traces=traces, campaign=together)
    if batch.baseline is not None:
        content = replace(content, baseline=batch.baseline.compare(content))
    return BatchRun(content, interrupted)


def _together(
    batch: Batch, results: Sequence[evaluation.CaseResult], observer: Observer, *, interrupted: bool
) -> tuple[report.Campaign | None, bool]:
    """Return what the results show together, and whether an interrupt ended that or the run before."""
    if batch.together is None:
        return None, interrupted
    whole = len(results) == len(batch.cases) and not interrupted
    try:
        return batch.together(results, observer if whole else None), interrupted
    except KeyboardInterrupt:
        return batch.together(results, None), True


class _CaseRunner(NamedTuple):
    """Simulates or judges cases of a batch, and hands on each that is finished."""

    batch: Batch
    observer: Observer
    drawing: TraceCollection
    keep: Keep | None

    def run(
        self, cases: Sequence[scenario.Case], settings: campaign.RunSettings, show: Show
    ) -> campaign.BatchResult[evaluation.CaseResult]:
        on_case = partial(self._hand_on, show)
        if self.batch.judge is not None:
            return campaign.judge_cases(cases, self.batch.judge, settings, on_case)
        recorded = replace(settings, recording=self.drawing.recording)
        return simulate_cases(cases, recorded, self.observer, on_case)

    def _hand_on(self, show: Show, case_run: campaign.CaseRun) -> None:
        """Draw, keep and show a finished case."""
        self.drawing.add(case_run)
        result, samples = case_run.result, case_run.recording
        if self.keep is not None and samples is not None and self.batch.settings.recording.wants(result):
            self.keep(result.id, samples)
        baseline = self.batch.baseline
        show(case_run, baseline.differences(result) if baseline else ())


def simulate_cases(
    cases: Sequence[scenario.Case],
    settings: campaign.RunSettings,
    observer: Observer,
    on_case: Callable[[campaign.CaseRun], None] = lambda case_run: None,
    unit: str = "",
) -> campaign.BatchResult[evaluation.CaseResult]:
    """Run cases while an observer follows their stops; it counts them as `unit`s [default: what they are]."""
    if not cases:
        return campaign.BatchResult()
    if settings.in_process and any(case.is_from_outside for case in cases):
        observer.foreign_in_process()
    asked = {case.id: case for case in cases if settings.asks_firmness_of(case)}
    varied = 0
    if asked:
        from uictest.runs.firmness import firmness_run, stops_of_case  # which few runs need

        varied = sum(stops_of_case(case, settings) for case in asked.values())
    stops = sum(case.scenario.repeat for case in cases) + varied
    unit = unit or ("stops" if stops > len(cases) else "cases")
    rig.compiled_rig()  # built before stops run side by side; where it cannot be, that is no result of a case
    with ExitStack() as stack:
        advance = stack.enter_context(observer.simulating(stops, unit=unit))
        if asked:
            firm = stack.enter_context(firmness_run(settings, advance))
            settings = replace(
                settings, firmness=lambda name: firm.of_case(asked[name]) if name in asked else None
            )
        return campaign.run_cases(cases, settings, on_case=on_case, on_stop=lambda: advance(1))


def _with_firmness(
    planned: series_plans.Series,
    result: judging_series.SeriesResult,
    settings: campaign.RunSettings,
    observer: Observer,
) -> judging_series.SeriesResult:
    """Return the result of a series, with how firm it is where that is asked and it was judged."""
    if not (settings.firm or planned.file.firm) or result.outcome in campaign.NOT_JUDGED:
        return result
    from uictest.runs.firmness import firmness_run, stops_of_series  # which few runs need

    stops = stops_of_series(planned, settings)
    with observer.simulating(stops, unit="stops") as advance, firmness_run(settings, advance) as firm:
        return replace(result, firmness=firm.of_series(planned))


def run_series(
    planned: Sequence[series_plans.Series],
    run: Callable[[Sequence[scenario.Case]], campaign.BatchResult[evaluation.CaseResult]],
    complete: Callable[
        [series_plans.Series, judging_series.SeriesResult], judging_series.SeriesResult
    ] = lambda planned, result: result,
    *,
    maxfail: int | None,
    show: Callable[[judging_series.SeriesResult], None],
) -> campaign.BatchResult[judging_series.SeriesResult]:
    """Run and judge series; after `maxfail` that are not as expected no further one is judged.

    Series of several cars of the same trains are run together, each train once. `complete` adds to a result
    what it takes further stops to say. A series whose stops an interrupt cut short is not judged.
    """
    batch: campaign.BatchResult[judging_series.SeriesResult] = campaign.BatchResult()
    finished: dict[str, evaluation.CaseResult] = {}
    for index, one in enumerate(planned):
        if maxfail is not None and sum(not result.met for result in batch.results) >= maxfail:
            break
        if any(case.id not in finished for case in one.cases):
            done = run(series_plans.cases_run_together(planned[index:]))
            if done.interrupted:
                batch.interrupted = True
                break
            finished = {result.id: result for result in done.results}
        result = judging_series.judge_results(one, [finished[case.id] for case in one.cases])
        try:
            result = complete(one, result)
        except KeyboardInterrupt:
            batch.interrupted = True
        batch.results.append(result)
        show(result)
        if batch.interrupted:
            break
    return batch


@dataclass(slots=True)
class TraceCollection:
    """Collects the traces of a batch.

    A small batch is recorded while it runs. The cases to draw of a large batch are known only at its end:
    they are simulated again, which is cheap compared with the batch. So are those of a batch whose recordings
    are too coarse for the valves, because a page shows every command. Stops with controllers from outside are
    not `repeatable`: all are recorded while they run, and the traces of those drawn are kept. Those that were
    `recorded` before have their traces anyway.
    """

    cases: Sequence[scenario.Case]
    request: campaign.RecordingRequest
    needed: bool
    repeatable: bool = True
    drawn_first: Collection[str] = ()
    recorded: bool = False
    traces: dict[str, report.PlotTrace] = field(default_factory=dict)

    @property
    def recording(self) -> campaign.RecordingRequest:
        """What to record while the batch runs."""
        if not self._while_running:
            return self.request
        return self.request._replace(cases="all", band_stops=report.BAND_STOPS)

    def add(self, case_run: campaign.CaseRun) -> None:
        """Add the trace of a case."""
        if self._while_running and case_run.recording is not None:
            trace = report.trace_of_stop(case_run.recording, case_run.result)
            self.traces[case_run.result.id] = report.with_band(trace, case_run.extremes)

    def finish(
        self, results: Sequence[evaluation.CaseResult], jobs: int, *, interrupted: bool
    ) -> dict[str, report.PlotTrace]:
        """Return the traces; simulate the drawn cases of a large batch again, unless it was interrupted."""
        drawn = _drawn_cases(results, self.drawn_first)
        if not self.repeatable:
            self.traces = {name: trace for name, trace in self.traces.items() if name in drawn}
        if self.needed and not self._while_running and not interrupted:
            every = _drawing_interval(self.cases, self.request.every)
            self.traces |= _simulated_again(self.cases, drawn, every, jobs)
        return self.traces

    @property
    def _while_running(self) -> bool:
        small_and_fine = len(self.cases) <= report.DRAWN and self.request.every <= _drawing_interval(
            self.cases, self.request.every
        )
        return self.needed and (small_and_fine or self.recorded or not self.repeatable)


def with_traces(
    content: report.RunContent,
    cases: Sequence[scenario.Case],
    recordings: Mapping[str, recording.Recording],
    every: float,
) -> report.RunContent:
    """Return a finished run with what a page draws of it: some of its stops, simulated again.

    Of stops that are not repeatable, and without `cases`, it draws those that were recorded.

    Args:
        content: what reports show of the run.
        cases: cases of the run.
        recordings: recordings of some of them, by id.
        every: the interval of these, s.
    """
    drawn = _drawn_cases(content.all_results, content.drawn_first)
    if cases and are_repeatable(cases):
        traces = _simulated_again(cases, drawn, _drawing_interval(cases, every), available_processors())
    else:
        traces = {
            name: report.trace_of_stop(recordings[name], result)
            for name, result in drawn.items()
            if name in recordings
        }
    return replace(content, traces=traces)


def are_repeatable(cases: Sequence[scenario.Case]) -> bool:
    """Return whether the stops of cases come out the same again: no controller is from outside."""
    return not any(case.is_from_outside for case in cases)


def _drawn_cases(
    results: Sequence[evaluation.CaseResult], drawn_first: Collection[str]
) -> dict[str, evaluation.CaseResult]:
    """Return the cases that a page draws, by id."""
    stopped = [result for result in results if result.outcome != "error"]
    return {result.id: result for result in report.drawn_cases(stopped, drawn_first)}


def _drawing_interval(cases: Sequence[scenario.Case], every: float) -> float:
    """Return the time between two samples of what is drawn, s."""
    return min(every, campaign.shortest_cycle(cases))


def _simulated_again(
    cases: Sequence[scenario.Case], drawn: Mapping[str, evaluation.CaseResult], every: float, jobs: int
) -> dict[str, report.PlotTrace]:
    """Return the traces; of a repeated case the first stop is drawn, before the band of those that follow."""
    stops = [
        stop.alone
        for stop in campaign.stops_of(campaign.by_id(cases, frozenset(drawn)))
        if stop.repeat < report.BAND_STOPS
    ]
    traces: dict[str, report.PlotTrace] = {}
    extremes: dict[str, list[report.StopExtremes]] = {}
    for case, samples in campaign.replay(stops, every=every, jobs=jobs):
        if case.id not in traces:
            traces[case.id] = report.trace_of_stop(samples, drawn[case.id])
        extremes.setdefault(case.id, []).append(report.stop_extremes(samples))
    return {case_id: report.with_band(trace, extremes[case_id]) for case_id, trace in traces.items()}
