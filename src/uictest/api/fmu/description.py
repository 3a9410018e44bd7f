"""What an FMU says about itself: `modelDescription.xml` for programs, and the frame of a page for people."""

from __future__ import annotations

from collections.abc import Iterable, Iterator, Sequence
from dataclasses import dataclass, replace
from html import escape
from typing import Any, Final, Literal
from xml.etree import ElementTree

from uictest import __version__

FmiVersion = Literal[2, 3]
_UNITS: Final = {
    "s": {"s": 1},
    "m": {"m": 1},
    "m/s": {"m": 1, "s": -1},
    "m/s2": {"m": 1, "s": -2},
    "N": {"kg": 1, "m": 1, "s": -2},
    "N.m": {"kg": 1, "m": 2, "s": -2},
    "Pa": {"kg": 1, "m": -1, "s": -2},
}
"""Unit -> exponents of the base units of the SI."""
_DISPLAYED: Final = {"m/s": ("km/h", "3.6"), "Pa": ("bar", "1e-5")}
"""Unit -> unit that people read, and how many of it one is."""
_FMI3_TYPES: Final = {"real": "Float64", "boolean": "Boolean", "integer": "Int64"}
_STYLE = "body{font:15px sans-serif;max-width:60em;margin:2em auto}td,th{text-align:left;padding:0 1em 0 0}"


@dataclass(frozen=True, slots=True)
class Model:
    """Contents of a model description.

    Attributes:
        name: for people.
        identifier: name of the shared library, an identifier of C.
        description: one line.
        version: of what is modelled, empty if not known.
        variables: in the order of their value references, from 0.
        token: ties the model description to what the shared library reads; empty until that is known.
        cycle_time: the only communication step, s; None where a parameter states it.
        longest: longest duration of a simulation, s; None for any.
        can_save: whether the state can be saved and restored.
    """

    name: str
    identifier: str
    description: str
    version: str
    variables: Sequence[Variable]
    token: str = ""
    cycle_time: float | None = None
    longest: float | None = None
    can_save: bool = False


def model_description(model: Model, version: FmiVersion) -> bytes:
    """Return the XML file."""
    attributes = {
        "fmiVersion": f"{version}.0",
        "modelName": model.name,
        "guid" if version == 2 else "instantiationToken": model.token,
        "description": model.description,
        **({"version": model.version} if model.version else {}),
        "generationTool": f"uictest {__version__}",
        "variableNamingConvention": "flat",
    }
    root = ElementTree.Element("fmiModelDescription", attributes)
    _add_capabilities(root, model, version)
    _add_units(root, model)
    categories = ElementTree.SubElement(root, "LogCategories")
    ElementTree.SubElement(categories, "Category", name="logStatusError", description="Every error")
    if model.cycle_time is not None:
        experiment = {"startTime": "0", "stopTime": repr(model.longest), "stepSize": repr(model.cycle_time)}
        ElementTree.SubElement(root, "DefaultExperiment", experiment)
    _add_variables(root, model, version)
    _add_structure(root, model, version)
    ElementTree.indent(root)
    content: bytes = ElementTree.tostring(root, "UTF-8", xml_declaration=True)
    return content + b"\n"


def _add_capabilities(root: ElementTree.Element, model: Model, version: FmiVersion) -> None:
    own = {"canGetAndSetFMUstate" if version == 2 else "canGetAndSetFMUState": str(model.can_save).lower()}
    if version == 2:
        own["canNotUseMemoryManagementFunctions"] = "true"
    elif model.cycle_time is not None:
        own["fixedInternalStepSize"] = repr(model.cycle_time)
    capabilities = {
        "modelIdentifier": model.identifier,
        "canHandleVariableCommunicationStepSize": "false",
        "canBeInstantiatedOnlyOncePerProcess": "false",
    }
    ElementTree.SubElement(root, "CoSimulation", capabilities | own)


def _add_units(root: ElementTree.Element, model: Model) -> None:
    used = {variable.unit: () for variable in model.variables if variable.unit}
    definitions = ElementTree.SubElement(root, "UnitDefinitions")
    for name in (*(name for name in _UNITS if name in used), *(name for name in used if name not in _UNITS)):
        unit = ElementTree.SubElement(definitions, "Unit", name=name)
        if name in _UNITS:  # a controller declares its parameters in units of its own
            ElementTree.SubElement(
                unit, "BaseUnit", {base: str(exponent) for base, exponent in _UNITS[name].items()}
            )
        if name in _DISPLAYED:
            displayed, factor = _DISPLAYED[name]
            ElementTree.SubElement(unit, "DisplayUnit", name=displayed, factor=factor)


def _add_variables(root: ElementTree.Element, model: Model, version: FmiVersion) -> None:
    listed = ElementTree.SubElement(root, "ModelVariables")
    for reference, variable in enumerate(model.variables):
        named = {
            "name": variable.name,
            "valueReference": str(reference),
            "description": variable.description,
            **_variability(variable),
        }
        content = {"unit": variable.unit} if variable.unit else {}
        if variable.unit in _DISPLAYED:
            content["displayUnit"] = _DISPLAYED[variable.unit][0]
        if variable.range is not None:
            content |= {"min": repr(variable.range[0]), "max": repr(variable.range[1])}
        if variable.start:
            content["start"] = variable.start
        if version == 2:
            scalar = ElementTree.SubElement(listed, "ScalarVariable", named)
            ElementTree.SubElement(scalar, variable.kind.capitalize(), content)
        else:
            ElementTree.SubElement(listed, _FMI3_TYPES[variable.kind], named | content)


def _variability(variable: Variable) -> dict[str, str]:
    # Everything is held for a controller cycle. What is calculated depends on parameters alone at first.
    if variable.causality == "independent":
        return {"causality": "independent", "variability": "continuous"}
    if variable.causality == "parameter":
        return {"causality": "parameter", "variability": "fixed", "initial": "exact"}
    initial = {"initial": "calculated"} if variable.causality == "output" else {}
    return {"causality": variable.causality, "variability": "discrete", **initial}


def _add_structure(root: ElementTree.Element, model: Model, version: FmiVersion) -> None:
    # No output depends on an input of the same instant: a loop of rig and controller can be solved.
    structure = ElementTree.SubElement(root, "ModelStructure")
    outputs = [index for index, variable in enumerate(model.variables) if variable.causality == "output"]
    for name in ("Output", "InitialUnknown"):
        unknowns = ElementTree.SubElement(structure, f"{name}s") if version == 2 else structure
        for index in outputs:
            if version == 2:
                ElementTree.SubElement(unknowns, "Unknown", index=str(index + 1), dependencies="")
            else:
                ElementTree.SubElement(unknowns, name, valueReference=str(index), dependencies="")


def page(title: str, *parts: str) -> bytes:
    """Return `documentation/index.html`."""
    escaped = escape(title)
    head = f"<!DOCTYPE html><meta charset='utf-8'><title>{escaped}</title><style>{_STYLE}</style>"
    return "\n".join((head, f"<h1>{escaped}</h1>", *parts)).encode()


def table(headings: Sequence[str], rows: Iterable[Sequence[str]]) -> Iterator[str]:
    """Yield the lines of a table."""
    yield "<table><tr>" + "".join(f"<th>{heading}</th>" for heading in headings) + "</tr>"
    for row in rows:
        yield "<tr>" + "".join(f"<td>{escape(cell)}</td>" for cell in row) + "</tr>"
    yield "</table>"


def table_of_variables(variables: Sequence[Variable]) -> Iterator[str]:
    """Yield the lines of a table that says what each variable is."""
    yield "<h2>Variables</h2>"
    rows = (
        (variable.name, variable.causality, variable.unit, variable.description) for variable in variables
    )
    yield from table(("name", "causality", "unit", "description"), rows)


@dataclass(frozen=True, slots=True)
class Variable:
    """One variable of an FMU.

    Attributes:
        name: in the model description.
        path: dotted, of its field in the memory of an instance.
        description: one line.
        unit: empty for a pure number.
        kind: of value.
        causality: as FMI has it.
        wheelset: which of several values in the field it is, from 0.
        start: value before anybody sets it, as FMI writes it; empty for what is calculated.
        range: smallest and largest value of a parameter; None where any is accepted.
    """

    name: str
    path: str
    description: str
    unit: str = ""
    kind: Literal["real", "boolean", "integer"] = "real"
    causality: Literal["independent", "input", "output", "parameter"] = "output"
    wheelset: int = 0
    start: str = ""
    range: tuple[float, float] | None = None


def of_wheelsets(*variables: Variable) -> Iterator[Variable]:
    """Yield each variable four times, numbered from 1."""
    for variable in variables:
        for number in range(1, 5):
            name, description = f"{variable.name}_{number}", f"{variable.description}, wheelset {number}"
            yield replace(variable, name=name, description=description, wheelset=number - 1)


def place_of(memory: Any, path: str, wheelset: int = 0) -> tuple[int, str]:
    """Return offset and storage of a field; of several, in an array of numbers or of records, one."""
    layout, offset = memory, 0
    for name in path.split("."):
        if layout.subdtype is not None:  # an array of records: as many records as there are wheelsets, or one
            record, shape = layout.subdtype
            offset += (wheelset if shape[-1] > 1 else 0) * record.itemsize
            layout = record
        layout, offset = layout.fields[name][0], offset + layout.fields[name][1]
    if layout.subdtype is not None:
        layout = layout.subdtype[0]
        offset += wheelset * layout.itemsize
    return offset, layout.str[1:]
