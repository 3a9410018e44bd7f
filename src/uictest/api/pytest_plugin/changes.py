"""What the command line changes in every scenario."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass
from pathlib import Path

import pytest

from uictest.plans import scenario, series
from uictest.plans.scenario import yaml


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
            yaml.parse_overrides(overrides, seed)
        except yaml.ScenarioErrors as errors:
            raise pytest.UsageError(str(errors)) from errors
        files = scenario.Files(scenario.Roots.of((), [config.rootpath]))
        return cls(overrides, seed, config.getoption("uictest_strict"), config.rootpath, files)

    def cases_of(self, path: Path) -> Sequence[scenario.Case]:
        """Return the cases of a scenario file. Raises ScenarioErrors."""
        return scenario.load_file(path, yaml.parse_overrides(self.overrides, self.seed), self.files)

    def series_of(self, path: Path) -> Sequence[series.Series]:
        """Return the series of a file. Raises ScenarioErrors."""
        return series.load_series(path, self.overrides, self.seed, [self.root])
