"""Which files hold scenarios or series, and the hooks of a test run that collects them."""

from __future__ import annotations

import os
import re
from collections.abc import Generator, Iterable, Sequence
from dataclasses import dataclass
from pathlib import Path
from typing import Final, Literal

import pytest

from uictest import rig
from uictest.api.pytest_plugin.cases import CaseItem, Changes, RigItem, ScenarioFile
from uictest.api.pytest_plugin.reports import Reports
from uictest.api.pytest_plugin.series_criteria import SeriesFile, SeriesItem
from uictest.plans import scenario

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
