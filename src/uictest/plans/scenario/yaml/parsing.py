"""YAML text to a tree of nodes with places.

Reads the events of the YAML parser instead of its objects: no tag can construct anything, no alias is ever
expanded, and size and depth are bounded before memory is spent.
"""

import re
from collections.abc import Callable
from typing import Any, Final

import yaml

from uictest.plans.scenario.yaml.diagnostics import Diagnostic, ScenarioErrors, diagnose, single_error
from uictest.plans.scenario.yaml.tree import (
    Document,
    Entry,
    Map,
    Node,
    Place,
    Scalar,
    Sequence,
    quoted,
    visible,
)

DEEPEST: Final = 20
MOST_NODES: Final = 20_000
MOST_DIAGNOSTICS: Final = 20

_LOADER = getattr(yaml, "CSafeLoader", yaml.SafeLoader)
# Non-printable characters of YAML 1.2; the parser would stop at them without a usable position.
_FORBIDDEN = re.compile("[^\t\n\r\x20-\x7e\x85\xa0-\ud7ff\ue000-\ufffd\U00010000-\U0010ffff]")
_BYTE_ORDER_MARK = "\ufeff"
# Plain scalars of YAML 1.2 (core schema).
_NULL: Final = frozenset({"", "~", "null", "Null", "NULL"})
_TRUE: Final = frozenset({"true", "True", "TRUE"})
_FALSE: Final = frozenset({"false", "False", "FALSE"})
# Python refuses to convert thousands of digits; nothing here needs more than these.
_INTEGER = re.compile(r"[-+]?[0-9]{1,30}")
_OCTAL = re.compile(r"0o[0-7]{1,30}")
_HEXADECIMAL = re.compile(r"0x[0-9a-fA-F]{1,30}")
_FLOAT = re.compile(r"[-+]?(?:\.[0-9]+|[0-9]+(?:\.[0-9]*)?)(?:[eE][-+]?[0-9]+)?")
_INFINITE = re.compile(r"[-+]?\.(?:inf|Inf|INF)")
_BEGINS_NUMBER: Final = frozenset("+-.0123456789")
_NAN: Final = frozenset({".nan", ".NaN", ".NAN"})


def parse(
    document: Document,
    line: int = 1,
    column: int = 1,
    text: str | None = None,
    beginning: str = "a scenario starts with its schema",
) -> Node:
    """The tree of a document, or of a piece of it that starts at ``line`` and ``column``.

    ``beginning`` is the hint for an empty document.

    Raises ScenarioErrors with every structural error and, if the text could be parsed in spite of them, the
    tree.
    """
    return _Parser(document, document.text if text is None else text, line, column, beginning).parse()


class _Parser:
    """Recursive descent over parser events."""

    def __init__(self, document: Document, text: str, line: int, column: int, beginning: str) -> None:
        self.document = document
        self.text = text
        self.line = line
        self.column = column
        self.beginning = beginning
        self.diagnostics: list[Diagnostic] = []
        self.nodes = 0
        self.next_event: Callable[[], Any] = _no_event

    def parse(self) -> Node:
        self._reject_control_characters()
        root: Node | None = None
        try:
            root = self._root()
        except yaml.YAMLError as error:
            self.diagnostics.append(self._syntax_error(error))
        except RecursionError:
            raise single_error(Place(self.document), "nested too deeply") from None
        if self.diagnostics or root is None:
            raise ScenarioErrors(self.diagnostics, root)
        return root

    def _reject_control_characters(self) -> None:
        match = _FORBIDDEN.search(self.text, 1 if self.text.startswith(_BYTE_ORDER_MARK) else 0)
        if match is not None:
            before = Document("", self.document.folder, self.text[: match.start()]).lines
            place = self._place(len(before) - 1, len(before[-1]))
            raise single_error(
                place, f"character {quoted(match[0])} is not allowed in YAML", hint="is this a text file?"
            )

    def _root(self) -> Node:
        loader = _LOADER(self.text)
        try:
            self.next_event = loader.get_event
            return self._only_document()
        finally:
            loader.dispose()

    def _only_document(self) -> Node:
        self.next_event()  # start of the stream
        if isinstance(self.next_event(), yaml.StreamEndEvent):
            raise single_error(Place(self.document), "the file is empty", hint=self.beginning)
        root = self._node(self.next_event(), depth=0)
        self.next_event()  # end of the document
        after = self.next_event()
        if not isinstance(after, yaml.StreamEndEvent):
            self._report(after, "a second YAML document", "one file holds one of them")
        return root

    def _node(self, event: Any, depth: int) -> Node:
        self._guard(event, depth)
        place = self._place_of(event)
        kind = type(event)
        if kind is yaml.ScalarEvent:
            text = event.value
            if "\0" in text:  # as an escape; no path and no name can have it
                raise single_error(place, f"character {quoted(chr(0))} is not accepted")
            # A style is a quotation or a block.
            return Scalar(text if event.style else scalar_value(text), text, place)
        if kind is yaml.MappingStartEvent:
            return self._map(place, depth)
        if kind is yaml.SequenceStartEvent:
            return self._sequence(place, depth)
        self._report(event, f"alias {quoted('*' + str(event.anchor))} is not accepted", _REPEAT_HINT)
        return Scalar(None, "", place)

    def _guard(self, event: Any, depth: int) -> None:
        self.nodes += 1
        if self.nodes > MOST_NODES:
            raise single_error(self._place_of(event), f"more than {MOST_NODES} values in one file")
        if depth > DEEPEST:
            raise single_error(self._place_of(event), f"nested deeper than {DEEPEST} levels")
        if type(event) is yaml.AliasEvent:
            return
        if event.anchor is not None:
            self._report(event, f"anchor {quoted('&' + event.anchor)} is not accepted", _REPEAT_HINT)
        if event.tag is not None:
            self._report(event, f"tag {quoted(event.tag)} is not accepted", "write the value without a tag")

    def _map(self, place: Place, depth: int) -> Map:
        entries: dict[str, Entry] = {}
        while type(event := self.next_event()) is not yaml.MappingEndEvent:
            key = self._node(event, depth + 1)
            node = self._node(self.next_event(), depth + 1)
            if not isinstance(key, Scalar):
                error = diagnose(key.place, "a key must be a text", hint="write `key: value`")
                self.diagnostics.append(error)
            elif key.text in entries:
                self.diagnostics.append(_duplicate(key, entries[key.text]))
            else:
                entries[key.text] = Entry(key.place, node)
        return Map(entries, place)

    def _sequence(self, place: Place, depth: int) -> Sequence:
        items: list[Node] = []
        while type(event := self.next_event()) is not yaml.SequenceEndEvent:
            items.append(self._node(event, depth + 1))
        return Sequence(tuple(items), place)

    def _report(self, event: Any, message: str, hint: str) -> None:
        self.diagnostics.append(diagnose(self._place_of(event), message, hint=hint))
        if len(self.diagnostics) >= MOST_DIAGNOSTICS:
            raise ScenarioErrors(self.diagnostics)

    def _place_of(self, event: Any) -> Place:
        mark = event.start_mark
        return self._place(mark.line, mark.column)

    def _place(self, line: int, column: int) -> Place:
        return Place(self.document, self.line + line, (self.column if line == 0 else 1) + column)

    def _syntax_error(self, error: yaml.YAMLError) -> Diagnostic:
        mark = getattr(error, "problem_mark", None) or getattr(error, "context_mark", None)
        place = Place(self.document) if mark is None else _within(self._place(mark.line, mark.column))
        problem = getattr(error, "problem", None) or getattr(error, "reason", None) or "cannot be read"
        context = getattr(error, "context", None)
        message = f"not valid YAML: {problem}" + (f" ({context})" if context else "")
        return diagnose(place, visible(message), hint=_syntax_hint(place))


def _no_event() -> Any:
    return None


_REPEAT_HINT: Final = "repeat the value, or use `extends`"


def _duplicate(key: Scalar, first: Entry) -> Diagnostic:
    return diagnose(
        key.place, f"duplicate key {quoted(key.text)}", key.text, f"first given in line {first.key.line}"
    )


def _within(place: Place) -> Place:
    """The place itself, or the end of the text when the parser points beyond it."""
    lines = place.document.lines
    return place if place.line <= len(lines) else Place(place.document, len(lines), len(lines[-1]) + 1)


def _syntax_hint(place: Place) -> str:
    lines = place.document.lines
    line = lines[place.line - 1]
    return "indent with blanks, not with tabs" if line[: len(line) - len(line.lstrip())].count("\t") else ""


def scalar_value(text: str) -> str | int | float | bool | None:
    """The value of a plain (unquoted) scalar: ``on`` and ``no`` are texts, ``1e3`` is a number."""
    if text in _NULL:
        return None
    if text in _TRUE or text in _FALSE:
        return text in _TRUE
    return _scalar_number(text)


def _scalar_number(text: str) -> str | int | float:
    if text[0] not in _BEGINS_NUMBER:
        return text
    if _INTEGER.fullmatch(text):
        return int(text)
    if _OCTAL.fullmatch(text):
        return int(text[2:], 8)
    if _HEXADECIMAL.fullmatch(text):
        return int(text[2:], 16)
    if _FLOAT.fullmatch(text):
        return float(text)
    if _INFINITE.fullmatch(text):
        return float(text.replace(".", ""))
    return float("nan") if text in _NAN else text
