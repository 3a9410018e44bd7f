"""Every kind of file that the program reads, damaged: an input error or a result, never an internal error.

A kind is a row of `KINDS`: valid files and how the program reads one. Values are replaced, deleted, repeated,
swapped and given other types, and bytes are damaged. `FOUND` holds what a search has found.
"""

import contextlib
import csv
import functools
import io
import json
import pickle
import re
import shutil
import zipfile
from collections.abc import Callable
from dataclasses import dataclass
from pathlib import Path
from typing import Any, get_args
from unittest.mock import patch
from xml.etree import ElementTree

import fmpy
import numpy as np
import pyarrow as pa
import pyarrow.parquet as pq
import pytest
import typer.main
import yaml
from hypothesis import HealthCheck, Phase, given, settings, strategies as st

from uictest import report
from uictest.analysis import comparison, validation
from uictest.cli.entry import execute
from uictest.cli.output import ExitCode
from uictest.controllers import Config, ControllerError
from uictest.controllers.adapters import fmu as fmu_instance, fmu_slave
from uictest.core.recording import Recording
from uictest.core.recording.formats import FORMATS, UnreadableError, read_contents, writer_of
from uictest.plans import scenario, series as series_plans
from uictest.recorded.field_data.defects import DefectKind
from uictest.rig import bench

SOURCE = Path(__file__).parents[1]
EXAMPLES = settings().max_examples * 2 // 5
"""Files that are tried of a kind in each way."""
Tree = Any


def _written_json(tree):
    """JSON, which is YAML as well; texts that UTF-8 cannot write are escaped."""
    return json.dumps(tree, default=str).encode()


def _read_csv(content):
    return list(csv.reader(io.StringIO(content.decode())))


def _written_csv(tree):
    rows = [row if isinstance(row, list) else [row] for row in (tree if isinstance(tree, list) else [tree])]
    text = io.StringIO()
    csv.writer(text).writerows(rows)
    return text.getvalue().encode("utf-8", "surrogatepass")


def _read_xml(content):
    def read(element):
        return [element.tag, dict(element.attrib), [read(each) for each in element]]

    return read(ElementTree.fromstring(content))


def _written_xml(tree):
    def write(node):
        tag, attributes, inner = [*node, "", {}, []][:3] if isinstance(node, list) else [node, {}, []]
        given = attributes.items() if isinstance(attributes, dict) else ()
        element = ElementTree.Element(
            re.sub(r"\W", "", str(tag)) or "x", {re.sub(r"\W", "", str(k)) or "x": str(v) for k, v in given}
        )
        element.extend(write(each) for each in (inner if isinstance(inner, list) else []))
        return element

    return ElementTree.tostring(write(tree)).translate(None, bytes({*range(9), 11, 12, *range(14, 32)}))


def _read_parquet(content):
    table = pq.read_table(pa.BufferReader(content)).slice(0, 60)
    facts = {name.decode(): text.decode() for name, text in table.schema.metadata.items() if b"uic" in name}
    columns = {name: table.column(name).to_pylist() for name in table.column_names[:6]}
    facts |= {name: json.loads(facts[name]) for name in ("uictest.units", "uictest.metadata")}
    return {"columns": columns, "facts": facts}


def _written_parquet(tree):
    columns = tree["columns"] if isinstance(tree["columns"], dict) else {"time": [tree["columns"]]}
    facts = tree["facts"] if isinstance(tree["facts"], dict) else {}
    arrays = {str(name): each if isinstance(each, list) else [each] for name, each in columns.items()}
    rows = min(map(len, arrays.values()), default=0)
    table = pa.table({name: pa.array(each[:rows]) for name, each in arrays.items()})
    texts = {name: each if isinstance(each, str) else json.dumps(each) for name, each in facts.items()}
    stream = io.BytesIO()
    pq.write_table(table.replace_schema_metadata(texts), stream)
    return stream.getvalue()


FORMS = {
    "yaml": (yaml.safe_load, _written_json),
    "json": (json.loads, _written_json),
    "csv": (_read_csv, _written_csv),
    "xml": (_read_xml, _written_xml),
    "parquet": (_read_parquet, _written_parquet),
}
"""Ending of a file -> how it is read as a tree, and how a tree is written."""

VALUES = (
    *(None, True, False, 0, 1, -1, 2, 4, 5, 10**30, 0.1, -0.0, 1e-320, 1e308, float("nan"), float("inf")),
    *("", " ", "0", "-1", "nan", "1e999", "on", "lost", "all", "half", "library"),
    *("../../evil", "/etc/passwd"),
    *("0 s", "5 s", "120 km/h", "0 km/h", "100 %", "0 %", "90 % of the dry stop", "20 degC", "-3 bar"),
    *("a\x00b", "\x1b[31m", "\ud800", "\u202e", "ä", "x" * 5000, "n" * 300 + ".yaml", "tcp://h:99999", "{n}"),
    *([], {}, [[]], [None], [0, 1], ["a"], {"": None}, {"a": 1}, {"value": "1 s"}, {"extends": "threshold"}),
    *(
        {"value": None, "source": 1},
        {"points": []},
        {"at_least": "90 %"},
        [{"position": "0 m"}],
        [1, [2, {}]],
    ),
)
WAYS = ("replace", "delete", "repeat", "swap", "wrap", "rename", "retype", "copy")
damages = st.lists(
    st.tuples(st.sampled_from(WAYS), *(st.integers(0, 9999) for _ in range(3))), min_size=1, max_size=3
)
BYTE_WAYS = ("change", "delete", "insert", "repeat", "cut", "line", "no line")
NEW_BYTES = (b"\x00", b"\xff", b"-", b":", b"{", b"]", b'"', b"\n", b"\t", b"9", b"e", b"\xed\xa0\x80")
byte_damage = st.tuples(
    st.sampled_from(BYTE_WAYS), st.integers(0, 10**6), st.integers(0, 40), st.sampled_from(NEW_BYTES)
)
byte_damages = st.lists(byte_damage, min_size=1, max_size=4)


def _places(tree, above=()):
    """Every place below the root: the keys and numbers that lead to it."""
    places = []
    for key, inner in tree.items() if isinstance(tree, dict) else enumerate(tree):
        places.append(place := (*above, key))
        if isinstance(inner, (dict, list)):
            places += _places(inner, place)
    return places


def _at(tree, place):
    for key in place:
        tree = tree[key]
    return tree


def _copied(tree):
    """The same as a deep copy, in a fifth of the time."""
    return pickle.loads(pickle.dumps(tree))


def damaged(tree, wanted):
    """A copy of a tree, damaged at places that are given by number."""
    root = [_copied(tree)]
    for way, number, other_number, value in wanted:
        places = _places(root)
        place, other = places[number % len(places)], places[other_number % len(places)]
        above, key, found = _at(root, place[:-1]), place[-1], _at(root, place)
        if way == "delete":
            del above[key]
        elif way == "repeat":
            above.insert(key, _copied(found)) if isinstance(above, list) else above.update({f"{key}2": found})
        elif way == "rename" and isinstance(above, dict):
            above[str(VALUES[value % len(VALUES)])] = above.pop(key)
        elif way == "wrap":
            above[key] = [found] if value % 2 else {"value": found}
        elif way == "retype":
            above[key] = str(found) if value % 2 or not isinstance(found, str) else len(found)
        elif way == "swap":
            above[key], _at(root, other[:-1])[other[-1]] = _copied(_at(root, other)), _copied(found)
        elif way == "copy":
            above[key] = _copied(_at(root, other))
        else:
            above[key] = _copied(VALUES[value % len(VALUES)])
        if not root:
            return None
    return root[0]


def damaged_bytes(content, wanted):
    """A copy of the bytes of a file, damaged."""
    for way, where, length, new in wanted:
        at = where % (len(content) + 1)
        lines = content.splitlines(keepends=True)
        if way == "change":
            content = content[:at] + new + content[at + len(new) :]
        elif way == "insert":
            content = content[:at] + new + content[at:]
        elif way == "repeat":
            content = content[: at + length] + content[at:]
        elif way == "cut":
            content = content[:at]
        elif way == "delete":
            content = content[:at] + content[at + length :]
        elif lines:
            line = where % len(lines)
            content = b"".join(
                [*lines[:line], *([lines[line]] * 2 if way == "line" else []), *lines[line + 1 :]]
            )
    return content


def command(line, reasons=()):
    """Read a file by a command, of which `{}` is its path; a stop may be in error for one of the reasons."""

    def read(path):
        shown = io.StringIO()
        with contextlib.redirect_stdout(shown), contextlib.redirect_stderr(shown):
            code = execute([argument.replace("{}", str(path)) for argument in line.split()])
        explained = any(f"{reason}: " in shown.getvalue() for reason in reasons)
        assert code is not ExitCode.ERROR or explained, shown.getvalue()
        assert "No such option" not in shown.getvalue()

    return read


def function(read, *errors):
    """Read a file by a function that raises these errors."""

    def call(path):
        with contextlib.suppress(scenario.ScenarioErrors, *errors):
            read(path)

    return call


def described_fmu(description):
    """Take an FMU of some description for a controller, as far as no code of it runs."""
    with zipfile.ZipFile("any.fmu", "w") as archive:
        archive.writestr("modelDescription.xml", description.read_bytes())
        for platform in (fmpy.platform, fmpy.platform_tuple):
            archive.writestr(f"binaries/{platform}/any{fmpy.sharedLibraryExtension}", b"")
    command("check uses-fmu.yaml")(description)
    fmu = Path("any.fmu")
    with contextlib.suppress(ControllerError):
        unpacked = fmu_slave.unpack(fmu.read_bytes())
        with patch.object(fmu_slave, "_instantiated"):
            slave = fmu_slave.Slave(unpacked)
        try:
            fmu_instance.FmuInstance(slave, [], Config(4, 0.01, 20.0, (0.46,) * 4, {"late": 1}), {})
        finally:
            slave.release()


def compared_baseline(path):
    """Compare the run that was made with a baseline."""
    run = report.read_run(Path("good"))
    scope = comparison.Scope(frozenset({"stop"}), ("stop.yaml",))
    comparison.read_baseline(path.parent, scope, comparison.Tolerances()).compare(run)


@dataclass(frozen=True)
class Kind:
    """A kind of file."""

    name: str
    file: str
    """Path of a damaged file; its ending may say what it is."""
    valid: str
    """Valid files: patterns below the repository, or names of files in the folder of the test, and blanks."""
    read: Callable[[Path], object]
    cost: int = 1
    """How many times as long as most it takes to read one; so much fewer are read."""

    @property
    def form(self):
        """What its content is a tree of, if it is one."""
        ending = self.file.rpartition(".")[2]
        return ending if ending in FORMS else ""


PARTS = {
    "vehicle": ("vehicles", "vehicle: part.yaml"),
    "brake": ("brakes", "brake: {system: part.yaml}"),
    "caliper": ("calipers", "rig: {caliper: part.yaml}"),
    "compensation": ("compensations", "rig: {compensation_model: part.yaml}"),
    "controller": ("controllers", "controller: part.yaml"),
    "criteria": ("criteria", "criteria: [part.yaml]"),
    "measures": ("measures", "measures: part.yaml"),
    "pad": ("pads", "brake: {pad: part.yaml}"),
    "rail": ("rails", "rail: {condition: part.yaml}"),
    "sensors": ("sensors", "rig: {sensors: part.yaml}"),
}
LIST = command("list -v --requirements --requirement-list {} stop.yaml")
REPORT = command("report bad --format md,junit,csv -o out")
EVALUATE = command(
    "evaluate -v x.csv --scenario stop.yaml --format json -o out --record none", reasons=get_args(DefectKind)
)
RUN, SWEEP, VALID = "good/results.json", "swept/results.json", "valid/validation.json"
STOP = "recordings/stop.parquet"
RECORD = f"good/{STOP}"
CHECK = command("check {}")
BASELINE = function(compared_baseline, ValueError, OSError)
USED_VALIDATION = function(validation.read_validation, ValueError, OSError)
CONTENTS = function(read_contents, UnreadableError, OSError)
LIBRARY = "src/uictest/plans/library"
MAPS = f"{LIBRARY}/channel_maps/*.yaml map.yaml"
ROWS = (
    ("scenario", "x.yaml", "scenarios/*-*[0-9].yaml full.yaml outside.yaml", CHECK),
    ("sweep", "x.sweep.yaml", "scenarios/*.sweep.yaml", CHECK),
    ("series", "x.series.yaml", "scenarios/*.series.yaml", CHECK),
    *(
        (f"{name} part", "part.yaml", f"{LIBRARY}/{folder}/*.yaml", command(f"check uses-{name}.yaml"))
        for name, (folder, _) in PARTS.items()
    ),
    (
        "controller outside",
        "part.yaml",
        "wsp.yaml fmu.yaml socket.yaml",
        command("check uses-controller.yaml"),
    ),
    ("bench recipe", "x.yaml", f"{LIBRARY}/benches/*.yaml", function(bench.load_bench)),
    ("channel map", "x.yaml", MAPS, command("evaluate -v --list stop.csv --map {}")),
    ("validation", "x.validation.yaml", "plan.validation.yaml", function(series_plans.load_validation)),
    ("requirements in YAML", "x.yaml", "list.yaml", LIST),
    ("requirements in CSV", "x.csv", "list.csv", LIST),
    ("requirements in text", "x.txt", "list.txt", LIST),
    ("description of an FMU", "x.xml", "fmi2.xml fmi3.xml", described_fmu),
    ("results of a run", "bad/results.json", RUN, REPORT, 3),
    ("results that are compared", "bad/results.json", RUN, command("compare -v good bad"), 3),
    ("last run", "last/latest/results.json", RUN, command("run -v --lf --dry-run -o last stop.yaml"), 3),
    ("accepted baseline", "bad/results.json", RUN, BASELINE, 3),
    ("manifest", "runs/one/manifest.json", "good/manifest.json", command("open runs"), 4),
    ("entry of the index", "runs/one/index-entry.json", "good/index-entry.json", command("open runs"), 4),
    ("result of a sweep", "sweep/results.json", SWEEP, command("report sweep --format md,csv -o out"), 3),
    ("manifest of a sweep", "sweep/manifest.json", "swept/manifest.json", command("open ."), 4),
    ("result of a validation", "validation.json", VALID, command("check uses-validation.yaml")),
    ("validation that is used", "x.json", VALID, USED_VALIDATION),
    ("recording in CSV", "x.csv", "short.csv", EVALUATE, 3),
    ("recording in Parquet", "x.parquet", RECORD, command(f"compare -v x.parquet {RECORD}")),
    (
        "recording of a run",
        "bad/recordings/stop.parquet",
        RECORD,
        command("report bad --format html -o out"),
        8,
    ),
    *(
        (f"recording in {name}", f"x{FORMATS[name].suffix}", f"short{FORMATS[name].suffix}", CONTENTS, 12)
        for name in ("mdf", "tdms", "mat", "parquet")
    ),
)
KINDS = tuple(Kind(*row) for row in ROWS)

FOUND = (
    ("validation", "a.parquet", "x" * 300),
    ("sensors part", "sources:", "sources:\n  value: {mark: chosen, text: x}"),
    ("recording in CSV", "\n0.49,", "\n0.29,"),
    ("scenario", "faults:", "faults: [lost]\nno:"),
    ("criteria part", "criteria:", "criteria: [lost]\nno:"),
    ("description of an FMU", "<fmi", '<?xml version="1.0" encoding="unknown"?><fmi'),
    ("description of an FMU", 'stepSize="0.01"', 'stepSize="0"'),
    ("description of an FMU", 'fixedInternalStepSize="0.01"', 'fixedInternalStepSize="x"'),
    ("description of an FMU", 'valueReference="1"', 'valueReference="-1"'),
    ("description of an FMU", 'modelIdentifier="any"', ""),
)
"""What was an internal error once: kind, text of a valid file, what stands in its place."""
HEAD = "schema: uictest/scenario/1\nname: stop\ninitial_speed: 30 km/h\n"
CONTROLLER = "schema: uictest/controller/1\nname: wsp\n"
VALIDATION = "schema: uictest/validation/1\nname: plan\nstops:\n"
FULL = """
title: everything
tags: [a]
test_case: T-1
requirements: [R-1]
vehicle: {extends: intercity-180, wheelsets: {"2": {wheel_radius: 450 mm, wsp_valve: {travel_time: 20 ms}}}}
brake: {command: 90 %, position: R, pad: {extends: disc-pad}}
rail: {condition: wet, friction: {points: [{position: 0 m, friction: 0.1}, {position: 50 m, friction: 0.08}]}}
rig: {topology: four-caliper, compensation: none, wsp: active, sensors: {extends: pole-wheel}}
controller: {extends: threshold}
criteria:
  - uictest-stop
  - {name: own, criteria: [{id: short, layer: requirement, measure: braking_distance, upper: 90 m}]}
faults:
  - {at: 1 s, until: 20 km/h, wheelset: 2, part: speed-sensor, kind: stuck, value: 10 km/h}
  - {at: 0 s, wheelset: 1, part: hold-magnet, kind: shorted}
repeat: 3
outcome_of_repeats: {at_least: 90 %}
seed: 1
matrix: {brake.command: [80 %, 90 %]}
zip: {initial_speed: [30 km/h, 40 km/h], expect: [pass, fail]}
include: [{rig.wsp: bypassed}]
exclude: [{brake.command: 80 %, initial_speed: 40 km/h}]
"""
FILES = {
    "stop.yaml": HEAD + "requirements: [R-1]\nrig: {compensation: none}\n",
    "full.yaml": HEAD + FULL,
    "outside.yaml": HEAD + "controller: {python: wsp.py, class: Wsp, parameters: {a: 1, b: [1, {c: x}]}}\n",
    "wsp.py": "__version__ = '1'\nclass Wsp:\n    def step(self, inputs): ...\n",
    "wsp.yaml": f"{CONTROLLER}python: wsp.py\nclass: Wsp\ncycle_time: 20 ms\nparameters: {{a: 1}}\n",
    "fmu.yaml": f"{CONTROLLER}fmu: any.fmu\nvariables: {{hold: y%d}}\n",
    "socket.yaml": f"{CONTROLLER}connect: tcp://127.0.0.1:5025\ntime_limit: 1 s\n",
    "uses-fmu.yaml": HEAD + "controller: fmu.yaml\n",
    "uses-validation.yaml": HEAD + "validated: validation.json\n",
    "two.sweep.yaml": "schema: uictest/scenario/1\nname: two\nextends: stop.yaml\n"
    "vary: {matrix: {brake.command: [80 %, 90 %]}}\n",
    "map.yaml": "schema: uictest/channel-map/1\nname: own\nextends: common-names\n"
    "channels: {speed: {source: [v, speed], unit: km/h, scale: 1, sign: -1}}\n",
    "plan.validation.yaml": f"{VALIDATION}  - {{scenario: stop.yaml, recordings: [a.parquet, b.parquet],"
    " set: {seed: 2}, repeat: 2, tuned: true}\n",
    "one.validation.yaml": f"{VALIDATION}  - {{scenario: stop.yaml, recordings: [{RECORD}]}}\n",
    "list.yaml": "- R-1\n- {id: R-2, title: x}\n",
    "list.csv": "id,title\nR-1,x\nR-2,y\n",
    "list.txt": "R-1  # first\nR-2\n",
    "fmi2.xml": (
        '<fmiModelDescription fmiVersion="2.0" modelName="any" guid="right" version="1">'
        '<CoSimulation modelIdentifier="any"/><DefaultExperiment stepSize="0.01"/>'
        "<ModelVariables>{}</ModelVariables><ModelStructure/></fmiModelDescription>"
    ),
    "fmi3.xml": (
        '<fmiModelDescription fmiVersion="3.0" modelName="any" instantiationToken="right">'
        '<CoSimulation modelIdentifier="any" fixedInternalStepSize="0.01"/>'
        "<ModelVariables>{}</ModelVariables><ModelStructure/></fmiModelDescription>"
    ),
}


def _variables(fmi):
    quantities = {"wheel_speed": "input", "hold": "output", "vent": "output"}
    listed = [(f"{name}_{number}", of) for name, of in quantities.items() for number in range(1, 5)]
    listed += [("late", "parameter"), ("reference_speed", "output")]
    texts = []
    for place, (name, causality) in enumerate(listed):
        kind = "fixed" if causality == "parameter" else "discrete"
        text = f'name="{name}" valueReference="{place}" causality="{causality}" variability="{kind}"'
        of_fmi = {2: f"<ScalarVariable {text}><Real/></ScalarVariable>", 3: f"<Float64 {text}/>"}
        texts.append(of_fmi[fmi])
    return "".join(texts)


def _small_recording():
    time = np.arange(200) * 0.01
    speed = 5.0 - 2.0 * time
    channels = {"time": time, "speed": speed, "wheel_speed_1": speed, "tank_pressure_1": 3.8e5 * time}
    units = {"time": "s", "speed": "m/s", "wheel_speed_1": "m/s", "tank_pressure_1": "Pa"}
    return Recording(channels, units, {"case": "small"})


@pytest.fixture(scope="module", autouse=True)
def _place(tmp_path_factory):
    """A working folder with a valid file of every kind, and what reads them."""
    folder = tmp_path_factory.mktemp("damaged")
    with pytest.MonkeyPatch.context() as patch:
        patch.chdir(folder)
        patch.setattr(typer.main, "get_command", functools.cache(typer.main.get_command))
        for variable in ("DISPLAY", "WAYLAND_DISPLAY", "BROWSER", "GITHUB_STEP_SUMMARY"):
            patch.delenv(variable, raising=False)
        for name, text in FILES.items():
            Path(name).write_text(
                text.replace("{}", _variables(int(name[3]))) if name.startswith("fmi") else text
            )
        for name, (_, used) in PARTS.items():
            Path(f"uses-{name}.yaml").write_text(f"{HEAD}{used}\n")
        with zipfile.ZipFile("any.fmu", "w") as archive:
            archive.write("fmi2.xml", "modelDescription.xml")
        command("run -v stop.yaml --record all -q")(folder)
        shutil.copytree("reports/latest/", "good")
        for copy in ("bad", "runs/one", "last/latest"):
            shutil.copytree("good", copy)
        command("sweep two.sweep.yaml -o sweeps")(folder)
        shutil.copytree("sweeps/two", "swept")
        shutil.copytree("sweeps/two", "sweep")
        command("validate -v one.validation.yaml -o validations")(folder)
        shutil.copytree(next(Path("validations").iterdir()), "valid")
        for kind in ("csv", "mdf", "tdms", "mat", "parquet"):
            writer_of(kind)(_small_recording(), Path(f"short{FORMATS[kind].suffix}"))
        shutil.copy("short.csv", "stop.csv")
        yield folder


def _valid_files(kind):
    paths = [
        path for pattern in kind.valid.split() for path in (sorted(SOURCE.glob(pattern)) or [Path(pattern)])
    ]
    return [path.read_bytes() for path in paths]


def _read(kind, content):
    path = Path(kind.file)
    kept = path.read_bytes() if path.parent.name else None
    path.write_bytes(content)
    try:
        kind.read(path)
    finally:
        if kept is not None:
            path.write_bytes(kept)


_checked = settings(
    suppress_health_check=list(HealthCheck),
    phases=(Phase.reuse, Phase.generate),  # the damage is short as it is, and reading it again takes long
    report_multiple_bugs=False,
)


@pytest.mark.parametrize("kind", KINDS, ids=lambda kind: kind.name)
def test_valid_files_are_read(kind):
    for content in _valid_files(kind):
        _read(kind, content)


@pytest.mark.parametrize(("name", "valid", "damaged"), FOUND)
def test_what_was_found_is_no_internal_error(name, valid, damaged):
    kind = next(each for each in KINDS if each.name == name)
    content = next(each for each in _valid_files(kind) if valid.encode() in each)
    _read(kind, content.replace(valid.encode(), damaged.encode()))


@pytest.mark.parametrize("kind", [each for each in KINDS if each.form], ids=lambda kind: kind.name)
def test_other_values_are_no_internal_error(kind):
    read, written = FORMS[kind.form]
    trees = [read(content) for content in _valid_files(kind)]

    @settings(_checked, max_examples=max(EXAMPLES // kind.cost, 1))
    @given(st.integers(0, len(trees) - 1), damages)
    def check(number, wanted):
        try:
            content = written(damaged(trees[number], wanted))
        except (pa.ArrowException, TypeError, ValueError, LookupError, OverflowError):
            return  # the damage cannot be written in this form
        _read(kind, content)

    check()


@pytest.mark.parametrize("kind", KINDS, ids=lambda kind: kind.name)
def test_damaged_bytes_are_no_internal_error(kind):
    contents = _valid_files(kind)

    @settings(_checked, max_examples=max(EXAMPLES // kind.cost // 2, 1))
    @given(st.integers(0, len(contents) - 1), byte_damages)
    def check(number, wanted):
        _read(kind, damaged_bytes(contents[number], wanted))

    check()
