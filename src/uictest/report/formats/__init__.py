"""A result in its formats: one module each, which knows no kind of result, and one place that writes them."""

from __future__ import annotations

import os
from collections.abc import Callable, Iterable, Iterator, Mapping, Sequence
from dataclasses import dataclass, field
from pathlib import Path
from types import MappingProxyType
from typing import TYPE_CHECKING, Final

from uictest.core import files

if TYPE_CHECKING:  # the command line names the formats before it knows whether it writes any
    from uictest.core.document import Document, Suite, Table

IN_EVERY_RUN: Final = ("csv", "junit")
"""Formats that every run is written in."""
DRAWING: Final = frozenset({"html"})
"""Formats that draw stops, so that a report needs their traces."""
WITH_TEST_PROPERTIES: Final = "junit-properties.xml"
"""File whose testcases have properties, which the schema of Jenkins' xUnit plugin forbids."""

LIMIT: Final = 1_000_000
"""Bytes of a summary at most: GitHub refuses a step's summary above 1 MiB."""
_ALWAYS: Final = 2_000
"""Bytes that a summary may have where others have filled the file; chosen."""

Chunks = Iterable[str | bytes]


@dataclass(frozen=True, slots=True, kw_only=True)
class Publication:
    """A result in the form that every format is written from.

    Args:
        document: what people read.
        tables: what programs read, each in a file of its own.
        page: returns index.html.
        suites: returns the testcases; where asked, with the properties by which test management knows them.
        named_in_tests: whether any testcase has such properties.
        texts: documents in JSON, by the names of their files.
    """

    document: Document
    tables: Sequence[Table]
    page: Callable[[], str]
    suites: Callable[[bool], Iterable[Suite]] = lambda _: ()
    named_in_tests: bool = False
    texts: Mapping[str, str] = field(default_factory=dict)

    def markdown(self, limit: int = LIMIT) -> str:
        """Return the Markdown for people in at most so many bytes; lines say what was left out."""
        from uictest.report.formats.markdown import document_markdown

        return document_markdown(self.document, limit, level=2)

    def junit(self) -> str:
        """Return the testcases as JUnit XML."""
        from uictest.report.formats.junit import junit_text

        return junit_text(self.suites(False))


def _csv(result: Publication) -> Iterator[tuple[str, Chunks]]:
    from uictest.report.formats.csv import csv_chunks

    for table in result.tables:
        yield table.file, csv_chunks(table)


def _html(result: Publication) -> Iterator[tuple[str, Chunks]]:
    yield "index.html", [result.page()]


def _junit(result: Publication) -> Iterator[tuple[str, Chunks]]:
    from uictest.report.formats.junit import junit_text

    yield "junit.xml", [result.junit()]
    if result.named_in_tests:
        yield WITH_TEST_PROPERTIES, [junit_text(result.suites(True))]


def _markdown(result: Publication) -> Iterator[tuple[str, Chunks]]:
    yield "summary.md", [result.markdown()]


def _workbook(result: Publication) -> Iterator[tuple[str, Chunks]]:
    from uictest.report.formats.xlsx import workbook_bytes

    yield "report.xlsx", [workbook_bytes(result.tables)]


FORMATS: Final[Mapping[str, Callable[[Publication], Iterator[tuple[str, Chunks]]]]] = MappingProxyType(
    {"csv": _csv, "html": _html, "junit": _junit, "md": _markdown, "xlsx": _workbook}
)
"""Format -> what yields its files: the name of each below the folder, and its content."""


def publish(result: Publication, formats: Iterable[str], folder: Path) -> list[Path]:
    """Write a result into a folder: its documents in JSON, and files in formats; return the latter.

    Raises OSError.
    """
    for name, text in result.texts.items():
        # A file name that is no UTF-8 holds lone surrogates; spelled out they are valid JSON escapes.
        files.write(folder, name, text.encode("utf-8", "backslashreplace"))
    paths = []
    for name in dict.fromkeys(formats):
        for file, chunks in FORMATS[name](result):
            with files.new_file(folder, file) as target:
                for chunk in chunks:
                    target.write(chunk if isinstance(chunk, bytes) else chunk.encode())
            paths.append(folder / file)
    return paths


def append_step_summary(result: Publication) -> None:
    """Append what people read to the file that GitHub Actions names, where it does. Raises OSError."""
    name = os.environ.get("GITHUB_STEP_SUMMARY")
    if not name:
        return
    path = Path(name)
    written = path.stat().st_size if path.exists() else 0
    files.append(path, result.markdown(max(LIMIT - written, _ALWAYS)))
