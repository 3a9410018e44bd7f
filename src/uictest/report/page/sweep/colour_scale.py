"""Colours of heat maps: viridis for measures, cividis for the share of cases met.

Both rise evenly in lightness, also in grey and for colour-blind eyes; the anchors are those of Matplotlib's
maps of these names (viridis: N. Smith and S. van der Walt, 2015; cividis: J. R. Nunez, C. R. Anderton and
R. S. Renslow, PLoS ONE 13 (2018) e0199239): sixteen of them, evenly spaced.
"""

from __future__ import annotations

from dataclasses import dataclass
from functools import cached_property
from typing import Final

_LIGHT_TEXT_BELOW: Final = 0.179
"""Relative luminance at which black and white text have the same contrast (WCAG 2.1, 1.4.3)."""


@dataclass(frozen=True)
class ColourScale:
    """Colours from `low` to `high`; the same value has the same colour everywhere on a page."""

    anchors: str
    low: float
    high: float

    STEPS = 64
    """Distinct colours: neighbours can hardly be told apart."""

    def step(self, value: float) -> int:
        """Return the number of the colour of a value."""
        if self.high <= self.low:
            return self.STEPS // 2
        share = (value - self.low) / (self.high - self.low)
        return min(max(round(share * (self.STEPS - 1)), 0), self.STEPS - 1)

    @cached_property
    def colours(self) -> list[str]:
        """All colours as `#rrggbb`, the lowest first."""
        return [_between(self._channels, number / (self.STEPS - 1)) for number in range(self.STEPS)]

    @cached_property
    def with_light_text(self) -> frozenset[int]:
        """Numbers of the colours that white text stands out from more than black."""
        return frozenset(
            number for number, each in enumerate(self.colours) if luminance(each) < _LIGHT_TEXT_BELOW
        )

    @cached_property
    def _channels(self) -> list[tuple[int, ...]]:
        return [_rgb(each) for each in self.anchors.split()]


VIRIDIS: Final = (
    "#440154 #481a6c #472f7d #414487 #39568c #31688e #2a788e #23888e #1f988b #22a884 #35b779 #54c568 "
    "#7ad151 #a5db36 #d2e21b #fde725"
)
CIVIDIS: Final = (
    "#00224e #002e6c #1e3a6f #35456c #47516c #575d6d #666970 #757575 #848279 #948e77 #a59c74 #b7a96e "
    "#c8b866 #dbc75a #eed649 #fee838"
)


def luminance(colour: str) -> float:
    """Return the relative luminance of a colour, 0 .. 1 (WCAG 2.1)."""
    red, green, blue = (_linear(channel / 255) for channel in _rgb(colour))
    return 0.2126 * red + 0.7152 * green + 0.0722 * blue


def _between(anchors: list[tuple[int, ...]], share: float) -> str:
    place = min(int(share * (len(anchors) - 1)), len(anchors) - 2)
    part = share * (len(anchors) - 1) - place
    channels = zip(anchors[place], anchors[place + 1], strict=True)
    return "#" + "".join(f"{round(low + part * (high - low)):02x}" for low, high in channels)


def _rgb(colour: str) -> tuple[int, ...]:
    return tuple(int(colour[k : k + 2], 16) for k in (1, 3, 5))


def _linear(channel: float) -> float:
    return channel / 12.92 if channel <= 0.04045 else ((channel + 0.055) / 1.055) ** 2.4
