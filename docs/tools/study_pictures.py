"""Pictures that a study draws, as `./reproduce` does, in few colours and at the width of a page."""

from __future__ import annotations

import subprocess
import sys
from pathlib import Path

_REPOSITORY = Path(__file__).parents[2]
_WIDTH = 1000  # pixels
_COLOURS = 48


def draw(picture: Path, folder: Path) -> None:
    """Draw the figure of the study with the name of the picture."""
    from PIL import Image

    study = picture.stem
    command = [sys.executable, "-m", "studies", study, "-q", "-o", str(folder)]
    subprocess.run(command, cwd=_REPOSITORY, check=True)
    with Image.open(folder / study / f"{study}.png") as figure:
        height = round(figure.height * _WIDTH / figure.width)
        small = figure.convert("RGB").resize((_WIDTH, height), Image.Resampling.LANCZOS)
        small.quantize(_COLOURS, dither=Image.Dither.NONE).save(picture, optimize=True)
