"""Bytes on disk to documents: bounded in size, UTF-8, hashed, of the kind expected; `extends` resolved."""

import hashlib
import os
from collections.abc import Callable
from functools import lru_cache
from pathlib import Path
from typing import Final

from uictest.plans import library
from uictest.plans.scenario.yaml.diagnostics import ScenarioErrors, single_error
from uictest.plans.scenario.yaml.parsing import parse
from uictest.plans.scenario.yaml.tree import (
    Document,
    Map,
    Place,
    Scalar,
    describe,
    merge,
    nearest,
    quoted,
    visible,
)

SCENARIO_SCHEMA: Final = "uictest/scenario/1"
SERIES_SCHEMA: Final = "uictest/series/1"
VALIDATION_SCHEMA: Final = "uictest/validation/1"
BENCH_SCHEMA: Final = "uictest/bench/1"

_COMMANDS: Final = {
    SCENARIO_SCHEMA: "a scenario is run with `uictest run`",
    SERIES_SCHEMA: "a series is in a file that ends in .series.yaml",
    VALIDATION_SCHEMA: "a validation is run with `uictest validate`",
    BENCH_SCHEMA: "a bench test is run with `uictest bench`",
    "uictest/sweep/1": "written for uictest 0.2 or older: now a sweep is a scenario with `extends` (was"
    " `scenario`), the values of the case that `case` named and, under `vary`, matrix (was grid), ranges, zip"
    " and sample",
}


def require_schema(tree: Map, expected: str, hints: dict[str, str] | None = None) -> None:
    """Raise ScenarioErrors where a file is of another schema.

    `hints` say of other kinds of file what to do with them, where that is not the command that takes them.
    """
    schema = tree.get("schema")
    if schema is None:
        raise single_error(tree.place, "missing key 'schema'", "schema", f"write `schema: {expected}`")
    if isinstance(schema, Scalar) and schema.value == expected:
        return
    actual, hint = describe(schema), ""
    if isinstance(schema, Scalar):
        actual, hint = quoted(schema.text), {**_COMMANDS, **(hints or {})}.get(schema.text, "")
    raise single_error(schema.place, f"expected {expected}, found {actual}", "schema", hint)


LARGEST: Final = 256 * 1024
"""Largest file that is read, bytes."""
LIBRARY: Final = "library:"
"""How the shown name of a library file begins."""


def read_file(path: Path, schema: str = SCENARIO_SCHEMA) -> Map:
    """The tree of a YAML file; ``schema`` is what an empty one should begin with. Raises ScenarioErrors."""
    display = display_name(path)
    # Bytes of a name that are no UTF-8 come from the system as lone surrogates.
    if any("\ud800" <= char <= "\udfff" for char in display):
        raise single_error(
            whole_file(path), "the file name is not UTF-8", hint="reports could not name it; rename the file"
        )
    return _tree(display, path.parent, _content(path), schema)


def read_document(path: Path, largest: int, hint: str) -> Document:
    """The text of a file of at most ``largest`` bytes, whatever it holds. Raises ScenarioErrors.

    ``hint`` is shown for a larger file.
    """
    display, content = display_name(path), _content(path, largest, hint)
    return Document(display, path.parent, _decoded(display, path.parent, content))


def read_library(folder: str, name: str) -> Map:
    """The tree of a library file."""
    return _tree(f"{LIBRARY}{folder}/{name}.yaml", Path(), library.content(folder, name))


def display_name(path: Path) -> str:
    """The path as messages and manifests show it: relative to the working folder where it lies below it.

    A shipped scenario is shown by its name.
    """
    return _display_name(path, os.getcwd())  # noqa: PTH109


@lru_cache(maxsize=1000)
def _display_name(path: Path, working_folder: str) -> str:
    working = Path(working_folder)
    absolute = Path(os.path.abspath(path))  # noqa: PTH100 - resolve() would follow links and rename what the user typed
    if name := library.scenario_name(absolute, working):
        return name
    shown = (
        absolute.relative_to(working) if absolute.is_relative_to(working) else Path(os.path.normpath(path))
    )
    return shown.as_posix()


def whole_file(path: Path) -> Place:
    """The place of an error of a file as a whole."""
    return Place(Document(display_name(path), path.parent, ""))


def unreadable_error(place: Place, error: Exception) -> ScenarioErrors:
    """The error of a file that the operating system cannot read."""
    return single_error(place, f"cannot be read: {getattr(error, 'strerror', None) or error}")


def is_file(path: Path) -> bool:
    """Whether there is a file to read; False for names that no file can have."""
    return os.path.isfile(path)  # noqa: PTH113 - Path.is_file raises for names that are too long


def _content(path: Path, largest: int = LARGEST, hint: str = "is this a scenario file?") -> bytes:
    try:
        if not is_file(path):
            there = os.path.lexists(path)
            hint = "" if there else _shipped_hint(path)
            raise single_error(whole_file(path), "not a file" if there else "no such file", hint=hint)
        with path.open("rb") as file:
            content = file.read(largest + 1)
    except (OSError, ValueError) as error:
        raise unreadable_error(whole_file(path), error) from None
    if len(content) > largest:
        raise single_error(whole_file(path), f"larger than {largest // 1024} KiB", hint=hint)
    return content


def _shipped_hint(path: Path) -> str:
    """What to write for a shipped scenario that was taken for a file here; empty where none is meant."""
    shipped = library.scenarios()
    name = path.name.partition(".")[0]
    if name in shipped:
        return f"{name} ships with uictest: write `{name}`, or copy it with `uictest init --scenarios`"
    if path.suffix or len(path.parts) > 1:
        return ""
    guess = nearest(name, shipped)
    return f"did you mean {quoted(guess)}?" if guess else f"by name there are {', '.join(shipped)}"


def _tree(display: str, folder: Path, content: bytes, schema: str = SCENARIO_SCHEMA) -> Map:
    document = Document(
        display, folder, _decoded(display, folder, content), hashlib.sha256(content).hexdigest()
    )
    beginning = f"start with `schema: {schema}`"
    root = parse(document, beginning=beginning)
    if not isinstance(root, Map):
        raise single_error(root.place, "the file must contain a mapping of keys to values", hint=beginning)
    return root


def _decoded(display: str, folder: Path, content: bytes) -> str:
    try:
        return content.decode("utf-8")
    except UnicodeDecodeError as error:
        readable = Document(display, folder, content[: error.start].decode("utf-8"))
        place = Place(readable, len(readable.lines), len(readable.lines[-1]) + 1)
        byte = f"0x{content[error.start]:02x}"
        raise single_error(place, f"byte {byte} is not UTF-8 text", hint="save the file as UTF-8") from None


LONGEST_CHAIN: Final = 16


def inherit(
    tree: Map,
    *,
    fetch: Callable[[Scalar], Map],
    check: Callable[[Map, Map], object] = lambda parent, merged: None,
) -> tuple[Map, tuple[Document, ...]]:
    """Lay ``tree`` over its parent, its parent's parent and so on.

    ``fetch`` reads the parent that a reference names; ``check`` gets every parent, its own parents merged in,
    and what its child makes of it. Returns the merged tree and the documents it came from,
    the child's first. Raises ScenarioErrors; a circle is reported at the reference that closes it.
    """
    generations = [tree]
    while (entry := generations[-1].entries.get("extends")) is not None:
        reference = entry.node
        if not isinstance(reference, Scalar) or not isinstance(reference.value, str):
            message = f"expected one parent, found {describe(reference)}"
            raise single_error(reference.place, message, "extends")
        parent = fetch(reference)
        _reject_circle(parent, generations, reference)
        generations.append(parent)
    documents = tuple(each.place.document for each in generations)
    merged = generations.pop().without("extends")
    while generations:
        child = merge(merged, generations.pop().without("extends"))
        assert isinstance(child, Map)
        check(merged, child)
        merged = child
    return merged, documents


def _reject_circle(parent: Map, generations: list[Map], reference: Scalar) -> None:
    seen = [each.place.document.display for each in generations]
    display = parent.place.document.display
    if display in seen:
        names = " -> ".join([*seen[seen.index(display) :], display])
        raise single_error(reference.place, f"circular 'extends': {visible(names)}", "extends")
    if len(seen) >= LONGEST_CHAIN:
        raise single_error(reference.place, f"more than {LONGEST_CHAIN} generations of 'extends'", "extends")
