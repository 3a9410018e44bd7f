"""A controller from outside: what names it, and what it is given against the parameters that it declares.

Installed packages register controllers as entry points of the group ``uictest.controllers``.
"""

from __future__ import annotations

import json
import math
from collections.abc import Iterator, Mapping, Sequence
from dataclasses import dataclass, field
from difflib import get_close_matches
from pathlib import Path
from typing import TYPE_CHECKING, Any, Final, Literal, NamedTuple, Protocol

if TYPE_CHECKING:
    from importlib.metadata import EntryPoint

CONTRACTS: Final = (1, 2)
"""Versions of the contract. Version 2 appends its fields to those of version 1, in inputs and outputs."""
_SHOWN: Final = 8
"""Names that a message lists at most; chosen."""


class Declaration(Protocol):
    """One declared parameter."""

    @property
    def default(self) -> Any:
        """Its value where nobody gives it; None where the program keeps its own."""

    @property
    def unit(self) -> str:
        """Unit of a number; empty or 1 for none."""

    @property
    def range(self) -> Sequence[float] | None:
        """Its smallest and its largest value; None where any is accepted."""


class Problem(NamedTuple):
    """An error in one parameter of a controller, and a hint what to write."""

    name: str
    message: str
    hint: str = ""

    def __str__(self) -> str:
        return f"{self.message}; {self.hint}" if self.hint else self.message


def unknown_parameter(name: str, known: Sequence[str]) -> Problem:
    """Return the problem of a name that is not declared, with the nearest of those that are."""
    near = get_close_matches(name, known, n=1)
    more = ", ..." if len(known) > _SHOWN else ""
    hint = f"did you mean {near[0]}?" if near else f"accepted: {', '.join(known[:_SHOWN]) or 'none'}{more}"
    return Problem(name, f"no parameter {name}", hint)


def parameter_problems(
    declared: Mapping[str, Declaration], given: Mapping[str, Any], *, free: bool = False
) -> Iterator[Problem]:
    """Yield names that are not declared, unless any are accepted, and values of another kind or range."""
    for name, value in given.items():
        if name in declared:
            yield from _problems_of_value(name, declared[name], value)
        elif not free:
            yield unknown_parameter(name, tuple(declared))


def _problems_of_value(name: str, declared: Declaration, value: Any) -> Iterator[Problem]:
    unit = f" {declared.unit}" if declared.unit not in ("", "1") else ""
    expected = None if declared.default is None else _kind_in_words(declared.default)
    if expected is not None and _kind_in_words(value) != expected:
        written = value if isinstance(value, str) else json.dumps(value)
        hint = f"write a bare number{unit and ' in'}{unit}" if expected == "a number" else ""
        yield Problem(name, f"expected {expected}, found {_kind_in_words(value)} ({written})", hint)
        return
    for element in value if isinstance(value, list | tuple) else (value,):
        if isinstance(element, float) and not math.isfinite(element):
            yield Problem(name, f"{element} is no finite number", "accepted: finite numbers")
        elif declared.range is not None:
            low, high = declared.range
            if _kind_in_words(element) != "a number" or not low <= element <= high:
                yield Problem(name, f"{element} is out of range", f"accepted: {low:g} to {high:g}{unit}")


def _kind_in_words(value: Any) -> str:
    kinds = {bool: "true or false", str: "a text", int | float: "a number", list | tuple: "a list"}
    return next((words for kind, words in kinds.items() if isinstance(value, kind)), "a mapping")


def nothing_declared(given: Mapping[str, Any]) -> Problem:
    """Return the problem of parameters for a controller that declares none: the lines to write."""
    names, lines = ", ".join(given), []
    for name, value in given.items():
        kind = _kind_in_words(value)
        default = "NUMBER, unit: UNIT" if kind == "a number" else kind.split()[-1].upper()
        lines.append(f"{name}: {{default: {default}}}")
    declared = f"`declared_parameters: {{{', '.join(lines)}}}`"
    hint = f"write {declared} in its part, or `free_parameters: true` to accept any name"
    return Problem(next(iter(given)), f"the controller declares no parameters, given: {names}", hint)


HEADER: Final = Path(__file__).with_name("uictest_controller.h")
"""The header that a controller in C includes."""

Kind = Literal["python", "library", "fmu", "connect", "registered"]
ProgramKey = tuple[str, str, str]
"""Kind, location and SHA-256 of a program."""


@dataclass(frozen=True, slots=True)
class ControllerProgram:
    """A controller that is not part of this package.

    Attributes:
        kind: the key that names it in a scenario.
        location: absolute path of its file, address of its socket, or its registered name.
        sha256: of the file; empty where there is none.
        parameters: its parameters as a JSON object.
        options: what only this kind has, such as ``class``.
        time_limit: longest time for one answer, s.
        real_time: whether its cycles are paced by the clock; only a program at a socket can be.
    """

    kind: Kind
    location: str
    sha256: str = ""
    parameters: str = "{}"
    options: Mapping[str, Any] = field(default_factory=dict)
    time_limit: float = 5.0
    real_time: bool = False

    @property
    def key(self) -> ProgramKey:
        """Identity of a program: equal for the same file or address."""
        return self.kind, self.location, self.sha256

    @property
    def surroundings(self) -> str:
        """Source of the modules and libraries that it may load, in words."""
        if self.kind == "connect":
            return "a process of its own"
        return "installed packages" if self.kind == "registered" else str(Path(self.location).parent)


LONGEST_VERSION: Final = 100
"""Characters of a version at most: it stands in sentences. Chosen."""


def shown_version(text: str) -> str:
    """Return a version that a program states, empty where it cannot be shown on one line."""
    return text if text.isprintable() and len(text) <= LONGEST_VERSION else ""


GROUP: Final = "uictest.controllers"


def installed_names() -> tuple[str, ...]:
    """Return the names of all registered controllers, sorted; no package is imported."""
    from importlib.metadata import entry_points  # only unknown names need it

    return tuple(sorted(entry_points(group=GROUP).names))


def installed(name: str) -> tuple[EntryPoint, ...]:
    """Return the entry points registered by packages under a name: none, one, or several that collide."""
    from importlib.metadata import entry_points

    return tuple(entry_points(group=GROUP, name=name))


def package_of(entry: EntryPoint) -> str:
    """Return name and version of the package that has registered a controller."""
    return "" if entry.dist is None else f"{entry.dist.name} {entry.dist.version}"


def installed_version(name: str) -> str:
    """Return name and version of the package that has registered a controller, empty if none or several have.

    Only the metadata of the package are read; it is not imported.
    """
    entries = installed(name)
    return shown_version(package_of(entries[0])) if len(entries) == 1 else ""


def installed_module(name: str) -> str:
    """Return the module that holds what is registered under a name, empty if no or several packages have it.

    Only the metadata of the package are read; it is not imported.
    """
    entries = installed(name)
    return entries[0].module if len(entries) == 1 else ""
