"""Console blocks: the commands in them are run, and what they print is what the page shows.

A block marked ``console`` shows what a pipe gets, which is what a terminal of 100 columns shows. All blocks
of a page are run one after the other in one folder that holds the shipped scenarios and every YAML or Python
block of the page that names its file.
"""

from __future__ import annotations

import os
import pty
import re
import shutil
import subprocess
import sys
import sysconfig
from collections.abc import Callable
from pathlib import Path

from markup import Block, blocks, with_blocks

REPOSITORY = Path(__file__).parents[2]
_PROMPT = "$ "
_NUMBER = re.compile(r"[-+]?\d[\d.,]*(?:e[-+]?\d+)?|\bnan\b")
_VOLATILE = re.compile(r"\d{8}T\d{6}Z-[0-9a-f]{8}(?:-\d+)?|\b(?:in|took) \d+\.\d s\b")
_SIGN_OF_LIFE = re.compile(r"^uictest: \d+ of \d+ (?:cases|stops)[^\n]*\n", re.MULTILINE)
Output = Callable[[str, Path], str]
_LONGEST = 1800  # seconds after which a command is taken for hanging, however busy the machine is


def refreshed(page: str, folder: Path) -> str:
    """Return the page with the console blocks as the commands print them now, run in an empty ``folder``."""
    prepare(page, folder)

    def rewrite(block: Block) -> str:
        shown = executed(block, folder)
        # The name of a run and the time it took are never the same: no reason to change a page.
        return block.text if steady(shown) == steady(block.text) else shown

    return with_blocks(page, "console", rewrite)


def prepare(page: str, folder: Path) -> None:
    """Put the shipped scenarios, the files that the page shows and `./reproduce` into ``folder``."""
    shutil.copytree(REPOSITORY / "scenarios", folder / "scenarios", dirs_exist_ok=True)
    if "$ ./reproduce" in page:
        # The script in the repository would set up an environment; here there is one.
        script = f"#!/bin/sh\nPYTHONPATH='{REPOSITORY}' exec '{sys.executable}' -m studies \"$@\"\n"
        (folder / "reproduce").write_text(script, "utf-8")
        (folder / "reproduce").chmod(0o755)
    for block in (*blocks(page, "yaml"), *blocks(page, "python")):
        if block.file_name is not None:
            target = folder / block.file_name
            target.parent.mkdir(parents=True, exist_ok=True)
            target.write_text(block.text, "utf-8")


def executed(block: Block, folder: Path, output_of: Output | None = None) -> str:
    """Return the block with each command followed by what it prints.

    `output_of` runs a command in a folder [default: in a shell of its own].
    """
    output_of = output_of or in_shell
    lines = []
    for command in commands_in(block):
        lines.append(f"{_PROMPT}{command}")
        # Only a slow machine says how far it is.
        shown = _SIGN_OF_LIFE.sub("", output_of(command, folder))
        lines += shown.lstrip("\n").splitlines()
    return "".join(f"{line.rstrip()}\n" for line in lines)


def coloured(command: str, folder: Path) -> str:
    """Return what a command writes to a terminal that shows colours."""
    colours = {name: text for name, text in environment().items() if name != "NO_COLOR"}
    return _on_terminal(command, folder, {**colours, "TERM": "xterm-256color"})


def commands_in(block: Block) -> list[str]:
    """Return the commands of a console block."""
    return [line.removeprefix(_PROMPT) for line in block.text.splitlines() if line.startswith(_PROMPT)]


def steady(text: str) -> str:
    """Return the text without what differs from one run to the next."""
    return _VOLATILE.sub("*", text)


def shape(text: str) -> str:
    """Return the text with every number and every width made alike: what stays when figures move.

    A bar of progress that has gone may leave an empty line: they do not count either.
    """
    return re.sub(r"\n\s*\n", "\n", re.sub(r"[ \t]+", " ", _NUMBER.sub("#", steady(text))))


def in_shell(command: str, folder: Path) -> str:
    """Return what a command writes to a pipe, both streams."""
    done = subprocess.run(
        ["sh", "-c", command],
        cwd=folder,
        env=environment(),
        stdin=subprocess.DEVNULL,
        stdout=subprocess.PIPE,
        stderr=subprocess.STDOUT,
        text=True,
        check=False,
        timeout=_LONGEST,
    )
    return done.stdout


def _on_terminal(command: str, folder: Path, variables: dict[str, str]) -> str:
    ours, theirs = pty.openpty()
    with subprocess.Popen(
        ["sh", "-c", command], cwd=folder, env=variables, stdin=theirs, stdout=theirs, stderr=theirs
    ) as process:
        os.close(theirs)
        text = _read_to_end(ours)
        process.wait(_LONGEST)
    os.close(ours)
    return text.replace("\r", "")


def _read_to_end(terminal: int) -> str:
    parts = []
    while True:
        try:
            part = os.read(terminal, 4096)
        except OSError:  # what Linux says when the other end has closed
            break
        if not part:
            break
        parts.append(part)
    return b"".join(parts).decode()


def environment() -> dict[str, str]:
    """Return the variables that the commands of a page see."""
    names = ("HOME", "LANG", "UICTEST_CACHE", "XDG_CACHE_HOME")
    kept = {name: os.environ[name] for name in names if name in os.environ}
    path = f"{sysconfig.get_path('scripts')}{os.pathsep}{os.environ.get('PATH', '')}"
    return {**kept, "PATH": path, "TERM": "dumb", "COLUMNS": "100", "NO_COLOR": "1"}
