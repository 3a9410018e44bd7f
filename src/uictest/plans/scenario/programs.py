"""The programs of controllers from outside: found and identified, their declarations read, never run.

A part lists parameters, or its program does where it can be read as text: a literal `PARAMETERS` in Python,
the description of an FMU. A library in C is asked once it runs.
"""

import ast
import hashlib
import re
import warnings
from collections.abc import Iterable, Iterator, Mapping
from contextlib import suppress
from functools import partial
from importlib.machinery import PathFinder
from pathlib import Path, PurePosixPath
from types import CodeType
from typing import Any, Final, NamedTuple

from uictest.controllers import (
    Problem,
    installed_module,
    installed_version,
    nothing_declared,
    parameter_problems,
    shown_version,
)
from uictest.plans.scenario.fmu_description import FmuDescription, read_description
from uictest.plans.scenario.parts.controller import (
    DeclaredParameter,
    ExternalController,
    ProgramFile,
    PythonController,
)
from uictest.plans.scenario.yaml import (
    COMMAND_LINE,
    Diagnostic,
    Document,
    Entry,
    Files,
    Inconsistency,
    Key,
    List,
    Location,
    Map,
    Node,
    Scalar,
    diagnose,
    display_name,
    dotted,
    entry_at,
    is_file,
    nearest_file,
    plain,
    quoted,
    require_none,
    single_error,
    suggestion,
    unreadable_error,
    validated,
    visible,
)

_LARGEST: Final = 65536
"""Most bytes of a statement; chosen: longer ones are not declarations."""
_NEXT_STATEMENT: Final = re.compile(rb"\n(?=[^\s#)\]}])")
_TEXTS: Final = rb"""#[^\n]*|(['"]{3})(?:[^\\]|\\.)*?\1|"(?:[^"\\\n]|\\.)*"|'(?:[^'\\\n]|\\.)*'|"""
"""Comments and texts, in which a name is none."""
UNPARSABLE: Final = (SyntaxError, ValueError, RecursionError, MemoryError)
"""Exceptions of :meth:`PythonText.statements` for a text that is not Python."""


class PythonText(NamedTuple):
    """The text of a statement, and the lines above it in its file."""

    text: bytes
    lines_above: int

    def statements(self) -> list[ast.stmt]:
        """Return the statement, and what stands behind it in its line. Raises `UNPARSABLE`."""
        module = ast.parse(self.text)
        return ast.increment_lineno(module, self.lines_above).body


def texts_beginning_with(name: str, content: bytes) -> Iterator[PythonText]:
    """Yield the texts of the statements of a module that begin with a name.

    Nothing else needs to be parsed: a syntax tree takes hundreds of times the memory of its text.
    """
    begins = rb"^" + name.encode() + rb"\b"
    if re.search(begins, content, re.MULTILINE) is None:
        return
    for found in re.finditer(_TEXTS + begins, content, re.MULTILINE | re.DOTALL):
        if found[0] == name.encode():
            text = _NEXT_STATEMENT.split(content[found.start() : found.start() + _LARGEST], maxsplit=1)[0]
            yield PythonText(text, content.count(b"\n", 0, found.start()))


def assigned(name: str, statement: ast.stmt) -> ast.expr | None:
    """Return the expression that a statement gives to a name, if any."""
    if not isinstance(statement, ast.Assign | ast.AnnAssign):
        return None
    targets = statement.targets if isinstance(statement, ast.Assign) else [statement.target]
    named = any(isinstance(target, ast.Name) and target.id == name for target in targets)
    return statement.value if named else None


def version_in(content: bytes) -> str:
    """Return the version in the text of a Python file, empty where it states none."""
    for text in texts_beginning_with("__version__", content):
        with suppress(*UNPARSABLE):
            for statement in text.statements():
                value = assigned("__version__", statement)
                if isinstance(value, ast.Constant) and isinstance(value.value, str):
                    return value.value
    return ""


KIND_OF_ENDING: Final = {
    ".py": "python",
    ".so": "library",
    ".dylib": "library",
    ".dll": "library",
    ".fmu": "fmu",
}
"""Ending of a program's file -> the key that names it in a scenario."""
PROGRAM_FILES: Final = ("python", "library", "fmu")
"""Keys that name a file."""
SOCKET: Final = "tcp://"
"""Beginning of the address of a socket."""


def program_files(controller: Map, files: Files, key: str) -> dict[str, ProgramFile]:
    """Return the program files that a controller names, by key.

    Raises ScenarioErrors for one that is missing, cannot be read, or lies outside the roots.
    """
    programs: dict[str, ProgramFile] = {}
    for kind in PROGRAM_FILES:
        node = controller.get(kind)
        if isinstance(node, Scalar) and isinstance(node.value, str):
            programs[kind] = _program_file(node, files, f"{key}.{kind}" if key else kind, kind)
    return programs


def _program_file(node: Scalar, files: Files, key: str, kind: str) -> ProgramFile:
    path = files.path_of(node, key)
    if not is_file(path):
        hint = nearest_file(path, "build it first, or mend the path: it starts at the folder of this file")
        raise single_error(node.location, f"no such file: {quoted(node.text)}", key, hint)
    try:
        document, version, *_ = read_program(files, kind, path)
    except OSError as error:
        raise unreadable_error(node.location, error) from None
    return ProgramFile(node.text, str(path.resolve()), document, version)


def version_stated_for(controller: Map, programs: Iterable[ProgramFile]) -> str:
    """Return the version that the installed package or the file of a controller states, empty for none."""
    registered = controller.get("registered")
    if isinstance(registered, Scalar) and isinstance(registered.value, str):
        return installed_version(registered.value)
    return next((file.version for file in programs if file.version), "")


class ProgramText(NamedTuple):
    """File of a program: its kind, the version that it states, and its text or description.

    A library states nothing: it would have to be loaded.
    """

    document: Document
    version: str
    content: bytes = b""
    fmu: FmuDescription = FmuDescription()


def read_program(files: Files, kind: str, path: Path) -> ProgramText:
    """Return the file of a program, read once. Raises OSError."""
    text: ProgramText = files.once(f"{kind}:{path.resolve()}", partial(_read, path, kind))
    return text


def _read(path: Path, kind: str) -> ProgramText:
    content = path.read_bytes()
    document = Document(display_name(path), path.parent, "", hashlib.sha256(content).hexdigest())
    if kind == "python":
        return ProgramText(document, shown_version(version_in(content)), content)
    described = read_description(path) if kind == "fmu" else FmuDescription()
    return ProgramText(document, shown_version(described.version), fmu=described)


def mapping_for(text: str) -> str:
    """Return the controller that a bare path or address is meant to be, as a mapping; empty for a name."""
    if text.startswith(SOCKET):
        return visible(f'{{connect: "{text}"}}')
    kind = KIND_OF_ENDING.get(PurePosixPath(text).suffix.lower())
    name = ", class: NAME" if kind == "python" else ""
    return visible(f"{{{kind}: {text}{name}}}") if kind else ""


LARGEST: Final = 128 * 1024
"""Most bytes of a file that is compiled, in some 30 ms; chosen. Others are left to the run."""
_UNSEEN: Final = re.compile(
    rb"\bimport\s*\(?\s*\*|\b(?:global|globals|locals|vars|setattr|exec|eval|modules|__getattr__)\b"
)
"""Ways in which a module gets names that its code does not show."""


def require_class(controller: PythonController, tree: Map, files: Files, key: Key) -> None:
    """Raise ScenarioErrors where the file of a controller is not Python, or cannot have its class.

    Whether a name that is imported or assigned is that of a class shows in a run.
    """
    path, name = Path(controller.python.location), controller.class_name
    content = read_program(files, "python", path).content
    if len(content) > LARGEST:
        return
    code: CodeType | None = files.once(f"code:{path}", partial(_compiled, path, content))
    if code is None or name in code.co_names or _UNSEEN.search(content):
        return
    nested = (each for each in code.co_consts if isinstance(each, CodeType))
    classes = [each.co_name for each in nested if "__qualname__" in each.co_names]
    location = entry_at(tree, ("class",))[0].node.location
    message = visible(f"{path.name} has no class {quoted(name)}")
    raise single_error(location, message, dotted((*key, "class")), visible(suggestion(name, classes)))


def _compiled(path: Path, content: bytes) -> CodeType | None:
    """Return the code of a file; None where it is too deep to tell. Raises ScenarioErrors."""
    try:
        with warnings.catch_warnings(action="ignore"):
            return compile(content, path, "exec", dont_inherit=True)
    except (RecursionError, MemoryError):
        return None
    except (SyntaxError, ValueError) as error:
        text = "" if b"\0" in content else content.decode("utf-8", "replace")
        document = Document(display_name(path), path.parent, text)
        line, column = (max(getattr(error, name, None) or 1, 1) for name in ("lineno", "offset"))
        reason = visible(getattr(error, "msg", str(error)))
        message = f"cannot be imported: {type(error).__name__}: {reason}"
        raise single_error(Location(document, line, column), message) from None


Declared = Mapping[str, DeclaredParameter]
NAME: Final = "PARAMETERS"
"""Names of the declarations in a Python file."""
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
    errors = [*_at_their_locations(problems, declared, tree, key)]
    require_none(errors)
    if declared is not listed and controller.kind == "fmu":
        return controller
    defaults = {name: each.default for name, each in declared.items()}
    changed = {"parameters": {**defaults, **given}, "declared_parameters": dict(declared)}
    return controller.model_copy(update=changed)


def with_parameters(controller: ExternalController, given: Mapping[str, Any]) -> ExternalController:
    """Return a controller with other parameters, from the command line. Raises ScenarioErrors."""
    entries: dict[str, Entry] = {}
    for name, value in given.items():
        location = Location(Document(COMMAND_LINE, Path(), f"{name}={value}"))
        entries[name] = Entry(location, Scalar(value, str(value), location))
    location = Location(Document(COMMAND_LINE, Path(), ""))
    tree = Map({"parameters": Entry(location, Map(entries, location))}, location)
    changed = controller.model_copy(update={"parameters": {**controller.parameters, **given}})
    return with_declared_parameters(changed, tree, Files(), ())


def _at_their_locations(
    problems: Iterator[Problem], declared: Declared, tree: Map, key: Key
) -> Iterator[Diagnostic]:
    for problem in problems:
        entry, _ = entry_at(tree, ("parameters", problem.name))
        location = entry.node.location if problem.name in declared else entry.key
        name = dotted((*key, "parameters", problem.name))
        yield diagnose(location, visible(problem.message), name, visible(problem.hint))


def _declared_by_program(controller: ExternalController, files: Files) -> Declared | None:
    """Return the parameters that the text of a program declares; None if only running it can tell."""
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
    if kind == "fmu":
        described = program.fmu.parameters
        if described is None:  # the description cannot be read
            return None
        return {name: _FmuParameter.model_construct(**each) for name, each in described.items()}
    declared: Declared | None = files.once(f"parameters:{path}", partial(_of_python, path, program.content))
    return declared


def _source_of_module(name: str) -> Path | None:
    """Return the file of a module that is installed; none of its packages is imported."""
    folders: Any = None
    origin = ""
    for depth in range(1, name.count(".") + 2):
        try:
            found = PathFinder.find_spec(".".join(name.split(".")[:depth]), folders)
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
    location = Location(document, value.lineno, value.col_offset + 1)
    if isinstance(value, ast.Dict):
        entries: dict[str, Entry] = {}
        for key, inner in zip(value.keys, value.values, strict=True):
            if not isinstance(key, ast.Constant) or not isinstance(key.value, str):
                raise single_error(location, "the keys of a declaration are texts", NAME, _HINT)
            key_place = Location(document, key.lineno, key.col_offset + 1)
            entries[key.value] = Entry(key_place, _tree(inner, document))
        return Map(entries, location)
    if isinstance(value, ast.List | ast.Tuple):
        return List(tuple(_tree(each, document) for each in value.elts), location)
    try:
        literal = ast.literal_eval(value)
    except (ValueError, TypeError, RecursionError):
        literal = ...
    if literal is None or isinstance(literal, str | int | float):
        return Scalar(literal, str(literal), location)
    written = ast.get_source_segment(document.text, value) or ""  # to unparse it may exceed the stack
    message = f"{quoted(written)} is no literal: the file is read, not run"
    raise single_error(location, message, NAME, f"{_HINT}, or {_IN_PART}")


class _FmuParameter(DeclaredParameter):
    """A parameter as an FMU declares it: its numbers need no unit, and its start value may lie anywhere."""

    def inconsistencies(self) -> Iterator[Inconsistency]:
        """Yield nothing."""
        yield from ()
