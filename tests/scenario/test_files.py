"""Which files are read: those of a folder, and references at or below the folders that were given."""

from pathlib import Path

import pytest

from uictest.plans.scenario import ScenarioErrors, load
from uictest.plans.sweeps import load_sweep
from uictest.recorded.field_data import load_map
from uictest.rig.bench.recipe import load_bench
from uictest.rig.identification.compensation_file import load_compensation

SECRET = "root:x:0:0 top secret\n"
HEAD = "schema: uictest/scenario/1\nname: stop\n"
SPEED = "initial_speed: 80 km/h\n"
CAR = "schema: uictest/vehicle/1\nextends: intercity-180\n"


@pytest.fixture
def place(tmp_path, monkeypatch):
    """A working folder `here/` with a sub-folder and, beside it, a folder `there/`."""
    for folder in ("here/sub", "there"):
        (tmp_path / folder).mkdir(parents=True)
    (tmp_path / "there" / "secret.yaml").write_text(SECRET)
    (tmp_path / "there" / "base.yaml").write_text(HEAD + SPEED)
    (tmp_path / "there" / "car.yaml").write_text(CAR)
    monkeypatch.chdir(tmp_path / "here")
    return tmp_path


def refused(read):
    with pytest.raises(ScenarioErrors) as caught:
        read()
    (diagnostic,) = caught.value.diagnostics
    assert "secret" not in str(diagnostic).replace("secret.yaml", "")
    return diagnostic


def scenario(text, name="sub/stop.yaml"):
    Path(name).write_text(HEAD + text)
    return Path(name)


REFERENCES = {
    "extends": "extends: ../../there/secret.yaml\n",
    "vehicle": SPEED + "vehicle: ../../there/secret.yaml\n",
    "vehicle.extends": SPEED + "vehicle: {extends: ../../there/secret.yaml}\n",
    "criteria.0": SPEED + "criteria: [../../there/secret.yaml]\n",
    "rail.condition": SPEED + "matrix: {rail.condition: [../../there/secret.yaml]}\n",
}


@pytest.mark.parametrize("key", REFERENCES)
def test_a_reference_that_climbs_out_is_refused_before_the_file_is_opened(place, key):
    diagnostic = refused(lambda: load([scenario(REFERENCES[key])]))
    assert (diagnostic.file, diagnostic.key) == ("sub/stop.yaml", key)
    assert diagnostic.line > 2
    assert diagnostic.message == f"'../../there/secret.yaml' leads out of {place / 'here'}"
    assert f"--trust {place / 'there'}" in diagnostic.hint


def test_neither_links_nor_parts_lead_out_and_what_is_not_there_is_not_told_apart(place):
    diagnostic = refused(lambda: load([scenario("extends: ../../there/nothing.yaml\n")]))
    assert "leads out of" in diagnostic.message
    Path("sub/link.yaml").symlink_to(place / "there" / "secret.yaml")
    Path("sub/folder").symlink_to(place / "there")
    assert "leads out of" in refused(lambda: load([scenario("extends: link.yaml\n")])).message
    assert "leads out of" in refused(lambda: load([scenario("extends: folder/secret.yaml\n")])).message
    Path("sub/car.yaml").write_text(CAR.replace("intercity-180", "../../there/secret.yaml"))
    diagnostic = refused(lambda: load([scenario(SPEED + "vehicle: car.yaml\n")]))
    assert (diagnostic.file, diagnostic.line, diagnostic.key) == ("sub/car.yaml", 2, "vehicle.extends")


def test_a_link_out_of_a_folder_given_is_not_read(place):
    Path("sub/link.yaml").symlink_to(place / "there" / "secret.yaml")
    diagnostic = refused(lambda: load([Path("sub")]))
    assert diagnostic.file == "sub/link.yaml"
    assert diagnostic.message == "a link that leads out of the folders given"


def test_folders_given_trusted_or_named_on_the_command_line_are_open_also_to_sweeps(place, monkeypatch):
    child = scenario("extends: ../../there/base.yaml\nvehicle: ../../there/car.yaml\n").absolute()
    assert load([child], trusted=[place / "there"])
    (place / "there" / "other.yaml").write_text(HEAD.replace("stop", "other") + SPEED)
    assert len(load([child, place / "there" / "other.yaml"])) == 2
    (place / "there" / "own.yaml").write_text("schema: uictest/vehicle/1\nextends: car.yaml\n")
    stop = scenario(SPEED, "sub/own.yaml")
    assert load([stop], ["vehicle=../there/own.yaml"])[0].scenario.vehicle.name == "intercity-180"
    (place / "there" / "child.yaml").write_text(HEAD + "extends: base.yaml\nvehicle: car.yaml\n")
    text = SWEEP.format(base="../../there/child.yaml", axis="vehicle: [crh380a, ../../there/car.yaml]")
    Path("sub/s.sweep.yaml").write_text(text)
    assert load_sweep(Path("sub/s.sweep.yaml"), trusted=[place / "there"]).size == 2
    monkeypatch.chdir(place)
    assert load([child])


SWEEP = "schema: uictest/scenario/1\nname: s\nextends: {base}\nvary: {{matrix: {{{axis}}}}}\n"


@pytest.mark.parametrize(
    ("base", "axis"),
    [
        ("../../there/secret.yaml", "seed: [1, 2]"),
        ("stop.yaml", "vehicle: [intercity-180, ../../there/secret.yaml]"),
        ("stop.yaml", "rail.condition: [dry, {extends: ../../there/secret.yaml}]"),
    ],
)
def test_sweeps_are_confined(place, base, axis):
    scenario(SPEED)
    Path("sub/s.sweep.yaml").write_text(SWEEP.format(base=base, axis=axis))
    assert "leads out of" in refused(lambda: load_sweep(Path("sub/s.sweep.yaml"))).message


BENCH = "schema: uictest/bench/1\nname: b\ninputs: [{kind: rest, duration: 1 s}]\n"
TRACE = "schema: uictest/bench/1\nname: b\ninputs:\n- {kind: trace, file: %s}\n"
MAP = "schema: uictest/channel-map/1\nname: m\nchannels: {}\n"
READERS = {
    "bench stop": (BENCH + "stop: {vehicle: ../../there/secret.yaml}\n", load_bench),
    "bench trace": (TRACE % "../../there/secret.yaml", load_bench),
    "bench trace by its absolute path": (TRACE % "/there/secret.yaml", load_bench),
    "channel map": (MAP + "extends: ../../there/secret.yaml\n", lambda path: load_map(str(path))),
    "compensation": (
        "schema: uictest/compensation/1\nextends: ../../there/secret.yaml\n",
        lambda path: load_compensation(str(path)),
    ),
}


@pytest.mark.parametrize("name", READERS)
def test_other_files_are_confined_too(place, name):
    text, read = READERS[name]
    Path("sub/file.yaml").write_text(text)
    diagnostic = refused(lambda: read(Path("sub/file.yaml")))
    assert "leads out of" in diagnostic.message or "is an absolute path" in diagnostic.message


def named(head, name):
    return head.replace("name: stop", f"name: {name}")


def test_a_folder_is_searched_below_in_order_for_scenarios_each_once(write, head, tmp_path):
    assert load([tmp_path]) == []
    for path in ("set/b.yaml", "set/a.yml", "set/deep/c.yaml"):
        write(path, named(head, Path(path).stem))
    assert [case.id for case in load([Path("set")])] == ["a", "b", "c"]
    assert len(load([Path("set"), Path("set/b.yaml"), Path("set/../set/b.yaml")])) == 3


def test_what_is_no_scenario_is_passed_over_in_a_folder_and_read_where_it_is_named(write, head):
    write("set/a.yaml", named(head, "a"))
    for kind in ("vehicle", "bench", "channel-map"):
        write(f"set/{kind}.yaml", f"schema: uictest/{kind}/1\nextends: crh380a\n")
    for path in ("set/many.sweep.yaml", "set/_base.yaml", "set/.hidden.yaml", "set/.git/x.yaml", "set/x.txt"):
        write(path, "no: scenario")
    assert [case.id for case in load([Path("set")])] == ["a"]
    write("_base.yaml", named(head, "base"))
    write("car.yaml", "schema: uictest/vehicle/1\n")
    assert [case.id for case in load([Path("_base.yaml")])] == ["base"]
    with pytest.raises(ScenarioErrors, match="expected uictest/scenario/1"):
        load([Path("car.yaml")])


def test_two_scenarios_of_one_name_and_what_cannot_be_told_are_refused(write, head):
    write("set/a.yaml", "name: a\n")
    with pytest.raises(ScenarioErrors, match="missing key 'schema'"):
        load([Path("set")])
    write("set/stop\udcff.yaml", head)
    with pytest.raises(ScenarioErrors, match="the file name is not UTF-8"):
        load([Path("set")])
    write("a.yaml", head)
    write("b.yaml", head)
    with pytest.raises(ScenarioErrors) as caught:
        load([Path("a.yaml"), Path("b.yaml")])
    (diagnostic,) = caught.value.diagnostics
    assert (diagnostic.file, diagnostic.line, diagnostic.column, diagnostic.key) == ("b.yaml", 2, 7, "name")
    assert "'a.yaml'" in diagnostic.message


@pytest.mark.parametrize("name", ["a" * 5000 + ".yaml", "a\x00.yaml", "stop.yaml/inside.yaml", "/dev/null"])
def test_a_name_that_no_file_can_have_is_refused(name):
    with pytest.raises(ScenarioErrors, match=r"no such file|not a file"):
        load([Path(name)])
