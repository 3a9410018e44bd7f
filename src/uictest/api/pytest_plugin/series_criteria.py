"""Series files: one item per criterion of each series."""

from __future__ import annotations

from collections.abc import Iterator, Sequence
from dataclasses import dataclass
from functools import cached_property
from pathlib import Path
from typing import Any

import pytest

from uictest import report
from uictest.api.pytest_plugin.cases import Changes, RigItem, numbers_in, simulated, with_reasons_first
from uictest.judging import series
from uictest.plans import series as series_plans
from uictest.plans.scenario import yaml

OUTCOME = "outcome"
"""Name of the only item of a series that should not pass: its criteria cannot be expected one by one. So is
that of a series without a criterion to judge it, which is skipped and not met. With `--uictest-strict` every
series has it: it says whether all verdicts are settled."""


class SeriesFile(pytest.File):
    """A series file. One with errors cannot be collected: the message has all of them."""

    def __init__(self, *, changes: Changes, **node: Any) -> None:
        super().__init__(**node)
        self._changes = changes

    def collect(self) -> Iterator[SeriesCollector]:
        """Yield the collector of the file's series, which share their name."""
        try:
            planned = self._changes.series_of(self.path)
        except yaml.ScenarioErrors as errors:
            raise self.CollectError(str(errors)) from errors
        if planned:
            yield SeriesCollector.from_parent(self, name=planned[0].file.name, planned=planned)


class SeriesCollector(pytest.Collector):
    """The series of a file: one, or one for each combination of its matrix."""

    def __init__(self, *, planned: Sequence[series_plans.Series], **node: Any) -> None:
        super().__init__(**node)
        self._planned = planned

    def collect(self) -> Iterator[SeriesItem]:
        """Yield for each series an item per criterion, or the one of its outcome."""
        for planned in self._planned:
            run = SeriesRun(self.config, planned)
            values = planned.id.removeprefix(self.name)
            names = [criterion.id for _, criterion in planned.judged_criteria]
            if planned.file.expect != "pass" or not names:
                names = [OUTCOME]
            elif self.config.getoption("uictest_strict"):
                names.append(OUTCOME)
            for name in names:
                yield SeriesItem.below(self, f"{name}{values}", criterion=name, run=run)


@dataclass
class SeriesRun:
    """A series whose stops are simulated once, when the first of its items is set up."""

    config: pytest.Config
    planned: series_plans.Series

    @cached_property
    def result(self) -> series.SeriesResult:
        """The series, judged."""
        results = [run.result for run in simulated(self.config, self.planned.cases)]
        return series.judge_results(self.planned, results)


class SeriesItem(RigItem):
    """One criterion of a series, or its outcome."""

    def __init__(self, *, criterion: str, run: SeriesRun, **node: Any) -> None:
        super().__init__(**node)
        self.run = run
        self._criterion = criterion
        self._result: series.SeriesResult | None = None
        self.tag(run.planned.file.tags)

    def setup(self) -> None:
        """Run the series unless an earlier item did."""
        self._result = result = self.run.result
        self.record(_properties(result, self._verdict(result)))
        if result.outcome == "error":
            pytest.fail(with_reasons_first(report.series_explanation(result)), pytrace=False)

    def runtest(self) -> None:
        """Fail where the criterion is not kept, skip where it applies to no stop."""
        assert self._result is not None  # pytest calls `setup` first
        each = self._verdict(self._result)
        if each is None:
            if not self._result.met:
                pytest.fail(with_reasons_first(report.series_explanation(self._result)), pytrace=False)
        elif each.verdict.status in ("fail", "inconclusive"):
            pytest.fail(_explanation(self._result, each), pytrace=False)
        elif each.verdict.status == "not_applicable":
            if self._result.outcome == "skipped":
                pytest.fail(with_reasons_first(report.series_explanation(self._result)), pytrace=False)
            pytest.skip(each.verdict.reason)

    def reportinfo(self) -> tuple[Path, int, str]:
        """Return the file, its first line, and the name of series and criterion."""
        return self.path, 0, f"{self.run.planned.file.name}.{self.name}"

    def results_document(self) -> dict[str, Any] | None:
        """Return the series in JSON; None before it is judged."""
        return None if self._result is None else {"series": series.series_document([self._result])}

    def _verdict(self, result: series.SeriesResult) -> series.SeriesVerdict | None:
        return next((each for each in result.criteria if each.verdict.id == self._criterion), None)


def _explanation(result: series.SeriesResult, each: series.SeriesVerdict) -> str:
    lines = [
        report.series_verdict_sentence(each, result.confidence),
        *report.count_sentences(result),
        *report.not_counted_sentences(result),
    ]
    return "\n".join(lines)


def _properties(result: series.SeriesResult, each: series.SeriesVerdict | None) -> dict[str, object]:
    if each is None:
        values = {name: value.estimate for name, value in result.measures.items()}
        figures = {name: estimate.value for name, estimate in values.items() if estimate is not None}
        tested = report.test_properties(result.test_case, report.requirements_of(result))
        return {**tested, "outcome": result.outcome, "expect": result.expect, **numbers_in(figures)}
    verdict = each.verdict
    requirements = dict.fromkeys((*result.requirements, *verdict.requirements))
    figures = {name: getattr(verdict, name) for name in ("value", "lower", "upper", "margin")}
    known = {name: value for name, value in figures.items() if value is not None}
    return {
        **report.test_properties(result.test_case, requirements),
        "status": verdict.status,
        "unit": verdict.unit,
        **numbers_in(known),
    }
