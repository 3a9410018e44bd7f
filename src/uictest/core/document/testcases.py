"""Testcases of a result: what a CI server is told of it."""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from dataclasses import dataclass, field
from pathlib import PurePosixPath
from typing import Literal

TestcaseStatus = Literal["passed", "failure", "error", "skipped"]


@dataclass(frozen=True, slots=True)
class Testcase:
    """One testcase.

    Args:
        class_name: under which a server groups it.
        name: its own.
        status: how it came out.
        lines: why; the first is the message, a server may show only that or only all of them.
        kind: of a failure, e.g. `baseline`.
        duration: s; None where it is not known.
        properties: by which tools know it; those without a text are left out.
    """

    __test__ = False  # the name is that of JUnit: no class of tests for pytest

    class_name: str
    name: str
    status: TestcaseStatus
    lines: Sequence[str] = ()
    kind: str = ""
    duration: float | None = None
    properties: Mapping[str, str] = field(default_factory=dict)


@dataclass(frozen=True, slots=True)
class Suite:
    """Testcases that belong together, and what is known of all of them."""

    name: str
    testcases: Sequence[Testcase]
    duration: float | None = None
    properties: Mapping[str, str] = field(default_factory=dict)


def class_name(file: str) -> str:
    """Return the path of a file as servers group by it: `scenarios/dry.yaml` -> `scenarios.dry`."""
    path = PurePosixPath(file).with_suffix("")
    return ".".join(part for part in path.parts if part not in ("/", "..", "."))
