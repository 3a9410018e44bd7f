"""A sweep is a scenario that says under `vary` what varies; what 0.2 wrote comes out the same."""

from pathlib import Path

import numpy as np
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
OLD_HEAD = "schema: uictest/sweep/1\nname: study\nscenario: stop.yaml\n"


@pytest.fixture
def write(load):
    """The plan of a sweep file with the given text."""
    load()

    def to(text, *overrides):
        Path("study.sweep.yaml").write_text(text)
        return load_sweep(Path("study.sweep.yaml"), overrides)

    return to


def cases(plan):
    indices = np.arange(plan.size)
    return [(key, column.texts) for key, column in plan.settings(indices).items()]


def test_a_file_of_0_2_has_the_same_cases(write):
    now = write(HEAD + vary(SECTIONS))
    old_sections = SECTIONS.replace("matrix:", "grid:")
    before = write(OLD_HEAD + old_sections)
    assert cases(before) == cases(now)
    assert before.ids(np.arange(before.size)) == now.ids(np.arange(now.size))
    assert before.base.scenario.model_copy(update={"name": "study"}) == now.base.scenario.model_copy(
        update={"extends": before.base.scenario.extends}
    )
    assert "extends: stop.yaml" in before.written_now
    assert not now.written_now


def test_a_file_of_0_2_sweeps_no_train_and_does_not_ask_for_one_of_its_cars(write):
    Path("stop.yaml").write_text(SCENARIO + "train: [{count: 2}]\n")
    with pytest.raises(ScenarioErrors, match=r"'stop\.yaml' is a train, which no file of 0.2 sweeps"):
        write(OLD_HEAD + "grid: {seed: [1, 2]}\n")


def test_a_case_that_0_2_names_has_its_values(write):
    Path("stop.yaml").write_text(SCENARIO + "matrix: {brake.command: [60 %, 90 %]}\n")
    old = OLD_HEAD + "grid: {seed: [1, 2]}\n"
    plan = write(f"{old}case: stop[command=90]\n")
    assert plan.base.scenario.brake.command == 0.9
    assert "the values of stop[command=90]" in plan.written_now
    with pytest.raises(ScenarioErrors, match="has 2 cases, a sweep starts from one"):
        write(old)
    with pytest.raises(ScenarioErrors, match=r"did you mean 'stop\[command=90\]'"):
        write(f"{old}case: stop[command=9]\n")


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
    ("text", "expected"),
    [
        ("grid: {rail.friction: {first: 0.1, last: 0.2, step: 0.1}}\n", "4:23: grid.rail.friction"),
        ("gird: {rail.friction: [0.1]}\n", "did you mean 'grid'?"),
        ("", "give values under grid, ranges, zip, sample"),
        ("grid: {seed: [1]}\nzip: {seed: [2]}\n", "5:7: zip.seed: 'seed' is under grid as well"),
        ("grid: {rail.frictoin: [0.1]}\n", "4:8: rail.frictoin: unknown key 'frictoin'"),
    ],
)
def test_a_mistake_in_a_file_of_0_2_is_told_in_its_words(write, text, expected):
    with pytest.raises(ScenarioErrors) as caught:
        write(OLD_HEAD + text)
    assert expected in str(caught.value)


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
    with pytest.raises(ScenarioErrors, match="is a sweep, not a scenario"):
        write(OLD_HEAD.replace("stop.yaml", "study.sweep.yaml"))
