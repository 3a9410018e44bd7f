"""The files of controllers from outside: found and identified, never loaded."""

import ast
import hashlib
import re
from collections.abc import Iterable, Iterator
from contextlib import suppress
from functools import partial
from pathlib import Path, PurePosixPath
from typing import Final, NamedTuple, Self

from uictest.controllers import installed_version, shown_version
from uictest.plans.scenario.files import Files, nearest_file
from uictest.plans.scenario.fmu_description import FmuDescription, read_description
from uictest.plans.scenario.yaml import (
    Document,
    Map,
    Scalar,
    display_name,
    is_file,
    quoted,
    single_error,
    unreadable_error,
    visible,
)

_NOWHERE: Final = Document("", Path(), "")


class ProgramFile(str):
    """The path of a program as a scenario writes it, with where the file lies and what it holds."""

    __slots__ = ("document", "location", "version")

    location: str
    document: Document
    version: str

    def __new__(cls, text: str, location: str = "", document: Document = _NOWHERE, version: str = "") -> Self:
        """A path as written; ``location`` is absolute, ``document`` has the SHA-256 of the content.

        ``version`` is what the file states, empty where it states none.
        """
        file = super().__new__(cls, text)
        file.location = location
        file.document = document
        file.version = version
        return file

    def __getnewargs__(self) -> tuple[str, str, Document, str]:  # type: ignore[override]
        return str.__str__(self), self.location, self.document, self.version

    @property
    def sha256(self) -> str:
        """Of the content."""
        return self.document.sha256


_LARGEST: Final = 65536
"""Most bytes of a statement; chosen: longer ones are no declarations."""
_NEXT_STATEMENT: Final = re.compile(rb"\n(?=[^\s#)\]}])")
_TEXTS: Final = rb"""#[^\n]*|(['"]{3})(?:[^\\]|\\.)*?\1|"(?:[^"\\\n]|\\.)*"|'(?:[^'\\\n]|\\.)*'|"""
"""Comments and texts, in which a name is none."""
UNPARSABLE: Final = (SyntaxError, ValueError, RecursionError, MemoryError)
"""What :meth:`PythonText.statements` raises for what is no Python."""


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
        raise single_error(node.place, f"no such file: {quoted(node.text)}", key, hint)
    try:
        document, version, *_ = read_program(files, kind, path)
    except OSError as error:
        raise unreadable_error(node.place, error) from None
    return ProgramFile(node.text, str(path.resolve()), document, version)


def version_stated_for(controller: Map, programs: Iterable[ProgramFile]) -> str:
    """Return the version that the installed package or the file of a controller states, empty for none."""
    registered = controller.get("registered")
    if isinstance(registered, Scalar) and isinstance(registered.value, str):
        return installed_version(registered.value)
    return next((file.version for file in programs if file.version), "")


class ProgramText(NamedTuple):
    """What the file of a program is, the version that it states, and its text or its description.

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
