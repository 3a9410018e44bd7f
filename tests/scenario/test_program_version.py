"""The version that the file of a program states, found without a syntax tree of the whole file."""

import io
import zipfile

import pytest

from uictest.plans.scenario.program_files import stated_version

ROWS = [
    ('__version__ = "1.2"\n', "1.2"),
    ('"""Text\n__version__ = "no"\n"""\n__version__: str = (\n    "4.2"  # ours\n)\nx = 1\n', "4.2"),
    ("'''\n__version__ = 'no'\n'''\n", ""),
    ('x = "\\"" # "\n__version__ = title = "7"\n', "7"),
    ("# '''\n__version__ = '3'\n", "3"),
    ("def f():\n    __version__ = '1'\n", ""),
    ("__version__ = '1' if x else '2'\n__version__ = '5'\n", "5"),
    ("__version__ = (\n__version__ = '6'\n", "6"),
    ("__version__ = 1\n", ""),
    ("__versions__ = '1'\n", ""),
    ("__version__ = '" + "9" * 100_000, ""),
    ("__version__ += '1'\n\x00", ""),
]


@pytest.mark.parametrize(("text", "version"), ROWS)
def test_the_version_of_a_python_file(text: str, version: str) -> None:
    assert stated_version("python", text.encode()) == version


@pytest.mark.parametrize("encoding", ["x-unknown", "utf-7", "base64"])
def test_an_fmu_with_an_encoding_that_nobody_knows_states_none(encoding: str) -> None:
    content = io.BytesIO()
    with zipfile.ZipFile(content, "w") as archive:
        head = f'<?xml version="1.0" encoding="{encoding}"?><fmiModelDescription version="2"/>'
        archive.writestr("modelDescription.xml", head)
    assert stated_version("fmu", content.getvalue()) == ""
