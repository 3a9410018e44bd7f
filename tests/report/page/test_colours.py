"""Colours of lines: apart for eyes without red, green or blue cones, and from the ground."""

import itertools
import re
from importlib import resources

import numpy as np
import pytest

# Machado, Oliveira and Fernandes, IEEE Trans. Visualization and Computer Graphics 15 (2009), severity 1.
VISION = {
    "ordinary": np.eye(3),
    "protanopia": np.array(
        [[0.152286, 1.052583, -0.204868], [0.114503, 0.786281, 0.099216], [-0.003882, -0.048116, 1.051998]]
    ),
    "deuteranopia": np.array(
        [[0.367322, 0.860646, -0.227968], [0.280085, 0.672501, 0.047413], [-0.011820, 0.042940, 0.968881]]
    ),
    "tritanopia": np.array(
        [[1.255528, -0.076749, -0.178779], [-0.078411, 0.930809, 0.147602], [0.004733, 0.691367, 0.303900]]
    ),
}
_XYZ = np.array(
    [[0.4124564, 0.3575761, 0.1804375], [0.2126729, 0.7151522, 0.0721750], [0.0193339, 0.1191920, 0.9503041]]
)
_WHITE = np.array([0.95047, 1.0, 1.08883])


def _linear(text):
    channels = np.array([int(text[k : k + 2], 16) for k in (1, 3, 5)]) / 255
    return np.where(channels <= 0.04045, channels / 12.92, ((channels + 0.055) / 1.055) ** 2.4)


def _lab(colour):
    x, y, z = (
        np.cbrt(each) if each > 0.008856 else 7.787 * each + 16 / 116 for each in _XYZ @ colour / _WHITE
    )
    return np.array([116 * y - 16, 500 * (x - y), 200 * (y - z)])


def _distance(first, second, vision):
    seen = (_lab(np.clip(vision @ _linear(each), 0, 1)) for each in (first, second))
    return float(np.linalg.norm(next(seen) - next(seen)))


def _contrast(first, second):
    dark, light = sorted(float(_XYZ[1] @ _linear(each)) for each in (first, second))
    return (light + 0.05) / (dark + 0.05)


def _palette(name, theme):
    style = (resources.files("uictest.report.page") / "styles" / "base.css").read_text("utf-8")
    pairs = re.findall(rf"--{name}(?:-\d)?: light-dark\((#\w{{6}}), (#\w{{6}})\)", style)
    return [pair[theme] for pair in pairs]


@pytest.mark.parametrize("vision", VISION)
@pytest.mark.parametrize("theme", [0, 1])
def test_wheelsets_are_told_apart_by_their_colours(theme, vision):
    """15 is more than six times what is just seen in CIELAB, 2.3."""
    colours = _palette("wheelset", theme)
    assert len(colours) == 4
    for pair in itertools.combinations(colours, 2):
        assert _distance(*pair, VISION[vision]) > 15.0, pair


@pytest.mark.parametrize("vision", VISION)
@pytest.mark.parametrize("theme", [0, 1])
def test_compared_cases_with_the_same_line_style_have_colours_apart(theme, vision):
    colours = _palette("compared", theme)
    assert len(colours) == 8
    for pair in zip(colours[:4], colours[4:], strict=True):
        assert _distance(*pair, VISION[vision]) > 20.0, pair
    for pair in itertools.combinations(colours[:4], 2):
        assert _distance(*pair, VISION[vision]) > 15.0, pair


@pytest.mark.parametrize("theme", [0, 1])
def test_lines_stand_out_from_the_ground(theme):
    """WCAG 2.1, 1.4.11: 3 to 1 for graphical objects."""
    (paper,) = _palette("paper", theme)
    for colour in [*_palette("wheelset", theme), *_palette("compared", theme)]:
        assert _contrast(colour, paper) >= 3.0, colour
