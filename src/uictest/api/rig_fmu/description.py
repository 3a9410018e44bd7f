"""What an FMU says about itself: `modelDescription.xml`, a page for people, and a file for programs."""

from __future__ import annotations

import json
from collections.abc import Iterable, Iterator, Sequence
from dataclasses import dataclass
from html import escape
from importlib import metadata
from pathlib import Path
from typing import Final, Literal
from xml.etree import ElementTree

from uictest import __version__
from uictest.api.rig_fmu.variables import VARIABLES, Variable
from uictest.judging import evaluation
from uictest.plans import scenario

FmiVersion = Literal[2, 3]
_UNITS: Final = {
    "s": {"s": 1},
    "m": {"m": 1},
    "m/s": {"m": 1, "s": -1},
    "N": {"kg": 1, "m": 1, "s": -2},
    "N.m": {"kg": 1, "m": 2, "s": -2},
    "Pa": {"kg": 1, "m": -1, "s": -2},
}
"""Unit -> exponents of the base units of the SI."""
_DISPLAYED: Final = {"m/s": ("km/h", "3.6"), "Pa": ("bar", "1e-5")}
"""Unit -> unit that people read, and how many of it one is."""
_LARGEST_SEED: Final = {2: 2**31 - 1, 3: 2**32 - 1}
"""FMI version -> largest whole number that a seed can be."""
_FMI3_TYPES: Final = {"real": "Float64", "boolean": "Boolean", "integer": "Int64"}
_STYLE = "body{font:15px sans-serif;max-width:60em;margin:2em auto}td,th{text-align:left;padding:0 1em 0 0}"
_PACKAGES = ("numba", "llvmlite", "numpy")


@dataclass(frozen=True, slots=True)
class Model:
    """What a model description says of one case.

    Attributes:
        name: for people.
        identifier: name of the shared library, an identifier of C.
        token: ties the model description to the shared library.
        description: one line.
        cycle_time: the only communication step, s.
        longest: longest duration of the stop, s.
        seed: of the sensor noise, unless it is set.
    """

    name: str
    identifier: str
    token: str
    description: str
    cycle_time: float
    longest: float
    seed: int


def model_description(model: Model, version: FmiVersion) -> bytes:
    """Return the XML file. Raises ValueError where the seed is too large for the version."""
    if model.seed > _LARGEST_SEED[version]:
        raise ValueError(
            f"seed {model.seed} is above {_LARGEST_SEED[version]}, the largest whole number of"
            f" FMI {version}.0: choose another with --seed"
        )
    attributes = {
        "fmiVersion": f"{version}.0",
        "modelName": model.name,
        "guid" if version == 2 else "instantiationToken": model.token,
        "description": model.description,
        "version": __version__,
        "generationTool": f"uictest {__version__}",
        "variableNamingConvention": "flat",
    }
    root = ElementTree.Element("fmiModelDescription", attributes)
    _add_capabilities(root, model, version)
    _add_units(root)
    categories = ElementTree.SubElement(root, "LogCategories")
    ElementTree.SubElement(categories, "Category", name="logStatusError", description="Every error")
    experiment = {"startTime": "0", "stopTime": repr(model.longest), "stepSize": repr(model.cycle_time)}
    ElementTree.SubElement(root, "DefaultExperiment", experiment)
    _add_variables(root, model, version)
    _add_structure(root, version)
    ElementTree.indent(root)
    content: bytes = ElementTree.tostring(root, "UTF-8", xml_declaration=True)
    return content + b"\n"


def _add_capabilities(root: ElementTree.Element, model: Model, version: FmiVersion) -> None:
    own = {
        2: {"canGetAndSetFMUstate": "true", "canNotUseMemoryManagementFunctions": "true"},
        3: {"canGetAndSetFMUState": "true", "fixedInternalStepSize": repr(model.cycle_time)},
    }
    capabilities = {
        "modelIdentifier": model.identifier,
        "canHandleVariableCommunicationStepSize": "false",
        "canBeInstantiatedOnlyOncePerProcess": "false",
    }
    ElementTree.SubElement(root, "CoSimulation", capabilities | own[version])


def _add_units(root: ElementTree.Element) -> None:
    definitions = ElementTree.SubElement(root, "UnitDefinitions")
    for name, exponents in _UNITS.items():
        unit = ElementTree.SubElement(definitions, "Unit", name=name)
        ElementTree.SubElement(unit, "BaseUnit", {base: str(power) for base, power in exponents.items()})
        if name in _DISPLAYED:
            shown, factor = _DISPLAYED[name]
            ElementTree.SubElement(unit, "DisplayUnit", name=shown, factor=factor)


def _add_variables(root: ElementTree.Element, model: Model, version: FmiVersion) -> None:
    listed = ElementTree.SubElement(root, "ModelVariables")
    for reference, variable in enumerate(VARIABLES):
        named = {
            "name": variable.name,
            "valueReference": str(reference),
            "description": variable.description,
            **_variability(variable),
        }
        content = {"unit": variable.unit} if variable.unit else {}
        if variable.unit in _DISPLAYED:
            content["displayUnit"] = _DISPLAYED[variable.unit][0]
        if variable.causality == "parameter":
            content |= {"min": "0", "max": str(_LARGEST_SEED[version]), "start": str(model.seed)}
        elif variable.causality == "input":
            content["start"] = "false"
        if version == 2:
            scalar = ElementTree.SubElement(listed, "ScalarVariable", named)
            ElementTree.SubElement(scalar, variable.kind.capitalize(), content)
        else:
            ElementTree.SubElement(listed, _FMI3_TYPES[variable.kind], named | content)


def _variability(variable: Variable) -> dict[str, str]:
    # Everything is held for a controller cycle. What is calculated depends on the seed alone at first.
    if variable.causality == "independent":
        return {"causality": "independent", "variability": "continuous"}
    if variable.causality == "parameter":
        return {"causality": "parameter", "variability": "fixed", "initial": "exact"}
    initial = {"initial": "calculated"} if variable.causality == "output" else {}
    return {"causality": variable.causality, "variability": "discrete", **initial}


def _add_structure(root: ElementTree.Element, version: FmiVersion) -> None:
    # No output depends on a command of the same instant: a loop with a controller can be solved.
    structure = ElementTree.SubElement(root, "ModelStructure")
    outputs = [place for place, variable in enumerate(VARIABLES) if variable.causality == "output"]
    for name in ("Output", "InitialUnknown"):
        unknowns = ElementTree.SubElement(structure, f"{name}s") if version == 2 else structure
        for place in outputs:
            if version == 2:
                ElementTree.SubElement(unknowns, "Unknown", index=str(place + 1), dependencies="")
            else:
                ElementTree.SubElement(unknowns, name, valueReference=str(place), dependencies="")


def documentation(case: scenario.Case, parts: dict[str, evaluation.EffectivePart]) -> bytes:
    """Return `documentation/index.html`."""
    return "\n".join(_page(case, parts)).encode()


def provenance(case: scenario.Case, parts: dict[str, evaluation.EffectivePart]) -> bytes:
    """Return `resources/case.json`: the same for programs."""
    content = {
        "uictest": __version__,
        "case": case.id,
        "cycle_time": float(case.scenario.controller.cycle_time),
        "scenario": case.path.name,
        "parameters": dict(case.parameters),
        "inputs": dict(_files(case)),
        "parts": evaluation.parts_document([parts]),
    }
    return json.dumps(content, indent=1, ensure_ascii=False).encode() + b"\n"


def _page(case: scenario.Case, parts: dict[str, evaluation.EffectivePart]) -> Iterator[str]:
    title = escape(f"Brake rig: {case.id}")
    yield f"<!DOCTYPE html><meta charset='utf-8'><title>{title}</title><style>{_STYLE}</style>"
    yield f"<h1>{title}</h1><p>{escape(case.scenario.title)}</p>"
    cycle = case.scenario.controller.cycle_time.text
    yield (
        f"<p>One stop from {escape(case.scenario.initial_speed.text)}, which begins at the brake command. The"
        f" communication step is the controller cycle, {escape(cycle)}; any other is an error. Outputs do not"
        " depend on inputs of the same instant. After the end of the stop the outputs stay.</p>"
    )
    yield "<h2>Variables</h2>"
    rows = ((each.name, each.causality, each.unit, each.description) for each in VARIABLES)
    yield from _table(("name", "causality", "unit", "description"), rows)
    yield "<h2>Versions</h2>"
    versions = [("uictest", __version__), *((name, metadata.version(name)) for name in _PACKAGES)]
    yield from _table(("program", "version"), versions)
    yield "<h2>Files</h2>"
    yield from _table(("file", "SHA-256"), _files(case))
    for role, part in parts.items():
        yield f"<h2>{escape(role)}: {escape(part.name)}</h2>"
        yield from _table(("key", "value", "mark"), ((p.key, p.written, p.mark) for p in part.parameters))


def _files(case: scenario.Case) -> Iterator[tuple[str, str]]:
    """Yield the files of a case with their SHA-256; a folder of this machine is nobody else's business."""
    for name, digest in case.inputs.items():
        yield (Path(name).name if Path(name).is_absolute() else name), digest


def _table(headings: Sequence[str], rows: Iterable[Sequence[str]]) -> Iterator[str]:
    yield "<table><tr>" + "".join(f"<th>{heading}</th>" for heading in headings) + "</tr>"
    for row in rows:
        yield "<tr>" + "".join(f"<td>{escape(cell)}</td>" for cell in row) + "</tr>"
    yield "</table>"
