"""Files to start from, written by `uictest init`."""

from pathlib import Path
from typing import Final, Literal

from uictest.controllers import HEADER

Language = Literal["python", "c"]
_HERE: Final = Path(__file__).parent
_CONTROLLER: Final[dict[Language, tuple[str, ...]]] = {
    "python": ("my_wsp.py", "my-wsp.yaml"),
    "c": ("wsp.c", "Makefile", "my-wsp.yaml"),
}


def controller_files(language: Language) -> dict[str, str]:
    """Return the files of a first controller by name, with a scenario that runs it."""
    files = {name: (_HERE / language / name).read_text("utf-8") for name in _CONTROLLER[language]}
    if language == "c":
        files[HEADER.name] = HEADER.read_text("utf-8")
    return {**files, "slip-120.yaml": (_HERE / "slip-120.yaml").read_text("utf-8")}


__all__ = ["Language", "controller_files"]
