"""The parameters that a controller from outside declares: read without running it, and held against the file.

A part lists them, or its program does where it can be read as text: a literal `PARAMETERS` in Python, the
description of an FMU. A library in C is asked once it runs.
"""

import ast
from collections.abc import Iterator, Mapping
from functools import partial
from importlib.machinery import PathFinder
from pathlib import Path
from typing import Any, Final

from uictest.controllers import Problem, installed_module, nothing_declared, parameter_problems
from uictest.plans.scenario.files import Files
from uictest.plans.scenario.fmu_description import FmuDescription
from uictest.plans.scenario.parts.external_controller import DeclaredParameter, ExternalController
from uictest.plans.scenario.program_files import UNPARSABLE, assigned, read_program, texts_beginning_with
from uictest.plans.scenario.yaml import (
    COMMAND_LINE,
    Diagnostic,
    Document,
    Entry,
    Inconsistency,
    Key,
    Map,
    Node,
    Place,
    Scalar,
    ScenarioErrors,
    Sequence,
    diagnose,
    display_name,
    dotted,
    entry_at,
    plain,
    quoted,
    single_error,
    validated,
    visible,
)

Declared = Mapping[str, DeclaredParameter]
NAME: Final = "PARAMETERS"
"""What a Python file calls its declarations."""
_HINT: Final = 'write {"NAME": {"default": 1.0, "unit": "s", "range": [0.0, 2.0]}}'
_IN_PART: Final = "list them under `declared_parameters` of its part"


def with_declared_parameters(
    controller: ExternalController, tree: Map, files: Files, key: Key
) -> ExternalController:
    """Return a controller that is given every declared parameter: those of the file, defaults for the others.

    The start values of an FMU are its own, and stay. Raises ScenarioErrors for a name that is not declared,
    a value outside of its range, and declarations that cannot be read.
    """
    listed: Declared = controller.declared_parameters
    declared = listed or _declared_by_program(controller, files)
    if declared is None:
        return controller  # asked once it runs
    given, free = controller.parameters, controller.free_parameters
    problems = parameter_problems(declared, given, free=free)
    if given and not declared and not free:
        problems = iter([nothing_declared(given)])
    errors = [*_at_their_places(problems, declared, tree, key)]
    if errors:
        raise ScenarioErrors(errors)
    if declared is not listed and controller.kind == "fmu":
        return controller
    defaults = {name: each.default for name, each in declared.items()}
    changed = {"parameters": {**defaults, **given}, "declared_parameters": dict(declared)}
    return controller.model_copy(update=changed)


def with_parameters(controller: ExternalController, given: Mapping[str, Any]) -> ExternalController:
    """Return a controller with other parameters, from the command line. Raises ScenarioErrors."""
    entries: dict[str, Entry] = {}
    for name, value in given.items():
        place = Place(Document(COMMAND_LINE, Path(), f"{name}={value}"))
        entries[name] = Entry(place, Scalar(value, str(value), place))
    place = Place(Document(COMMAND_LINE, Path(), ""))
    tree = Map({"parameters": Entry(place, Map(entries, place))}, place)
    changed = controller.model_copy(update={"parameters": {**controller.parameters, **given}})
    return with_declared_parameters(changed, tree, Files(), ())


def _at_their_places(
    problems: Iterator[Problem], declared: Declared, tree: Map, key: Key
) -> Iterator[Diagnostic]:
    for problem in problems:
        entry, _ = entry_at(tree, ("parameters", problem.name))
        place = entry.node.place if problem.name in declared else entry.key
        name = dotted((*key, "parameters", problem.name))
        yield diagnose(place, visible(problem.message), name, visible(problem.hint))


def _declared_by_program(controller: ExternalController, files: Files) -> Declared | None:
    """Return what the text of a program declares; None where only a run can tell."""
    if controller.kind == "connect":
        return {}
    if controller.kind == "registered":
        source = _source_of_module(installed_module(controller.reference))
        # Where its module has none, the class may come from another one.
        return (_declared_in(source, "python", files) or None) if source else None
    if controller.kind == "python" or (controller.kind == "fmu" and controller.parameters):
        return _declared_in(Path(getattr(controller, controller.kind).location), controller.kind, files)
    return None


def _declared_in(path: Path, kind: str, files: Files) -> Declared | None:
    try:
        program = read_program(files, kind, path)
    except OSError:
        return None
    read = partial(_of_python, path, program.content) if kind == "python" else partial(_of_fmu, program.fmu)
    declared: Declared | None = files.once(f"parameters:{path}", read)
    return declared


def _source_of_module(name: str) -> Path | None:
    """Return the file of a module that is installed; none of its packages is imported."""
    folders: Any = None
    origin = ""
    for place in range(1, name.count(".") + 2):
        try:
            found = PathFinder.find_spec(".".join(name.split(".")[:place]), folders)
        except KeyError:  # a package without a file inside another one is found only once that is imported
            return None
        if found is None:
            return None
        folders, origin = found.submodule_search_locations, found.origin or ""
    return Path(origin) if origin.endswith(".py") else None


def _of_python(path: Path, content: bytes) -> Declared | None:
    try:
        texts = texts_beginning_with(NAME, content)
        statements = [statement for each in texts for statement in each.statements()]
    except UNPARSABLE:
        return None  # who imports it says why
    values = (assigned(NAME, each) for each in statements)
    value = next((each for each in values if each is not None), None)
    if value is None:
        return {}
    document = Document(display_name(path), path.parent, content.decode("utf-8", "replace"))
    tree = _tree(value, document)
    declared: Declared = validated(dict[str, DeclaredParameter], plain(tree), tree, (NAME,))
    return declared


def _tree(value: ast.expr, document: Document) -> Node:
    """Return a literal of Python as the tree of a file, so that its errors have their places."""
    place = Place(document, value.lineno, value.col_offset + 1)
    if isinstance(value, ast.Dict):
        entries: dict[str, Entry] = {}
        for key, inner in zip(value.keys, value.values, strict=True):
            if not isinstance(key, ast.Constant) or not isinstance(key.value, str):
                raise single_error(place, "the keys of a declaration are texts", NAME, _HINT)
            key_place = Place(document, key.lineno, key.col_offset + 1)
            entries[key.value] = Entry(key_place, _tree(inner, document))
        return Map(entries, place)
    if isinstance(value, ast.List | ast.Tuple):
        return Sequence(tuple(_tree(each, document) for each in value.elts), place)
    try:
        literal = ast.literal_eval(value)
    except (ValueError, TypeError, RecursionError):
        literal = ...
    if literal is None or isinstance(literal, str | int | float):
        return Scalar(literal, str(literal), place)
    written = ast.get_source_segment(document.text, value) or ""  # to unparse it may exceed the stack
    message = f"{quoted(written)} is no literal: the file is read, not run"
    raise single_error(place, message, NAME, f"{_HINT}, or {_IN_PART}")


def _of_fmu(described: FmuDescription) -> Declared | None:
    """Return the parameters in the description of an FMU; None where it cannot be read."""
    if described.parameters is None:
        return None
    return {name: _FmuParameter.model_construct(**each) for name, each in described.parameters.items()}


class _FmuParameter(DeclaredParameter):
    """A parameter as an FMU declares it: its numbers need no unit, and its start value may lie anywhere."""

    def inconsistencies(self) -> Iterator[Inconsistency]:
        """Yield nothing."""
        yield from ()
