"""Draws the pictures of the pages anew, from what the program shows now.

    python docs/tools/pictures.py [NAME...]

Without names, all of them but `rig`, which is drawn by hand. Those of pages need chromium and chromedriver.
"""

from __future__ import annotations

import sys
import tempfile
from collections.abc import Callable, Sequence
from pathlib import Path

import page_pictures
import study_pictures
import terminal_picture

REPOSITORY = Path(__file__).parents[2]
FOLDER = REPOSITORY / "docs" / "pictures"
_PICTURES: dict[str, Callable[[Path, Path], None]] = {
    "terminal.svg": terminal_picture.draw,
    "valve-actuations.png": study_pictures.draw,
    "cylinder-dynamics.png": study_pictures.draw,
    "page.png": page_pictures.draw_stop,
    "map.png": page_pictures.draw_map,
}
"""What draws each picture: a function of its file and of an empty folder to work in."""


def main(arguments: Sequence[str]) -> int:
    """Draw the pictures that the arguments name, or all."""
    for name in arguments or _PICTURES:
        if name not in _PICTURES:
            sys.exit(f"no picture {name!r}; there are: {', '.join(_PICTURES)}")
        with tempfile.TemporaryDirectory() as folder:
            _PICTURES[name](FOLDER / name, Path(folder))
        sys.stdout.write(f"drew {name}\n")
    return 0


if __name__ == "__main__":
    sys.exit(main(sys.argv[1:]))
