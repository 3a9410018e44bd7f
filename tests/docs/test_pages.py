"""What every page keeps to: links and tests that are there, readable lines, nothing left undescribed."""

import ast
import dataclasses
import re
from functools import cache
from pathlib import Path

import pytest
import yaml

from uictest.core.measures import STOP_COLUMNS, WHEELSET_COLUMNS
from uictest.core.series_measures import SERIES_MEASURES
from uictest.judging.evaluation import CaseResult, Verdict
from uictest.plans.scenario.model import Brake, Rail, Record, Rig, Scenario, Simulation
from uictest.rig.model.trace import CAR_CHANNELS, WHEELSET_CHANNELS

REPOSITORY = Path(__file__).parents[2]
LONGEST = 110
_FENCED = re.compile(r"^```.*?^```$", re.MULTILINE | re.DOTALL)
_LINK = re.compile(r"\[[^\]]*\]\(([^)\s]+)\)")


def page_text(name):
    return (REPOSITORY / "docs" / f"{name}.md").read_text("utf-8")


def prose(page):
    return _FENCED.sub("", page.read_text("utf-8"))


def anchors(page):
    """The anchors that GitHub and GitLab give to the headings of a page."""
    headings = re.findall(r"^#+ (.+)$", prose(page), re.MULTILINE)
    kept = (re.sub(r"[^\w\- ]", "", heading.lower()) for heading in headings)
    return {text.strip().replace(" ", "-") for text in kept}


@pytest.mark.parametrize("guide", ["CONTRIBUTING.md", "docs/extending.md"])
def test_every_module_that_contributors_are_led_to_exists(guide):
    modules = {path.as_posix() for path in REPOSITORY.rglob("*.py")}
    named = set(re.findall(r"[\w/]+\.py\b", (REPOSITORY / guide).read_text("utf-8")))
    assert named
    assert [name for name in named if not any(module.endswith(f"/{name}") for module in modules)] == []


def test_every_link_leads_somewhere(page):
    for target in _LINK.findall(prose(page)):
        if target.startswith(("http://", "https://", "mailto:")):
            continue
        name, _, anchor = target.partition("#")
        place = (page.parent / name).resolve() if name else page
        assert place.exists(), target
        assert not anchor or anchor in anchors(place), target


def test_prose_fits_a_window(page):
    lines = [line for line in prose(page).splitlines() if not line.startswith(("|", "<!--"))]
    assert [line for line in lines if len(line) > LONGEST] == []


def test_generated_tables_are_those_of_the_models(page):
    from markup import with_generated
    from refresh import generated

    text = page.read_text("utf-8")
    assert with_generated(text, generated) == text, "run docs/tools/refresh.py"


def test_every_field_of_a_result_and_every_channel_of_a_recording_is_described():
    text = page_text("commands")
    names = {field.name for each in (CaseResult, Verdict) for field in dataclasses.fields(each)}
    # How long the simulation took is not part of a result; the status of a verdict stands at `verdict`.
    names = names - {"duration", "status"} | {"verdict", *STOP_COLUMNS, *WHEELSET_COLUMNS}
    assert {name for name in names if not re.search(rf"`(?:\S*[.])?{name}`", text)} == set()
    channels = [name for name, _ in (*CAR_CHANNELS, *WHEELSET_CHANNELS)]
    assert [name for name in channels if f"`{name}`" not in text] == []


def test_every_key_of_a_scenario_is_named():
    text = page_text("scenarios")
    groups = {"brake": Brake, "rail": Rail, "rig": Rig, "simulation": Simulation, "record": Record}
    keys = {field.alias or name for name, field in Scenario.model_fields.items()} - groups.keys()
    keys |= {f"{group}.{name}" for group, model in groups.items() for name in model.model_fields}
    assert {key for key in keys if f"`{key}`" not in text} == set()


def test_the_definitions_of_the_measures_are_those_of_the_library():
    lines = (REPOSITORY / "docs/parts.md").read_text("utf-8").splitlines()
    file = REPOSITORY / "src/uictest/plans/library/measures/standard.yaml"
    numbers = {key: each for key, each in yaml.safe_load(file.read_text("utf-8")).items() if "value" in each}
    assert numbers
    for key, each in numbers.items():
        assert any(f"`{key}`" in line and each["value"] in line for line in lines), key


def test_every_measure_of_a_series_is_described():
    """A median or worst value has the row of its figure."""
    text = page_text("series")
    names = {
        re.sub("^(median|worst)_", "", name) if measure.has_dry_value else name
        for name, measure in SERIES_MEASURES.items()
    }
    assert {name for name in names if not re.search(rf"^[|].*`{name}`.*[|]", text, re.MULTILINE)} == set()


def test_the_first_screen_shows_the_two_commands():
    first = (REPOSITORY / "README.md").read_text("utf-8").splitlines()[:20]
    assert [line.strip() for line in first if line.startswith("    ")] == ["./demo", "./test"]


def test_how_firm_its_verdicts_are_is_said_of_every_shipped_scenario():
    section = (REPOSITORY / "docs/trust.md").read_text("utf-8").partition("\nShipped verdicts")[2]
    names = {path.name.split(".")[0] for path in REPOSITORY.glob("scenarios/*.yaml")}
    sweeps = {path.name.split(".")[0] for path in REPOSITORY.glob("scenarios/*.sweep.yaml")}
    said = set(re.findall(r"`([\w-]+)`", section.partition("\n## ")[0]))
    assert names - sweeps - said == set()


_TEST = re.compile(r"\[(test_\w+)\]\(([^)]+\.py)\)")


@cache
def names_in(path):
    tree = ast.parse(path.read_text("utf-8"))
    return frozenset(node.name for node in tree.body if isinstance(node, ast.FunctionDef))


def rows(page):
    """Return the cells of every row of the tables of a page but their heads."""
    lines = re.findall(r"^\| (.+) \|$", page.read_text("utf-8"), re.MULTILINE)
    return [[cell.strip() for cell in line.split(" | ")] for line in lines][1:]


REQUIREMENTS, FUNCTIONS = (
    rows(REPOSITORY / "docs" / f"{name}.md") for name in ("requirements", "tool-errors")
)


def test_each_requirement_stands_once_and_has_one_test():
    assert len({requirement for requirement, _ in REQUIREMENTS}) == len(REQUIREMENTS) > 10
    assert [row for row in REQUIREMENTS if len(_TEST.findall(row[1])) != 1 or row[1].count("[") != 1] == []


def test_the_tests_that_are_named_exist(page):
    for name, link in _TEST.findall(page.read_text("utf-8")):
        assert name in names_in((page.parent / link).resolve()), f"no {name} in {link}"


def test_every_function_of_the_tool_says_how_it_could_lie_what_finds_it_and_what_remains():
    assert len(FUNCTIONS) > 15
    assert all(len(row) == 4 and all(row) for row in FUNCTIONS)
    assert [row[0] for row in FUNCTIONS if not _TEST.search(row[2])] == []
