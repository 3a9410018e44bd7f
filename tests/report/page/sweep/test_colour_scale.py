"""Colours of heat maps against Matplotlib's maps as plotly has them, and against CIELAB."""

import numpy as np
import pytest
from plotly.colors import sequential

from uictest.report.page.sweep.colour_scale import CIVIDIS, VIRIDIS, ColourScale, luminance

MAPS = pytest.mark.parametrize(("anchors", "name"), [(VIRIDIS, "Viridis"), (CIVIDIS, "Cividis")])


def rgb(colour):
    return np.array([int(colour[k : k + 2], 16) for k in (1, 3, 5)])


@MAPS
def test_colours_are_those_of_the_map(anchors, name):
    published = getattr(sequential, name)
    scale = ColourScale(anchors, 0.0, len(published) - 1.0)
    for place, colour in enumerate(published):
        assert np.abs(rgb(scale.colours[scale.step(place)]) - rgb(colour)).max() <= 6


@MAPS
def test_lightness_rises_evenly(anchors, name):
    """L* of CIELAB, in every step by 1.2 on average and never by less than a half or more than twice that."""
    lightness = [116.0 * np.cbrt(luminance(each)) - 16.0 for each in ColourScale(anchors, 0.0, 1.0).colours]
    steps = np.diff(lightness)
    assert np.all(steps > 0.4 * steps.mean())
    assert np.all(steps < 2.0 * steps.mean())
    assert steps.sum() > 70.0


@MAPS
def test_text_on_every_colour_can_be_read(anchors, name):
    """WCAG 2.1, 1.4.3: 4.5 to 1."""
    scale = ColourScale(anchors, 0.0, 1.0)
    for number, colour in enumerate(scale.colours):
        dark, light = sorted((luminance(colour), 1.0 if number in scale.with_light_text else 0.0))
        assert (light + 0.05) / (dark + 0.05) >= 4.5


def test_values_have_colours_between_the_ends():
    scale = ColourScale(VIRIDIS, 10.0, 20.0)
    assert [scale.step(value) for value in (10.0, 15.0, 20.0, 0.0, 99.0)] == [0, 32, 63, 0, 63]
    assert (scale.colours[0], scale.colours[-1]) == ("#440154", "#fde725")
