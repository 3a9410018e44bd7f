"""What a sweep file says under `vary`, what its cases are expected to come to, and how a mistake is told."""

from pathlib import Path

import numpy as np
import pytest

from uictest.plans.scenario import PASS, Expectation, ScenarioErrors, load
from uictest.plans.sweeps import group_reader, load_sweep
from uictest.plans.sweeps.base_case import BaseCase

from ..conftest import HEAD, MATRIX, SCENARIO, vary

SAMPLE = "sample: {method: sobol, size: 4, parameters: {rail.friction: {uniform: [0.05, 0.15]}}}\n"

SHIPPED = sorted((Path(__file__).parents[3] / "scenarios").glob("*.sweep.yaml"))


def values(plan, key):
    return plan.settings(np.arange(plan.size))[key].texts


def test_every_combination_first_key_slowest_and_numbers_for_values_without_a_name(load):
    plan = load(MATRIX + "zip: {seed: [1, 2], rail.gradient: [0 permille, 5 permille]}\n")
    assert plan.size == 12
    assert values(plan, "rail.friction") == ["0.08"] * 4 + ["0.10"] * 4 + ["0.12"] * 4
    assert values(plan, "seed") == ["1", "2"] * 6
    assert values(plan, "rail.gradient") == ["0 permille", "5 permille"] * 6
    assert plan.ids(np.array([3])) == ["study[friction=0.08,command=100,seed=2,gradient=5permille]"]
    profiles = "{points: [{position: 0 m, friction: 0.1}]}, {points: [{position: 0 m, friction: 0.2}]}"
    plan = load(f"matrix: {{rail.friction: [{profiles}]}}\n")
    assert plan.ids(np.arange(2)) == ["study[friction=value1]", "study[friction=value2]"]
    plan = load(
        "ranges:\n  rail.friction: {first: 0.08, last: 0.10, step: 0.01}\n"
        "  initial_speed: {first: 20 km/h, last: 30 km/h, count: 3}\n"
    )
    assert values(plan, "rail.friction")[::3] == ["0.08", "0.09", "0.10"]
    assert values(plan, "initial_speed")[:3] == ["20 km/h", "25 km/h", "30 km/h"]


def test_a_sample_is_numbered_in_ids_that_are_unique_and_of_each_case(load):
    plan = load(SAMPLE + "matrix: {brake.command: [80 %, 100 %]}\n")
    assert plan.ids(np.array([0, 5])) == ["study[command=80,sample=0]", "study[command=100,sample=1]"]
    drawn = plan.settings(np.arange(8))["rail.friction"]
    assert drawn.texts[:4] == drawn.texts[4:]
    assert all(0.05 <= number <= 0.15 for number in drawn.numbers)
    plan = load(SAMPLE + MATRIX.replace("rail.friction", "rail.condition.friction"))
    ids = plan.ids(np.arange(plan.size))
    assert len(set(ids)) == plan.size
    assert plan.ids(np.array([7, 2])) == [ids[7], ids[2]]


def test_the_command_line_fixes_a_key_or_sweeps_it(load):
    fixed = load(MATRIX, "rail.friction=0.2")
    assert fixed.keys == ("brake.command",)
    assert fixed.base.scenario.rail.friction == 0.2
    swept = load(MATRIX, "rail.friction=0.2,0.3")
    assert values(swept, "rail.friction") == ["0.2", "0.2", "0.3", "0.3"]
    assert load(
        SAMPLE + MATRIX.replace("rail.friction", "seed").replace("0.08, 0.10, 0.12", "1"), "rail.friction=0.2"
    ).keys == ("seed", "brake.command")
    assert load(MATRIX, seed=7).base.scenario.seed == 7


def test_the_files_read_are_inputs(load):
    inputs = load(MATRIX + "zip: {rig.caliper: [six-inch], vehicle: [crh380a]}\n").inputs
    assert {"stop.yaml", "study.sweep.yaml", "library:vehicles/crh380a.yaml"} <= set(inputs)


@pytest.mark.parametrize(
    ("text", "expected"),
    [
        ("matrix: {rail.frictoin: [0.1]}\n", "study.sweep.yaml:5:12: rail.frictoin: unknown key 'frictoin'"),
        ("matrix: {rail.frictoin: [0.1]}\n", "did you mean 'friction'?"),
        ("matrix: {rail.friction: [0.1, 5]}\n", "study.sweep.yaml:5:33: rail.friction: 5 is out of range"),
        ("matrix: {initial_speed: [30]}\n", "write `30 km/h` or"),
        ("matrix: {brake.position: [R, X]}\n", "unknown brake position 'X'"),
        ("matrix: {vehicle: [crh380]}\n", "did you mean 'crh380a'?"),
        ("matrix: {rail.friction: [0.1, 0.1]}\n", "is there twice"),
        ("matrix: {name: [a, b]}\n", "cannot vary"),
        ("matrix: {rail.friction: {first: 0.1, last: 0.2, step: 0.1}}\n", "goes under `ranges`"),
        ("matrx: {rail.friction: [0.1]}\n", "did you mean 'matrix'?"),
        ("", "nothing varies"),
        ("matrix: {rail.friction: [0.1]}\nzip: {rail.friction: [0.2]}\n", "is under vary.matrix as well"),
        ("zip: {rail.friction: [0.1, 0.2], seed: [1]}\n", "1 values where 'rail.friction' has 2"),
        ("ranges: {rail.friction: {first: 0.1, last: 0.2}}\n", "give either 'step' or 'count'"),
        ("ranges: {rail.friction: {first: 0.1, last: 0.2, step: -0.1}}\n", "do not lead from 0.1 to 0.2"),
        ("ranges: {initial_speed: {first: 3 m/s, last: 20 km/h, count: 3}}\n", "different units"),
        ("sample: {size: 3, parameters: {rail.friction: {uniform: [0.2, 0.1]}}}\n", "the values must rise"),
        ("sample: {size: 3, parameters: {rail.friction: {uniform: [0.2, 9]}}}\n", "9 is out of range"),
        ("sample: {size: 3, parameters: {rail.friction: {log-uniform: [0, 1]}}}\n", "0 has no logarithm"),
        ("sample: {size: 3, parameters: {rail.friction: {}}}\n", "give exactly one distribution"),
        ("sample: {size: 3, parameters: {seed: {uniform: [1, 5]}}}\n", "only a quantity can be drawn"),
        ("sample: {size: 3, parameters: {rig.wsp: {choice: [active, off]}}}\n", "unknown value 'off'"),
        ("sample: {method: sobol, size: 3, parameters: {seed: {choice: [1]}}}\n", "a power of two: 2 or 4"),
    ],
)
def test_errors_say_where_and_what_is_accepted(load, text, expected):
    with pytest.raises(ScenarioErrors) as caught:
        load(text)
    assert expected in str(caught.value)
    assert str(caught.value).startswith("study.sweep.yaml:")


SIX_COLUMNS = (
    "{rail.friction: {uniform: [0.1, 0.2]}, rail.gradient: {uniform: [0 permille, 1 permille]},"
    " brake.command: {uniform: [50 %, 100 %]}, initial_speed: {uniform: [50 km/h, 60 km/h]}}"
)
"""Parameters of which Saltelli's scheme makes six cases a point."""
MANY = "ranges: {rail.friction: {first: 0.05, last: 0.2, count: 1000000}%s}\n"
AS_MANY = ", rail.gradient: {first: 0 permille, last: 5 permille, count: 1000000}"
FINE = "ranges: {rail.friction: {first: 0.1, last: 0.2, step: 1e-10}}\n"
LARGEST = SAMPLE.replace("size: 4", "size: 16777216")
SIX = f"sample: {{method: saltelli, size: 16777216, parameters: {SIX_COLUMNS}}}\n"
SEEDS = "zip: {seed: %s}\n"
OPTIONS = ("seed=range(1,101,1)", "brake.command=50 %,100 %")


@pytest.mark.parametrize(
    ("text", "overrides", "expected"),
    [
        (MANY % AS_MANY, (), "1000000000000 cases (1000000 of rail.friction x 1000000 of rail.gradient)"),
        (FINE, (), "1000000001 values; at most 16777216"),
        (MANY % "", OPTIONS, "202000000 cases (101 of seed x 2 of brake.command x 1000000 of rail.friction)"),
        (LARGEST + SEEDS % [*range(6)], (), "100663296 cases (6 of seed x 16777216 of sample)"),
        (SIX, (), "100663296 cases (100663296 of sample)"),
        (MANY % "" + SEEDS % [*range(101)], (), "101000000 cases (1000000 of rail.friction x 101 of seed)"),
    ],
)
def test_cases_are_counted_before_any_of_them_is_made(load, monkeypatch, text, overrides, expected):
    monkeypatch.setattr(group_reader, "range_node", None)
    with pytest.raises(ScenarioErrors) as caught:
        load(text, *overrides)
    (error,) = caught.value.diagnostics
    assert error.message.startswith(expected)
    assert error.key == ("vary.ranges.rail.friction.step" if text == FINE else "vary")
    assert "are accepted" in error.message
    assert error.hint


def test_as_many_cases_as_are_accepted_are_planned(load):
    assert load(LARGEST + "matrix: {seed: [0, 1, 2, 3, 4]}\n").size == 5 * 16777216


def test_choices_of_one_label_are_two_where_they_are_written_differently(load):
    load()
    for folder in (Path("here"), Path("there")):
        folder.mkdir()
        (folder / "rail.yaml").write_text("schema: uictest/rail/1\nextends: wet\n")
    parameters = "{rail.condition: {choice: [here/rail.yaml, there/rail.yaml]}}"
    assert load(f"sample: {{size: 4, parameters: {parameters}}}\n", "rail.friction=null").size == 4


@pytest.mark.parametrize(
    ("text", "hint"),
    [
        ("", "start with `schema: uictest/scenario/1`"),
        ("[1, 2]\n", "start with `schema: uictest/scenario/1`"),
        ("schema: uictest/sweep/2\nname: a\n", "expected uictest/scenario/1, found 'uictest/sweep/2'"),
        ("schema: uictest/series/1\nname: a\n", "a series is in a file that ends in .series.yaml"),
        ("name: a\n", "write `schema: uictest/scenario/1`"),
    ],
)
def test_what_is_no_sweep_gets_a_hint_how_a_sweep_starts(load, text, hint):
    load()
    Path("other.sweep.yaml").write_text(text)
    with pytest.raises(ScenarioErrors, match=hint):
        load_sweep(Path("other.sweep.yaml"))


@pytest.mark.parametrize(
    ("normal", "expected"),
    [
        ("{mean: 0.1, deviation: 1e-7, lower: 0.2, upper: 0.3}", "lower: 0.2"),
        ("{mean: 0.3, deviation: 1e-7, lower: 0.1, upper: 0.2}", "upper: 0.2"),
    ],
)
def test_a_normal_without_spread_between_its_ends_is_rejected(load, normal, expected):
    with pytest.raises(ScenarioErrors, match=rf"\.normal\.{expected} lies more than 100000 deviations"):
        load(f"sample: {{size: 3, parameters: {{rail.friction: {{normal: {normal}}}}}}}\n")


def test_all_errors_are_reported_at_once_and_those_of_an_axis_counted(load):
    with pytest.raises(ScenarioErrors) as caught:
        load("matrix:\n  rail.friction: [5, 0.1, 6]\n  brake.command: [200 %]\n")
    assert [error.line for error in caught.value.diagnostics] == [6, 7]
    with pytest.raises(ScenarioErrors, match="; 2 more of the 5 values are rejected"):
        load("matrix: {rail.friction: [0.1, 5, 6, 0.2, 7]}\n")
    with pytest.raises(ScenarioErrors, match="; 999 more of the 1000 values are rejected"):
        load("ranges: {rail.friction: {first: 0.001, last: 0.002, count: 1000}}\n")
    with pytest.raises(ScenarioErrors, match=r"unknown key 'frictoin'\n"):
        load("matrix: {rail.frictoin: [1, 2, 3]}\n")


OF_FRICTION = "sample: {size: 3, parameters: {rail.friction: %s}}"


@pytest.mark.parametrize(
    ("text", "column", "expected"),
    [
        ("matrix: {rail.friction: [0.1, 5, 6, 0.2, 7]}", 33, "5 is out of range"),
        ("ranges: {rail.friction: {first: 1, last: 1.4, step: 0.1}}", 27, "1.1 is out of range"),
        ("ranges: {rail.friction: {first: 0.001, last: 0.1, count: 9}}", 27, "'0.001' is inconsistent with"),
        ("ranges: {rail.frictoin: {first: 1, last: 2, count: 9}}", 12, "unknown key 'frictoin'"),
        ("zip: {seed: [1, 2, 3], rail.friction: [0.1, 0, 0]}", 47, "0 is out of range"),
        ("zip: {seed: [1, 2], rail.friction: [0.1, 0.002]}", 19, "'2' with '0.002' is inconsistent with"),
        ("sample: {size: 1, parameters: {rail.friction: {uniform: [0.001, 9]}}}", 60, "'0.001' is inconsist"),
        ("sample: {size: 1, parameters: {vehicle: {choice: [crh380a, a, b]}}}", 62, "no vehicle 'a'"),
        (OF_FRICTION % "{choice: [0.1, 0.2, 0.1, 0.2]}", 34, "'0.1' is there twice; 1 more of the 4 values"),
        (OF_FRICTION % "{choice: [0.1, 5, 7]}", 64, "must be at most 1; 1 more of the 3 values is rejected"),
        (OF_FRICTION % "{uniform: [0.2]}", 59, "expected two bounds, [lowest, highest], found 1"),
        (OF_FRICTION % "{log-uniform: [0.1, 0.2, 0.3]}", 63, "two bounds, [lowest, highest], found 3"),
        (OF_FRICTION % "{uniform: 0.2}", 59, "expected two bounds, [lowest, highest], found no list"),
        (OF_FRICTION % "{triangular: [0.1, 0.2]}", 62, "values, [lowest, likeliest, highest], found 2"),
        (OF_FRICTION % "0.1", 49, "triangular, normal, choice; such as {uniform: [0.08, 0.16]}"),
    ],
)
def test_an_axis_has_one_error_at_its_place(load, text, column, expected):
    with pytest.raises(ScenarioErrors) as caught:
        load(text + "\n")
    (error,) = caught.value.diagnostics
    assert (error.file, error.line, error.column) == ("study.sweep.yaml", 5, column)
    assert expected in str(error)


def test_only_the_first_rejected_value_is_read_as_a_scenario(load, monkeypatch):
    read = []
    original = BaseCase.contents
    monkeypatch.setattr(BaseCase, "contents", lambda *given: read.append(given) or original(*given))
    with pytest.raises(ScenarioErrors):
        load("ranges: {rail.friction: {first: 0.001, last: 0.002, count: 1000}}\n")
    assert len(read) == 1


def test_what_a_value_does_to_an_option_is_reported_at_the_value(load):
    with pytest.raises(
        ScenarioErrors, match=r"study.sweep.yaml:5:28: .*'0.005' is inconsistent with initial_speed"
    ):
        load("matrix: {rail.friction: [0.005]}\n", "initial_speed=300 km/h")


def test_errors_inside_a_part_are_reported_in_its_file(load):
    load()
    Path("rail.yaml").write_text("name: rail\nfriction: 7\nfriction_ratio: 8\n")
    with pytest.raises(ScenarioErrors) as caught:
        load("matrix: {rail.condition: [rail.yaml, wet]}\n", "rail.friction=null")
    assert {error.file for error in caught.value.diagnostics} == {"rail.yaml"}


@pytest.mark.parametrize(
    "text",
    [
        "matrix: {rail.condition: [dry, wet]}\n",
        "matrix: {rail.condition.friction: [0.2, 0.3]}\n",
        "sample: {size: 4, parameters: {rail.condition: {choice: [dry, wet]}}}\n",
        "sample: {size: 4, parameters: {rail.condition.friction: {uniform: [0.2, 0.3]}}}\n",
    ],
)
def test_a_rail_condition_is_not_swept_beside_the_friction_of_the_scenario(load, text):
    with pytest.raises(ScenarioErrors, match=r"but rail\.friction stays '0\.1'"):
        load(text)
    assert load(text + "zip: {rail.friction: [null, 0.2]}\n").size % 2 == 0


@pytest.mark.parametrize("path", SHIPPED, ids=lambda path: path.name)
def test_shipped_sweeps_are_called_like_their_files(path):
    assert f"{load_sweep(path).name}.sweep.yaml" == path.name


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


STOP = """\
schema: uictest/scenario/1
name: stop
initial_speed: 30 km/h
rail: {condition: wet, friction: 0.1}
criteria: [uictest-stop]
"""
NAMED = Expectation("fail", ("locked-wheels",))


@pytest.mark.parametrize(
    ("text", "overrides", "expected"),
    [
        ("matrix: {rail.friction: [0.05, 0.1]}\n", [], NAMED),
        # Where controllers are set nothing is allowed: no case of a sweep is listed with what it misses.
        ("matrix: {controller: [threshold, slip-band]}\n", [], PASS),
        ("matrix: {controller.deep_slide: [30 %, 40 %]}\n", [], PASS),
        ("matrix: {rail.friction: [0.05, 0.1]}\n", ["controller=slip-band"], PASS),
        ("matrix: {rail.friction: [0.05, 0.1]}\n", ["expect=pass"], PASS),
    ],
)
def test_a_sweep_expects_of_its_cases_what_the_scenario_does_of_its_controller(
    load, text, overrides, expected
):
    plan = load(text, *overrides, stop=f"{STOP}expect: {{fail: [locked-wheels]}}\n")
    assert plan.base.scenario.expect == expected


def test_an_expectation_without_names_allows_the_controllers_of_a_sweep_nothing(load):
    plan = load("matrix: {controller: [threshold, slip-band]}\n", stop=f"{STOP}expect: fail\n")
    assert plan.base.scenario.expect == PASS
