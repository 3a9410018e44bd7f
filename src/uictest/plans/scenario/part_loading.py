"""Parts that somebody names on a command line: by a file or in the library; a controller by its program."""

import ast
from collections.abc import Sequence
from pathlib import Path
from typing import Any

from uictest.plans.scenario.files import Files, Roots
from uictest.plans.scenario.loading import load
from uictest.plans.scenario.parts.external_controller import ControllerPart
from uictest.plans.scenario.program_files import KIND_OF_ENDING, SOCKET
from uictest.plans.scenario.references import Parts, folder_of, is_path
from uictest.plans.scenario.resolution import PART_KEYS, PART_KINDS
from uictest.plans.scenario.yaml import (
    COMMAND_LINE,
    SCENARIO_SCHEMA,
    Document,
    Entry,
    Map,
    Part,
    Place,
    Scalar,
    display_name,
    is_file,
    quoted,
    single_error,
    unreadable_error,
    whole_file,
)


def load_part(reference: str) -> Part:
    """The library part called ``folder/name``, e.g. ``vehicles/intercity-180``.

    Raises ScenarioErrors when there is none, KeyError when there is no such folder.
    """
    folder, _, name = reference.partition("/")
    models = {folder_of(each.model): each.model for each in PART_KEYS.values()}
    if folder not in models:
        raise KeyError(folder)
    place = Place(Document(reference, Path(), reference), 1, len(folder) + 2)
    part: Part = Parts(Files()).part(Scalar(name, name, place), models[folder], (folder,)).part
    return part


def load_part_file(path: Path, trusted: Sequence[Path] = ()) -> Part:
    """The part that a file describes, of any kind.

    References stay at or below the file's folder, the working folder and the ``trusted`` folders. Raises
    ScenarioErrors.
    """
    files = Files(Roots.of([path], trusted))
    tree = files.at(path)
    schema = tree.get("schema")
    models = {f"uictest/{kind}/1": PART_KEYS[key].model for key, kind in PART_KINDS.items()}
    if not isinstance(schema, Scalar) or schema.text not in models:
        schema_text = quoted(schema.text) if isinstance(schema, Scalar) else "none"
        place = tree.place if schema is None else schema.place
        raise single_error(
            place, f"not a part: its schema is {schema_text}", "schema", f"accepted: {', '.join(models)}"
        )
    part: Part = _part_in(path, files, models[schema.text])
    return part


def _part_in(path: Path, files: Files, model: Any) -> Any:
    name = Scalar(path.name, path.name, Place(Document(str(path), path.parent, path.name)))
    return Parts(files).part(name, model, ()).part


def load_controller(
    reference: str, class_name: str = "", trusted: Sequence[Path] = (), library: Path | None = None
) -> ControllerPart:
    """The controller that ``reference`` names.

    Args:
        reference: a part file or a scenario file, the file of a program, the address of a socket, or the name
            of a controller of the library or of an installed package.
        class_name: class in a Python file; where it has one controller alone this may be left out.
        trusted: folders that may be read besides those of the files given and the working folder.
        library: takes the place of the one that a part file names, which need not be there.

    Raises:
        ScenarioErrors: when there is none, or a scenario has cases with several.
    """
    path, model = Path(reference), PART_KEYS["controller",].model
    files = Files(Roots.of([path], trusted))
    controller: ControllerPart
    if not (is_path(reference) and is_file(path)):
        controller = Parts(files).part(_node(reference, path, class_name), model, ()).part
        return controller
    if library is not None:
        places = {
            key: (Place(Document(COMMAND_LINE, file.parent, file.name)), file.name)
            for key, file in (("extends", path), ("library", library))
        }
        entries = {key: Entry(place, Scalar(name, name, place)) for key, (place, name) in places.items()}
        node = Map(entries, places["extends"][0])
        controller = Parts(Files(Roots.of([path, library], trusted))).part(node, model, ()).part
        return controller
    schema = files.at(path).get("schema")
    if not isinstance(schema, Scalar) or schema.value != SCENARIO_SCHEMA:
        controller = _part_in(path, files, model)
        return controller
    controller, *others = [case.scenario.controller for case in load([path], trusted=trusted)]
    if any(other != controller for other in others):
        hint = "name the file of one of them"
        raise single_error(whole_file(path), "its cases have different controllers", "controller", hint)
    return controller


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
    names = [
        each.name
        for each in module.body
        if isinstance(each, ast.ClassDef)
        and any(isinstance(inner, ast.FunctionDef) and inner.name == "step" for inner in each.body)
    ]
    if len(names) != 1:
        listed = ", ".join(map(quoted, names)) or "none"
        message = f"which class is the controller? Those with a method step: {listed}"
        raise single_error(whole_file(path), message, hint="name it with --class")
    return names[0]
