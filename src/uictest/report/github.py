"""Lines that GitHub Actions reads: one workflow command per case that is not met, and lines that are none."""

from __future__ import annotations

import re
from collections.abc import Iterable, Iterator
from typing import TYPE_CHECKING, Literal

from uictest.report.escaping import workflow_message, workflow_property
from uictest.report.wording import explanation, verdict_word

if TYPE_CHECKING:
    from uictest.evaluation import CaseResult

_COMMAND = re.compile(r"^(\s*):(?=:)")


def case_annotations(results: Iterable[CaseResult]) -> Iterator[str]:
    """Yield an `::error` command for each case that did not meet its expectation."""
    for result in results:
        if not result.met:
            title = f"{verdict_word(result)} {result.id}"
            yield annotation(result.scenario, title, "\n".join(explanation(result)))


def annotation(
    file: str,
    title: str,
    message: str,
    line: int | None = None,
    column: int | None = None,
    level: Literal["error", "notice"] = "error",
) -> str:
    """Return one workflow command; `line` and `column` count from 1."""
    properties = {"file": file, "line": line, "col": column, "title": title}
    shown = ",".join(
        f"{name}={workflow_property(str(value))}" for name, value in properties.items() if value is not None
    )
    return f"::{level} {shown}::{workflow_message(message)}"


def no_command(line: str) -> str:
    """Return a line of the log as one that GitHub takes for no command, whatever stands in it."""
    # The runner looks behind leading blanks, and for commands of its first kind anywhere in a line.
    return _COMMAND.sub(r"\1\\x3a", line).replace("##[", r"#\x23[")
