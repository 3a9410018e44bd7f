"""The parts of a Markdown page that tools read or write: fenced blocks and generated stretches."""

from __future__ import annotations

import re
from collections.abc import Callable
from dataclasses import dataclass

_FENCED = re.compile(r"^```(?P<info>[^\n`]*)\n(?P<text>.*?)^```$", re.MULTILINE | re.DOTALL)
_GENERATED = re.compile(
    r"(?P<begin><!-- generated: (?P<what>[^>]*?) -->\n)(?P<text>.*?)(?P<end><!-- end -->)", re.DOTALL
)
_FILE_NAME = re.compile(r"# (\S+\.(?:ya?ml|py))\n")


@dataclass(frozen=True, slots=True)
class Block:
    """A fenced block: what stands behind the opening fence, its text, and the page's line it begins in."""

    info: str
    text: str
    line: int

    @property
    def file_name(self) -> str | None:
        """The file that the block shows, as its first line says: ``# name.yaml`` or ``# name.py``."""
        match = _FILE_NAME.match(self.text)
        return match[1] if match else None


def blocks(page: str, language: str) -> list[Block]:
    """Return the fenced blocks of one language, such as ``yaml``."""
    found = (_block(page, match) for match in _FENCED.finditer(page))
    return [block for block in found if block.info.split()[:1] == [language]]


def _block(page: str, match: re.Match[str]) -> Block:
    return Block(match["info"].strip(), match["text"], page.count("\n", 0, match.start()) + 1)


def with_blocks(page: str, language: str, rewrite: Callable[[Block], str]) -> str:
    """Return the page with the text of every block of one language rewritten."""

    def replaced(match: re.Match[str]) -> str:
        block = _block(page, match)
        if block.info.split()[:1] != [language]:
            return match[0]
        return f"```{match['info']}\n{rewrite(block)}```"

    return _FENCED.sub(replaced, page)


def with_generated(page: str, generate: Callable[[str], str]) -> str:
    """Return the page with what stands between ``<!-- generated: ... -->`` and ``<!-- end -->`` renewed."""
    return _GENERATED.sub(
        lambda match: f"{match['begin']}\n{generate(match['what'])}\n\n{match['end']}", page
    )


def table(headings: tuple[str, ...], rows: list[tuple[str, ...]]) -> str:
    """Return a Markdown table; vertical bars in cells are escaped."""
    head, *lines = [
        "| " + " | ".join(cell.replace("|", "\\|") for cell in row) + " |" for row in (headings, *rows)
    ]
    return "\n".join([head, "|---" * len(headings) + "|", *lines])
