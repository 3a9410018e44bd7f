"""Which files a folder holds."""

from pathlib import Path

import pytest

from uictest.plans.scenario import ScenarioErrors, load


def named(head, name):
    return head.replace("name: stop", f"name: {name}")


def test_a_folder_is_searched_below_in_order(write, head):
    for path in ("set/b.yaml", "set/a.yml", "set/deep/c.yaml"):
        write(path, named(head, Path(path).stem))
    assert [case.id for case in load([Path("set")])] == ["a", "b", "c"]


def test_what_is_no_scenario_is_passed_over(write, head):
    write("set/a.yaml", named(head, "a"))
    for kind in ("vehicle", "bench", "channel-map"):
        write(f"set/{kind}.yaml", f"schema: uictest/{kind}/1\nextends: crh380a\n")
    for path in ("set/many.sweep.yaml", "set/_base.yaml", "set/.hidden.yaml", "set/.git/x.yaml", "set/x.txt"):
        write(path, "no: scenario")
    assert [case.id for case in load([Path("set")])] == ["a"]


def test_a_named_file_is_always_read(write, head):
    write("_base.yaml", named(head, "base"))
    write("car.yaml", "schema: uictest/vehicle/1\n")
    assert [case.id for case in load([Path("_base.yaml")])] == ["base"]
    with pytest.raises(ScenarioErrors, match="expected uictest/scenario/1"):
        load([Path("car.yaml")])


def test_a_file_without_a_schema_is_an_error_and_not_passed_over(write):
    write("set/a.yaml", "name: a\n")
    with pytest.raises(ScenarioErrors, match="missing key 'schema'"):
        load([Path("set")])


def test_a_file_named_twice_is_loaded_once(write, head):
    write("set/a.yaml", named(head, "a"))
    assert len(load([Path("set"), Path("set/a.yaml"), Path("set/../set/a.yaml")])) == 1


def test_two_scenarios_of_one_name_are_refused(write, head):
    write("a.yaml", head)
    write("b.yaml", head)
    with pytest.raises(ScenarioErrors) as caught:
        load([Path("a.yaml"), Path("b.yaml")])
    (diagnostic,) = caught.value.diagnostics
    assert (diagnostic.file, diagnostic.line, diagnostic.column, diagnostic.key) == ("b.yaml", 2, 7, "name")
    assert "'a.yaml'" in diagnostic.message


def test_an_empty_folder_holds_no_case(tmp_path):
    assert load([tmp_path]) == []


@pytest.mark.parametrize("name", ["a" * 5000 + ".yaml", "a\x00.yaml", "stop.yaml/inside.yaml", "/dev/null"])
def test_a_name_that_no_file_can_have_is_refused(name):
    with pytest.raises(ScenarioErrors, match=r"no such file|not a file"):
        load([Path(name)])


def test_a_name_that_is_no_text_is_refused(write, head):
    write("set/stop\udcff.yaml", head)
    with pytest.raises(ScenarioErrors, match="the file name is not UTF-8"):
        load([Path("set")])
