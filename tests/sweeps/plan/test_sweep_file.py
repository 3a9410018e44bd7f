"""A sweep is a scenario that says under `vary` what varies."""

from pathlib import Path

import pytest

from uictest.plans.scenario import ScenarioErrors, load
from uictest.plans.sweeps import load_sweep

from ..conftest import HEAD, SCENARIO, vary

SECTIONS = """\
matrix:
  brake.command: [80 %, 100 %]
ranges:
  rail.friction: {first: 0.06, last: 0.10, step: 0.02}
zip:
  seed: [1, 2]
  rig.wsp: [active, bypassed]
sample: {size: 3, seed: 5, parameters: {brake.system.disc.pad_friction: {uniform: [0.3, 0.4]}}}
"""


@pytest.fixture
def write(load):
    """The plan of a sweep file with the given text."""
    load()

    def to(text, *overrides):
        Path("study.sweep.yaml").write_text(text)
        return load_sweep(Path("study.sweep.yaml"), overrides)

    return to


def test_a_file_of_0_2_is_told_how_it_is_written_now(write):
    written_now = r"written for uictest 0\.2 or older: now a sweep is a scenario .* that `case` named"
    with pytest.raises(ScenarioErrors, match=written_now):
        write("schema: uictest/sweep/1\nname: study\nscenario: stop.yaml\ngrid: {seed: [1]}\n")


def test_lists_of_cases_that_a_sweep_inherits_do_not_count(write):
    Path("stop.yaml").write_text(SCENARIO + "brake: {command: 70 %}\nmatrix: {brake.command: [60 %, 90 %]}\n")
    plan = write(HEAD + vary("matrix: {seed: [1, 2]}"))
    assert plan.size == 2
    assert plan.base.scenario.brake.command == 0.7


def test_a_sweep_may_extend_a_sweep(write):
    Path("wide.sweep.yaml").write_text(HEAD + vary("matrix: {seed: [1, 2], brake.command: [80 %, 100 %]}"))
    text = HEAD.replace("stop.yaml", "wide.sweep.yaml")
    assert write(text + vary("matrix: {seed: [1, 2, 3]}")).size == 6


def test_a_comment_does_not_change_which_cases_there_are(write):
    plan = write(HEAD + vary(SECTIONS))
    explained = write(HEAD + "# why\n" + vary(SECTIONS))
    other_seed = write(HEAD + vary(SECTIONS.replace("seed: 5", "seed: 6")))
    other_stop = write(HEAD + "initial_speed: 31 km/h\n" + vary(SECTIONS))
    assert plan.cases_sha256 == explained.cases_sha256
    assert len({plan.cases_sha256, other_seed.cases_sha256, other_stop.cases_sha256}) == 3


@pytest.mark.parametrize(
    ("text", "place", "message"),
    [
        ("", (1, ""), "nothing varies"),
        ("vary: {}\n", (4, ""), "give values under vary.matrix, vary.ranges, vary.zip, vary.sample"),
        ("vary: friction\n", (4, "vary"), "expected a mapping, found a text"),
        ("vary: {grid: {seed: [1]}}\n", (4, "vary.grid"), "unknown key 'grid'"),
        ("vary: {matrix: {seed: {first: 1, last: 2, step: 1}}}\n", (4, "vary.matrix.seed"), "under `ranges`"),
        ("vary: {ranges: {seed: {first: 1, last: 2}}}\n", (4, "vary.ranges.seed"), "'step' or 'count'"),
        ("vary: {matrix: {seed: [1]}}\nmatrix: {seed: [1]}\n", (5, "matrix"), "no 'matrix' beside 'vary'"),
        ("ranges: {seed: {first: 1, last: 2, step: 1}}\n", (4, "ranges"), "no 'ranges' beside 'vary'"),
        ("vary: {matrix: {seed: [1]}}\nrepeat: 2\n", (5, "repeat"), "repeats its stop 2 times"),
        ("vary: {matrix: {vary.matrix: [1]}}\n", (4, "vary.matrix.vary.matrix"), "cannot vary"),
        ("vary: {matrix: {seed: [1]}, zip: {seed: [1]}}\n", (4, "vary.zip.seed"), "vary.matrix as well"),
    ],
)
def test_a_mistake_is_told_at_its_key(write, text, place, message):
    with pytest.raises(ScenarioErrors, match=message) as caught:
        write(HEAD + text)
    first = caught.value.diagnostics[0]
    assert (first.line, first.key) == place or (not place[1] and first.line)


def test_a_sweep_is_no_scenario_and_a_scenario_no_sweep(write):
    write(HEAD + vary(SECTIONS))
    with pytest.raises(ScenarioErrors, match="run it with `uictest sweep`"):
        load([Path("study.sweep.yaml")])
    with pytest.raises(ScenarioErrors, match="'vary' belongs to the file"):
        load([Path("stop.yaml")], ["vary.matrix.seed=1"])
    with pytest.raises(ScenarioErrors, match="a scenario without `vary` is run with `uictest run`"):
        load_sweep(Path("stop.yaml"))
