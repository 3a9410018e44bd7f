"""Writes plain Python functions of numbers and records as C++.

The source of a function is read with `ast`; the names of its module say what it calls. Each function becomes
a template of the same name, in a namespace named after its module. C++ finds the types: the arguments decide
whether a template works on one stop (`double`), on one lane of several (numbers that lie apart) or on all
lanes at once (vectors). Only what the model uses is known here; anything else is refused with its place and
with what to write instead, or its types do not compile.

What is taken gives the bits of Python, within limits that no compiler sees: whole numbers have 64 bits, or 53
where they meet a float; indices count from the front; and where Python would raise an error, as for a
division by zero or an index beyond the end, the code goes on.
"""

from collections.abc import Callable, Iterable, Mapping
from pathlib import Path
from types import FunctionType
from typing import Any

from kernel.function import FunctionWriter, place_of
from kernel.names import UntranslatableError, constant_text, literal, namespace, safe
from uictest.core.record import FieldCopier, FieldStarter

_FIXED = {int: "int64_t", bool: "bool"}
"""Members of a named tuple that are never a number of each lane."""


class Program:
    """Functions written so far, each behind those that it calls.

    Args:
        root: folder that the names of files are relative to.
        replaced: functions that the runtime header has, and their names there.
        outlined: functions that are called, not copied to where they are called.

    """

    def __init__(
        self, root: Path, replaced: Mapping[Any, str], outlined: Iterable[Callable[..., Any]] = ()
    ) -> None:
        self.root, self.replaced, self.outlined = root, dict(replaced), frozenset(outlined)
        self._parts: list[str] = []
        # By function, named tuple, (module, name) of a constant and (table, field) of a choice: C++ names.
        self.names: dict[Any, str] = {}
        self._being_written: set[Any] = set()

    def text(self) -> str:
        """Return all that was written."""
        return "\n".join(self._parts)

    def add(self, text: str) -> None:
        """Write C++ of one's own behind what is there."""
        self._parts.append(text)

    def function(self, function: Any) -> str:
        """Return the C++ name of a function, written now unless it was before."""
        if function in self.replaced:
            header: str = self.replaced[function]
            return header
        if function in self._being_written:
            raise UntranslatableError(f"{place_of(function)}: calls itself; write a loop")
        if function not in self.names:
            self._being_written.add(function)
            match function:
                case FieldCopier():
                    name, text = self._copier(function)
                case FieldStarter():
                    name, text = self._starter(function)
                case _:
                    name, text = self._written(function)
            self._being_written.remove(function)
            self.names[function] = name
            self._parts.append(text)
        written: str = self.names[function]
        return written

    def _written(self, function: FunctionType) -> tuple[str, str]:
        name = f"{namespace(function.__module__)}::{safe(function.__name__)}"
        return name, FunctionWriter(self, function).text()

    def _copier(self, copier: FieldCopier) -> tuple[str, str]:
        name = f"copy_{copier.record.__name__}"
        lines = "".join(f"    target->{safe(field)} = source->{safe(field)};\n" for field in copier.fields)
        return name, f"INLINE void {name}(auto target, auto source) {{\n{lines}}}\n"

    def _starter(self, starter: FieldStarter) -> tuple[str, str]:
        name = f"start_{starter.record.__name__}"
        values = starter.values.items()
        lines = "".join(f"    target->{safe(field)} = {literal(value)};\n" for field, value in values)
        return name, f"INLINE void {name}(auto target) {{\n{lines}}}\n"

    def choice(self, table: tuple[Any, ...], field: str, name: str) -> str:
        """Return the C++ name of the choice among the functions in a field of the rows of a table.

        As in Python, the number of a row comes first; in C++ the last row stands for any other number, too.
        """
        key = (id(table), field)
        if key not in self.names:
            targets = [self.function(getattr(row, field)) for row in table]
            self.names[key] = f"{safe(name.lower())}_{field}"
            lines = [f"    if (row == {n}) return {each}(given...);\n" for n, each in enumerate(targets[:-1])]
            lines.append(f"    return {targets[-1]}(given...);\n")
            head = f"INLINE auto {self.names[key]}(int64_t row, auto... given)"
            self._parts.append(f"{head} {{\n{''.join(lines)}}}\n")
        return self.names[key]

    def constant(self, module: str, name: str, value: Any, place: str) -> str:
        """Return the C++ name of a number, or of a table of numbers, of a module."""
        key = (module, name)
        if key not in self.names:
            self.names[key] = f"{namespace(module)}::{safe(name)}"
            self._parts.append(
                f"namespace {namespace(module)} {{ {constant_text(safe(name), value, place)} }}\n"
            )
        return self.names[key]

    def named_tuple(self, kind: Any) -> str:
        """Return the C++ name of a named tuple; members that are no whole number or truth have any type."""
        if kind not in self.names:
            self.names[kind] = safe(kind.__name__)
            fixed = {name: _FIXED.get(kind.__annotations__[name]) for name in kind._fields}
            free = [name for name in kind._fields if not fixed[name]]
            types = {name: fixed[name] or f"T{free.index(name)}" for name in kind._fields}
            head = f"template <{', '.join(f'class {types[name]}' for name in free)}> " if free else ""
            members = " ".join(f"{types[name]} {safe(name)};" for name in kind._fields)
            self_type = f"const {self.names[kind]}* operator->() const {{ return this; }}"
            lines = [f"{head}struct {self.names[kind]} {{ {members} {self_type} }};\n"]
            if free:
                deduced = f"{self.names[kind]}<{', '.join(types[name] for name in free)}>"
                lines.append(f"{head}{self.names[kind]}({', '.join(types.values())}) -> {deduced};\n")
            self._parts.append("".join(lines))
        return self.names[kind]
