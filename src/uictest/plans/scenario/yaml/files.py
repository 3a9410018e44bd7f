"""The files of a load: bounded in size, UTF-8, hashed, of the kind expected, below known folders."""

import codecs
import hashlib
import os
from collections.abc import Callable, Iterable, Iterator, Sequence
from functools import cache, lru_cache, partial
from pathlib import Path, PureWindowsPath
from typing import Any, Final, NamedTuple, Self

from uictest.plans import library
from uictest.plans.scenario.yaml.diagnostics import (
    COMMAND_LINE,
    Diagnostic,
    Document,
    Location,
    ScenarioErrors,
    collecting,
    diagnose,
    nearest,
    quoted,
    single_error,
    visible,
)
from uictest.plans.scenario.yaml.tree import Map, Scalar, describe, merge, parse

SCENARIO_SCHEMA: Final = "uictest/scenario/1"
SERIES_SCHEMA: Final = "uictest/series/1"
PROGRAMME_SCHEMA: Final = "uictest/programme/1"
VALIDATION_SCHEMA: Final = "uictest/validation/1"
BENCH_SCHEMA: Final = "uictest/bench/1"
_COMMANDS: Final = {
    SCENARIO_SCHEMA: "a scenario is run with `uictest run`",
    SERIES_SCHEMA: "a series is in a file that ends in .series.yaml",
    PROGRAMME_SCHEMA: "a programme is run with `uictest run`, from a file that ends in .programme.yaml",
    VALIDATION_SCHEMA: "a validation is run with `uictest validate`",
    BENCH_SCHEMA: "a bench test is run with `uictest bench`",
    **{f"uictest/{kind}/1": "a part: name it in a scenario" for kind in library.FOLDERS.values()},
    "uictest/channel-map/1": "a channel map goes with --map of `uictest evaluate`",
    "uictest/result/2": "results of a run: `uictest report` and `uictest compare` read them",
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
        raise single_error(tree.location, "missing key 'schema'", "schema", f"write `schema: {expected}`")
    if isinstance(schema, Scalar) and schema.value == expected:
        return
    actual, hint = describe(schema), ""
    if isinstance(schema, Scalar):
        actual, hint = quoted(schema.text), {**_COMMANDS, **(hints or {})}.get(schema.text, "")
    raise single_error(schema.location, f"expected {expected}, found {actual}", "schema", hint)


_RECORDINGS: Final = (".csv", ".mat", ".mdf", ".mf4", ".parquet", ".tdms")
LARGEST: Final = 256 * 1024
"""Largest file that is read, bytes."""
LIBRARY: Final = "library:"
"""Prefix of the shown name of a library file."""


def read_file(path: Path, schema: str = SCENARIO_SCHEMA) -> Map:
    """The tree of a YAML file; ``schema`` is what an empty one should begin with. Raises ScenarioErrors."""
    display = display_name(path)
    # Bytes of a name that are no UTF-8 come from the system as lone surrogates.
    if any("\ud800" <= char <= "\udfff" for char in display):
        raise single_error(
            whole_file(path), "the file name is not UTF-8", hint="reports could not name it; rename the file"
        )
    if path.suffix.lower() in _RECORDINGS and is_file(path):
        raise single_error(whole_file(path), "a recording", hint="`uictest evaluate` judges recordings")
    return _parse_tree(display, path.parent, _read_content(path), schema)


def read_document(path: Path, largest: int, hint: str) -> Document:
    """The text of a file of at most ``largest`` bytes, whatever it holds. Raises ScenarioErrors.

    ``hint`` is shown for a larger file.
    """
    display, content = display_name(path), _read_content(path, largest, hint)
    return Document(display, path.parent, _decode_content(display, path.parent, content))


@cache
def read_library(folder: str, name: str) -> Map:
    """The tree of a library file, read once by a process: the library does not change."""
    return _parse_tree(f"{LIBRARY}{folder}/{name}.yaml", Path(), library.content(folder, name))


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


def whole_file(path: Path) -> Location:
    """The place of an error of a file as a whole."""
    return Location(Document(display_name(path), path.parent, ""))


def unreadable_error(location: Location, error: Exception) -> ScenarioErrors:
    """The error of a file that the operating system cannot read."""
    return single_error(location, f"cannot be read: {getattr(error, 'strerror', None) or error}")


def is_file(path: Path) -> bool:
    """Whether there is a file to read; False for names that no file can have."""
    return os.path.isfile(path)  # noqa: PTH113 - Path.is_file raises for names that are too long


def _read_content(path: Path, largest: int = LARGEST, hint: str = "is this a scenario file?") -> bytes:
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
    """Hint for a missing file that names a shipped scenario; empty if it names none."""
    shipped = library.scenarios()
    name = path.name.partition(".")[0]
    if name in shipped:
        how = f"write `{name}`, or copy it" if path.suffix else "a scenario, which is not taken here; copy it"
        return f"{name} ships with uictest: {how} with `uictest init --scenarios`"
    if path.suffix or len(path.parts) > 1:
        return nearest_file(path)
    guess = nearest(name, shipped)
    return f"did you mean {quoted(guess)}?" if guess else f"by name there are {', '.join(shipped)}"


def _parse_tree(display: str, folder: Path, content: bytes, schema: str = SCENARIO_SCHEMA) -> Map:
    document = Document(
        display, folder, _decode_content(display, folder, content), hashlib.sha256(content).hexdigest()
    )
    beginning = f"start with `schema: {schema}`"
    root = parse(document, beginning=beginning)
    if not isinstance(root, Map):
        raise single_error(root.location, "the file must contain a mapping of keys to values", hint=beginning)
    return root


def _decode_content(display: str, folder: Path, content: bytes) -> str:
    try:
        return content.decode("utf-8")
    except UnicodeDecodeError as error:
        readable = Document(display, folder, content[: error.start].decode("utf-8"))
        location = Location(readable, len(readable.lines), len(readable.lines[-1]) + 1)
        byte = f"0x{content[error.start]:02x}"
        is_utf_16 = content.startswith((codecs.BOM_UTF16_LE, codecs.BOM_UTF16_BE))
        hint = f"save the file as UTF-8{', it is UTF-16' if is_utf_16 else ''}"
        raise single_error(location, f"byte {byte} is not UTF-8 text", hint=hint) from None


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
            raise single_error(reference.location, message, "extends")
        parent = fetch(reference)
        _reject_circle(parent, generations, reference)
        generations.append(parent)
    documents = tuple(each.location.document for each in generations)
    merged = generations.pop().without("extends")
    while generations:
        child = merge(merged, generations.pop().without("extends"))
        assert isinstance(child, Map)
        check(merged, child)
        merged = child
    return merged, documents


def _reject_circle(parent: Map, generations: list[Map], reference: Scalar) -> None:
    seen = [each.location.document.display for each in generations]
    display = parent.location.document.display
    if display in seen:
        names = " -> ".join([*seen[seen.index(display) :], display])
        raise single_error(reference.location, f"circular 'extends': {visible(names)}", "extends")
    if len(seen) >= LONGEST_CHAIN:
        raise single_error(
            reference.location, f"more than {LONGEST_CHAIN} generations of 'extends'", "extends"
        )


class Roots(NamedTuple):
    """Folders, links resolved, at or below which every file must lie that is read by reference."""

    folders: tuple[Path, ...]

    @classmethod
    def of(cls, paths: Iterable[Path], trusted: Iterable[Path] = ()) -> Self:
        """The roots for files and folders that a user named, with the folders that are trusted besides."""
        named = (path if os.path.isdir(path) else path.parent for path in paths)  # noqa: PTH112 - never raises
        return cls(tuple(dict.fromkeys(map(real, (*named, Path.cwd(), *trusted)))))

    def with_folder(self, folder: Path) -> "Roots":
        """The roots and one more."""
        return Roots((*self.folders, real(folder)))

    def contain(self, path: Path) -> bool:
        """Whether a path, links resolved, lies at or below one of the roots."""
        return any(real(path).is_relative_to(folder) for folder in self.folders)

    def around(self, folder: Path) -> Path:
        """The outermost root that ``folder`` lies in, else the folder itself."""
        around = (root for root in self.folders if real(folder).is_relative_to(root))
        return min(around, key=lambda root: len(root.parts), default=real(folder))


def real(path: Path) -> Path:
    """The path with its links resolved, whether it exists or not."""
    return Path(os.path.realpath(path))


class Files:
    """The files of one load; each is read once."""

    def __init__(self, roots: Roots | None = None) -> None:
        self._read: dict[str, Any] = {}
        self.roots = Roots.of(()) if roots is None else roots

    def at(self, path: Path) -> Map:
        """The tree of the file at ``path``."""
        tree: Map = self.once(str(path), partial(read_file, path))
        return tree

    def beside(self, reference: Scalar, key: str, shipped: str | None = None) -> Map:
        """The tree of the file that a relative path names. Raises ScenarioErrors at the reference.

        ``shipped`` is what it may have been meant to name, if there is no such file.
        """
        path = self.path_of(reference, key)
        if not is_file(path):
            hint = "paths start at the folder of the file that names them"
            hint = f"did you mean {quoted(shipped)}?" if shipped else nearest_file(path, hint)
            raise single_error(reference.location, f"no such file: {quoted(reference.text)}", key, hint)
        return self.at(path)

    def scenario_beside(self, reference: Scalar, key: str) -> Path:
        """The scenario that a reference names: a file, else one that ships. Raises ScenarioErrors there."""
        path = self.path_of(reference, key)
        shipped = library.scenarios().get(reference.text)
        if shipped is None or is_file(path):
            self.beside(reference, key, nearest(reference.text, library.scenarios()))
            return path
        self.roots = self.roots.with_folder(shipped.parent)
        return shipped

    def path_of(self, reference: Scalar, key: str) -> Path:
        """The path that a relative path names, checked only for whether it may be read.

        Raises ScenarioErrors at a reference that leads out of the roots, itself or by a link. A path on the
        command line is an argument like any other: its folder becomes a root.
        """
        name = reference.text
        if Path(name).is_absolute() or PureWindowsPath(name).is_absolute():
            hint = "write it relative to the file that names it, so that it holds on every machine"
            raise single_error(reference.location, f"{quoted(name)} is an absolute path", key, hint)
        folder = reference.location.document.folder
        path = folder / name
        if reference.location.document.display == COMMAND_LINE:
            self.roots = self.roots.with_folder(path.parent)
        elif not self.roots.contain(path):
            message = f"{quoted(name)} leads out of {visible(str(self.roots.around(folder)))}"
            raise single_error(reference.location, message, key, trust_hint(path))
        return path

    def once(self, name: str, read: Callable[[], Any]) -> Any:
        """Return the result of ``read``, which is called only at the first call for this name."""
        if name not in self._read:
            self._read[name] = read()
        return self._read[name]


def trust_hint(path: Path) -> str:
    """The hint for a file outside the roots."""
    folder = visible(str(real(path).parent))
    return (
        f"add --trust {folder}, or UICTEST_TRUST={folder} to the environment;"
        " without it only the working folder and those of the files given are read"
    )


def nearest_file(path: Path, otherwise: str = "") -> str:
    """Hint for a missing file: a file of a similar name in its folder, or another remedy."""
    if "\\" in path.name:
        return "write / in place of \\ in paths"
    try:
        guess = nearest(path.name, (each.name for each in path.parent.iterdir() if each.is_file()))
    except (OSError, ValueError):
        return otherwise
    return f"did you mean {quoted(guess)}?" if guess else otherwise


SWEEP_SUFFIXES: Final = (".sweep.yaml", ".sweep.yml")
SERIES_SUFFIXES: Final = (".series.yaml", ".series.yml")
PROGRAMME_SUFFIXES: Final = (".programme.yaml", ".programme.yml")
_OTHER_KINDS: Final = (*library.FOLDERS.values(), "bench", "channel-map", "validation")
_OTHER_SCHEMAS: Final = frozenset(f"uictest/{kind}/1" for kind in _OTHER_KINDS)
"""Schemas of files that may lie among scenarios and are none: parts, benches, channel maps, validations."""


def scenario_trees(
    paths: Sequence[Path], files: Files, diagnostics: list[Diagnostic]
) -> Iterator[tuple[Path, Map]]:
    """Yield the tree of every scenario file at or below ``paths``, once and in order; append errors.

    A folder is searched for ``*.yaml`` and ``*.yml``, except sweeps (``*.sweep.yaml``), series
    (``*.series.yaml``), programmes (``*.programme.yaml``), parts, bench recipes, channel maps, validations,
    hidden files, and files that begin with an underscore (parents only). A file that is named explicitly is
    always read.
    """
    seen: set[str] = set()
    for given in paths:
        named = not os.path.isdir(given)  # noqa: PTH112 - Path.is_dir raises for names that are too long
        for path in [given] if named else _files_below(given, diagnostics):
            key = os.path.abspath(path)  # noqa: PTH100 - one file under two spellings, links left alone
            if key in seen:
                continue
            seen.add(key)
            if not named and not files.roots.contain(path):
                diagnostics.append(link_outside(path))
                continue
            tree = None
            with collecting(diagnostics, whole_file(path)):
                try:
                    tree = files.at(path)
                except ScenarioErrors as errors:
                    tree = errors.salvaged if isinstance(errors.salvaged, Map) else None
                    raise
            schema = None if tree is None else tree.get("schema")
            is_other = isinstance(schema, Scalar) and schema.value in _OTHER_SCHEMAS
            if tree is not None and (named or not is_other):
                yield path, tree


def link_outside(path: Path) -> Diagnostic:
    """The error of a file in a given folder that is a link to a place outside: it is not read."""
    return diagnose(whole_file(path), "a link that leads out of the folders given", hint=trust_hint(path))


def _files_below(folder: Path, diagnostics: list[Diagnostic]) -> list[Path]:
    def report(error: OSError) -> None:
        diagnostics.extend(unreadable_error(whole_file(Path(error.filename or folder)), error).diagnostics)

    inside: list[Path] = []
    for parent, folders, names in os.walk(folder, onerror=report):
        folders[:] = [name for name in folders if not name.startswith(".")]
        inside.extend(Path(parent, name) for name in names if _may_be_scenario(name))
    return sorted(inside, key=Path.as_posix)


def _may_be_scenario(name: str) -> bool:
    return (
        name.endswith((".yaml", ".yml"))
        and not name.startswith((".", "_"))
        and not name.endswith((*SWEEP_SUFFIXES, *SERIES_SUFFIXES, *PROGRAMME_SUFFIXES))
    )
