"""Where a verdict flips: found as closely as stated, and every flip of several."""

import numpy as np
import pytest

from uictest.analysis.summaries import FrontierError, FrontierSearch
from uictest.plans.scenario.yaml.quantities import parse_decimal_quantity
from uictest.report import WrittenValue

TEXT = """\
matrix:
  brake.command: [80 %, 100 %]
  rail.friction: [0.16, 0.04, 0.08, 0.12]
  seed: [1, 2]
"""


def judged(holds):
    def judge(plan, indices):
        settings = plan.settings(indices)
        pairs = zip(settings["rail.friction"], settings["brake.command"], strict=True)
        return np.array([holds(mu.number, command.number) for mu, command in pairs], np.int8)

    return judge


def search(plan, holds, tolerance=None):
    judge = judged(holds)
    wanted = None if tolerance is None else parse_decimal_quantity(tolerance)
    return FrontierSearch(plan, "rail.friction", wanted).run(judge(plan, np.arange(plan.size)), judge)


def test_a_flip_is_bracketed_for_every_combination_of_the_others(load):
    found = search(load(TEXT), lambda mu, command: mu > 0.1 * command, "0.001")
    assert [scan.circumstances for scan in found] == [
        {"brake.command": WrittenValue(command), "seed": WrittenValue(seed)}
        for command in ("80 %", "100 %")
        for seed in ("1", "2")
    ]
    for scan in found:
        (flip,) = scan.flips
        at = 0.08 if scan.circumstances["brake.command"].text == "80 %" else 0.1
        assert float(flip.low.text) <= at <= float(flip.high.text)
        assert float(flip.high.text) - float(flip.low.text) <= 0.001
        assert (flip.met_at_low, scan.note) == (False, "")


def test_without_a_tolerance_a_flip_is_known_to_a_64th_of_the_smallest_step(load):
    """As the command's help states it; halving steps of 0.04 meets 0.04/64 exactly."""
    for scan in search(load(TEXT), lambda mu, command: mu > 0.1 * command):
        (flip,) = scan.flips
        assert float(flip.high.text) - float(flip.low.text) == pytest.approx(0.04 / 64)


def test_several_flips_are_all_found_and_noted(load):
    found = search(load(TEXT), lambda mu, command: 0.07 < mu < 0.13)
    assert [len(scan.flips) for scan in found] == [2] * 4
    assert [flip.met_at_low for flip in found[0].flips] == [False, True]
    assert found[0].note == "flips 2 times"


def test_no_flip_is_noted_and_cases_that_were_not_run_are_none(load):
    plan = load(TEXT)
    assert {scan.note for scan in search(plan, lambda mu, command: True)} == {"met at all 4 values"}
    assert {scan.note for scan in search(plan, lambda mu, command: False)} == {"met at none of the 4 values"}
    verdicts = np.full(plan.size, -1, np.int8)
    found = FrontierSearch(plan, "rail.friction").run(verdicts, judged(lambda mu, command: True))
    assert {scan.note for scan in found} == {"some cases were not run"}


@pytest.mark.parametrize(
    ("key", "tolerance", "message"),
    [
        ("initial_speed", None, "needs two values or more under `matrix` or `ranges`; there are: brake.comm"),
        ("seed", None, "seed is not a quantity"),
        ("brake.command", "0.1", "the tolerance must be above zero and in %"),
    ],
)
def test_what_has_no_frontier(load, key, tolerance, message):
    with pytest.raises(FrontierError, match=message):
        FrontierSearch(load(TEXT), key, None if tolerance is None else parse_decimal_quantity(tolerance))
