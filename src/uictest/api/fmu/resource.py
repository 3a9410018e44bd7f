"""`resources/model.bin`: what the library of an FMU, which is the same in all, reads about this one."""

from __future__ import annotations

import zlib
from collections.abc import Mapping, Sequence
from dataclasses import dataclass, field
from functools import reduce
from operator import getitem
from typing import Any, Final

import numpy as np

from uictest.api.fmu.description import Model, Variable, place_of

FILE_NAME: Final = "resources/model.bin"
MAGIC: Final = "uictest1"
ENUMERATIONS: Final = {
    "MODEL": ("rig", "built_in", "library"),
    "KIND": ("real", "boolean", "integer"),
    "CAUSALITY": ("independent", "input", "output", "parameter"),
    "STORAGE": ("f8", "i4", "i8"),
    "BASE": ("number", "memory", "constant"),
    "FORM": ("number", "truth", "fixed"),
    "PLACE": (
        *("time", "cycle_time", "exchange"),
        *("kept", "closed", "commands", "ended"),  # of the rig
        *("initial_speed", "wheel_radius"),  # of a controller
    ),
}
"""Names of the numbers in the file, which count from 0."""
_SECTIONS: Final = ("variables", "arguments", "json", "memory", "constants", "texts")
HEAD: Final = np.dtype(
    [
        *(("magic", "u1", 8), ("code", "u1", 16), ("checksum", "u8"), ("size", "i8"), ("token", "u1", 40)),
        *((name, "i8") for name in ("model", "can_save", "begun", "kept")),
        ("places", "i8", len(ENUMERATIONS["PLACE"])),
        *((name, "i8", 2) for name in _SECTIONS),
    ]
)
"""Head of the file. `code`: digest of the sources that the library was made from. `checksum`: CRC-32 of all
bytes from `size` on. `begun`: number of bytes of the memory that are zeroed when a stop begins, except for
`kept` bytes at the place of that name. Of a section: offset of its first byte, number of rows or bytes."""
VARIABLE_ROW: Final = np.dtype(
    [
        *((name, "i8") for name in ("name", "kind", "causality", "storage", "place")),
        ("lowest", "f8"),
        ("highest", "f8"),
    ]
)
ARGUMENT_ROW: Final = np.dtype([("base", "i8"), ("value", "i8")])
"""An argument of the machine code: a number, or a place in the memory or among the constants."""
JSON_ROW: Final = np.dtype([("form", "i8"), ("text", "i8"), ("place", "i8")])
"""A parameter in the JSON object that a controller is given: its key, and the place of its value."""

LAYOUTS: Final = {"Head": HEAD, "VariableRow": VARIABLE_ROW, "ArgumentRow": ARGUMENT_ROW, "JsonRow": JSON_ROW}
"""The records of the file, by their names in C++."""


class _Texts:
    """Texts one after the other, each terminated by a zero byte."""

    def __init__(self) -> None:
        self.content = b""

    def place(self, text: str) -> int:
        """Append a text and return its offset."""
        self.content, offset = self.content + text.encode() + b"\0", len(self.content)
        return offset


@dataclass(frozen=True, slots=True)
class Content:
    """Contents of the model file of one FMU.

    Attributes:
        kind: what it is of, a name of ``ENUMERATIONS["MODEL"]``.
        start: memory of an instance at the start, a record in an array of shape (1,).
        places: name of ``ENUMERATIONS["PLACE"]`` -> path of a field of the memory.
        arguments: of the machine code, as :func:`uictest.rig.placed` gives them; `start` is block 1.
        constants: block 2, an array of shape (1,).
        begun: name of the field that is zeroed when a stop begins.
        json: for each parameter its form, key (with the value where that is fixed) and the path of the value.
    """

    kind: str
    start: Any
    places: Mapping[str, str]
    arguments: Sequence[tuple[int, int]] = ()
    constants: Any = field(default_factory=lambda: np.zeros(0, np.uint8))
    begun: str = ""
    json: Sequence[tuple[str, str, str]] = ()

    def file(self, model: Model, code: str) -> bytes:
        """Return the bytes of the file.

        Args:
            model: what its description says.
            code: digest of the sources that the libraries were built from.
        """
        texts = _Texts()
        variables = [self._variable_row(variable, texts) for variable in model.variables]
        json = [
            (ENUMERATIONS["FORM"].index(form), texts.place(text), self._place(path) if path else 0)
            for form, text, path in self.json
        ]
        sections = {
            "variables": np.array(variables, VARIABLE_ROW),
            "arguments": np.array([*self.arguments], ARGUMENT_ROW),
            "json": np.array(json, JSON_ROW),
            "memory": np.frombuffer(self.start.tobytes(), np.uint8),
            "constants": np.frombuffer(self.constants.tobytes(), np.uint8),
            "texts": np.frombuffer(texts.content, np.uint8),
        }
        return _serialised_model_file(self._head(model, code), sections)

    def _head(self, model: Model, code: str) -> Any:
        head = np.zeros(1, HEAD)
        for name, text in (("magic", MAGIC), ("code", code), ("token", model.token)):
            head[name][0, : len(text)] = np.frombuffer(text.encode(), np.uint8)
        head["model"], head["can_save"] = ENUMERATIONS["MODEL"].index(self.kind), model.can_save
        names = ENUMERATIONS["PLACE"]
        head["places"] = [self._place(self.places[name]) if name in self.places else 0 for name in names]
        if self.begun:
            head["begun"] = self.start[self.begun].nbytes
            head["kept"] = reduce(getitem, self.places["kept"].split("."), self.start).nbytes
        return head

    def _place(self, path: str) -> int:
        return place_of(self.start.dtype, path)[0]

    def _variable_row(self, variable: Variable, texts: _Texts) -> tuple[float, ...]:
        offset, storage = place_of(self.start.dtype, variable.path, variable.wheelset)
        numbers = (
            ENUMERATIONS["KIND"].index(variable.kind),
            ENUMERATIONS["CAUSALITY"].index(variable.causality),
            ENUMERATIONS["STORAGE"].index("i4" if storage == "u4" else storage),  # bit by bit
        )
        return (texts.place(variable.name), *numbers, offset, *(variable.range or (-np.inf, np.inf)))


def _serialised_model_file(head: Any, sections: Mapping[str, Any]) -> bytes:
    """Return the bytes of a file from its head and its sections.

    Sets the offsets and lengths of the sections, the size of the file and the checksum in ``head``. Each
    section begins at a multiple of 8 bytes. The checksum is the CRC-32 of all bytes from the field ``size``
    on. The reader in the C++ sources must match.
    """
    content = b""
    for name in _SECTIONS:
        content += bytes(-len(content) % 8)
        head[name] = HEAD.itemsize + len(content), len(sections[name])
        content += sections[name].tobytes()
    head["size"] = HEAD.itemsize + len(content)
    checked_from = HEAD.fields["size"][1]  # type: ignore[index]
    head["checksum"] = zlib.crc32(head.tobytes()[checked_from:] + content)
    return bytes(head.tobytes() + content)
