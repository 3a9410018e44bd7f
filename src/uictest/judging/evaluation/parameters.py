"""The parts that a case was run with, and what of it lies outside of a validated domain."""

from __future__ import annotations

import hashlib
import json
from collections.abc import Iterable, Mapping
from dataclasses import dataclass, field
from functools import cached_property
from typing import Annotated, Any, Final

from pydantic import ConfigDict, SerializerFunctionWrapHandler, TypeAdapter, WrapSerializer

from uictest.judging.evaluation.json_values import from_json_form, to_json_form

_DIGITS = 12
"""Hexadecimal digits of a digest: of ten thousand parts two share one with a probability below 1e-6."""

PlainValue = bool | int | float | str
"""Value of a parameter: a number in its unit, a text or a truth value."""


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
    value: PlainValue
    unit: str
    written: str
    mark: str
    source: str = ""
    differs: bool = False
    library_value: PlainValue | None = None
    library_written: str = ""


def _without_library(parameter: Parameter, write: SerializerFunctionWrapHandler) -> dict[str, Any]:
    form: dict[str, Any] = write(parameter)
    if not parameter.differs:
        del form["library_value"], form["library_written"]
    return form


WrittenParameter = Annotated[Parameter, WrapSerializer(_without_library)]
"""In JSON `library_value` and `library_written` stand only where the parameter differs."""


@dataclass(frozen=True)
class EffectivePart:
    """A part of the rig, a section of the scenario or a profile of criteria, with its parameters.

    Args:
        kind: controller, vehicle, ...; `scenario`, `scenario.brake`, ... for what the scenario says itself.
        key: where it stands in the scenario.
        name: what its file calls it; of a controller from outside, its class, file or address without one.
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
    parameters: tuple[WrittenParameter, ...]
    removed: tuple[str, ...] = ()
    sources: Mapping[str, str] = field(default_factory=dict)

    @cached_property
    def id(self) -> str:
        """Kind and digest of the content, e.g. `controller/3f2a91c0b2d4`."""
        text = json.dumps(parts_form({"": self})[""], sort_keys=True)
        return f"{self.kind}/{hashlib.sha256(text.encode('utf-8', 'surrogatepass')).hexdigest()[:_DIGITS]}"

    @cached_property
    def changed(self) -> tuple[Parameter, ...]:
        """The parameters that differ from the part it is based on; in a scenario, from the defaults."""
        return tuple(parameter for parameter in self.parameters if parameter.differs)


def parts_table(cases: Iterable[Mapping[str, EffectivePart]]) -> dict[str, EffectivePart]:
    """Return every distinct part of some cases by its id, in the order of its first use."""
    return {part.id: part for parts in cases for part in parts.values()}


_PARTS: Final = TypeAdapter(dict[str, EffectivePart], config=ConfigDict(extra="forbid", defer_build=True))


def parts_form(parts: Mapping[str, EffectivePart]) -> dict[str, Any]:
    """Return the JSON form of parts, under the keys given."""
    form: dict[str, Any] = to_json_form(_PARTS, parts)
    return form


def parts_document(cases: Iterable[Mapping[str, EffectivePart]]) -> dict[str, Any]:
    """Return the JSON form of every distinct part of some cases, by id."""
    return parts_form(parts_table(cases))


def parts_of(document: Mapping[str, Any]) -> dict[str, EffectivePart]:
    """Return the parts in a document by id.

    Raises ValueError where there are none, a part lacks or adds a field, or a value is of another type.
    """
    return from_json_form(_PARTS, document.get("parts"), place="parts")


Found = str | tuple[float, float] | None
"""A setting or the name of a part; the lowest and the highest value of a number, SI; None: it is not set."""


@dataclass(frozen=True, slots=True)
class Deviation:
    """One condition of a case that none of the validated stops had.

    Args:
        key: of the scenario, or of a part.
        found: in the case.
        validated: among the validated stops that come nearest to it.
        unit: of numbers, SI.

    """

    key: str
    found: Found
    validated: Found
    unit: str = ""


@dataclass(frozen=True, slots=True)
class DomainOfValidity:
    """Whether a case lies in the domain of a validation: then nothing is `outside`.

    Args:
        validation: its name.
        sha256: of its file.
        outside: every condition beyond it.

    """

    validation: str
    sha256: str
    outside: tuple[Deviation, ...] = ()
