from pathlib import Path

import pytest
from hypothesis import given, strategies as st

from uictest.plans.scenario import in_order_of_ids, load, named_requirements, read_requirement_list, values_in
from uictest.plans.scenario.yaml import ScenarioErrors

CRITERIA = """\
criteria:
  name: own
  criteria:
    - {id: short, layer: requirement, measure: braking_distance, upper: 900 m, requirements: [B-2, A-1]}
    - {id: quick, layer: requirement, measure: braking_time, upper: 90 s, requirements: [B-2]}
"""


def test_every_case_has_the_ids_of_its_scenario_and_may_have_a_test_case_of_its_own(loaded, head):
    cases = loaded(
        head + "requirements: [BR-WSP-12]\ntest_case: TC-7\nmatrix: {brake.command: [80 %, 90 %]}\n"
    )
    assert [(case.scenario.requirements, case.scenario.test_case) for case in cases] == [
        (("BR-WSP-12",), "TC-7"),
        (("BR-WSP-12",), "TC-7"),
    ]
    cases = loaded(head + "zip:\n  brake.command: [80 %, 90 %]\n  test_case: [TC-1, TC-2]\n")
    assert [case.scenario.test_case for case in cases] == ["TC-1", "TC-2"]


def test_a_child_inherits_the_requirements_of_its_parent_or_replaces_them(write, head):
    parent = write("parent.yaml", head + "requirements: [BR-1]\n")
    child = "schema: uictest/scenario/1\nextends: parent.yaml\n"
    paths = [
        parent,
        write("same.yaml", f"{child}name: same\n"),
        write("other.yaml", f"{child}name: other\nrequirements: [BR-2]\n"),
    ]
    requirements = {case.scenario.name: case.scenario.requirements for case in load(paths)}
    assert requirements == {"stop": ("BR-1",), "same": ("BR-1",), "other": ("BR-2",)}


def test_the_requirements_of_criteria_are_those_of_the_scenario_and_no_parameters(loaded, head):
    (case,) = loaded(head + "requirements: [C-3, A-1]\n" + CRITERIA)
    assert named_requirements(case.scenario) == ("C-3", "A-1", "B-2")
    # A stop cannot depend on them, so a profile that only names other ones is not a changed profile.
    (case,) = loaded(head + CRITERIA)
    assert not [key for key, _ in values_in(case.scenario.criteria[0]) if "requirements" in key]
    assert not [key for key, _ in values_in(case.scenario) if {"requirements", "test_case"} & set(key)]


@pytest.mark.parametrize(
    ("text", "line", "message"),
    [
        ("requirements: [BR-1, BR-2, BR-1]\n", 4, "'BR-1' appears twice"),
        ("requirements:\n  - BR 1\n", 5, "'BR 1' is not allowed"),
        ("requirements:\n  - BR-1\n  - 'BR-1,BR-2'\n", 6, "'BR-1,BR-2' is not allowed"),
        ("requirements: BR-1\n", 4, "expected a list"),
        ("test_case: '-7'\n", 4, "'-7' is not allowed"),
        (CRITERIA.replace("[B-2, A-1]", "[B-2, B-2]"), 7, "'B-2' appears twice"),
    ],
)
def test_what_is_no_list_of_ids_is_refused_where_it_stands(refused, head, text, line, message):
    (diagnostic,) = refused(head + text)
    assert (diagnostic.file, diagnostic.line) == ("stop.yaml", line)
    assert message in diagnostic.message


def test_ids_are_listed_by_their_numbers():
    assert in_order_of_ids(["BR-10", "BR-9", "A", "BR-9.10", "BR-9.2"]) == [
        "A",
        "BR-9",
        "BR-9.2",
        "BR-9.10",
        "BR-10",
    ]


@given(st.sets(st.text("019AZaz._:/-", min_size=1, max_size=10)))
def test_any_ids_have_an_order_that_their_first_order_does_not_change(ids):
    ordered = in_order_of_ids(ids)
    assert set(ordered) == ids
    assert in_order_of_ids(reversed(ordered)) == ordered


def _read(write, name, content):
    return read_requirement_list(write(name, content))


@pytest.mark.parametrize(
    ("name", "content"),
    [
        ("all.txt", "# exported\nBR-1\n\n  BR-2  # braking\nBR-1\n"),
        ("all.txt", b"\xef\xbb\xbfBR-1\r\nBR-2\r\n"),
        ("all.csv", "id,text\nBR-1,Stop\nBR-2,Go\n"),
        ("all.csv", 'Text; ID \n"two\nlines; one id";BR-1\nheading;\nx;BR-2\n'),
        ("all.csv", b"\xef\xbb\xbfid\ttext\r\nBR-1\ta\r\nBR-2\tb\r\n"),
        ("all.yaml", "- BR-1\n- {id: BR-2, text: Go}\n"),
        ("all.yml", "[BR-1, BR-2]\n"),
    ],
)
def test_lists_are_read_as_tools_export_them(write, name, content):
    assert _read(write, name, content) == ("BR-1", "BR-2")


@pytest.mark.parametrize(
    ("name", "content", "place", "message"),
    [
        ("all.txt", "BR-1\n  BR 2\n", "all.txt:2:3", "'BR 2' is not the id of a requirement"),
        ("all.csv", 'text;id\n"a\nb";BR-1\nc;B?\n', "all.csv:4:1", "'B?' is not the id"),
        ("all.csv", "name,text\nBR-1,x\n", "all.csv:1:1", "the first row names no column 'id'"),
        ("all.yaml", "- BR-1\n- {name: BR-2}\n", "all.yaml:2:3", "a mapping with the key 'id'"),
        ("all.yaml", "id: BR-1\n", "all.yaml:1:1", "expected a list of ids"),
        ("all.txt", "# nothing\n", "all.txt:1:1", "the list has no requirement"),
        ("all.csv", "", "all.csv:1:1", "names no column"),
        ("all.txt", b"BR-1\nBR-\xe4\n", "all.txt:2:4", "is not UTF-8 text"),
    ],
)
def test_an_error_in_a_list_names_its_place(write, name, content, place, message):
    with pytest.raises(ScenarioErrors) as caught:
        _read(write, name, content)
    assert str(caught.value).startswith(f"{place}: ")
    assert message in str(caught.value)


def test_every_wrong_line_is_reported_at_once_and_a_missing_list_is_an_error_of_the_file(write):
    with pytest.raises(ScenarioErrors) as caught:
        _read(write, "all.txt", "a b\nBR-1\nc d\n")
    assert [each.line for each in caught.value.diagnostics] == [1, 3]
    with pytest.raises(ScenarioErrors, match="no such file"):
        read_requirement_list(Path("other.txt"))
