"""Properties of a JUnit suite: which controller from outside its cases were run with."""

from __future__ import annotations

import dataclasses
from collections.abc import Iterable
from xml.etree import ElementTree

from uictest import evaluation
from uictest.report.escaping import xml_text


def program_properties(program: evaluation.Program, told: Iterable[str] = ()) -> ElementTree.Element:
    """Return `controller` and, where known, `controller.kind`, `.source`, `.version` and `.sha256`.

    `told` has the versions that the program said of itself in the cases of the suite, empty where it said
    none. Where its scenario or file states another one, they are `controller.told_version`.
    """
    properties = ElementTree.Element("properties")
    facts = dataclasses.asdict(program.telling(", ".join(filter(None, told))))
    named = {"controller": facts.pop("name"), **{f"controller.{name}": text for name, text in facts.items()}}
    for name, text in named.items():
        if text:
            ElementTree.SubElement(properties, "property", name=name, value=xml_text(text))
    return properties
