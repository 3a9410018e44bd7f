"""What junit-10.xsd of Jenkins' xUnit plugin (its release of November 2025) asks of a file."""

from __future__ import annotations

import re
from collections.abc import Mapping
from typing import Final
from xml.etree import ElementTree

_REASON: Final = {"type", "message"}
_ATTRIBUTES: Final = {
    "testsuites": {"name", "time", "tests", "failures", "errors"},
    "testsuite": {"name", "tests", "failures", "errors", "group", "time", "skipped", "timestamp", "hostname"}
    | {"id", "package", "file", "log", "url", "version"},
    "testcase": {"name", "time", "classname", "group"},
    "properties": set(),
    "property": {"name", "value"},
    "failure": _REASON,
    "error": _REASON,
    "skipped": _REASON,
    "system-out": set(),
}
"""Attributes that an element can have."""

_REQUIRED: Final = {
    "testsuite": {"name", "tests", "failures", "errors"},
    "testcase": {"name"},
    "property": {"name", "value"},
}
CHILDREN: Final = {
    "testsuites": {"testsuite"},
    "testsuite": {"testsuite", "properties", "testcase", "system-out", "system-err"},
    "testcase": {"skipped", "error", "failure", "system-out", "system-err"},
    "properties": {"property"},
}
_TIME: Final = re.compile(r"(([0-9]{0,3},)*[0-9]{3}|[0-9]{0,3})*(\.[0-9]*)?")


WITH_TEST_PROPERTIES: Final = CHILDREN | {"testcase": CHILDREN["testcase"] | {"properties"}}
"""The one thing in which `junit-properties.xml` goes beyond that schema."""


def check(element: ElementTree.Element, children: Mapping[str, set[str]] = CHILDREN) -> None:
    """Hold an element, and what is below it, to these rules."""
    assert set(element.attrib) <= _ATTRIBUTES[element.tag]
    assert set(element.attrib) >= _REQUIRED.get(element.tag, set())
    assert _TIME.fullmatch(element.get("time", ""))
    assert {child.tag for child in element} <= children.get(element.tag, set())
    for child in element:
        check(child, children)
