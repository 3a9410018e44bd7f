"""The tree of a YAML file, with the place of every key and value, and how user text is worded."""

import re
from collections.abc import Iterable, Mapping
from dataclasses import dataclass
from difflib import get_close_matches
from functools import cached_property
from pathlib import Path
from typing import Any, Final, NamedTuple

COMMAND_LINE: Final = "--set"
"""Display name of values from the command line, in place of a file name."""

# libyaml counts these as line breaks, so excerpts must too.
_LINE_BREAK = re.compile("\r\n|[\n\r\x85\u2028\u2029]")


@dataclass(frozen=True, eq=False)
class Document:
    """One text that was read: a file, a library file, or an option of the command line."""

    display: str
    """Name shown in messages."""
    folder: Path
    """Where relative paths inside it start."""
    text: str
    sha256: str = ""

    @cached_property
    def lines(self) -> list[str]:
        """The lines of the text as YAML counts them."""
        return _LINE_BREAK.split(self.text)


class Place(NamedTuple):
    """A position in a document, counted from one."""

    document: Document
    line: int = 1
    column: int = 1


class Scalar(NamedTuple):
    """A single value; ``text`` is what the file says."""

    value: str | int | float | bool | None
    text: str
    place: Place


class Sequence(NamedTuple):
    """A list."""

    items: tuple["Node", ...]
    place: Place


class Entry(NamedTuple):
    """A value with the place of its key."""

    key: Place
    node: "Node"


class Map(NamedTuple):
    """A mapping."""

    entries: Mapping[str, Entry]
    place: Place

    def get(self, key: str) -> "Node | None":
        """The value at ``key``."""
        entry = self.entries.get(key)
        return None if entry is None else entry.node

    def with_entry(self, key: str, entry: Entry) -> "Map":
        """A copy in which ``key`` has another value."""
        return self._replace(entries={**self.entries, key: entry})

    def without(self, *keys: str) -> "Map":
        """A copy without ``keys``."""
        return self._replace(entries={key: entry for key, entry in self.entries.items() if key not in keys})


Node = Scalar | Sequence | Map


class WrittenFloat(float):
    """A float that remembers its digits as written."""

    __slots__ = ("text",)
    text: str


def plain(node: Node) -> Any:
    """The node as Python data: str, int, WrittenFloat, bool, None, tuple and dict."""
    if isinstance(node, Map):
        return {key: plain(entry.node) for key, entry in node.entries.items()}
    if isinstance(node, Sequence):
        return tuple(plain(item) for item in node.items)
    if isinstance(node.value, float):
        number = WrittenFloat(node.value)
        number.text = node.text
        return number
    return node.value


def as_written(node: Node) -> str:
    """The node in one line, as a flow of YAML."""
    if isinstance(node, Map):
        return (
            "{" + ", ".join(f"{key}: {as_written(entry.node)}" for key, entry in node.entries.items()) + "}"
        )
    if isinstance(node, Sequence):
        return "[" + ", ".join(map(as_written, node.items)) + "]"
    return node.text


def describe(node: Node) -> str:
    """What sort of node this is, in the words of a message."""
    if isinstance(node, Map):
        return "a mapping"
    if isinstance(node, Sequence):
        return "a list"
    if node.value is None:
        return "nothing"
    names: dict[type, str] = {bool: "true or false", str: "a text"}
    return names.get(type(node.value), "a number")


def merge(parent: Node, child: Node) -> Node:
    """``child`` laid over ``parent``: maps merge, everything else is replaced by the child's."""
    if not isinstance(parent, Map) or not isinstance(child, Map) or _is_marked(parent) or _is_marked(child):
        return child
    entries = dict(parent.entries)
    for key, entry in child.entries.items():
        below = entries.get(key)
        entries[key] = entry if below is None else Entry(entry.key, merge(below.node, entry.node))
    return Map(entries, child.place)


def _is_marked(node: Map) -> bool:
    # A number with its source is one value: a changed number must not keep the source of the old one.
    return "value" in node.entries


def entry_at(node: Node, key: tuple[str | int, ...]) -> tuple[Entry, int]:
    """The entry nearest to ``key`` and how many elements of the key lead to it.

    Elements that name nothing are passed over: a validator's location has tags for members of unions.
    """
    entry, depth = Entry(node.place, node), 0
    for count, element in enumerate(key, start=1):
        inner = _child(entry.node, element)
        if inner is not None:
            entry, depth = inner, count
    return entry, depth


def _child(node: Node, element: str | int) -> Entry | None:
    if isinstance(node, Map) and isinstance(element, str):
        return node.entries.get(element)
    if isinstance(node, Sequence) and isinstance(element, int) and 0 <= element < len(node.items):
        item = node.items[element]
        return Entry(item.place, item)
    return None


QUOTED_LENGTH: Final = 60
EXAMPLE_LENGTH: Final = 80


def visible(text: str) -> str:
    """``text`` with every character that a terminal would act on, or not show, written as an escape."""
    if text.isprintable():
        return text
    return "".join(char if char.isprintable() else _escape(char) for char in text)


def _escape(char: str) -> str:
    code = ord(char)
    if code <= 0xFF:
        return f"\\x{code:02x}"
    return f"\\u{code:04x}" if code <= 0xFFFF else f"\\U{code:08x}"


def quoted(text: str) -> str:
    """``text`` in single quotes, escaped and cut to a readable length."""
    short = text if len(text) <= QUOTED_LENGTH else text[: QUOTED_LENGTH - 3] + "..."
    return f"'{visible(short)}'"


def short_example(text: str) -> str:
    """Return the text, escaped; empty if it is too long for a hint, since half an example is wrong."""
    return visible(text) if len(text) <= EXAMPLE_LENGTH else ""


def nearest(text: str, valid: Iterable[str]) -> str | None:
    """The valid name that ``text`` was probably meant to be."""
    candidates = list(valid)
    matches = get_close_matches(
        text[:QUOTED_LENGTH].lower(), [name.lower() for name in candidates], n=1, cutoff=0.6
    )
    if not matches:
        return longer_name(text, candidates)
    return next(name for name in candidates if name.lower() == matches[0])


def longer_name(text: str, valid: Iterable[str]) -> str | None:
    """The one valid name of which ``text`` is a whole word: `initial_speed` for `speed`."""
    longer = [name for name in valid if text.lower() in name.lower().split("_")]
    return longer[0] if len(longer) == 1 else None


def suggestion(text: str, valid: Iterable[str]) -> str:
    """A hint that names the nearest valid name, or else lists what is accepted."""
    candidates = sorted(valid)
    guess = nearest(text, candidates)
    if guess is not None:
        return f"did you mean {quoted(guess)}?"
    return "accepted: " + ", ".join(candidates) if candidates else ""
