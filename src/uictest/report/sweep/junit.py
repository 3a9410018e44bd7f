"""JUnit XML of a sweep: one testcase per value of its first parameter, never one per case."""

from __future__ import annotations

from collections.abc import Iterator
from pathlib import PurePosixPath
from xml.etree import ElementTree

from uictest.judging import evaluation
from uictest.report.escaping import xml_text
from uictest.report.junit_properties import add_suite_properties, add_test_properties
from uictest.report.sweep.result import OutcomeCount, SweepResult


def sweep_junit_xml(result: SweepResult, file: str, *, test_properties: bool = False) -> str:
    """Return the counts of a sweep as a JUnit document; `file` is the sweep file as shown to users.

    Like that of a run it keeps to the schema of Jenkins' xUnit plugin, which has no `file` of a testcase and
    properties only with `test_properties`.
    """
    parameter, counts = next(iter(result.rates.items()))
    root = ElementTree.Element("testsuites")
    suite = ElementTree.SubElement(root, "testsuite", name=xml_text(result.name), tests=str(len(counts)))
    class_name = _class_name(file)
    for count in counts:
        name = xml_text(f"{result.name}[{parameter}={count.value.label}]")
        testcase = ElementTree.SubElement(suite, "testcase", classname=class_name, name=name)
        _add_outcome(testcase, result, count)
        if test_properties:
            add_test_properties(testcase, result.test_case, result.requirements)
    add_suite_properties(suite, evaluation.program_in(result.base), (), result.requirements)
    for name, tag in (("failures", "failure"), ("errors", "error"), ("skipped", "skipped")):
        suite.set(name, str(len(suite.findall(f"testcase/{tag}"))))
    ElementTree.indent(root)
    return f'<?xml version="1.0" encoding="utf-8"?>\n{ElementTree.tostring(root, encoding="unicode")}\n'


def _class_name(file: str) -> str:
    path = PurePosixPath(file).with_suffix("")
    return xml_text(".".join(part for part in path.parts if part not in ("/", "..", ".")))


def _add_outcome(testcase: ElementTree.Element, result: SweepResult, count: OutcomeCount) -> None:
    tag = _child_tag(count)
    if tag is not None:
        lines = [xml_text(line) for line in _explanation(result, count)]
        ElementTree.SubElement(testcase, tag, message=lines[0]).text = "\n".join(lines)


def _child_tag(count: OutcomeCount) -> str | None:
    if count.cases == 0:
        return "skipped"
    if count.outcomes["error"]:
        return "error"
    if count.met < count.cases:
        return "failure"
    return "skipped" if count.outcomes["skipped"] == count.cases else None


def _explanation(result: SweepResult, count: OutcomeCount) -> Iterator[str]:
    yield f"{count.cases - count.met} of {count.cases} cases did not meet their expectation"
    yield ", ".join(f"{name}: {number}" for name, number in count.outcomes.items() if number)
    if result.missed and count.met < count.cases:
        yield "the first of the whole sweep:"
        yield from (f"{case.id}: {case.outcome}, {case.reason}" for case in result.missed)
