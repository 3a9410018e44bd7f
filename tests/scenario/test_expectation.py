"""What a scenario expects, by name, and whose controller it is expected of."""

import json
from dataclasses import replace

import pytest
from hypothesis import given, strategies as st
from jsonschema import Draft7Validator
from pydantic import TypeAdapter

from uictest.plans import series
from uictest.plans.scenario import PASS, Expectation, WrittenExpectation, expectation_of, json_schema, load

from .conftest import HEAD

SLIP = HEAD + "rail: {condition: wet, friction: 0.09}\ncriteria: [uic-541-05-appendix-b, uictest-stop]\n"
FAIL = "expect: {fail: [locked-wheels, total-locked-time]}\n"
BOTH = "expect: {fail: [locked-wheels], invalid: [initial-adhesion]}\n"
OWN = Expectation("fail", ("locked-wheels", "total-locked-time"))
ALLOWED = OWN.of_another_controller()


def expectations(cases):
    return [case.scenario.expect for case in cases]


@pytest.mark.parametrize(
    ("text", "expected"),
    [
        ("", PASS),
        ("expect: pass\n", PASS),
        ("expect: fail\n", Expectation("fail")),
        ("expect: skipped\n", Expectation("skipped")),
        (FAIL, OWN),
        ("expect: {invalid: [minimum-slide]}\n", Expectation("invalid", (), ("minimum-slide",))),
        (BOTH, Expectation("fail", ("locked-wheels",), ("initial-adhesion",))),
        ("expect: {fail: [locked-wheels, locked-wheels]}\n", Expectation("fail", ("locked-wheels",))),
    ],
)
def test_what_a_scenario_expects_is_read_and_written_as_it_was(loaded, text, expected):
    (case,) = loaded(SLIP + text)
    assert case.scenario.expect == expected
    assert expectation_of(expected.form()) == expected


@pytest.mark.parametrize(
    ("text", "message", "hint"),
    [
        ("»{fail: [locked-wheel]}", "'locked-wheel' is no criterion", "did you mean 'locked-wheels'?"),
        ("»{fail: []}", "`fail` lists ids of criteria of requirement, at least", "`{fail: [locked-wheels]}`"),
        ("»{fail: locked-wheels}", "`fail` lists ids of criteria of", "`{fail: [locked-wheels]}`"),
        ("»{invalid: [3]}", "`invalid` lists ids of criteria of validity", "`{fail: [locked-wheels]}`"),
        ("»{failed: [locked-wheels]}", "unknown key 'failed', expected fail or invalid", "fail, invalid"),
        ("»{}", "an empty mapping names no criterion", "`{fail: [locked-wheels]}`"),
        ("»[fail]", "unknown value", "pass, fail, invalid, skipped"),
        ("»error", "unknown value 'error', expected one of pass, fail, invalid, skipped", "write one of"),
        (
            "»{fail: [initial-adhesion]}",
            "has the layer validity",
            "accepted: distance-over-reference, locked",
        ),
        (
            "»{invalid: [locked-wheels]}",
            "has the layer requirement",
            "braking-distance, initial-adhesion, min",
        ),
    ],
)
def test_what_cannot_be_expected_is_refused_at_its_place(refused, text, message, hint):
    content = f"{SLIP}expect: {text}\n"
    line = content[: content.index("»")].count("\n") + 1
    (found,) = refused(content.replace("»", ""))
    assert (found.file, found.line, found.column, found.key) == ("stop.yaml", line, 9, "expect")
    assert message in found.message
    assert hint in found.hint


def test_names_are_those_of_the_profiles_of_the_scenario(refused):
    (found,) = refused(f"{HEAD}criteria: [uic-541-05-appendix-b]\n{FAIL.replace(', total-locked-time', '')}")
    assert "'locked-wheels' is no criterion" in found.message
    assert found.hint == "there is none in the profiles of this scenario"


def test_an_editor_that_knows_the_schema_accepts_what_the_program_does():
    schema = json.loads(json.dumps(json_schema()))
    validator = Draft7Validator({**schema["properties"]["expect"], "definitions": schema["definitions"]})
    accepted = ["pass", "fail", "invalid", "skipped", {"fail": ["a"]}, {"fail": ["a"], "invalid": ["b", "c"]}]
    refused = ["error", {}, {"fail": []}, {"failed": ["a"]}, {"fail": "a"}, ["fail"], {"fail": ["A B"]}, 1]
    assert [each for each in accepted if not validator.is_valid(each)] == []
    assert [each for each in refused if validator.is_valid(each)] == []


ids = st.lists(st.sampled_from(["a", "b-1", "locked-wheels"]), unique=True, max_size=3).map(tuple)


@given(ids, ids, st.booleans())
def test_an_expectation_comes_back_from_its_form_and_says_all_of_its_names(fail, invalid, another):
    outcome = "fail" if fail else "invalid" if invalid else "pass"
    expect = Expectation(outcome, fail, invalid)
    expect = expect.of_another_controller() if another else expect
    in_results = TypeAdapter(WrittenExpectation)
    assert in_results.validate_json(in_results.dump_json(expect)) == expect
    # A scenario says nothing of another controller.
    assert expectation_of(json.loads(json.dumps(expect.form()))) == replace(expect, is_allowance=False)
    assert all(name in str(expect) for name in (*fail, *invalid))
    assert str(expect).startswith("pass") == (another or outcome == "pass")


def test_a_controller_that_is_set_or_compared_is_allowed_what_is_named_unless_it_never_acts(loaded):
    assert expectations(loaded(SLIP + FAIL, "controller=slip-band")) == [ALLOWED]
    assert expectations(loaded(SLIP + FAIL, "rail.friction=0.08", "repeat=2")) == [OWN]
    named = f"{SLIP}controller: slip-band\n{FAIL}"
    assert expectations(loaded(named)) == [OWN]
    assert expectations(loaded(named, "controller=threshold,slip-band")) == [ALLOWED, ALLOWED]
    # Its own, set otherwise, is another one.
    assert expectations(loaded(SLIP + FAIL, "controller.deep_slide=40 %")) == [ALLOWED]
    cases = loaded(SLIP + FAIL + "matrix: {controller: [threshold, slip-band]}\n")
    assert expectations(cases) == [ALLOWED, ALLOWED]
    bypassed = f"{SLIP}rig: {{wsp: bypassed}}\n{FAIL}"
    assert expectations(loaded(bypassed, "controller=slip-band")) == [OWN]
    assert expectations(loaded(f"{HEAD}expect: skipped\n", "controller=slip-band")) == [
        Expectation("skipped")
    ]


@pytest.mark.parametrize("outcome", ["fail", "invalid"])
def test_an_expectation_without_names_allows_another_controller_nothing(loaded, outcome):
    cases = loaded(f"{SLIP}expect: {outcome}\n", "controller=threshold,slip-band")
    assert expectations(cases) == [PASS, PASS]


def test_who_sets_the_expectation_beside_the_controller_means_that_controller(loaded):
    rows = "include: [{controller: slip-band, expect: {fail: [wheelset-contact-energy]}}, {seed: 3}]\n"
    cases = loaded(SLIP + FAIL + rows)
    assert expectations(cases) == [Expectation("fail", ("wheelset-contact-energy",)), OWN]
    cases = loaded(SLIP + FAIL, "controller=slip-band", "expect=fail")
    assert expectations(cases) == [Expectation("fail")]


def test_a_child_and_a_series_take_of_an_expectation_what_is_for_their_controller_and_criteria(write):
    write("parent.yaml", (SLIP + FAIL).replace("name: stop", "name: parent"))
    child = "schema: uictest/scenario/1\nname: child\nextends: parent.yaml\n"

    def expected(more):
        return expectations(load([write("child.yaml", child + more)]))

    assert expected("") == [OWN]
    assert expected("rail: {friction: 0.08}\n") == [OWN]
    assert expected("controller: slip-band\n") == [ALLOWED]
    assert expected(f"controller: slip-band\n{FAIL}") == [OWN]
    assert expected("controller: slip-band\nexpect: fail\n") == [Expectation("fail")]
    write("dry.yaml", HEAD.replace("name: stop", "name: dry") + "criteria: uictest-stop\n")
    write("stop.yaml", SLIP + BOTH)
    text = (
        "schema: uictest/series/1\nname: own\nset: {criteria: uictest-stop}\ndry: dry.yaml\nwet: stop.yaml\n"
    )
    (planned,) = series.load_series(write("own.series.yaml", text))
    assert [stop.case.scenario.expect for stop in planned.stops] == [PASS, PASS]


def test_a_controller_that_is_set_in_a_train_makes_an_allowance_of_what_its_cars_expect(write):
    train = f"""{SLIP}{FAIL}train:
  - {{vehicle: crh380a}}
  - {{vehicle: crh380a, controller: slip-band, expect: {{fail: [wheelset-contact-energy]}}}}
  - {{vehicle: crh380a, count: 2}}
"""
    path = write("train.yaml", train)
    second = Expectation("fail", ("wheelset-contact-energy",))
    assert expectations(load([path])) == [OWN, second, OWN, OWN]
    another = second.of_another_controller()
    allowed = [ALLOWED, another, ALLOWED, ALLOWED]
    assert expectations(load([path], ["controller=slip-band"])) == allowed
    assert expectations(load([path], ["train.1.controller=threshold"])) == allowed


def test_what_is_expected_is_no_part_of_an_id_nor_a_parameter(loaded, refused):
    zipped = "zip: {seed: [1, 2], expect: [fail, {fail: [locked-wheels]}]}\n"
    cases = loaded(SLIP + zipped)
    assert [case.id for case in cases] == ["stop[seed=1]", "stop[seed=2]"]
    assert [case.parameters for case in cases] == [{"seed": "1"}, {"seed": "2"}]
    assert expectations(cases) == [Expectation("fail"), Expectation("fail", ("locked-wheels",))]
    assert [case.id for case in loaded(SLIP, "expect=fail")] == ["stop"]
    # Two cases that differ in nothing else are the same stop.
    (found,) = refused(SLIP, "expect=pass,fail")
    assert (found.key, found.message) == ("expect", "'fail' and 'pass' make the same case id")
