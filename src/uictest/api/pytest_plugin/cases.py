"""Scenario files: one item per case."""

from __future__ import annotations

from collections.abc import Iterator
from typing import Any

import pytest

from uictest import report
from uictest.api.pytest_plugin.item import Changes, RigItem, numbers_in, simulated, with_reasons_first
from uictest.judging import evaluation
from uictest.plans import scenario
from uictest.plans.scenario import yaml
from uictest.running import campaign


class ScenarioFile(pytest.File):
    """A scenario file. A file with errors cannot be collected: the message has all of them."""

    def __init__(self, *, changes: Changes, **node: Any) -> None:
        super().__init__(**node)
        self._changes = changes

    def collect(self) -> Iterator[CaseItem]:
        """Yield an item per case."""
        try:
            cases = self._changes.cases_of(self.path)
        except yaml.ScenarioErrors as errors:
            raise self.CollectError(str(errors)) from errors
        for case in cases:
            yield CaseItem.below(self, case.id, case=case)


class CaseItem(RigItem):
    """One case: passes if its outcome is the expected one."""

    def __init__(self, *, case: scenario.Case, **node: Any) -> None:
        super().__init__(**node)
        self.case = case
        self._result: evaluation.CaseResult | None = None
        self.tag(case.scenario.tags)

    def setup(self) -> None:
        """Simulate and judge the case."""
        [run] = simulated(self.config, [self.case])
        self._result = run.result
        self.record(_properties(run.result))
        if run.result.outcome == "error":
            pytest.fail(_error_text(run, traceback=self.config.get_verbosity() > 0), pytrace=False)

    def runtest(self) -> None:
        """Fail, or skip, where the outcome says so."""
        result = self._result
        assert result is not None  # pytest calls `setup` first
        if not result.met:
            pytest.fail(with_reasons_first(report.explanation(result)), pytrace=False)
        if result.outcome == "skipped":
            pytest.skip(result.reason)

    def results_document(self) -> dict[str, Any] | None:
        """Return the result in JSON, and how long it took; None before there is one."""
        if self._result is None:
            return None
        return {"cases": evaluation.result_document([self._result]), "duration": self._result.duration}


def _properties(result: evaluation.CaseResult) -> dict[str, object]:
    tested = report.test_properties(result.test_case, report.requirements_of(result))
    return {**tested, "outcome": result.outcome, "expect": result.expect, **numbers_in(result.measures)}


def _error_text(run: campaign.CaseRun, *, traceback: bool) -> str:
    text = with_reasons_first(report.explanation(run.result))
    return f"{text}\n{run.traceback.rstrip()}" if traceback and run.traceback else text
