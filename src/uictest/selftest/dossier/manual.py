"""The pages of the manual as the package carries them, rendered so that their links stay in the archive."""

from __future__ import annotations

import re
from collections.abc import Iterator
from itertools import pairwise
from pathlib import Path
from typing import Any, Final

from markupsafe import escape

_HERE: Final = Path(__file__).parent
_OF_WHEEL, _OF_CLONE = _HERE / "docs", _HERE.parents[3] / "docs"
PAGES: Final = _OF_WHEEL if _OF_WHEEL.is_dir() else _OF_CLONE
"""The folder of the pages: in a wheel beside this file, in a working tree that of the documentation."""
QUESTIONS: Final = _HERE / "questions.md"
_REQUIREMENT: Final = re.compile(r"^\| (TOOL-\d+): ([^|]+) \| ([^|]+) \|$", re.MULTILINE)
_TEST: Final = re.compile(r"\[(test_\w+)\]\(\.\./([^)]+\.py)\)")
_ERROR: Final = re.compile(r"^\| ([^|]+) \| ([^|]+) \| ([^|]+) \|$", re.MULTILINE)


def pages() -> list[Path]:
    """Return every page of the manual, and the changes of each version."""
    named = [path for path in sorted(PAGES.glob("*.md")) if path.stem != "index"]
    return [*named, *([] if change_log().parent == PAGES else [change_log()])]


def change_log() -> Path:
    """Return the changes of each version."""
    return (PAGES if PAGES == _OF_WHEEL else PAGES.parent) / "CHANGELOG.md"


def requirements() -> list[dict[str, Any]]:
    """Return the requirements of the tool, each with its tests and their files."""
    return [
        {
            "id": match[1],
            "requirement": match[2],
            "tests": [{"name": name, "file": file} for name, file in _TEST.findall(match[3])],
        }
        for match in _REQUIREMENT.finditer((PAGES / "requirements.md").read_text("utf-8"))
    ]


def known_errors() -> list[dict[str, str]]:
    """Return the known errors of this version, as the page words them."""
    _, _, section = (PAGES / "known-errors.md").read_text("utf-8").partition("\nOpen:\n")
    _, *rows = _ERROR.findall(section)
    return [dict(zip(("error", "effect", "what_to_do"), row, strict=True)) for row in rows]


def rendered(page: Path, folder: str) -> str:
    """Return a page as HTML for a file in `folder` of the archive; pictures are their descriptions."""
    from markdown_it import MarkdownIt

    parser = MarkdownIt("commonmark").enable("table")
    tokens = parser.parse(page.read_text("utf-8"))
    _name_headings(tokens)
    for token in _all(tokens):
        if token.type == "link_open":
            _lead(token, folder)
    return str(parser.renderer.render(tokens, parser.options, {}))


def _all(tokens: list[Any]) -> Iterator[Any]:
    for token in tokens:
        children = token.children or []
        for child in [each for each in children if each.type == "image"]:
            child.type, child.tag, child.content = "text", "", f"[picture: {child.content}]"
        yield token
        yield from children


def _name_headings(tokens: list[Any]) -> None:
    """Give each heading the anchor that GitHub gives it."""
    for heading, inline in pairwise(tokens):
        if heading.type == "heading_open":
            words = re.sub(r"[^\w\- ]", "", inline.content.replace("`", "").lower())
            heading.attrSet("id", words.replace(" ", "-"))


def _lead(token: Any, folder: str) -> None:
    """Lead a link to the page in the archive; what is not part of it stays a text, with its path as title."""
    target = str(token.attrs["href"])
    if "://" in target or target.startswith("#"):
        return
    name, _, anchor = target.partition("#")
    file = Path(name).name
    known = {path.name for path in pages()}
    if name.endswith(".html"):
        return
    if file in known and (not folder or name in (file, f"../{file}")):
        token.attrs["href"] = f"{Path(file).stem}.html{f'#{anchor}' if anchor else ''}"
        return
    del token.attrs["href"]
    token.attrs["title"] = str(escape(f"{name.removeprefix('../')} of the repository"))
