"""Annotations for GitHub Actions: one workflow command per case that is not met."""

from __future__ import annotations

from collections.abc import Iterable, Iterator
from typing import TYPE_CHECKING

from uictest.report.escaping import workflow_message, workflow_property
from uictest.report.wording import explanation, verdict_word

if TYPE_CHECKING:
    from uictest.evaluation import CaseResult


def case_annotations(results: Iterable[CaseResult]) -> Iterator[str]:
    """Yield an `::error` command for each case that did not meet its expectation."""
    for result in results:
        if not result.met:
            title = f"{verdict_word(result)} {result.id}"
            yield annotation(result.scenario, title, "\n".join(explanation(result)))


def annotation(
    file: str, title: str, message: str, line: int | None = None, column: int | None = None
) -> str:
    """Return one `::error` command; `line` and `column` count from 1."""
    properties = {"file": file, "line": line, "col": column, "title": title}
    shown = ",".join(
        f"{name}={workflow_property(str(value))}" for name, value in properties.items() if value is not None
    )
    return f"::error {shown}::{workflow_message(message)}"
