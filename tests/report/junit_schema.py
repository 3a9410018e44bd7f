"""What junit-10.xsd of Jenkins' xUnit plugin (its release of November 2025) asks of a file."""

import re

_REASON = {"type", "message"}
_ATTRIBUTES = {
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

_REQUIRED = {
    "testsuite": {"name", "tests", "failures", "errors"},
    "testcase": {"name"},
    "property": {"name", "value"},
}
CHILDREN = {
    "testsuites": {"testsuite"},
    "testsuite": {"testsuite", "properties", "testcase", "system-out", "system-err"},
    "testcase": {"skipped", "error", "failure", "system-out", "system-err"},
    "properties": {"property"},
}
_TIME = re.compile(r"(([0-9]{0,3},)*[0-9]{3}|[0-9]{0,3})*(\.[0-9]*)?")


WITH_TEST_PROPERTIES = CHILDREN | {"testcase": CHILDREN["testcase"] | {"properties"}}
"""The one thing in which `junit-properties.xml` goes beyond that schema."""


def check(element, children=CHILDREN):
    """Hold an element, and what is below it, to these rules."""
    assert set(element.attrib) <= _ATTRIBUTES[element.tag]
    assert set(element.attrib) >= _REQUIRED.get(element.tag, set())
    assert _TIME.fullmatch(element.get("time", ""))
    assert {child.tag for child in element} <= children.get(element.tag, set())
    for child in element:
        check(child, children)
