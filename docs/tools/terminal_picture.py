"""A recording of a terminal as SVG: commands, and what they print, each after the time that it took.

The picture plays once. Where it does not move (in print, or for readers who want none), it shows everything.
"""

from __future__ import annotations

import io
import re
import time
from dataclasses import dataclass
from pathlib import Path

from consoles import coloured, prepare
from rich.console import Console
from rich.text import Text

COMMANDS = (
    "uictest check scenarios",
    'uictest run scenarios -k "dry or slip-120 or bypassed"',
    "uictest run scenarios/slip-120.yaml --repeat 10",
)
_TITLE = "A terminal: check scenarios, run three of them, repeat one under ten seeds"
_COLUMNS = 100
_PAUSE = 1.5  # s to read what a command printed
_TYPING = 0.8  # s between a command and its start
_CONTROL = re.compile(r"\x1b\[\?\d+[hl]|\x1b\[\d*A")
_FORMAT = """\
<svg xmlns="http://www.w3.org/2000/svg" viewBox="0 0 {width} {height}" role="img" aria-labelledby="title">
<title id="title">{chrome}</title>
<style>
.{unique_id}-matrix {{
  font-family: ui-monospace, "DejaVu Sans Mono", Menlo, Consolas, monospace;
  font-size: {char_height}px; line-height: {line_height}px;
}}
@keyframes appear {{ from {{ visibility: hidden }} }}
{styles}
@media (prefers-reduced-motion: reduce), print {{ .{unique_id}-matrix text {{ animation: none !important }} }}
</style>
<defs>{lines}</defs>
<rect width="{width}" height="{height}" rx="8" fill="#1b2028"/>
<g transform="translate({terminal_x}, {terminal_y})">
{backgrounds}
<g class="{unique_id}-matrix">
{matrix}
</g>
</g>
</svg>
"""


@dataclass(frozen=True, slots=True)
class Shown:
    """A command, the lines that stand in the terminal once it has ended, and the seconds that it took."""

    command: str
    lines: list[str]
    seconds: float


def draw(picture: Path, folder: Path) -> None:
    """Record the commands in a folder with the shipped scenarios, and write the picture."""
    picture.write_text(drawn(recorded(folder)), "utf-8")


def recorded(folder: Path) -> list[Shown]:
    """Run every command in a terminal."""
    prepare("", folder)
    return [_recorded(command, folder) for command in COMMANDS]


def drawn(recording: list[Shown]) -> str:
    """Return the recording as SVG."""
    console = Console(record=True, width=_COLUMNS, file=io.StringIO(), force_terminal=True)
    delays: list[float] = []
    now = 0.0
    for shown in recording:
        _print(console, f"\x1b[1m$ {shown.command}\x1b[0m", delays, now)
        now += _TYPING + shown.seconds
        for line in (*shown.lines, ""):
            _print(console, line, delays, now)
        now += _PAUSE
    svg = console.export_svg(code_format=_FORMAT.replace("{chrome}", _TITLE), unique_id="t")
    return svg.replace("</style>", f"{_appearing(delays)}\n</style>", 1)


def _recorded(command: str, folder: Path) -> Shown:
    start = time.perf_counter()
    text = coloured(command, folder)
    return Shown(command, _standing(text), time.perf_counter() - start)


def _standing(text: str) -> list[str]:
    """Return the lines that were not erased again, as those of a progress bar are."""
    lines = [_CONTROL.sub("", line).split("\x1b[2K")[-1] for line in text.splitlines()]
    return [line for line in lines if not line.startswith("simulating ")]


def _print(console: Console, line: str, delays: list[float], now: float) -> None:
    text = Text.from_ansi(line, no_wrap=False)
    rows = text.wrap(console, _COLUMNS) or [text]
    for row in rows:
        console.print(row, highlight=False)
        delays.append(now)


def _appearing(delays: list[float]) -> str:
    rules = (
        f'[clip-path="url(#t-line-{row})"] {{ animation: appear 1ms {delay:.2f}s backwards }}'
        for row, delay in enumerate(delays)
        if delay > 0.0
    )
    return "\n".join(rules)
