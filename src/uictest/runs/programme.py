"""A programme from its stops to what reports show: its tests judged, and where along friction each is met."""

from __future__ import annotations

import math
from collections.abc import Callable, Mapping, Sequence
from dataclasses import replace
from decimal import Decimal
from itertools import pairwise
from typing import ClassVar

import numpy as np
from numpy.typing import NDArray

from uictest import report
from uictest.analysis import summaries
from uictest.judging import evaluation, series as judging_series
from uictest.plans import scenario, series as series_plans, sweeps
from uictest.plans.scenario import yaml
from uictest.running import campaign
from uictest.runs.batch import Batch, simulate_cases
from uictest.runs.observer import Observer


def of_programme(batch: Batch, planned: series_plans.Programme) -> Batch:
    """Return a batch of stops of a programme, in which its tests are judged when these are finished.

    With strict settings a test that has a limit and is not valid and met fails; the stops decide nothing.
    """
    strict, settings = batch.settings.strict, replace(batch.settings, strict=False)

    def together(results: Sequence[evaluation.CaseResult], observer: Observer | None) -> report.Campaign:
        tests = judging_series.judge_programme(planned, results)
        ranges = [] if observer is None else _met_ranges(tests, settings, observer)
        return report.programme_campaign(planned.file, tests, ranges, strict=strict)

    manifest = replace(batch.manifest, inputs={**batch.manifest.inputs, **planned.inputs})
    return batch._replace(manifest=manifest, settings=settings, together=together)


def _met_ranges(
    tests: Sequence[judging_series.JudgedTest], settings: campaign.RunSettings, observer: Observer
) -> list[report.MetRange]:
    """Return where along friction each test that was run is valid and met: of a scan, halved where it turns.

    Raises KeyboardInterrupt.
    """
    scans = [
        _FrictionScan(test, rail, case)
        for test in tests
        for rail, case in test.planned.scanned
        if test.status not in ("not run", "no reference")
    ]
    quiet = replace(settings, recording=campaign.RecordingRequest("none"), maxfail=None, firm=False)
    cases = [case for scan in scans for case in scan.plan.cases(np.arange(scan.plan.size))]
    done = simulate_cases(cases, quiet, observer)
    if done.interrupted:
        raise KeyboardInterrupt
    found = {result.id: result for result in done.results}
    return [scan.met_range(found, quiet) for scan in scans]


class _FrictionScan:
    """A test on a rail, along the values of its friction."""

    finest: ClassVar[int] = 8
    """Part of the smallest step of the scan to which a verdict is located; chosen: single stops scatter."""

    def __init__(self, test: judging_series.JudgedTest, rail: str, case: scenario.Case) -> None:
        assert test.limits is not None
        self.name, self.rail, self.limits = test.planned.test.name, rail, test.limits
        frictions = test.planned.frictions
        rows = tuple((sweeps.ParameterValue(each.text, each, each.text),) for each in frictions)
        group = sweeps.ListedGroup((series_plans.FRICTION,), rows)
        name, short = f"{case.id}.{rail}", {series_plans.FRICTION: "friction"}
        self.plan = sweeps.Plan(name, "", case.path.as_posix(), case, (group,), short)
        smallest = min(after - before for before, after in pairwise(Decimal(each.text) for each in frictions))
        self.tolerance = yaml.DecimalQuantity(smallest / self.finest, "")

    def met_range(
        self, found: Mapping[str, evaluation.CaseResult], settings: campaign.RunSettings
    ) -> report.MetRange:
        """Return where all stops are valid and met, from the results of the scan by id and of further stops.

        Where they are tests and where they keep the limit are sought apart: both may hold between two
        frictions of the scan. Raises KeyboardInterrupt.
        """
        scanned = [_stops_of(found[name]) for name in self.plan.ids(np.arange(self.plan.size))]
        stops = [stop for of_case in scanned for stop in of_case]
        valid, further = self._intervals(scanned, settings, _is_valid)
        within, others = self._intervals(scanned, settings, self._keeps_limit)
        stops += [*further, *others]
        both = [(max(a[0], b[0]), min(a[1], b[1])) for a in valid for b in within]
        judged = all(evaluation.validity_of(stop.criteria) != "not_judged" for stop in stops)
        return report.MetRange(
            self.name,
            self.rail,
            tuple(sorted((low, high) for low, high in both if low <= high)),
            judged,
            len(stops),
            sum(stop.outcome == "error" for stop in stops),
        )

    def _keeps_limit(self, stop: evaluation.RepeatedStop) -> bool:
        measures = stop.measures
        return measures is not None and self.limits.hold(float(measures["braking_distance_m"]))

    def _intervals(
        self,
        scanned: Sequence[Sequence[evaluation.RepeatedStop]],
        settings: campaign.RunSettings,
        holds: Callable[[evaluation.RepeatedStop], bool],
    ) -> tuple[list[tuple[float, float]], list[evaluation.RepeatedStop]]:
        """Return the intervals of friction in which something holds for all stops, and the stops it took.

        An end of the scan is infinite.
        """
        further: list[evaluation.RepeatedStop] = []

        def judge(plan: sweeps.Plan, indices: NDArray[np.int64]) -> NDArray[np.int8]:
            done = campaign.run_cases(plan.cases(indices), settings)
            if done.interrupted:
                raise KeyboardInterrupt
            stops = [_stops_of(result) for result in done.results]
            further.extend(stop for of_case in stops for stop in of_case)
            return np.array([all(map(holds, of_case)) for of_case in stops], np.int8)

        verdicts = np.array([all(map(holds, of_case)) for of_case in scanned], np.int8)
        search = summaries.FrontierSearch(self.plan, series_plans.FRICTION, self.tolerance)
        [scan] = search.run(verdicts, judge)
        starts = [-math.inf] if verdicts[0] else []
        ends = [math.inf] if verdicts[-1] else []
        starts += [float(flip.high.text) for flip in scan.flips if not flip.met_at_low]
        ends += [float(flip.low.text) for flip in scan.flips if flip.met_at_low]
        return list(zip(sorted(starts), sorted(ends), strict=True)), further


def _stops_of(result: evaluation.CaseResult) -> Sequence[evaluation.RepeatedStop]:
    """Return the stops of a case, one where it is not repeated."""
    if result.repeats is not None:
        return result.repeats.stops
    return [evaluation.RepeatedStop(0, result.outcome, "", result.criteria, result.measures)]


def _is_valid(stop: evaluation.RepeatedStop) -> bool:
    return not evaluation.why_no_test(stop.criteria)
