"""A recording as a figure: one panel for each unit, over the time."""

from __future__ import annotations

import re
from collections.abc import Iterable, Iterator, Mapping, Sequence
from fnmatch import fnmatchcase
from typing import TYPE_CHECKING, Any, Final

import numpy as np
from numpy.typing import NDArray

if TYPE_CHECKING:
    import plotly.graph_objects as go

Channels = Mapping[str, NDArray[Any]]

DEFAULT: Final = ("speed", "wheel_speed_*", "slide_*", "cylinder_pressure_*", "clamping_force_*")
"""What a figure shows unless other channels are named."""

_COLOURS: Final = ("#000000", "#0072b2", "#d55e00", "#009e73", "#cc79a7")
"""Of the train, then of each wheelset: told apart by colour-blind eyes (Okabe and Ito, 2008)."""
_DASHES: Final = ("solid", "solid", "dash", "dot", "dashdot")
_PANEL: Final = 190
"""Height of a panel in pixels; chosen."""
_FRAME: Final = 110


def figure_of(channels: Channels, units: Mapping[str, str], patterns: Sequence[str] | None) -> go.Figure:
    """Return a figure of some channels.

    Args:
        channels: the first is the time, s.
        units: of every channel.
        patterns: names of channels, in which `*` stands for any characters; None: :data:`DEFAULT`.

    Raises:
        KeyError: a pattern names no channel.

    """
    from plotly.subplots import make_subplots

    time, *others = channels
    names = list(_chosen(others, patterns)) if patterns is not None else _recorded(channels, others)
    panels = list(dict.fromkeys(units[name] for name in names))
    figure = make_subplots(rows=max(len(panels), 1), shared_xaxes=True, vertical_spacing=0.04)
    for name in names:
        row = panels.index(units[name]) + 1
        figure.add_scatter(
            x=channels[time], y=channels[name], name=name, line=_line(name), row=row, col=1, mode="lines"
        )
    for row, unit in enumerate(panels, start=1):
        figure.update_yaxes(title_text=unit, row=row, col=1)
    figure.update_xaxes(title_text=f"{time}, {units[time]}", row=max(len(panels), 1), col=1)
    figure.update_layout(height=_FRAME + _PANEL * max(len(panels), 1), hovermode="x unified")
    return figure


def _chosen(names: Sequence[str], patterns: Iterable[str]) -> Iterator[str]:
    """Yield the channels of patterns, each once. Raises KeyError."""
    seen: set[str] = set()
    for pattern in patterns:
        matching = [name for name in names if fnmatchcase(name, pattern)]
        if not matching:
            raise KeyError(f"no channel {pattern!r} in this recording of {', '.join(names)}")
        yield from (name for name in matching if name not in seen)
        seen.update(matching)


def _recorded(channels: Channels, names: Sequence[str]) -> list[str]:
    """Return the default channels that hold numbers; all channels of a recording that has none of them."""
    default = [name for name in names if any(fnmatchcase(name, pattern) for pattern in DEFAULT)]
    known = [name for name in default if np.isfinite(channels[name]).any()]
    return known or list(names)


def _line(name: str) -> dict[str, str]:
    match = re.search(r"_([1-4])$", name)
    place = int(match[1]) if match else 0
    return {"color": _COLOURS[place], "dash": _DASHES[place]}
