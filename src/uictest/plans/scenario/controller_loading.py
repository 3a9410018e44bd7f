"""The controller that somebody names on a command line: a program, a part, a scenario or a name."""

import ast
from collections.abc import Sequence
from pathlib import Path
from typing import Any

from uictest.plans.scenario.files import Files, Roots
from uictest.plans.scenario.loading import load
from uictest.plans.scenario.parts.external_controller import ControllerPart
from uictest.plans.scenario.program_files import KIND_OF_ENDING, SOCKET
from uictest.plans.scenario.references import Parts, is_path
from uictest.plans.scenario.resolution import PART_KEYS
from uictest.plans.scenario.yaml import (
    SCENARIO_SCHEMA,
    Document,
    Entry,
    Map,
    Place,
    Scalar,
    display_name,
    is_file,
    quoted,
    single_error,
    unreadable_error,
    whole_file,
)


def load_controller(reference: str, class_name: str = "", trusted: Sequence[Path] = ()) -> ControllerPart:
    """The controller that ``reference`` names.

    Args:
        reference: a part file or a scenario file, the file of a program, the address of a socket, or the name
            of a controller of the library or of an installed package.
        class_name: class in a Python file; where it has one controller alone this may be left out.
        trusted: folders that may be read besides those of the files given and the working folder.

    Raises:
        ScenarioErrors: when there is none, or a scenario has cases with several.
    """
    path = Path(reference)
    if is_path(reference) and is_file(path):
        return _of_yaml(path, trusted)
    parts = Parts(Files(Roots.of([path], trusted)))
    model = PART_KEYS["controller",].model
    controller: ControllerPart = parts.resolve(_node(reference, path, class_name), model, ()).part
    return controller


def _of_yaml(path: Path, trusted: Sequence[Path]) -> ControllerPart:
    files = Files(Roots.of([path], trusted))
    schema = files.at(path).get("schema")
    if isinstance(schema, Scalar) and schema.value == SCENARIO_SCHEMA:
        return _of_scenario(path, trusted)
    name = Scalar(path.name, path.name, Place(Document(str(path), path.parent, path.name)))
    controller: ControllerPart = Parts(files).resolve(name, PART_KEYS["controller",].model, ()).part
    return controller


def _of_scenario(path: Path, trusted: Sequence[Path]) -> ControllerPart:
    first, *others = [case.scenario.controller for case in load([path], trusted=trusted)]
    if any(other != first for other in others):
        hint = "name the file of one of them"
        raise single_error(whole_file(path), "its cases have different controllers", "controller", hint)
    return first


def _node(reference: str, path: Path, class_name: str) -> Any:
    """Return what a scenario would have at `controller`."""
    place = Place(Document(display_name(path), path.parent, reference))
    kind = "connect" if reference.startswith(SOCKET) else KIND_OF_ENDING.get(path.suffix.lower())
    if kind is None:
        return Scalar(reference, reference, place)
    text = reference if kind == "connect" else path.name
    entries = {kind: Entry(place, Scalar(text, text, place))}
    if kind == "python":
        name = class_name or _only_controller(path)
        entries["class"] = Entry(place, Scalar(name, name, place))
    return Map(entries, place)


def _only_controller(path: Path) -> str:
    """Return the class of a Python file that has a method `step`; the file is read, not run."""
    try:
        module = ast.parse(path.read_bytes(), path.name)
    except OSError as error:
        raise unreadable_error(whole_file(path), error) from None
    except (SyntaxError, ValueError) as error:
        raise single_error(whole_file(path), f"not Python: {error}") from None
    names = [each.name for each in module.body if isinstance(each, ast.ClassDef) and _steps(each)]
    if len(names) != 1:
        listed = ", ".join(map(quoted, names)) or "none"
        message = f"which class is the controller? Those with a method step: {listed}"
        raise single_error(whole_file(path), message, hint="name it with --class")
    return names[0]


def _steps(definition: ast.ClassDef) -> bool:
    return any(isinstance(each, ast.FunctionDef) and each.name == "step" for each in definition.body)
