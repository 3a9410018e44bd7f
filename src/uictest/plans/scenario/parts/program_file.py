"""The file of a controller from outside, as a scenario names it."""

from pathlib import Path
from typing import Final, Self

from uictest.plans.scenario.yaml import Document

_NOWHERE: Final = Document("", Path(), "")


class ProgramFile(str):
    """The path of a program as a scenario writes it, with where the file lies and what it holds."""

    __slots__ = ("document", "location", "version")

    location: str
    document: Document
    version: str

    def __new__(cls, text: str, location: str = "", document: Document = _NOWHERE, version: str = "") -> Self:
        """A path as written; ``location`` is absolute, ``document`` has the SHA-256 of the content.

        ``version`` is what the file states, empty where it states none.
        """
        file = super().__new__(cls, text)
        file.location = location
        file.document = document
        file.version = version
        return file

    def __getnewargs__(self) -> tuple[str, str, Document, str]:  # type: ignore[override]
        return str.__str__(self), self.location, self.document, self.version

    @property
    def sha256(self) -> str:
        """Of the content."""
        return self.document.sha256
