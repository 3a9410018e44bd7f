"""References stay at or below the files that were named, the working folder and trusted folders."""

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


def test_what_is_not_there_outside_is_not_told_apart_from_what_is(place):
    diagnostic = refused(lambda: load([scenario("extends: ../../there/nothing.yaml\n")]))
    assert "leads out of" in diagnostic.message


def test_links_are_followed_before_it_is_decided(place):
    Path("sub/link.yaml").symlink_to(place / "there" / "secret.yaml")
    Path("sub/folder").symlink_to(place / "there")
    assert "leads out of" in refused(lambda: load([scenario("extends: link.yaml\n")])).message
    assert "leads out of" in refused(lambda: load([scenario("extends: folder/secret.yaml\n")])).message


def test_a_link_out_of_a_folder_given_is_not_read(place):
    Path("sub/link.yaml").symlink_to(place / "there" / "secret.yaml")
    diagnostic = refused(lambda: load([Path("sub")]))
    assert diagnostic.file == "sub/link.yaml"
    assert diagnostic.message == "a link that leads out of the folders given"


def test_the_working_folder_the_folders_given_and_trusted_ones_are_open(place, monkeypatch):
    child = scenario("extends: ../../there/base.yaml\nvehicle: ../../there/car.yaml\n").absolute()
    assert load([child], trusted=[place / "there"])
    (place / "there" / "other.yaml").write_text(HEAD.replace("stop", "other") + SPEED)
    assert len(load([child, place / "there" / "other.yaml"])) == 2
    monkeypatch.chdir(place)
    assert load([child])


def test_a_file_named_on_the_command_line_opens_its_folder(place):
    (place / "there" / "own.yaml").write_text("schema: uictest/vehicle/1\nextends: car.yaml\n")
    stop = scenario(SPEED)
    assert load([stop], ["vehicle=../there/own.yaml"])[0].scenario.vehicle.name == "intercity-180"


def test_parts_are_confined_wherever_they_come_from(place):
    Path("sub/car.yaml").write_text(CAR.replace("intercity-180", "../../there/secret.yaml"))
    diagnostic = refused(lambda: load([scenario(SPEED + "vehicle: car.yaml\n")]))
    assert (diagnostic.file, diagnostic.line, diagnostic.key) == ("sub/car.yaml", 2, "vehicle.extends")


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


def test_a_trusted_folder_is_open_to_a_sweep_and_the_scenario_it_names(place):
    (place / "there" / "child.yaml").write_text(HEAD + "extends: base.yaml\nvehicle: car.yaml\n")
    text = SWEEP.format(base="../../there/child.yaml", axis="vehicle: [crh380a, ../../there/car.yaml]")
    Path("sub/s.sweep.yaml").write_text(text)
    assert load_sweep(Path("sub/s.sweep.yaml"), trusted=[place / "there"]).size == 2


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
