"""The calibration of the chosen parameters runs on the rig as it is."""

import runpy
import sys
from pathlib import Path

import pytest

FOLDER = Path(__file__).parent.parent / "calibration"


@pytest.fixture
def calibrate(monkeypatch):
    """What the script defines; its modules are forgotten afterwards."""
    monkeypatch.syspath_prepend(str(FOLDER))
    yield runpy.run_path(str(FOLDER / "calibrate.py"))
    for name in ("objective", "parameters", "compensation_fit"):
        sys.modules.pop(name, None)


def test_the_numbers_of_the_library_are_not_given_up(calibrate):
    """They come within the part of the misfit in which all stops are run."""
    misfit, present = calibrate["misfit"], calibrate["_present"]()
    assert misfit(present) < sys.modules["objective"].GIVEN_UP
    assert misfit(0.0 * present) > misfit(present)
