"""The compensation of the library comes out again of the commands that its recipes name."""

from __future__ import annotations

import shlex
from pathlib import Path

import numpy as np
import pytest

from uictest.cli.entry import execute
from uictest.identification.compensation_file import load_compensation
from uictest.identification.transfer_function import TransferFunction
from uictest.rig.bench.loading import recipe_path
from uictest.scenario.parts.compensation import Compensation

PHASES = ("bc_squeezing", "bc_releasing", "wsp_squeezing", "wsp_releasing")
FREQUENCIES = np.geomspace(0.01, 20.0, 30)


def commands() -> list[list[str]]:
    """The command lines that the comment of the recipe gives."""
    lines = recipe_path("six-inch-hysteresis").read_text("utf-8").splitlines()
    return [shlex.split(line[1:])[1:] for line in lines if line.startswith("#   uictest ")]


def response(part: Compensation) -> np.ndarray:
    numerator, denominator = map(tuple, (part.cylinder.numerator, part.cylinder.denominator))
    return TransferFunction(numerator, denominator, float(part.sampling_time)).response(FREQUENCIES)


@pytest.mark.slow
def test_it_is_regenerated(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    """Lines to a thousandth, the response to a hundredth: the simplex ends elsewhere under another BLAS."""
    monkeypatch.chdir(tmp_path)
    steps = commands()
    assert len(steps) == 4
    assert [execute(arguments) for arguments in steps] == [0, 0, 0, 0]
    identified, shipped = load_compensation("six-inch.yaml"), load_compensation("six-inch")
    for phase in PHASES:
        line, other = getattr(identified.hysteresis, phase), getattr(shipped.hysteresis, phase)
        assert line.slope == pytest.approx(other.slope, rel=1e-3)
        assert line.intercept == pytest.approx(other.intercept, rel=1e-2)
    assert np.abs(response(identified) - response(shipped)).max() < 0.01
    assert identified.provenance.keys() == shipped.provenance.keys()
    for topic in ("hysteresis", "cylinder"):
        assert (
            identified.provenance[f"{topic} samples sha256"] == shipped.provenance[f"{topic} samples sha256"]
        )


def test_its_numbers_are_marked_identified_from_the_simulated_caliper() -> None:
    shipped = load_compensation("six-inch")
    numbers = [shipped.linear.slope, shipped.cylinder.numerator[0]]
    numbers += [getattr(shipped.hysteresis, phase).slope for phase in PHASES]
    assert {shipped.sources[number.source].mark for number in numbers} == {"identified"}
    assert shipped.provenance["hysteresis record origin"] == "simulated caliper"
    assert shipped.provenance["cylinder record origin"] == "simulated caliper"
