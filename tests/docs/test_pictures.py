"""Pictures: each is shown by a page and described for those who cannot see it, and shows what is so now."""

import importlib
import re
from pathlib import Path
from xml.etree import ElementTree

import pytest

REPOSITORY = Path(__file__).parents[2]
PICTURES = REPOSITORY / "docs" / "pictures"
SVG = "{http://www.w3.org/2000/svg}"
_SHOWN = re.compile(r"!\[(?P<text>[^\]]*)\]\((?P<file>[^)\s]+)\)")


def shown():
    """Return the text in place of each picture that a page shows."""
    pages = [REPOSITORY / "README.md", *(REPOSITORY / "docs").glob("*.md")]
    return {
        (page.parent / match["file"]).resolve(): match["text"]
        for page in pages
        for match in _SHOWN.finditer(page.read_text("utf-8"))
    }


def test_every_picture_is_shown_and_described():
    texts = shown()
    assert set(texts) == set(PICTURES.iterdir())
    assert all(len(text.split()) >= 8 for text in texts.values())


@pytest.mark.parametrize("picture", sorted(PICTURES.glob("*.svg")), ids=lambda path: path.name)
def test_a_drawing_has_a_title_and_needs_nothing_from_elsewhere(picture):
    root = ElementTree.parse(picture).getroot()
    title = root.find(f"{SVG}title")
    assert title is not None and title.text and title.get("id") in root.get("aria-labelledby", "").split()
    assert root.find(f".//{SVG}script") is None
    assert set(re.findall(r"https?://[^\"')\s]+", picture.read_text("utf-8"))) == {
        "http://www.w3.org/2000/svg"
    }


def test_the_terminal_shows_what_the_commands_print(tmp_path):
    consoles, terminal = importlib.import_module("consoles"), importlib.import_module("terminal_picture")
    drawn = ElementTree.fromstring(terminal.drawn(terminal.recorded(tmp_path)))
    kept = ElementTree.parse(PICTURES / "terminal.svg").getroot()
    assert consoles.shape(_rows(kept)) == consoles.shape(_rows(drawn))
    assert all(f"$ {command}" in _rows(kept) for command in terminal.COMMANDS)


def _rows(root):
    rows = {}
    for text in root.iter(f"{SVG}text"):
        row = text.get("clip-path", "")
        rows[row] = rows.get(row, "") + " " + (text.text or "").replace("\xa0", " ")
    return "\n".join(row.strip() for row in rows.values())
