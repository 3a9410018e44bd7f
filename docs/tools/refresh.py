"""Renews what pages and notebooks take from the program: generated tables, the output of commands and code.

    python docs/tools/refresh.py [PAGE...]

Without pages, all of them and the notebooks. Run it after a change to models, options, messages or
calibrated numbers; the tests in tests/docs and tests/examples say when that is needed.
"""

from __future__ import annotations

import sys
import tempfile
from collections.abc import Callable, Sequence
from pathlib import Path

import fields
import notebooks
from consoles import refreshed
from markup import with_generated

REPOSITORY = Path(__file__).parents[2]
_TABLES: dict[str, Callable[[], str]] = {
    "units": fields.units_table,
    "measures": lambda: fields.measures_table(of_wheelsets=False),
    "measures of wheelsets": lambda: fields.measures_table(of_wheelsets=True),
    "faults": fields.faults_table,
    "plausible": fields.plausible_table,
}


def pages() -> list[Path]:
    """Return every page: the README and all of docs/."""
    return [REPOSITORY / "README.md", *sorted((REPOSITORY / "docs").glob("*.md"))]


def generated(what: str) -> str:
    """Return the table that a marker such as ``units`` asks for."""
    return _TABLES[what]()


def main(names: Sequence[str]) -> None:
    """Renew the named pages, else all."""
    for page in [Path(name) for name in names] or pages():
        text = page.read_text("utf-8")
        with tempfile.TemporaryDirectory() as folder:
            renewed = refreshed(with_generated(text, generated), Path(folder))
        if renewed != text:
            page.write_text(renewed, "utf-8")
    for notebook in () if names else notebooks.notebooks():
        notebooks.refresh(notebook)


if __name__ == "__main__":
    main(sys.argv[1:])
