"""The hooks of a test run that collects scenarios."""

from __future__ import annotations

from collections.abc import Generator, Sequence
from dataclasses import dataclass
from pathlib import Path

import pytest

from uictest import rig
from uictest.api.pytest_plugin.cases import CaseItem, ScenarioFile
from uictest.api.pytest_plugin.changes import Changes
from uictest.api.pytest_plugin.item import RigItem
from uictest.api.pytest_plugin.reports import Reports
from uictest.api.pytest_plugin.selection import Selection
from uictest.api.pytest_plugin.series_criteria import SeriesFile, SeriesItem


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
