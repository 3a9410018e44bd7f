import json
import tracemalloc
from importlib import import_module
from pathlib import Path

import pytest

from uictest.plans import series


def test_valid_files_exit_0_and_errors_of_every_named_file_are_shown_with_their_places(call, scenario):
    scenario("a")
    scenario("b", "matrix:\n  brake.command: [80 %, 90 %]\n")
    answer = call("check", code=0)
    assert (answer.out, answer.err) == ("", "uictest: 2 scenarios with 3 cases, no error\n")
    scenario("a", "vehicel: x\n")
    scenario("b", "seed: -1\n")
    answer = call("check", code=4)
    assert answer.out == ""
    for said in ("scenarios/a.yaml:4:1: ", "vehicle", "scenarios/b.yaml:4:", "uictest: 2 errors"):
        assert said in answer.err
    call("check", scenario("a"), code=0)


def test_json_and_github_annotations_point_to_the_line(call, scenario):
    path = scenario("a", "vehicel: x\n")
    (found,) = json.loads(call("check", "--format", "json").out)
    assert (found["file"], found["line"], found["column"]) == (path.as_posix(), 4, 1)
    assert found["message"]
    scenario("a")
    assert json.loads(call("check", "--format", "json").out) == []
    scenario("a", "vehicel: x\n")
    answer = call("check", "--format", "github")
    assert answer.out.startswith("::error file=scenarios/a.yaml,line=4,col=1,title=")


def test_a_word_for_a_fault_is_an_error_at_its_place(call, scenario):
    answer = call("check", scenario("a", "faults: [lost]\n"), code=4)
    assert "scenarios/a.yaml:4:10: faults.0: expected a mapping, found a text" in answer.err
    assert "a mapping of at, kind, part, until, value, wheelset" in answer.err


def test_what_a_sweep_varies_is_warned_of_in_the_file_that_it_extends(call, scenario, workplace):
    scenario("a", "rail: {condition: wet, friction: 0.1}\n")
    sweep = workplace / "scenarios" / "b.sweep.yaml"
    sweep.write_text(
        "schema: uictest/scenario/1\nname: b\nextends: a.yaml\nvary:\n  sample:\n    method: saltelli\n"
        "    size: 2\n    parameters: {rail.friction: {uniform: [0.11, 0.15]}}\n"
    )
    call("check", code=0, says="warning: rail.friction: the scenario's own 0.1 lies OUTSIDE the range")
    call("check", "scenarios", sweep, code=0, says="1 scenario with 1 case and 1 sweep, no error")
    scenario("a", "vehicle: {extends: intercity-180, body: {mass: 150 t}}\n")
    sweep = workplace / "scenarios" / "b.sweep.yaml"
    sweep.write_text(
        "schema: uictest/scenario/1\nname: b\nextends: a.yaml\nvary: {matrix: {brake.command: [90 %]}}\n"
    )
    answer = call("check", sweep, code=0)
    assert "scenarios/a.yaml:4:48: vehicle.body.mass: warning: axle load 40.7 t" in answer.err


def _broken_in(monkeypatch, name):
    """Let the program fail with what one scenario says, whichever way it is read."""
    module = import_module("uictest.plans.scenario.train")
    resolve = module.resolve

    def resolved(tree, parts):
        if tree.get("name").value == name:
            raise ZeroDivisionError("no wheel load")
        return resolve(tree, parts)

    monkeypatch.setattr(module, "resolve", resolved)


@pytest.mark.parametrize(
    "arguments", [["check"], ["list"], ["run"], ["run", "scenarios/a.yaml", "scenarios/b.yaml"]]
)
def test_an_internal_error_names_its_file_and_hides_no_other(call, scenario, monkeypatch, arguments):
    scenario("a")
    scenario("b", "vehicel: x\n")
    Path("scenarios", "c.series.yaml").write_text("schema: uictest/series/1\nname: c\n")
    _broken_in(monkeypatch, "a")
    answer = call(*arguments, code=3)
    assert "scenarios/a.yaml:1:1: internal error: ZeroDivisionError: no wheel load" in answer.err
    assert "scenarios/b.yaml:4:1: vehicel: unknown key" in answer.err
    assert ("scenarios/c.series.yaml:" in answer.err) is (len(arguments) == 1)
    assert answer.err.count("Traceback") == 1


def test_an_internal_error_in_a_series_hides_no_other_file(call, scenario, monkeypatch):
    scenario("a")
    for name in "cd":
        text = f"schema: uictest/series/1\nname: {name}\ndry: a.yaml\nwet: a.yaml\nno: 1\n"
        Path("scenarios", f"{name}.series.yaml").write_text(text)
    load = series.load_series

    def failing(path, *arguments, **options):
        if path.name.startswith("c"):
            raise RecursionError("too deep")
        return load(path, *arguments, **options)

    monkeypatch.setattr(series, "load_series", failing)
    for command in ("check", "run", "list"):
        answer = call(command, code=3)
        assert "scenarios/c.series.yaml:1:1: internal error: RecursionError: too deep" in answer.err
        assert "scenarios/d.series.yaml:5:1: no: unknown key" in answer.err


def test_a_large_program_costs_hardly_more_than_its_text(call, scenario):
    """A syntax tree of 2 MB of Python takes a gigabyte."""
    scenario("a", "controller: {python: wsp.py, class: Wsp}\n")
    rows = "".join(f"    ({number}, 'text'),\n" for number in range(80_000))
    Path("scenarios", "wsp.py").write_text(f"class Wsp: ...\nTABLE = [\n{rows}]\n__version__ = '4.2'\n")
    call("check")
    tracemalloc.start()
    try:
        assert call("check").code == 0
        assert tracemalloc.get_traced_memory()[1] < 30e6
    finally:
        tracemalloc.stop()


def test_a_compensation_that_is_not_for_its_rig_is_reported_with_file_key_and_values(call, workplace):
    (workplace / "unfit.yaml").write_text(
        "schema: uictest/scenario/1\nname: unfit\ninitial_speed: 120 km/h\n"
        "rig:\n  caliper: {extends: six-inch, lever_ratio: 3}\n"
    )
    answer = call("check", "unfit.yaml", code=4)
    told = "unfit.yaml:5:45: rig.caliper.lever_ratio: is 3, the compensation is for 2.45 within 0.5 %"
    assert told in answer.err
    (workplace / "unfit.yaml").write_text((workplace / "unfit.yaml").read_text() + "expect: invalid\n")
    # A rig that is wrong is never what an invalid stop was expected for.
    assert told in call("check", "unfit.yaml", code=4).err


CAR = "schema: uictest/vehicle/1\nname: mine\nextends: intercity-180\nwheelset:\n  radius: 860 mm\n"


def test_an_implausible_train_is_a_warning_in_its_own_file_and_an_error_if_strict(call, scenario, workplace):
    """Each derived quantity stands once, at the key that is set, however many cases have it."""
    path = scenario("a", "vehicle: mine.yaml\nmatrix: {brake.command: [90 %, 100 %]}\n")
    (workplace / path).with_name("mine.yaml").write_text(CAR)
    answer = call("check", path, code=0)
    assert answer.out == ""
    place = "scenarios/mine.yaml:5:11: vehicle.wheelset.radius: "
    text = "wheel radius 860 mm, plausible 300 to 650 mm (from vehicle.wheelset.radius)\n"
    assert answer.err.count(f"{place}warning: {text}") == 1
    assert "= a diameter written as radius?" in answer.err
    assert "1 scenario with 2 cases, no error, 2 warnings" in answer.err
    strict = call("check", path, "--strict", "--format", "json", code=4, says="2 errors")
    assert "warning" not in strict.err
    assert [each["key"] for each in json.loads(strict.out)] == ["vehicle.wheelset.radius"] * 2
