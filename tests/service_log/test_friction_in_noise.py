"""The friction under stops of a log whose speeds are noisy: found, and inside its interval as often as said.

Rails, speeds and seeds are others than those by which the numbers of the fit were chosen.
"""

import random

import numpy as np
import pyarrow as pa
import pytest
from pyarrow import parquet
from scipy.stats import binom

import uictest
from tests.service_log import logs
from uictest.analysis.logged_stops.stop_groups import friction_of
from uictest.recorded import fitting
from uictest.recorded.field_data import load_map, stop_in
from uictest.recorded.service_log import find_stops, write_stops

MAP = load_map("uictest")[0]
EVERY = 2
"""Of the samples of a log 100 times a second: 50 Hz."""
FORCES = {"forces": (), "speeds alone": ("clamping_force",)}
"""What is not recorded."""


def conditions(seed, count):
    draw = random.Random(seed)
    return [
        (round(draw.uniform(0.05, 0.13), 3), draw.uniform(60.0, 120.0), draw.randrange(10**6))
        for _ in range(count)
    ]


def found_stops(stops, folder, noise, without):
    """Write a log of 50 Hz with white noise on all speeds, m/s, and return the stops that are found in it."""
    table = parquet.read_table(logs.write_log(stops, folder / "log.parquet"))
    dice, names = (
        np.random.default_rng(len(stops)),
        [n for n in table.schema.names if not n.startswith(without)],
    )
    columns = {name: table[name].to_numpy()[::EVERY] for name in names}
    for name in ("speed", *(f"wheel_speed_{n}" for n in (1, 2, 3, 4))):
        columns[name] = columns[name] + dice.normal(0.0, noise, len(columns[name]))
    schema = pa.schema([table.schema.field(name) for name in names])
    parquet.write_table(pa.table(list(columns.values()), schema=schema), folder / "log.parquet")
    log = find_stops([folder / "log.parquet"], MAP)
    return [stop_in(path, MAP) for path in write_stops(log, MAP, folder / "stops")]


@pytest.fixture(scope="module")
def simulated():
    """Return simulated stops of known friction, each once."""
    kept = {}

    def make(rails):
        for rail in rails:
            kept.setdefault(rail, logs.simulated(logs.wet(rail[0]), *rail[1:]))
        return [kept[rail] for rail in rails]

    return make


def scenario():
    case, *_ = uictest.load(logs.SCENARIO, set={"rail": {"condition": "wet"}, "criteria": "uictest-stop"})
    return case.scenario


def study(simulated, folder, rails, noise, without):
    """Return the errors and half widths of `log` as shares of the friction; those of `fit` are the same."""
    stops = found_stops(simulated(rails), folder, noise, without or ("-",))
    errors, widths = [], []
    for (friction, *_), stop in zip(rails, stops, strict=True):
        seen = friction_of(stop, scenario())
        assert seen.standing == "found", seen.remark
        [estimate] = fitting.fit_stop(stop, scenario()).friction
        assert (estimate.value, estimate.half_width) == (seen.value, seen.half_width)
        errors.append(seen.value / friction - 1.0)
        widths.append(seen.half_width / friction)
    return np.array(errors), np.array(widths)


@pytest.mark.parametrize(("lacking", "largest"), [("forces", 0.002), ("speeds alone", 0.03)])
def test_ordinary_noise_hides_no_friction(simulated, tmp_path, lacking, largest):
    errors, widths = study(simulated, tmp_path, conditions(41, 4), 0.02, FORCES[lacking])
    assert np.abs(errors).max() < largest
    assert (np.abs(errors) < 2.0 * widths).all()
    assert widths.max() < largest


@pytest.mark.slow
@pytest.mark.parametrize("lacking", FORCES)
@pytest.mark.parametrize("noise", [0.004, 0.02, 0.05])
def test_intervals_hold_the_truth_as_often_as_they_say(simulated, tmp_path, noise, lacking):
    """At least so many of 51 that 95 % of all are not refuted at 0.1 %, and none of them for nothing."""
    errors, widths = study(simulated, tmp_path, conditions(42, 51), noise, FORCES[lacking])
    held = int((np.abs(errors) <= widths).sum())
    assert held >= binom.ppf(0.001, len(errors), 0.95)
    assert widths.max() < (0.002 if lacking == "forces" else 0.1)


@pytest.mark.parametrize("lacking", FORCES)
def test_noise_does_not_pass_for_one_friction(tmp_path, lacking):
    """A rail that sliding cleans is still told at ordinary noise."""
    stop = logs.simulated(logs.wet(0.06, "wet-cleaning"), 100.0, 5)
    [recorded] = found_stops([stop], tmp_path, 0.02, FORCES[lacking] or ("-",))
    assert friction_of(recorded, scenario()).standing == "not one"


def test_noise_that_may_hide_a_variation_is_told(tmp_path):
    [recorded] = found_stops([logs.simulated(logs.wet(0.06), 80.0, 5)], tmp_path, 0.1, ("clamping_force",))
    seen = friction_of(recorded, scenario())
    assert seen.standing == "found"
    assert "noise may hide that it varies" in seen.remark
