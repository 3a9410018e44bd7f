"""`modelDescription.xml` of FMI 2.0 and FMI 3.0."""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import dataclass
from typing import Final, Literal
from xml.etree import ElementTree

from uictest import __version__
from uictest.api.rig_fmu.variables import Variable, variables

FmiVersion = Literal[2, 3]
_TOOL: Final = f"uictest {__version__}"
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
    root = _WRITERS[version](model)
    ElementTree.indent(root)
    content: bytes = ElementTree.tostring(root, "UTF-8", xml_declaration=True)
    return content + b"\n"


def _common(model: Model, version: FmiVersion, token: str) -> ElementTree.Element:
    return ElementTree.Element(
        "fmiModelDescription",
        {
            "fmiVersion": f"{version}.0",
            "modelName": model.name,
            token: model.token,
            "description": model.description,
            "version": __version__,
            "generationTool": _TOOL,
            "variableNamingConvention": "flat",
        },
    )


def _capabilities(model: Model, state: str) -> dict[str, str]:
    return {
        "modelIdentifier": model.identifier,
        "canHandleVariableCommunicationStepSize": "false",
        "canBeInstantiatedOnlyOncePerProcess": "false",
        state: "true",
    }


def _add_units(root: ElementTree.Element) -> None:
    definitions = ElementTree.SubElement(root, "UnitDefinitions")
    for name, exponents in _UNITS.items():
        unit = ElementTree.SubElement(definitions, "Unit", name=name)
        ElementTree.SubElement(unit, "BaseUnit", {base: str(power) for base, power in exponents.items()})
        if name in _DISPLAYED:
            shown, factor = _DISPLAYED[name]
            ElementTree.SubElement(unit, "DisplayUnit", name=shown, factor=factor)


def _add_experiment(root: ElementTree.Element, model: Model) -> None:
    categories = ElementTree.SubElement(root, "LogCategories")
    ElementTree.SubElement(categories, "Category", name="logStatusError", description="Every error")
    ElementTree.SubElement(
        root,
        "DefaultExperiment",
        startTime="0",
        stopTime=repr(model.longest),
        stepSize=repr(model.cycle_time),
    )


def _named(reference: int, variable: Variable) -> dict[str, str]:
    described = {"description": variable.description}
    return {"name": variable.name, "valueReference": str(reference), **described}


def _start(variable: Variable, model: Model) -> dict[str, str]:
    if variable.causality == "input":
        return {"start": "false"}
    return {"start": str(model.seed)} if variable.causality == "parameter" else {}


def _unit(variable: Variable) -> dict[str, str]:
    shown = {"displayUnit": _DISPLAYED[variable.unit][0]} if variable.unit in _DISPLAYED else {}
    return {"unit": variable.unit, **shown} if variable.unit else {}


def _variability(variable: Variable) -> dict[str, str]:
    # Everything is held for a controller cycle. What is calculated depends on the seed alone at first.
    if variable.causality == "independent":
        return {"causality": "independent", "variability": "continuous"}
    if variable.causality == "parameter":
        return {"causality": "parameter", "variability": "fixed", "initial": "exact"}
    initial = {"initial": "calculated"} if variable.causality == "output" else {}
    return {"causality": variable.causality, "variability": "discrete", **initial}


def _range(version: FmiVersion, variable: Variable) -> dict[str, str]:
    return {"min": "0", "max": str(_LARGEST_SEED[version])} if variable.causality == "parameter" else {}


def _fmi2(model: Model) -> ElementTree.Element:
    root = _common(model, 2, "guid")
    own = {"canNotUseMemoryManagementFunctions": "true"}
    ElementTree.SubElement(root, "CoSimulation", _capabilities(model, "canGetAndSetFMUstate") | own)
    _add_units(root)
    _add_experiment(root, model)
    listed = ElementTree.SubElement(root, "ModelVariables")
    for reference, variable in enumerate(variables()):
        attributes = _named(reference, variable) | _variability(variable)
        scalar = ElementTree.SubElement(listed, "ScalarVariable", attributes)
        content = _unit(variable) | _range(2, variable) | _start(variable, model)
        ElementTree.SubElement(scalar, variable.kind.capitalize(), content)
    structure = ElementTree.SubElement(root, "ModelStructure")
    for name in ("Outputs", "InitialUnknowns"):
        unknowns = ElementTree.SubElement(structure, name)
        for place in _outputs():
            # No output depends on a command of the same instant: a loop with a controller can be solved.
            ElementTree.SubElement(unknowns, "Unknown", index=str(place + 1), dependencies="")
    return root


_FMI3_TYPES: Final = {"real": "Float64", "boolean": "Boolean", "integer": "Int64"}


def _fmi3(model: Model) -> ElementTree.Element:
    root = _common(model, 3, "instantiationToken")
    own = {"fixedInternalStepSize": repr(model.cycle_time)}
    ElementTree.SubElement(root, "CoSimulation", _capabilities(model, "canGetAndSetFMUState") | own)
    _add_units(root)
    _add_experiment(root, model)
    listed = ElementTree.SubElement(root, "ModelVariables")
    for reference, variable in enumerate(variables()):
        content = _unit(variable) | _range(3, variable) | _start(variable, model)
        attributes = _named(reference, variable) | _variability(variable) | content
        ElementTree.SubElement(listed, _FMI3_TYPES[variable.kind], attributes)
    structure = ElementTree.SubElement(root, "ModelStructure")
    for name in ("Output", "InitialUnknown"):
        for place in _outputs():
            ElementTree.SubElement(structure, name, valueReference=str(place), dependencies="")
    return root


def _outputs() -> list[int]:
    return [place for place, variable in enumerate(variables()) if variable.causality == "output"]


_WRITERS: Final[dict[FmiVersion, Callable[[Model], ElementTree.Element]]] = {2: _fmi2, 3: _fmi3}
