"""The parts that a case was run with, and every parameter in them."""

from __future__ import annotations

import hashlib
import json
from collections.abc import Iterable, Mapping
from dataclasses import dataclass, field
from functools import cached_property
from typing import Any

_DIGITS = 12
"""Hexadecimal digits of a digest: of ten thousand parts two share one with a probability below 1e-6."""


@dataclass(frozen=True, slots=True)
class Parameter:
    """One number or setting.

    Args:
        key: where it stands in the scenario, e.g. `controller.slip_threshold`.
        value: in `unit`; a text or a truth value for a setting.
        unit: SI, `1` for a pure number, empty for a setting.
        written: the value as the file writes it.
        mark: how far it can be trusted: stated, published, identified or chosen; `user` for a value that the
            user gave without a source, `default` for one that was not given, empty for a setting of a library
            part.
        source: a key of the part's `sources`, else empty.
        differs: whether the part that this one is based on has another value, or none.
        library_value: its value there where it differs, in `unit`; None where it has none.
        library_written: the same as the file writes it, else empty.

    """

    key: str
    value: float | str
    unit: str
    written: str
    mark: str
    source: str = ""
    differs: bool = False
    library_value: float | str | None = None
    library_written: str = ""

    def to_dict(self) -> dict[str, Any]:
        """Return the JSON form: `library_value` and `library_written` only where the parameter differs."""
        names = _OF_EVERY_PARAMETER if not self.differs else (*_OF_EVERY_PARAMETER, *_OF_A_CHANGED_ONE)
        return {name: getattr(self, name) for name in names}


_OF_EVERY_PARAMETER = ("key", "value", "unit", "written", "mark", "source", "differs")
_OF_A_CHANGED_ONE = ("library_value", "library_written")


@dataclass(frozen=True)
class EffectivePart:
    """A part of the rig, a section of the scenario or a profile of criteria, with its parameters.

    Args:
        kind: controller, vehicle, ...; `scenario`, `scenario.brake`, ... for what the scenario says itself.
        key: where it stands in the scenario.
        name: what its file calls it.
        based_on: name of the library part at the root of `extends`, or of the file there; None where it
            extends nothing.
        parameters: all of them, in the order of the model.
        removed: keys of parameters, or of whole sections, that the part at the root has and this one has not.
        sources: text of each source that a parameter names.

    """

    kind: str
    key: str
    name: str
    based_on: str | None
    parameters: tuple[Parameter, ...]
    removed: tuple[str, ...] = ()
    sources: Mapping[str, str] = field(default_factory=dict)

    @cached_property
    def id(self) -> str:
        """Kind and digest of the content, e.g. `controller/3f2a91c0b2d4`."""
        text = json.dumps(self.to_dict(), sort_keys=True)
        return f"{self.kind}/{hashlib.sha256(text.encode('utf-8', 'surrogatepass')).hexdigest()[:_DIGITS]}"

    @cached_property
    def changed(self) -> tuple[Parameter, ...]:
        """The parameters that differ from the part it is based on; in a scenario, from the defaults."""
        return tuple(parameter for parameter in self.parameters if parameter.differs)

    def to_dict(self) -> dict[str, Any]:
        """Return the JSON form."""
        return {
            "kind": self.kind,
            "key": self.key,
            "name": self.name,
            "based_on": self.based_on,
            "parameters": [parameter.to_dict() for parameter in self.parameters],
            "removed": list(self.removed),
            "sources": dict(self.sources),
        }

    @classmethod
    def from_dict(cls, content: Mapping[str, Any]) -> EffectivePart:
        """Return the part whose `to_dict` is `content`."""
        parameters = tuple(Parameter(**each) for each in content["parameters"])
        return cls(**{**content, "parameters": parameters, "removed": tuple(content["removed"])})


def parts_table(cases: Iterable[Mapping[str, EffectivePart]]) -> dict[str, EffectivePart]:
    """Return every distinct part of some cases by its id, in the order of its first use."""
    return {part.id: part for parts in cases for part in parts.values()}
