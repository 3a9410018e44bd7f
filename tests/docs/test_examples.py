"""Examples are files that load, and console blocks show what the program prints."""

import contextlib
import io
import json
import os
import re
import runpy
import shlex
import subprocess
from itertools import pairwise
from pathlib import Path
from textwrap import dedent
from unittest.mock import patch

import pytest
import yaml
from jsonschema import Draft7Validator

import uictest
from studies.study import STUDIES
from uictest.cli.commands.schema import SchemaKind, schema_text
from uictest.cli.entry import execute
from uictest.plans import library, scenario
from uictest.plans.scenario import Scenario, ScenarioErrors
from uictest.plans.scenario.yaml import Document, parse, plain, read_file, validated
from uictest.plans.series import ValidationFile, load_programme, load_series
from uictest.plans.series.model import SeriesFile
from uictest.plans.sweeps import load_sweep
from uictest.recorded.field_data import load_map
from uictest.rig.bench.recipe import load_bench

from .conftest import pages

REPOSITORY = Path(__file__).parents[2]
SLOW_STUDIES = ("compensation-domain", "field-against-rig")
WORDS = r"""(?:[^|;&<>$`*'"]|"[^"$`\\\\]*"|'[^']*')*"""
CALL = re.compile(
    rf"""(?P<call>(?:uictest|python)\ {WORDS}?)(?P<lost>\ (?:2?>/dev/null|2>&1))?
    (?:\ \|\ (?P<filter>[^;<>]+))?""",
    re.VERBOSE,
)
"""A call of the program, or of a script of the page, with what becomes of its output."""
CODE = 'echo "exit code $?"'
LOOP = re.compile(r"for seed in ([\d ]+); do (.*); done")
KEYS = {
    "brake": "brake: {system: %s}",
    "pad": "brake: {pad: %s}",
    "caliper": "rig: {caliper: %s}",
    "compensation": "rig: {compensation_model: %s}",
    "sensors": "rig: {sensors: %s}",
    "rail": "rail: {condition: %s}",
}


def load_validation_model(path):
    """The page's commands make the recordings that the file names."""
    tree = read_file(path)
    return validated(ValidationFile, plain(tree), tree)


LOADERS = {
    "bench": load_bench,
    "channel-map": lambda path: load_map(str(path)),
    "sweep": load_sweep,
    "series": load_series,
    "programme": load_programme,
    "validation": load_validation_model,
}


def examples(page):
    from markup import blocks

    return list(blocks(page.read_text("utf-8"), "yaml"))


def kind_of(text):
    """What a YAML example is: the word in its schema, empty where it belongs to another program."""
    schema = str(yaml.safe_load(text).get("schema", ""))
    return schema.split("/")[1] if schema.startswith("uictest/") else ""


def test_examples_load(page, tmp_path):
    from consoles import prepare

    prepare(page.read_text("utf-8"), tmp_path)
    for block in examples(page):
        kind = kind_of(block.text)
        if block.file_name.endswith(scenario.SWEEP_SUFFIXES):
            LOADERS["sweep"](tmp_path / block.file_name)
        elif kind == "scenario":
            load_scenario(block, tmp_path)
        elif kind in library.FOLDERS.values():
            load_part(block, kind, tmp_path)
        elif kind:
            LOADERS[kind](tmp_path / block.file_name)
        else:
            assert block.file_name, f"{page.name}:{block.line}: neither ours nor a named file"


def load_scenario(block, folder):
    path = folder / (block.file_name or "example.yaml")
    path.write_text(block.text, "utf-8")
    if "mistakes" in path.name:
        with pytest.raises(ScenarioErrors):
            scenario.load([path])
        return
    assert scenario.load([path])


def load_part(block, kind, folder):
    path = folder / "with-part.yaml"
    key = KEYS.get(kind, f"{kind}: %s") % block.file_name
    path.write_text(f"schema: uictest/scenario/1\nname: with-part\ninitial_speed: 80 km/h\n{key}\n", "utf-8")
    [case] = scenario.load([path])
    assert any(name.endswith(block.file_name) for name in case.inputs)


def fragments(text):
    """The indented blocks of a page that are keys of a scenario or of a series, in the smallest file."""
    outside = re.sub(r"^```.*?^```$", "", text, flags=re.MULTILINE | re.DOTALL)
    for found in re.finditer(r"^\n((?:    .*\n|\n(?=    ))+)", outside, re.MULTILINE):
        try:
            content = content_of(dedent(found[1]))
        except ScenarioErrors:
            continue  # a command, or Python
        for kind, keys, head in FRAMES:
            if isinstance(content, dict) and content.keys() <= keys:
                yield kind, {"schema": f"uictest/{kind}/1", "name": "m", **head, **content}
                break


def keys_of(model):
    return {field.alias or name for name, field in model.model_fields.items()}


FRAMES = (("scenario", keys_of(Scenario), {"initial_speed": "120 km/h"}), ("series", keys_of(SeriesFile), {}))


def content_of(text):
    """What the program reads, as JSON has it: an editor that follows YAML 1.2 reads the same."""
    return json.loads(json.dumps(plain(parse(Document("block.yaml", Path(), text)))))


def is_valid(kind, content):
    return Draft7Validator(json.loads(schema_text(SchemaKind(kind)))).is_valid(content)


def loads_as(kind, content, folder):
    """Whether the program accepts a file in a folder that lacks what it names."""
    if "vary" in content:
        content = merged(content, {"vary": {"matrix": {"rail.friction": [0.1, 0.2]}}})
    ending, load = ".yaml", lambda path: scenario.load([path])
    if "vary" in content or kind == "series":
        ending, load = (".sweep.yaml", load_sweep) if "vary" in content else (".series.yaml", load_series)
    path = folder / f"file{ending}"
    path.write_text(json.dumps(content), "utf-8")
    try:
        load(path)
    except ScenarioErrors as errors:
        return all("no such file" in each.message for each in errors.diagnostics)
    return True


def merged(one, other):
    both = one.keys() & other.keys()
    return {**one, **other, **{key: merged(one[key], other[key]) for key in both}}


def test_schemas_and_the_program_agree_on_what_pages_show(page, tmp_path):
    for block in examples(page):
        if kind := kind_of(block.text):
            # All others load: test_examples_load.
            assert is_valid(kind, content_of(block.text)) is ("mistakes" not in block.file_name), block.line
    for kind, content in fragments(page.read_text("utf-8")):
        assert is_valid(kind, content), content
        assert loads_as(kind, content, tmp_path), content


def test_fragments_are_found():
    found = [kind for each in pages() for kind, _ in fragments(each.read_text("utf-8"))]
    assert found.count("scenario") >= 15
    assert "series" in found


def is_of_slow_study(block):
    """Whether a console block runs a study whose bands are judged among the slow tests."""
    return any(f"./reproduce {each}" in block.text for each in SLOW_STUDIES)


def commands_of(line):
    """The commands of a line, one after the other."""
    loop = LOOP.fullmatch(line)
    if loop is None:
        return line.split("; ")
    return [each for seed in loop[1].split() for each in commands_of(loop[2].replace("$seed", seed))]


def output_of(line, folder):
    """What a line of a page prints: ours and its scripts in this process, what else there is in a shell."""
    from consoles import in_shell

    shown, code = "", 0
    for command in commands_of(line):
        call = CALL.fullmatch(command)
        if command == CODE:
            shown += f"exit code {code}\n"
        elif call is None:
            shown += in_shell(command, folder)
        else:
            text, code = called(call, folder)
            shown += text
    return shown


def called(call, folder):
    """What a call of ours shows, and its exit code."""
    from consoles import environment

    shown = io.StringIO()
    out = io.StringIO() if call["filter"] else shown
    lost = (call["lost"] or "").strip()
    with (
        contextlib.chdir(folder),
        patch.dict(os.environ, environment(), clear=True),
        contextlib.redirect_stdout(io.StringIO() if lost == ">/dev/null" else out),
        contextlib.redirect_stderr({"2>/dev/null": io.StringIO(), "2>&1": out}.get(lost, shown)),
    ):
        program, *arguments = shlex.split(call["call"])
        code = 0
        if program == "python":
            runpy.run_path(arguments[0], run_name="__main__")
        else:
            code = int(execute(arguments))
        if call["filter"]:
            done = subprocess.run(
                call["filter"], shell=True, input=out.getvalue(), capture_output=True, text=True, check=False
            )
            shown.write(done.stdout + done.stderr)
    return shown.getvalue(), code


def check_consoles(page, folder, chosen):
    """Run the console blocks of a page that are chosen, and compare what they print with the page."""
    from consoles import executed, prepare, shape
    from markup import blocks

    text = page.read_text("utf-8")
    prepare(text, folder)
    for block in filter(chosen, blocks(text, "console")):
        assert shape(executed(block, folder, output_of)) == shape(block.text), "run docs/tools/refresh.py"


def test_console_blocks_show_what_the_program_prints(page, tmp_path):
    """Up to the digits: figures move with calibration, and docs/tools/refresh.py renews them.

    Blocks of studies that take long are compared among the slow tests; the one with all studies to the digit
    by tests/studies/test_claims.py.
    """
    check_consoles(
        page, tmp_path, lambda block: not ("./reproduce -q" in block.text or is_of_slow_study(block))
    )


def test_console_blocks_of_slow_studies_show_their_quantities():
    from markup import blocks

    page = (REPOSITORY / "docs" / "studies.md").read_text("utf-8")
    shown = [block.text for block in blocks(page, "console") if is_of_slow_study(block)]
    assert shown
    for text in shown:
        [study] = (study for name, study in STUDIES.items() if f"reproduce {name}" in text)
        [_, *values] = text.splitlines()
        assert values
        for value in values:
            assert any(f"  {quantity.title}: paper " in value for quantity in study.quantities), value


@pytest.mark.slow
def test_console_blocks_of_slow_studies_show_what_the_program_prints(tmp_path):
    check_consoles(REPOSITORY / "docs" / "studies.md", tmp_path, is_of_slow_study)


def test_the_verdict_by_hand_adds_up_from_the_speeds_of_the_stop():
    """The speeds of the page are those of the stop; trapezoids over them give its distance."""
    page = (REPOSITORY / "docs" / "trust.md").read_text("utf-8").partition("### A verdict by hand")[2]
    speeds = [float(each) for each in re.search(r"\n\n((?:    [\d. ]+\n)+)", page)[1].split()]
    stop = uictest.simulate("dry-120")
    assert speeds == pytest.approx(list(3.6 * stop["speed"][::100][: len(speeds)]), abs=0.051)
    area = sum((a + b) / 7.2 for a, b in pairwise(speeds)) + speeds[-1] / 7.2 * (27.85 - len(speeds) + 1)
    assert f"add up to {area:.1f} m" in " ".join(page.split())
