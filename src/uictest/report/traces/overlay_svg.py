"""A recorded stop and its simulation as an SVG: train and wheel speeds, one panel each."""

from __future__ import annotations

import numpy as np

from uictest.core.recording import TIME, Recording
from uictest.core.units import KILOMETRE_PER_HOUR

_WIDTH, _PANEL, _MARGIN = 900, 130, 45
_MOST_POINTS = 1500
_COLOURS = {"recorded": "#888888", "simulated": "#0060a8"}


def overlay_svg(both: Recording) -> str:
    """Return an SVG of an overlay: speeds in km/h over time in s, recorded in grey, simulated in blue."""
    names = [name.removesuffix("_recorded") for name in both.channels if name.endswith("_recorded")]
    panels = "".join(_panel(both, name, k) for k, name in enumerate(names))
    height = len(names) * (_PANEL + _MARGIN) + _MARGIN
    return (
        f'<svg xmlns="http://www.w3.org/2000/svg" viewBox="0 0 {_WIDTH} {height}" font-family="sans-serif"'
        f' font-size="12"><title>Recorded and simulated speeds</title>'
        f'<rect width="{_WIDTH}" height="{height}" fill="white"/>{panels}</svg>\n'
    )


def _panel(both: Recording, name: str, number: int) -> str:
    top = _MARGIN + number * (_PANEL + _MARGIN)
    end = float(both[TIME][-1])
    highest = max(float(np.nanmax(both[f"{name}_{kind}"])) for kind in _COLOURS) / KILOMETRE_PER_HOUR
    lines = "".join(_line(both, f"{name}_{kind}", colour, top, highest) for kind, colour in _COLOURS.items())
    frame = (
        f'<rect x="{_MARGIN}" y="{top}" width="{_WIDTH - 2 * _MARGIN}" height="{_PANEL}" fill="none"'
        ' stroke="#cccccc"/>'
    )
    labels = (
        f'<text x="{_MARGIN}" y="{top - 6}">{name.replace("_", " ")}, 0 to {highest:.0f} km/h</text>'
        f'<text x="{_WIDTH - _MARGIN}" y="{top + _PANEL + 14}" text-anchor="end">{end:.1f} s</text>'
    )
    return frame + lines + labels


def _line(both: Recording, channel: str, colour: str, top: float, highest: float) -> str:
    stride = max(len(both) // _MOST_POINTS, 1)
    x = _MARGIN + (_WIDTH - 2 * _MARGIN) * both[TIME][::stride] / both[TIME][-1]
    speed = both[channel][::stride] / KILOMETRE_PER_HOUR
    y = top + _PANEL * (1.0 - speed / max(highest, 1e-9))
    points = " ".join(f"{a:.1f},{b:.1f}" for a, b in zip(x, y, strict=True) if np.isfinite(b))
    return f'<polyline points="{points}" fill="none" stroke="{colour}" stroke-width="1.2"/>'
