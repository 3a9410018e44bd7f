"""YAML text to a tree of nodes with the place of every key and value.

Reads the events of the YAML parser instead of its objects or nodes: no tag can construct anything, no alias
is ever expanded, anchors are seen, and size and depth are bounded before memory is spent.
"""

import math
import re
from collections.abc import Callable, Mapping
from functools import partial
from typing import Any, Final, NamedTuple

import yaml

from uictest.plans.scenario.yaml.diagnostics import (
    Diagnostic,
    Document,
    Location,
    ScenarioErrors,
    diagnose,
    quoted,
    single_error,
    visible,
)


class Scalar(NamedTuple):
    """A single value; ``text`` is what the file says."""

    value: str | int | float | bool | None
    text: str
    location: Location


class List(NamedTuple):
    """A list."""

    items: tuple["Node", ...]
    location: Location


class Entry(NamedTuple):
    """A value with the place of its key."""

    key: Location
    node: "Node"


class Map(NamedTuple):
    """A mapping."""

    entries: Mapping[str, Entry]
    location: Location

    def get(self, key: str) -> "Node | None":
        """The value at ``key``."""
        entry = self.entries.get(key)
        return None if entry is None else entry.node

    def at(self, *key: str) -> "Node | None":
        """The value at a key that leads through mappings inside."""
        node: Node | None = self
        for element in key:
            node = node.get(element) if isinstance(node, Map) else None
        return node

    def with_entry(self, key: str, entry: Entry) -> "Map":
        """A copy in which ``key`` has another value."""
        return self._replace(entries={**self.entries, key: entry})

    def without(self, *keys: str) -> "Map":
        """A copy without ``keys``."""
        return self._replace(entries={key: entry for key, entry in self.entries.items() if key not in keys})


Node = Scalar | List | Map


class WrittenFloat(float):
    """A float that remembers its digits as written."""

    __slots__ = ("text",)
    text: str


def is_null(node: Node | None) -> bool:
    """Return whether a key is missing, or says nothing."""
    return node is None or (isinstance(node, Scalar) and node.value is None)


def plain(node: Node) -> Any:
    """Return the node as Python data: str, int, WrittenFloat, bool, None, tuple and dict."""
    if isinstance(node, Map):
        return {
            key: inner.value if type(inner) is Scalar else plain(inner)
            for key, (_, inner) in node.entries.items()
        }
    if isinstance(node, List):
        return tuple(inner.value if type(inner) is Scalar else plain(inner) for inner in node.items)
    return node.value


def as_written(node: Node) -> str:
    """The node in one line, as a flow of YAML."""
    if isinstance(node, Map):
        return (
            "{" + ", ".join(f"{key}: {as_written(entry.node)}" for key, entry in node.entries.items()) + "}"
        )
    if isinstance(node, List):
        return "[" + ", ".join(map(as_written, node.items)) + "]"
    return node.text


def describe(node: Node) -> str:
    """Kind of a node in the words of a message."""
    if isinstance(node, Map):
        return "a mapping"
    if isinstance(node, List):
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
    return Map(entries, child.location)


def _is_marked(node: Map) -> bool:
    # A number with its source is one value: a changed number must not keep the source of the old one.
    return "value" in node.entries


def entry_at(node: Node, key: tuple[str | int, ...]) -> tuple[Entry, int]:
    """The entry nearest to ``key`` and how many elements of the key lead to it.

    Elements that name nothing are passed over: a validator's location has tags for members of unions.
    """
    entry, depth = Entry(node.location, node), 0
    for count, element in enumerate(key, start=1):
        inner = _child_entry(entry.node, element)
        if inner is not None:
            entry, depth = inner, count
    return entry, depth


def _child_entry(node: Node, element: str | int) -> Entry | None:
    if isinstance(node, Map) and isinstance(element, str):
        return node.entries.get(element)
    if isinstance(node, List) and isinstance(element, int) and 0 <= element < len(node.items):
        item = node.items[element]
        return Entry(item.location, item)
    return None


DEEPEST: Final = 20
_MOST_NODES: Final = 20_000
_MOST_DIAGNOSTICS: Final = 20

_LOADER = getattr(yaml, "CSafeLoader", yaml.SafeLoader)
# Non-printable characters of YAML 1.2; the parser would stop at them without a usable position.
_FORBIDDEN = re.compile("[^\t\n\r\x20-\x7e\x85\xa0-\ud7ff\ue000-\ufffd\U00010000-\U0010ffff]")
_BYTE_ORDER_MARK = "\ufeff"
_REPEAT_HINT: Final = "repeat the value, or use `extends`"


def parse(
    document: Document,
    line: int = 1,
    column: int = 1,
    text: str | None = None,
    beginning: str = "a scenario starts with its schema",
) -> Node:
    """Return the tree of a document, or of a piece of it that starts at ``line`` and ``column``.

    ``beginning`` is the hint for an empty document.

    Raises ScenarioErrors with every structural error and, if the text could be parsed in spite of them, the
    tree.
    """
    parser = _Parser(document, document.text if text is None else text, line, column)
    root: Node | None = None
    try:
        root = parser.only_document(beginning)
    except yaml.YAMLError as error:
        parser.diagnostics.append(parser.syntax_error(error))
    except RecursionError:
        raise single_error(Location(document), "nested too deeply") from None
    finally:
        parser.loader.dispose()
    if parser.diagnostics or root is None:
        raise ScenarioErrors(parser.diagnostics, root)
    return root


class _Parser:
    """Recursive descent over parser events."""

    def __init__(self, document: Document, text: str, line: int, column: int) -> None:
        self.document = document
        self.line = line
        self.column = column
        self.diagnostics: list[Diagnostic] = []
        self.nodes = 0
        match = _FORBIDDEN.search(text, 1 if text.startswith(_BYTE_ORDER_MARK) else 0)
        if match is not None:
            before = Document("", document.folder, text[: match.start()]).lines
            raise single_error(
                self._location(len(before) - 1, len(before[-1])),
                f"character {quoted(match[0])} is not allowed in YAML",
                hint="is this a text file?",
            )
        self.loader: Any = _LOADER(text)

    def only_document(self, beginning: str) -> Node:
        next_event = self.loader.get_event
        next_event()  # start of the stream
        if isinstance(next_event(), yaml.StreamEndEvent):
            raise single_error(Location(self.document), "the file is empty", hint=beginning)
        root = self._node(next_event(), depth=0)
        next_event()  # end of the document
        after = next_event()
        if not isinstance(after, yaml.StreamEndEvent):
            location = self._location(after.start_mark.line, after.start_mark.column)
            self._add_diagnostic(location, "a second YAML document", "one file holds one of them")
        return root

    def _node(self, event: Any, depth: int) -> Node:
        mark, kind, next_event = event.start_mark, type(event), self.loader.get_event
        location = self._location(mark.line, mark.column)
        self.nodes += 1
        if self.nodes > _MOST_NODES:
            raise single_error(location, f"more than {_MOST_NODES} values in one file")
        if depth > DEEPEST:
            raise single_error(location, f"nested deeper than {DEEPEST} levels")
        if kind is yaml.AliasEvent:
            self._add_diagnostic(
                location, f"alias {quoted('*' + str(event.anchor))} is not accepted", _REPEAT_HINT
            )
            return Scalar(None, "", location)
        if event.anchor is not None:
            self._add_diagnostic(
                location, f"anchor {quoted('&' + event.anchor)} is not accepted", _REPEAT_HINT
            )
        if event.tag is not None:
            self._add_diagnostic(
                location, f"tag {quoted(event.tag)} is not accepted", "write the value without a tag"
            )
        if kind is yaml.MappingStartEvent:
            return self._map(location, depth)
        if kind is yaml.SequenceStartEvent:
            items: list[Node] = []
            while type(event := next_event()) is not yaml.SequenceEndEvent:
                items.append(self._node(event, depth + 1))
            return List(tuple(items), location)
        text = event.value
        if "\0" in text:  # as an escape; no path and no name can have it
            raise single_error(location, f"character {quoted(chr(0))} is not accepted")
        if event.style:  # a quotation or a block
            return Scalar(text, text, location)
        value = scalar_value(text)
        if type(value) is float:
            value = WrittenFloat(value)
            value.text = text
        return Scalar(value, text, location)

    def _map(self, location: Location, depth: int) -> Map:
        entries: dict[str, Entry] = {}
        next_event = self.loader.get_event
        while type(event := next_event()) is not yaml.MappingEndEvent:
            key, node = self._node(event, depth + 1), self._node(next_event(), depth + 1)
            if not isinstance(key, Scalar):
                error = diagnose(key.location, "a key must be a text", hint="write `key: value`")
                self.diagnostics.append(error)
            elif (first := entries.get(key.text)) is not None:
                hint = f"first given in line {first.key.line}"
                message = f"duplicate key {quoted(key.text)}"
                self.diagnostics.append(diagnose(key.location, message, key.text, hint))
            else:
                entries[key.text] = Entry(key.location, node)
        return Map(entries, location)

    def _add_diagnostic(self, location: Location, message: str, hint: str) -> None:
        self.diagnostics.append(diagnose(location, message, hint=hint))
        if len(self.diagnostics) >= _MOST_DIAGNOSTICS:
            raise ScenarioErrors(self.diagnostics)

    def _location(self, line: int, column: int) -> Location:
        return Location(self.document, self.line + line, (self.column if line == 0 else 1) + column)

    def syntax_error(self, error: yaml.YAMLError) -> Diagnostic:
        mark = getattr(error, "problem_mark", None) or getattr(error, "context_mark", None)
        location, lines = Location(self.document), self.document.lines
        if mark is not None:
            location = self._location(mark.line, mark.column)
        if location.line > len(lines):  # the parser points beyond the text
            location = Location(self.document, len(lines), len(lines[-1]) + 1)
        problem = getattr(error, "problem", None) or getattr(error, "reason", None) or "cannot be read"
        context = getattr(error, "context", None)
        message = f"not valid YAML: {problem}" + (f" ({context})" if context else "")
        line = lines[location.line - 1]
        has_tab = "\t" in line[: len(line) - len(line.lstrip())]
        hint = "indent with blanks, not with tabs" if has_tab else ""
        if "escape character" in message:
            hint = 'between " and " a backslash begins an escape: write / in paths'
        return diagnose(location, visible(message), hint=hint)


_WORDS: Final[dict[str, str | float | bool | None]] = {
    **dict.fromkeys(("", "~", "null", "Null", "NULL")),
    **dict.fromkeys(("true", "True", "TRUE"), True),
    **dict.fromkeys(("false", "False", "FALSE"), False),
    **dict.fromkeys((".nan", ".NaN", ".NAN"), math.nan),
    **{f"{sign}.{word}": float(f"{sign}inf") for sign in ("", "+", "-") for word in ("inf", "Inf", "INF")},
}
# Python refuses to convert thousands of digits; nothing here needs more than these.
_NUMBER = re.compile(
    r"(?P<whole>[-+]?[0-9]{1,30})|0o(?P<octal>[0-7]{1,30})|0x(?P<hexadecimal>[0-9a-fA-F]{1,30})"
    r"|(?P<decimal>[-+]?(?:\.[0-9]+|[0-9]+(?:\.[0-9]*)?)(?:[eE][-+]?[0-9]+)?)"
)
_READERS: Final[dict[str | None, Callable[[str], int | float]]] = {
    "whole": int,
    "octal": partial(int, base=8),
    "hexadecimal": partial(int, base=16),
    "decimal": float,
}


def scalar_value(text: str) -> str | int | float | bool | None:
    """Return the value of a plain scalar of YAML 1.2: ``on`` and ``no`` are texts, ``1e3`` is a number."""
    if text in _WORDS:
        return _WORDS[text]
    match = _NUMBER.fullmatch(text)
    return text if match is None else _READERS[match.lastgroup](match[match.lastgroup or 0])
