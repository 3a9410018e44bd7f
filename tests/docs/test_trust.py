"""What the page on trust works out by hand is what the program finds."""

import re
from itertools import pairwise
from pathlib import Path

import pytest

import uictest

PAGE = Path(__file__).parents[2] / "docs" / "trust.md"


def test_the_verdict_by_hand_adds_up_from_the_speeds_of_the_stop():
    """The speeds of the page are those of the stop; trapezoids over them give its distance."""
    page = PAGE.read_text("utf-8").partition("### A verdict by hand")[2]
    speeds = [float(each) for each in re.search(r"\n\n((?:    [\d. ]+\n)+)", page)[1].split()]
    stop = uictest.simulate("dry-120")
    assert speeds == pytest.approx(list(3.6 * stop["speed"][::100][: len(speeds)]), abs=0.051)
    area = sum((a + b) / 7.2 for a, b in pairwise(speeds)) + speeds[-1] / 7.2 * (27.85 - len(speeds) + 1)
    assert f"add up to {area:.1f} m" in " ".join(page.split())
