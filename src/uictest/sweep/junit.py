"""JUnit XML of a sweep: one testcase per value of its first parameter, never one per case."""

from __future__ import annotations

from collections.abc import Iterator
from pathlib import PurePosixPath
from xml.etree import ElementTree

from uictest.report import xml_text
from uictest.sweep.summaries.tally import OutcomeCount, Tally


def junit_xml(tally: Tally) -> str:
    """Return the counts of a sweep as a JUnit document.

    Like that of a run it keeps to the schema of Jenkins' xUnit plugin, which knows no `file` of a testcase.
    """
    key = next(iter(tally.classes))
    counts = tally.by_class(key)
    root = ElementTree.Element("testsuites")
    suite = ElementTree.SubElement(root, "testsuite", name=xml_text(tally.plan.name), tests=str(len(counts)))
    suite.extend(_testcase(tally, key, count) for count in counts)
    for name, tag in (("failures", "failure"), ("errors", "error"), ("skipped", "skipped")):
        suite.set(name, str(len(suite.findall(f"testcase/{tag}"))))
    ElementTree.indent(root)
    return f'<?xml version="1.0" encoding="utf-8"?>\n{ElementTree.tostring(root, encoding="unicode")}\n'


def _testcase(tally: Tally, key: str, count: OutcomeCount) -> ElementTree.Element:
    path = PurePosixPath(tally.plan.file).with_suffix("")
    dotted = ".".join(part for part in path.parts if part not in ("/", "..", "."))
    name = xml_text(f"{tally.plan.name}[{key}={count.label}]")
    element = ElementTree.Element("testcase", classname=xml_text(dotted), name=name)
    tag = _child_tag(count)
    if tag is not None:
        lines = [xml_text(line) for line in _explanation(tally, count)]
        ElementTree.SubElement(element, tag, message=lines[0]).text = "\n".join(lines)
    return element


def _child_tag(count: OutcomeCount) -> str | None:
    if count.cases == 0:
        return "skipped"
    if count.outcomes["error"]:
        return "error"
    return None if count.met == count.cases else "failure"


def _explanation(tally: Tally, count: OutcomeCount) -> Iterator[str]:
    yield f"{count.cases - count.met} of {count.cases} cases did not meet their expectation"
    yield ", ".join(f"{name}: {number}" for name, number in count.outcomes.items() if number)
    if tally.missed and count.met < count.cases:
        yield "the first of the whole sweep:"
        yield from (f"{name}: {outcome}, {reason}" for name, outcome, reason in tally.missed)
