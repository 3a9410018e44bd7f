"""Statements of a Python file that begin with a name, found without running or parsing the rest."""

import ast
import re
from collections.abc import Iterator
from typing import Final, NamedTuple

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
