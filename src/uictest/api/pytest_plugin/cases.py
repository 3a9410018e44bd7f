"""What tests of the rig have in common, and scenario files: one item per case."""

from __future__ import annotations

from abc import abstractmethod
from collections.abc import Iterable, Iterator, Mapping, Sequence
from dataclasses import dataclass
from pathlib import Path
from typing import Any, Final, Self

import pytest

from uictest import report, runs
from uictest.judging import evaluation
from uictest.plans import scenario, series
from uictest.plans.scenario import yaml
from uictest.running import campaign

_MEANT_FOR_PYTEST: Final = frozenset(
    {"filterwarnings", "parametrize", "skip", "skipif", "usefixtures", "xfail"}
)
"""Marks that change how pytest runs a test: a tag of this name stays a word for `-k`."""


class RigItem(pytest.Item):
    """A test of the rig: its stops are simulated in `setup`, its verdict is given in `runtest`.

    What the rig cannot simulate is thereby an error of the test, and a missed expectation is a failure.
    """

    @classmethod
    def below(cls, parent: pytest.Collector, name: str, **own: Any) -> Self:
        """Return the item of this name, whose values in brackets pytest takes for parameters."""
        # `--lf` finds `case[friction=0.1]` again only if the id is handed over whole.
        item: Self = cls.from_parent(parent, name=name, nodeid=f"{parent.nodeid}::{name}", **own)
        return item

    @abstractmethod
    def results_document(self) -> dict[str, Any] | None:
        """Return the results that the test rests on, in JSON: cases or series; None where there are none."""

    def tag(self, tags: Iterable[str]) -> None:
        """Make tags words for `-k`, and marks for `-m`, which `--strict-markers` accepts."""
        for tag in tags:
            self.extra_keyword_matches.add(tag)
            if tag not in _MEANT_FOR_PYTEST:
                self.config.addinivalue_line("markers", f"{tag}: tag of a scenario or series")
                self.add_marker(tag)

    def record(self, properties: Mapping[str, object]) -> None:
        """Add properties to the test: JUnit and other reports show them."""
        self.user_properties.extend(properties.items())

    def reportinfo(self) -> tuple[Path, int, str]:
        """Return the file, its first line and the name."""
        return self.path, 0, self.name


def simulated(config: pytest.Config, cases: Sequence[scenario.Case]) -> list[campaign.CaseRun]:
    """Simulate and judge cases; the workers of pytest-xdist use one thread each. Raises KeyboardInterrupt."""
    case_runs: list[campaign.CaseRun] = []
    jobs = 1 if hasattr(config, "workerinput") else runs.available_processors()
    strict: bool = config.getoption("uictest_strict")
    settings = campaign.RunSettings(jobs, campaign.RecordingRequest("none"), strict=strict)
    campaign.run_cases(cases, settings, on_case=case_runs.append).whole()
    return case_runs


def with_reasons_first(explanation: Sequence[str]) -> str:
    """Return an explanation as text; its first line, which summaries show, is a reason where there is one."""
    outcome, *reasons = explanation
    return "\n".join([*reasons, outcome])


def numbers_in(measures: Mapping[str, float] | None) -> dict[str, Any]:
    """Return the measures that have a value, with five significant digits."""
    return {name: report.number(value) for name, value in (measures or {}).items() if value == value}


@dataclass(frozen=True, slots=True)
class Changes:
    """The options `--uictest-set`, `--uictest-seed` and `--uictest-repeat`, and the files of the session.

    References may lead anywhere below the root directory: pytest executes code from there anyway.

    Args:
        overrides: `key=value` texts.
        seed: of every case, None for its own.
        strict: whether verdicts that are not settled fail a test.
        root: the root directory.
        files: read once for all scenarios.

    """

    overrides: tuple[str, ...]
    seed: int | None
    strict: bool
    root: Path
    files: scenario.Files

    @classmethod
    def of(cls, config: pytest.Config) -> Changes:
        """Return the changes that the command line asks for. Raises pytest.UsageError."""
        repeat: int | None = config.getoption("uictest_repeat")
        overrides = (*config.getoption("uictest_set"), *([] if repeat is None else [f"repeat={repeat}"]))
        seed: int | None = config.getoption("uictest_seed")
        try:
            scenario.parse_overrides(overrides, seed)
        except yaml.ScenarioErrors as errors:
            raise pytest.UsageError(str(errors)) from errors
        files = scenario.Files(scenario.Roots.of((), [config.rootpath]))
        return cls(overrides, seed, config.getoption("uictest_strict"), config.rootpath, files)

    def cases_of(self, path: Path) -> Sequence[scenario.Case]:
        """Return the cases of a scenario file. Raises ScenarioErrors."""
        return scenario.load_file(path, scenario.parse_overrides(self.overrides, self.seed), self.files)

    def series_of(self, path: Path) -> Sequence[series.Series]:
        """Return the series of a file. Raises ScenarioErrors."""
        return series.load_series(path, self.overrides, self.seed, [self.root])


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
