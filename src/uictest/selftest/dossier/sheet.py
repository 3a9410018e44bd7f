"""A page of the dossier: sentences, then tables under headings that can be linked, then text."""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from typing import Any, Final, NamedTuple

from markupsafe import Markup

from uictest import __version__
from uictest.core.document import Column, Table
from uictest.report.page import render
from uictest.selftest.dossier.build import is_release


class Section(NamedTuple):
    """A table under a heading.

    Args:
        title: the heading.
        table: what it shows; None where only sentences do.
        anchor: by which links find it.
        before, after: sentences above and below the table.
        anchored: whether links find each row by its name.
    """

    title: str
    table: Table | None
    anchor: str = ""
    before: Sequence[str] = ()
    after: Sequence[str] = ()
    anchored: bool = False


COVER: Final = "index.html"


def sheet(
    title: str,
    sections: Sequence[Section] = (),
    *,
    said: Sequence[str] = (),
    body: str = "",
    home: str = COVER,
    subline: str = "",
) -> str:
    """Return a page as HTML.

    Args:
        title: its heading.
        sections: its tables.
        said: sentences above them.
        body: HTML below them.
        home: where the cover is; empty on the cover itself.
        subline: below the heading; the version by default.
    """
    version = f"uictest {__version__}{'' if is_release() else ', not a release'}"
    return render(
        "dossier.html.j2",
        with_plots=False,
        running_head=title,
        headline=title,
        subline=subline or version,
        said=said,
        sections=sections,
        links={each.title: each.anchor for each in sections if each.anchor},
        body=Markup(body),
        home=home,
    )


def entries(
    rows: Sequence[Mapping[str, Any]], headings: Mapping[str, str], wide: Sequence[str] = ()
) -> Table:
    """Return a table of entries of `rows`.

    Args:
        rows: mappings; what they lack or is None is shown as "-".
        headings: key of an entry -> heading of its column.
        wide: keys whose texts may continue on the next line.
    """

    def column(key: str, heading: str) -> Column[Mapping[str, Any]]:
        return Column(heading=heading, text=lambda row: _text(row.get(key)), wraps=key in wide)

    return Table([column(key, heading) for key, heading in headings.items()], rows)


def _text(value: object) -> str:
    return "-" if value is None else str(value).replace("`", "")
