"""User text made harmless for the place where it is shown: terminal, CSV, XML, workflow command."""

from __future__ import annotations

import re
import shlex

from uictest.core.units import UNIT_SYMBOLS

_FORMULA_STARTS = ("=", "+", "-", "@", "\t", "\r", "\n", *"\uff1d\uff0b\uff0d\uff20")
_UNITS = "|".join(map(re.escape, sorted(UNIT_SYMBOLS)))
_QUANTITY = re.compile(rf"[+-]?(\d+\.?\d*|\.\d+)([eE][+-]?\d+)?( ?({_UNITS}))?")
_COMMAND = re.compile(r"^(\s*):(?=:)")
_NOT_XML = re.compile("[\0-\b\v\f\x0e-\x1f\x7f-\x84\x86-\x9f\ud800-\udfff\ufffe\uffff]")


def printable(text: str) -> str:
    """Return the text on one line with every control, format and unassigned character spelled out."""
    if text.isprintable():
        return text
    # It is not for exactly what can move the cursor, reverse the reading direction or hide.
    return "".join(
        each if each.isprintable() else each.encode("unicode_escape").decode("ascii") for each in text
    )


def argument(path: str) -> str:
    """Return a path as a shell takes it for one argument, and a command for no option: `./-x.yaml`."""
    return shlex.quote(f"./{path}" if path.startswith("-") else path)


def csv_cell(text: str) -> str:
    """Return the text as a cell no spreadsheet takes for a formula: an apostrophe goes in front of one.

    A number is none, nor is one with a unit, such as `-0.05 bar`.
    """
    shown = printable(text)
    harmless = not text.lstrip(" ").startswith(_FORMULA_STARTS) or _QUANTITY.fullmatch(text)
    return shown if harmless else f"'{shown}"


def xml_text(text: str) -> str:
    """Return the text without the characters that XML 1.0 forbids or discourages."""
    return _NOT_XML.sub("", text)


def workflow_message(text: str) -> str:
    """Return the text as the message of a GitHub workflow command (line breaks stay)."""
    lines = "\n".join(printable(line) for line in text.split("\n"))
    return lines.replace("%", "%25").replace("\n", "%0A")


def workflow_property(text: str) -> str:
    """Return the text as the value of a property of a GitHub workflow command."""
    return workflow_message(text).replace(":", "%3A").replace(",", "%2C")


def no_command(line: str) -> str:
    """Return a line of the log as one that GitHub does not take for a command, whatever it contains."""
    # The runner looks behind leading blanks, and for commands of its first kind anywhere in a line.
    return _COMMAND.sub(r"\1\\x3a", line).replace("##[", r"#\x23[")
