"""The pages of the manual as the package carries them, rendered so that their links stay in the archive."""

from __future__ import annotations

import re
from collections.abc import Collection, Iterator
from itertools import pairwise
from pathlib import Path
from typing import Any, Final

_HERE: Final = Path(__file__).parent
_OF_WHEEL, _OF_CLONE = _HERE / "docs", _HERE.parents[3] / "docs"
PAGES: Final = _OF_WHEEL if _OF_WHEEL.is_dir() else _OF_CLONE
"""The folder of the pages: in a wheel beside this file, in a working tree that of the documentation."""
QUESTIONS: Final = _HERE / "questions.md"
_REQUIREMENT: Final = re.compile(r"^\| (TOOL-\d+): ([^|]+) \| ([^|]+) \|$", re.MULTILINE)
_TEST: Final = re.compile(r"\[(test_\w+)\]\(\.\./([^)]+\.py)\)")
_ERROR: Final = re.compile(r"^\| ([^|]+) \| ([^|]+) \| ([^|]+) \|$", re.MULTILINE)
_FUNCTION: Final = re.compile(r"^\| ([^|]+) \| [^|]+ \| ([^|]+) \| [^|]+ \|$", re.MULTILINE)
_NUMBER: Final = re.compile(r"\bTOOL-\d+\b")
TESTS: Final = "tests.html"
"""The page that has every named test with its file."""


def pages() -> list[Path]:
    """Return every page of the manual, and the changes of each version."""
    named = [path for path in sorted(PAGES.glob("*.md")) if path.stem != "index"]
    return [*named, *([] if change_log().parent == PAGES else [change_log()])]


def change_log() -> Path:
    """Return the changes of each version."""
    return (PAGES if PAGES == _OF_WHEEL else PAGES.parent) / "CHANGELOG.md"


def _text(page: str) -> str:
    return (PAGES / page).read_text("utf-8")


def requirements() -> list[dict[str, Any]]:
    """Return the requirements of the tool, each with its tests and their files."""
    return [
        {
            "id": match[1],
            "requirement": match[2],
            "tests": [{"name": name, "file": file} for name, file in _TEST.findall(match[3])],
        }
        for match in _REQUIREMENT.finditer(_text("requirements.md"))
    ]


def named_tests() -> list[dict[str, str]]:
    """Return every test that a requirement names: its file, requirements, and functions that these hold."""
    analysis = _FUNCTION.findall(_text("tool-errors.md"))
    of: dict[str, list[str]] = {}
    for function, detected in analysis[1:]:
        for number in _NUMBER.findall(detected):
            of.setdefault(number, []).append(function)
    found: dict[tuple[str, str], list[str]] = {}
    for each in requirements():
        for test in each["tests"]:
            found.setdefault((test["file"], test["name"]), []).append(each["id"])
    return [
        {
            "test": name,
            "file": file,
            "requirements": ", ".join(numbers),
            "functions": "; ".join(dict.fromkeys(each for number in numbers for each in of.get(number, ()))),
        }
        for (file, name), numbers in sorted(found.items())
    ]


def known_errors() -> list[dict[str, str]]:
    """Return the known errors of this version, as the page words them, with links into the archive."""
    page = re.sub(r"\]\((\S+?)\.md(#\S+?)?\)", r"](manual/\1.html\2)", _text("known-errors.md"))
    _, _, section = page.partition("\nOpen:\n")
    _, *rows = _ERROR.findall(section)
    return [dict(zip(("error", "effect", "what_to_do"), row, strict=True)) for row in rows]


def rendered(page: Path, folder: str) -> str:
    """Return a page as HTML for a file in `folder` of the archive; pictures are their descriptions."""
    from markdown_it import MarkdownIt

    parser = MarkdownIt("commonmark").enable("table")
    tokens = parser.parse(page.read_text("utf-8"))
    _name_headings(tokens)
    is_list = page.stem == "requirements"
    known = {path.name for path in pages()}
    for token, following in pairwise([*_all(tokens), None]):
        if token.type == "link_open":
            _lead(token, following, folder, known)
            kind = token.tag
        if token.type == "link_close":
            token.tag = kind
        if is_list and token.type == "td_open" and (number := _NUMBER.match(following.content)):
            token.attrSet("id", number[0])
    shown = str(parser.renderer.render(tokens, parser.options, {}))
    if is_list:
        return shown
    place = "" if folder else "manual/"
    return _NUMBER.sub(rf'<a href="{place}requirements.html#\g<0>">\g<0></a>', shown)


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


def _lead(token: Any, words: Any, folder: str, known: Collection[str]) -> None:
    """Lead a link to its place in the archive; what is not part of it becomes a text with its path."""
    target = str(token.attrs["href"])
    name, _, anchor = target.partition("#")
    file = Path(name).name
    if "://" in target or target.startswith("#") or name.endswith(".html") or not folder:
        return
    if words.content.startswith("test_") and name.endswith(".py"):
        token.attrs["href"] = f"../{TESTS}#{words.content}"
        return
    if file in known and name in (file, f"../{file}"):
        token.attrs["href"] = f"{Path(file).stem}.html{f'#{anchor}' if anchor else ''}"
        return
    del token.attrs["href"]
    token.tag = "span"
    words.content += f" ({name.removeprefix('../')})"
