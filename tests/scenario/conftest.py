"""A folder to write scenario files into, which is also the working folder."""

import io
import re
import zipfile

import pytest

from uictest.plans.scenario import ScenarioErrors, load

HEAD = "schema: uictest/scenario/1\nname: stop\ninitial_speed: 120 km/h\n"
"""The least that a scenario says; three lines, so that what a test adds starts in line 4."""


def refusals(table):
    """The rows of a table: what a file says and, below it after arrows, what is told of its error."""
    found = re.findall(r"((?:(?!->).*\n)+)((?:-> .*\n)+)", table)
    return [
        (says.removesuffix("\n"), *map(str.strip, re.split(r"-> |\|", error)[1:])) for says, error in found
    ]


@pytest.fixture
def head():
    return HEAD


@pytest.fixture
def loaded(write):
    """The cases of a scenario given as text."""

    def _loaded(content, *overrides, seed=None):
        return load([write("stop.yaml", content)], overrides, seed)

    return _loaded


@pytest.fixture
def case(loaded, head):
    """The stop of `head`, which a module may replace, changed by `key=value` overrides."""
    return lambda *overrides: loaded(head, *overrides)[0]


@pytest.fixture
def refused(write):
    """The diagnostics of a scenario that must be refused."""

    def _refused(content, *overrides):
        with pytest.raises(ScenarioErrors) as caught:
            load([write("stop.yaml", content)], overrides)
        return caught.value.diagnostics

    return _refused


@pytest.fixture(scope="session")
def fmu():
    """An FMU that holds nothing but its description."""

    def _fmu(description):
        content = io.BytesIO()
        with zipfile.ZipFile(content, "w") as archive:
            archive.writestr("modelDescription.xml", description)
        return content.getvalue()

    return _fmu
