"""What `import uictest` offers, and what it does not load."""

import subprocess
import sys

import pytest

import uictest

HEAVY = ("numpy", "numba", "pandas", "pyarrow", "pydantic", "plotly", "scipy", "typer", "uictest.rig")


def test_importing_loads_nothing_heavy() -> None:
    program = f"import sys, uictest; print([name for name in {HEAVY!r} if name in sys.modules])"
    done = subprocess.run([sys.executable, "-c", program], capture_output=True, text=True, check=True)
    assert done.stdout.strip() == "[]"


def test_the_public_names_are_these() -> None:
    names = "Case CaseResult Recording Results Rig ScenarioErrors SweepResults Validation evaluate load"
    others = "read_recording read_results run simulate sweep validate"
    assert sorted(uictest.__all__) == [*names.split(), *others.split()]


@pytest.mark.parametrize("first", ["uictest.running.chunked", "uictest.cli.entry", "uictest.runs"])
def test_no_room_takes_the_place_of_a_function(first: str) -> None:
    program = f"import {first}, uictest; assert all(callable(getattr(uictest, n)) for n in uictest.__all__)"
    subprocess.run([sys.executable, "-c", program], check=True)


@pytest.mark.parametrize("name", uictest.__all__)
def test_every_public_name_has_a_docstring(name: str) -> None:
    assert getattr(uictest, name).__doc__
