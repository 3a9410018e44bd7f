"""The files of controllers from outside: found and identified, never loaded here."""

import hashlib
from collections.abc import Iterable, Iterator
from functools import partial
from pathlib import Path, PurePosixPath
from typing import Final, NamedTuple

from uictest.controllers import installed_version
from uictest.plans.scenario.files import Files, nearest_file
from uictest.plans.scenario.parts.external_controller import PROGRAM_FILES
from uictest.plans.scenario.parts.program_file import ProgramFile
from uictest.plans.scenario.program_version import stated_version
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

KIND_OF_ENDING: Final = {
    ".py": "python",
    ".so": "library",
    ".dylib": "library",
    ".dll": "library",
    ".fmu": "fmu",
}
"""Ending of a program's file -> the key that names it in a scenario."""
SOCKET: Final = "tcp://"
"""Beginning of the address of a socket."""


def program_files(controller: Map, files: Files, key: str) -> dict[str, ProgramFile]:
    """Return the program files that a controller names, by key.

    Raises ScenarioErrors for one that is missing, cannot be read, or lies outside the roots.
    """
    return dict(_found(controller, files, f"{key}." if key else ""))


def _found(controller: Map, files: Files, above: str) -> Iterator[tuple[str, ProgramFile]]:
    for key in PROGRAM_FILES:
        node = controller.get(key)
        if isinstance(node, Scalar) and isinstance(node.value, str):
            yield key, _program_file(node, files, above, key)


def _program_file(node: Scalar, files: Files, above: str, kind: str) -> ProgramFile:
    path = files.path_of(node, f"{above}{kind}")
    if not is_file(path):
        hint = nearest_file(path, "build it first, or mend the path: it starts at the folder of this file")
        raise single_error(node.place, f"no such file: {quoted(node.text)}", f"{above}{kind}", hint)
    try:
        document, version, _ = read_program(files, kind, path)
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
    """What the file of a program is, the version that it states, and its content where that is a text."""

    document: Document
    version: str
    content: bytes


def read_program(files: Files, kind: str, path: Path) -> ProgramText:
    """Return the file of a program, read once. Raises OSError."""
    text: ProgramText = files.once(f"{kind}:{path.resolve()}", partial(_read, path, kind))
    return text


def _read(path: Path, kind: str) -> ProgramText:
    content = path.read_bytes()
    document = Document(display_name(path), path.parent, "", hashlib.sha256(content).hexdigest())
    return ProgramText(document, stated_version(kind, content), b"" if kind == "library" else content)


def mapping_for(text: str) -> str:
    """Return the controller that a bare path or address is meant to be, as a mapping; empty for a name."""
    if text.startswith(SOCKET):
        return visible(f'{{connect: "{text}"}}')
    kind = KIND_OF_ENDING.get(PurePosixPath(text).suffix.lower())
    name = ", class: NAME" if kind == "python" else ""
    return visible(f"{{{kind}: {text}{name}}}") if kind else ""
