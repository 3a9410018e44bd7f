"""The pytest plugin: scenario and series files as tests, once a project asks for it.

pytest imports this module in every test run of an environment that has uictest. It imports nothing else of
the package until the option `--uictest` or the ini option `uictest_files` is given.
"""

from __future__ import annotations

from collections.abc import Callable
from typing import TYPE_CHECKING, Any

import pytest

if TYPE_CHECKING:
    from uictest import Results

__all__ = ["pytest_addoption", "pytest_configure", "uictest_run"]


def pytest_addoption(parser: pytest.Parser) -> None:
    """Declare the options of the command line and of the ini file."""
    group = parser.getgroup("uictest", "scenarios of the brake rig (uictest)")
    group.addoption("--uictest", action="store_true", help="Collect all scenario and series files.")
    group.addoption(
        "--uictest-set",
        action="append",
        default=[],
        metavar="KEY=VALUE",
        help="Set a key in every scenario, as `uictest run --set` does. May be repeated.",
    )
    group.addoption(
        "--uictest-seed", type=int, metavar="N", help="Seed of noise and random rail in all cases."
    )
    group.addoption("--uictest-repeat", type=int, metavar="N", help="Run the stop of every case N times.")
    group.addoption(
        "--uictest-strict", action="store_true", help="Fail also where a verdict is not settled (--strict)."
    )
    group.addoption(
        "--uictest-output",
        metavar="DIR",
        help="Write the reports of all scenarios; each run gets a folder in DIR.",
    )
    parser.addini(
        "uictest_files",
        "Scenario and series files to collect: files, folders or globs, relative to the root directory.",
        type="args",
        default=[],
    )


def pytest_configure(config: pytest.Config) -> None:
    """Collect scenarios if the project or the command line asks for it. Raises pytest.UsageError."""
    if config.getoption("uictest") or config.getini("uictest_files"):
        from uictest.api.pytest_plugin.collection import register

        register(config)
        return
    for option in ("set", "seed", "repeat", "strict", "output"):
        given = config.getoption(f"uictest_{option}")
        if given is not False and given not in (None, []):
            raise pytest.UsageError(
                f"--uictest-{option} has no effect where no scenarios are collected: add --uictest, or set"
                " uictest_files in the ini file"
            )


@pytest.fixture
def uictest_run(pytestconfig: pytest.Config) -> Callable[..., Results]:
    """Run scenarios in a test: `uictest_run("scenarios/dry-120.yaml", set={...})` gives `uictest.Results`.

    The path is relative to the root directory, below which references may lead anywhere. All keywords are
    those of `uictest.run`. A worker of pytest-xdist simulates on one thread.
    """
    root = pytestconfig.rootpath
    threads = {"jobs": 1} if hasattr(pytestconfig, "workerinput") else {}

    def run(path: str, **options: Any) -> Results:
        import uictest

        return uictest.run(root / path, **{"trust": [root], **threads, **options})

    return run
