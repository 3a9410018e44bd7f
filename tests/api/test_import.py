"""What `import uictest` offers, and what it does not load."""

import subprocess
import sys

import pytest

import uictest

HEAVY = ("numpy", "pandas", "pyarrow", "pydantic", "plotly", "scipy", "typer", "uictest.rig")


def test_importing_loads_nothing_heavy():
    program = f"import sys, uictest; print([name for name in {HEAVY!r} if name in sys.modules])"
    done = subprocess.run([sys.executable, "-c", program], capture_output=True, text=True, check=True)
    assert done.stdout.strip() == "[]"


def test_the_public_names_are_these_and_each_has_a_docstring():
    names = "Case CaseResult Recording Results Rig ScenarioErrors SweepResults TrainRig Validation evaluate"
    others = "load read_recording read_results run simulate sweep validate"
    assert sorted(uictest.__all__) == [*names.split(), *others.split()]
    assert all(getattr(uictest, name).__doc__ for name in uictest.__all__)


@pytest.mark.parametrize("first", ["uictest.running.chunked", "uictest.cli.entry", "uictest.runs"])
def test_no_room_takes_the_place_of_a_function(first):
    program = f"import {first}, uictest; assert all(callable(getattr(uictest, n)) for n in uictest.__all__)"
    subprocess.run([sys.executable, "-c", program], check=True)
