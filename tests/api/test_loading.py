"""Load cases as the commands do, with their messages."""

from decimal import Decimal

import pytest

import uictest


def test_lists_are_axes_and_the_default_is_the_folder(write):
    write()
    cases = uictest.load(set={"rail.friction": [0.08, 0.1], "brake.command": "90 %"}, seed=3)
    assert [case.id for case in cases] == ["stop[friction=0.08]", "stop[friction=0.1]"]
    assert {case.scenario.seed for case in cases} == {3}
    assert {case.scenario.brake.command.text for case in cases} == {"90 %"}


def test_expressions_and_tags_select(write):
    write("a", "tags: [wet]\n"), write("b", "tags: [wet, long]\n")
    assert [case.id for case in uictest.load("scenarios", tag="long")] == ["b"]
    assert [case.id for case in uictest.load("scenarios", select="not b")] == ["a"]


def test_every_error_of_a_file_is_in_the_message(write):
    path = write(text="seeed: 3\nbrake: {comand: 90 %}\n")
    with pytest.raises(uictest.ScenarioErrors) as raised:
        uictest.load(path)
    assert "scenarios/stop.yaml:6:1: seeed" in str(raised.value)
    assert "did you mean 'command'?" in str(raised.value)


def test_a_key_of_set_is_checked_like_one_of_the_command_line(write):
    with pytest.raises(uictest.ScenarioErrors, match=r"(?s)rail\.fricton.*did you mean 'friction'\?"):
        uictest.load(write(), set={"rail.fricton": 0.1})
    with pytest.raises(uictest.ScenarioErrors, match=r"(?s)brake\.command.*100 %"):
        uictest.load(write(), set={"brake.command": 1.0})


@pytest.mark.parametrize(
    ("arguments", "message"),
    [
        ({"select": "nothing"}, "nothing selected among 1 case; their tags: wet"),
        ({"select": "a and"}, "select: at column 6: expected a word, 'not' or '(', found the end in 'a and'"),
        ({"tag": "("}, "tag: at column 2: expected a word, 'not' or '(', found the end in '('"),
        ({"seed": -1}, "seed is -1, expected a whole number from 0 to 4294967295"),
        ({"seed": 1.5}, "seed is 1.5, expected a whole number from 0 to 4294967295"),
        ({"seed": Decimal("1.5")}, "seed is Decimal('1.5'), expected a whole number from 0 to 4294967295"),
        ({"seed": "5"}, "seed is '5', expected a whole number from 0 to 4294967295"),
    ],
)
def test_an_argument_that_cannot_be_used_is_named(write, arguments, message):
    path = write("a", "tags: [wet]\n")
    with pytest.raises(ValueError) as raised:
        uictest.load(path, **arguments)
    assert str(raised.value) == message


def test_without_files_the_message_says_how_to_begin():
    with pytest.raises(ValueError, match="there is no folder scenarios/ here: name scenario files"):
        uictest.load()


def test_series_are_run_not_loaded():
    with pytest.raises(ValueError, match=r"wsp\.series\.yaml is a series: uictest\.run"):
        uictest.load("wsp.series.yaml")


def test_references_outside_need_trust(workplace, monkeypatch):
    head = "schema: uictest/scenario/1\nname: stop\n"
    for name, line in (("beside", "initial_speed: 30 km/h"), ("inside", "extends: ../beside/stop.yaml")):
        (workplace / name).mkdir()
        (workplace / name / "stop.yaml").write_text(f"{head}{line}\n")
    monkeypatch.chdir("inside")
    with pytest.raises(uictest.ScenarioErrors, match="--trust"):
        uictest.load("stop.yaml")
    assert uictest.load("stop.yaml", trust=["../beside"])[0].id == "stop"
