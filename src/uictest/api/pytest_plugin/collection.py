"""What a project asks to run as tests, and the reports of the session."""

from __future__ import annotations

import os
import re
from collections.abc import Generator, Iterable, Mapping, Sequence
from dataclasses import dataclass, field, replace
from pathlib import Path
from typing import Any, Final, Literal

import pytest

from uictest import report, rig, runs
from uictest.api.pytest_plugin.cases import CaseItem, Changes, RigItem, ScenarioFile
from uictest.api.pytest_plugin.series_criteria import SeriesFile, SeriesItem
from uictest.core import recording
from uictest.judging import evaluation, series
from uictest.plans import scenario, series as series_plans
from uictest.plans.scenario import yaml
from uictest.running import campaign

_ATTRIBUTE: Final = "uictest_results"
"""Attribute of a test report: the results of its item in JSON, which pytest-xdist can send."""
_FORMATS: Final = ("csv", "html")


@dataclass(eq=False)
class Reports:
    """Collects the results of the items, those of the workers of pytest-xdist too, and writes the reports.

    Args:
        output: folder of all runs.
        changes: with which the scenarios were loaded.

    """

    output: Path
    changes: Changes
    _results: dict[str, evaluation.CaseResult] = field(default_factory=dict)
    _series: dict[str, series.SeriesResult] = field(default_factory=dict)
    _files: set[Path] = field(default_factory=set)
    _message: str = ""

    @pytest.hookimpl(wrapper=True)
    def pytest_runtest_makereport(
        self, item: pytest.Item
    ) -> Generator[None, pytest.TestReport, pytest.TestReport]:
        """Attach the results of an item to the report that says how it came out."""
        test_report = yield
        decides = test_report.when == "call" or (test_report.when == "setup" and test_report.failed)
        if isinstance(item, RigItem) and decides:
            setattr(test_report, _ATTRIBUTE, item.results_document())
        return test_report

    def pytest_runtest_logreport(self, report: pytest.TestReport) -> None:
        """Collect the results of a finished item."""
        document: Mapping[str, Any] | None = getattr(report, _ATTRIBUTE, None)
        if document is not None:
            self._add(document, self.changes.root / report.nodeid.partition("::")[0])

    def pytest_sessionfinish(self, session: pytest.Session, exitstatus: int) -> None:
        """Write the reports, unless this process is a worker or no item has finished."""
        if hasattr(session.config, "workerinput") or not self._files:
            return
        ended = exitstatus in (pytest.ExitCode.OK, pytest.ExitCode.TESTS_FAILED)
        try:
            place = self._write(complete=ended and not (session.shouldstop or session.shouldfail))
        except (OSError, runs.InvalidInputError, yaml.ScenarioErrors) as error:
            self._message = f"the reports were not written: {error}"
            session.exitstatus = pytest.ExitCode.INTERNAL_ERROR
        else:
            self._message = f"reports in {place}"

    def pytest_terminal_summary(self, terminalreporter: pytest.TerminalReporter) -> None:
        """Say where the reports are, or why there are none."""
        if self._message:
            terminalreporter.write_line(f"uictest: {self._message}")

    def _add(self, document: Mapping[str, Any], file: Path) -> None:
        self._files.add(file)
        if "cases" in document:
            for result in evaluation.results_of(document["cases"]):
                self._results[result.id] = replace(result, duration=document["duration"])
        else:
            for judged in series.series_results_of(document["series"]):
                self._series[judged.id] = judged

    def _write(self, *, complete: bool) -> Path:
        """Write the reports; return the folder of the run. Raises as :meth:`_load`, and OSError."""
        cases, planned = self._load()
        settings = campaign.RunSettings(strict=self.changes.strict)
        batch = runs.batch_of(cases, planned, self._command(), self.changes.seed, settings)
        completed = batch.settings.completed
        results = [completed(self._results[case.id]) for case in cases]
        judged = [
            replace(each, cases=tuple(replace(stop, case=completed(stop.case)) for stop in each.cases))
            for each in (self._series[each.id] for each in planned)
        ]
        content = replace(batch.content(results, judged), complete=complete)
        every = settings.recording.every
        recordings = _recordings_of_missed(cases, content, every)
        content = runs.with_traces(content, batch.all_cases, recordings, every)
        return runs.publish_run(content, recordings, self.output, _FORMATS).place

    def _load(self) -> tuple[list[scenario.Case], list[series_plans.Series]]:
        """Return the cases and series that there are results of, in the order of `uictest run`.

        They are loaded together, as two files cannot have a case or a series of the same id in one run:
        raises ScenarioErrors for cases, InvalidInputError for series.
        """
        paths, changes = sorted(self._files), self.changes
        cases = runs.load_cases(
            [path for path in paths if not runs.is_series(path)],
            changes.overrides,
            changes.seed,
            [changes.root],
        )
        planned = runs.load_series(
            [path for path in paths if runs.is_series(path)], changes.overrides, changes.seed, [changes.root]
        )
        return [case for case in cases if case.id in self._results], [
            each for each in planned if each.id in self._series
        ]

    def _command(self) -> list[str]:
        """Return the arguments with which `uictest` runs the same files."""
        options = [word for text in self.changes.overrides for word in ("--set", text)]
        if self.changes.seed is not None:
            options += ["--seed", str(self.changes.seed)]
        options += ["--strict"] if self.changes.strict else []
        return ["run", *map(str, sorted(self._files)), *options]


def _recordings_of_missed(
    cases: Sequence[scenario.Case], content: report.RunContent, every: float
) -> dict[str, recording.Recording]:
    """Return recordings of the stops that are not as expected, simulated again: they come out the same.

    A controller from outside may answer otherwise: its stops are not recorded.
    """
    missed = {result.id for result in content.results if not result.met and result.outcome != "error"}
    again = [case for case in cases if case.id in missed and not case.is_from_outside]
    jobs = runs.available_processors()
    return {case.id: samples for case, samples in campaign.replay(again, every=every, jobs=jobs)}


_SCHEMA: Final = re.compile(
    rb"""(?:\A\s*\{\s*|^)["']?schema["']?\s*:\s*["']?(uictest/[^\s"'#,}]+)""", re.MULTILINE
)


@dataclass(frozen=True, slots=True)
class Selection:
    """The files to collect.

    Args:
        named: files and folders that the ini file names, absolute.
        every: whether all files with a schema of scenarios or series are collected.

    """

    named: frozenset[Path]
    every: bool

    @classmethod
    def of(cls, config: pytest.Config) -> Selection:
        """Return what the command line and the ini file ask for. Raises pytest.UsageError."""
        return cls(_named(config.rootpath, config.getini("uictest_files")), config.getoption("uictest"))

    def kind_of(self, path: Path) -> Literal["scenario", "series"] | None:
        """Return what a file holds; None if it is not to be collected.

        A folder is searched as by `uictest run`: sweeps, parts, hidden files, and files that begin with an
        underscore are left out. Where every file is collected, it must state its schema.
        """
        kind = _kind_by_name(path.name)
        if kind is None or not (self.every or self._names(path)):
            return None
        schema = _schema_in(path)
        if self._names(path):
            return None if schema in scenario.OTHER_SCHEMAS and kind == "scenario" else kind
        return kind if schema.startswith(f"uictest/{kind}/") else None

    def _names(self, path: Path) -> bool:
        return any(place in self.named for place in (path, *path.parents))


def _named(root: Path, patterns: Iterable[str]) -> frozenset[Path]:
    """Return what the patterns match below a folder. Raises pytest.UsageError for one without a match."""
    named: set[Path] = set()
    for pattern in patterns:
        matches = _matches(root, pattern)
        if not matches:  # a misspelt pattern would leave tests out without a word
            raise pytest.UsageError(f"uictest_files: {pattern!r} matches nothing below {root}")
        named |= matches
    return frozenset(named)


def _matches(root: Path, pattern: str) -> set[Path]:
    place = Path(os.path.abspath(root / pattern))  # noqa: PTH100 - `.` and `..` are left out, links left alone
    if place.exists():
        return {place}
    return set() if Path(pattern).is_absolute() else set(root.glob(pattern))


def _kind_by_name(name: str) -> Literal["scenario", "series"] | None:
    if name.endswith(scenario.SERIES_SUFFIXES):
        return None if name.startswith(".") else "series"
    return "scenario" if scenario.may_be_scenario(name) else None


def _schema_in(path: Path) -> str:
    """Return the schema that a file states; empty where it states none of ours or cannot be read."""
    try:
        match = _SCHEMA.search(path.read_bytes())
    except OSError:
        return ""
    return match[1].decode("utf-8", "replace") if match else ""


def register(config: pytest.Config) -> None:
    """Let pytest collect what options and ini file ask for. Raises pytest.UsageError."""
    changes = Changes.of(config)
    config.pluginmanager.register(Collection(Selection.of(config), changes), "uictest-collection")
    output: str | None = config.getoption("uictest_output")
    if output is not None:
        config.pluginmanager.register(
            Reports(config.invocation_params.dir / output, changes), "uictest-reports"
        )


@dataclass(frozen=True, slots=True, eq=False)
class Collection:
    """Collects the selected files, with the changes of the command line."""

    selection: Selection
    changes: Changes

    def pytest_collect_file(self, file_path: Path, parent: pytest.Collector) -> pytest.File | None:
        """Return the collector of a scenario or series file."""
        kind = self.selection.kind_of(file_path)
        if kind is None:
            return None
        files = {"scenario": ScenarioFile, "series": SeriesFile}
        collector: pytest.File = files[kind].from_parent(parent, path=file_path, changes=self.changes)
        return collector

    def pytest_report_collectionfinish(self, items: Sequence[pytest.Item]) -> list[str]:
        """Announce that the rig is compiled: the first test takes longer."""
        cases = [item.case for item in items if isinstance(item, CaseItem)]
        cases += [case for item in items if isinstance(item, SeriesItem) for case in item.run.planned.cases]
        if not cases or rig.stop_is_compiled():
            return []
        return ["uictest: the first test compiles the rig (once per installation, about 15 s)"]

    @pytest.hookimpl(wrapper=True)
    def pytest_runtest_makereport(
        self, item: pytest.Item
    ) -> Generator[None, pytest.TestReport, pytest.TestReport]:
        """Report a skipped test at its file, not at the line of the plugin that skips it."""
        test_report = yield
        if isinstance(item, RigItem) and isinstance(test_report.longrepr, tuple):
            test_report.longrepr = (str(item.path), 1, test_report.longrepr[2])
        return test_report
