"""How the "minimum slide" of the quotation is read decides whether the shipped slip-brake test counts."""

from pathlib import Path

import numpy as np

from uictest.plans.scenario import load
from uictest.rig import simulate

SCENARIO = Path(__file__).parents[2] / "scenarios" / "slip-120.yaml"
RATE = 100
LIMIT = 0.35


def test_the_largest_slide_passes_where_the_largest_mean_over_a_second_does_not():
    (case,) = load([SCENARIO])
    recording = simulate(case, record_every=1.0 / RATE).recording
    assert recording is not None
    fast = recording["speed"] > 30.0 / 3.6
    slides = [1.0 - recording[f"wheel_speed_{n}"][fast] / recording["speed"][fast] for n in (1, 2, 3, 4)]
    means = [np.convolve(slide, np.full(RATE, 1.0 / RATE), "valid") for slide in slides]
    assert all(slide.max() > LIMIT for slide in slides)
    assert all(mean.max() < LIMIT for mean in means)
