"""The version that a program's file states, read without running anything of it."""

import ast
import io
import zipfile
from collections.abc import Callable, Iterator, Mapping
from contextlib import suppress
from types import MappingProxyType
from typing import Any, Final

from uictest.controllers import shown_version
from uictest.plans.scenario.python_statements import UNPARSABLE, texts_beginning_with

_FMU_DESCRIPTION: Final = "modelDescription.xml"
_BEGINNING: Final = 65536
"""Bytes of an FMU's description that are read: its first element states the version."""


def stated_version(kind: str, content: bytes) -> str:
    """Return the version that the file of a controller states, empty where it states none.

    `kind` is the key that names the file: `__version__ = "..."` of a Python file is found in its text, that
    of an FMU in its description. A library would have to be loaded.
    """
    return shown_version(_READERS[kind](content)) if kind in _READERS else ""


def _of_python(content: bytes) -> str:
    versions = map(_assigned_version, _version_statements(content))
    return next((text for text in versions if text is not None), "")


def _version_statements(content: bytes) -> Iterator[ast.stmt]:
    for each in texts_beginning_with("__version__", content):
        with suppress(*UNPARSABLE):
            yield from each.statements()


def _assigned_version(statement: ast.stmt) -> str | None:
    if not isinstance(statement, ast.Assign | ast.AnnAssign) or not isinstance(statement.value, ast.Constant):
        return None
    targets = statement.targets if isinstance(statement, ast.Assign) else [statement.target]
    names = [target.id for target in targets if isinstance(target, ast.Name)]
    text = statement.value.value
    return text if "__version__" in names and isinstance(text, str) else None


def _of_fmu(content: bytes) -> str:
    try:
        with zipfile.ZipFile(io.BytesIO(content)) as archive, archive.open(_FMU_DESCRIPTION) as file:
            return _attribute_of_first_element(file.read(_BEGINNING), "version")
    except Exception:  # a library that meets a damaged file may raise anything; who loads the FMU says so
        return ""


def _attribute_of_first_element(xml: bytes, name: str) -> str:
    from xml.etree import ElementTree

    parser: Any = ElementTree.XMLPullParser(["start"])
    parser.feed(xml)
    first = next(iter(parser.read_events()), None)
    return "" if first is None else str(first[1].get(name, ""))


_READERS: Final[Mapping[str, Callable[[bytes], str]]] = MappingProxyType(
    {"python": _of_python, "fmu": _of_fmu}
)
