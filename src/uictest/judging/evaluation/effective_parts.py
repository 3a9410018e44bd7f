"""The parts that a case was run with, their parameters, and which program its controller is."""

from __future__ import annotations

import hashlib
import json
from collections.abc import Iterable, Iterator, Mapping
from dataclasses import dataclass, field, replace
from functools import cached_property, lru_cache
from operator import attrgetter
from typing import Annotated, Any, Final, get_args

from pydantic import ConfigDict, SerializerFunctionWrapHandler, TypeAdapter, WrapSerializer

from uictest.controllers import Kind
from uictest.judging.evaluation.json_values import from_json_form, to_json_form
from uictest.plans.scenario import (
    DESCRIPTIVE,
    PART_KEYS,
    PART_KINDS,
    Coupler,
    DescribedValue,
    Scenario,
    described_values,
)
from uictest.plans.scenario.yaml import Key, Model, Part, dotted

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


_WRITTEN_PARTS: Final = TypeAdapter(
    dict[str, EffectivePart], config=ConfigDict(extra="forbid", defer_build=True)
)


def parts_form(parts: Mapping[str, EffectivePart]) -> dict[str, Any]:
    """Return the JSON form of parts, under the keys given."""
    form: dict[str, Any] = to_json_form(_WRITTEN_PARTS, parts)
    return form


def parts_document(cases: Iterable[Mapping[str, EffectivePart]]) -> dict[str, Any]:
    """Return the JSON form of every distinct part of some cases, by id."""
    return parts_form(parts_table(cases))


def parts_of(document: Mapping[str, Any]) -> dict[str, EffectivePart]:
    """Return the parts in a document by id.

    Raises ValueError where there are none, a part lacks or adds a field, or a value is of another type.
    """
    return from_json_form(_WRITTEN_PARTS, document.get("parts"), place="parts")


_PARTS: Final = {kind: dotted(key) for key, kind in PART_KINDS.items() if not PART_KEYS[key].several}
"""Kind of a part -> where it stands in a scenario."""

_CONDITIONS: Final = ("brake.command", "brake.position", "rail.gradient", "rig.wsp")
"""Keys that describe a recorded stop, besides rail condition, criteria and measures."""

_Rows = Mapping[Key, DescribedValue]
_SECTIONS: Final = ("brake", "rail", "rig", "simulation", "record")
_OF_SAND: Final = "rail.sand."
_RAIL_OVERRIDES: Final = ("friction", "cleaning", "variation")
"""Keys of the rail that replace what the rail condition has under the same name."""


class _Same:
    """A part that is equal to itself alone: to compare parts, or to hash one, is to read all of it."""

    __slots__ = ("part",)

    def __init__(self, part: Part) -> None:
        self.part = part

    def __hash__(self) -> int:
        return id(self.part)

    def __eq__(self, other: object) -> bool:
        return isinstance(other, _Same) and self.part is other.part


def effective_parts(scenario: Scenario) -> dict[str, EffectivePart]:
    """Return every part of a simulated stop by its role: the kind, and `criteria.0`, ... for profiles."""
    couplers = None if scenario.coupler is None else Coupler()  # a train has some, stated or not
    stop = [
        *_scenario_parameters(scenario, "", {"coupler": couplers}),
        *_scenario_parameters(scenario.simulation, "simulation.", {}),
    ]
    parts = {"scenario": EffectivePart("scenario", "", "", None, tuple(stop))}
    for name in ("brake", "rail", "rig"):
        own = tuple(_section_parameters(scenario, name))
        parts[f"scenario.{name}"] = EffectivePart(f"scenario.{name}", name, "", None, own)
    overrides = tuple(name for name in _RAIL_OVERRIDES if getattr(scenario.rail, name) is not None)
    for kind, key in _PARTS.items():
        part = attrgetter(key)(scenario)
        parts[kind] = _effective_part(_Same(part), kind, key, overrides if kind == "rail" else ())
    return parts | _profile_parts(scenario.judged_by)


def recorded_parts(scenario: Scenario) -> dict[str, EffectivePart]:
    """Return the parts of a recorded stop: conditions, measures and criteria, nothing of a rig."""
    condition = scenario.rail.condition
    stated = [Parameter("rail.condition", condition.name, "", condition.name, "user")]
    for name in ("brake", "rail", "rig"):
        stated += [row for row in _section_parameters(scenario, name) if row.key.startswith(_CONDITIONS)]
    stated += _section_parameters(scenario, "record")
    return {
        "conditions": EffectivePart("conditions", "", "", None, tuple(stated)),
        "measures": _effective_part(_Same(scenario.measures), "measures", "measures", ()),
        **_profile_parts(scenario.criteria),
    }


def _profile_parts(profiles: Iterable[Part]) -> dict[str, EffectivePart]:
    return {
        f"criteria.{index}": _effective_part(_Same(profile), "criteria", "", ())
        for index, profile in enumerate(profiles)
    }


_MOST_KEPT: Final = 1000
"""Parts that are kept in a process, those that were asked for last; chosen."""


@lru_cache(_MOST_KEPT)
def _effective_part(same: _Same, kind: str, key: str, overridden: Key) -> EffectivePart:
    """Return one part that stands at `key`, without the keys that the scenario overrides."""
    part, root = same.part, same.part.original
    values, original = (
        {
            row.elements: row
            for row in (() if each is None else described_values(each, each.sources))
            if row.elements[0] not in overridden
        }
        for each in (part, root)
    )
    above, library = f"{key}." if key else "", original if root else None
    parameters = []
    for elements, row in values.items():
        # A setting has no source: it is the user's where the original has another.
        other = original.get(elements)
        setting_mark = "" if other is not None and other.value == row.value else "user"
        parameters.append(_as_declared(part, row, _compared_parameter(above, row, setting_mark, library)))
    removed = tuple(f"{above}{dotted(place)}" for place in _removed_keys(original, values))
    used = {parameter.source for parameter in parameters if parameter.source}
    sources = {name: source.text for name, source in part.sources.items() if name in used}
    return EffectivePart(kind, key, part.label, part.based_on, tuple(parameters), removed, sources)


def _removed_keys(original: Mapping[Key, object], values: Mapping[Key, object]) -> list[Key]:
    """Return the keys of its original that a part lacks; of a section that it lacks, the section alone."""
    prefixes = {elements[:depth] for elements in values for depth in range(len(elements) + 1)}
    return list(
        dict.fromkeys(
            next(elements[:depth] for depth in range(len(elements) + 1) if elements[:depth] not in prefixes)
            for elements in original
            if elements not in values
        )
    )


def _as_declared(part: Part, row: DescribedValue, parameter: Parameter) -> Parameter:
    """Return a parameter of a controller from outside with its unit, marked where it has its default."""
    if row.elements[0] != "parameters":
        return parameter
    name = row.elements[1]
    declared = getattr(part, "declared_parameters", {}).get(name)
    if declared is None:
        return parameter
    is_default = parameter.mark == "user" and getattr(part, "parameters", {})[name] == declared.default
    return replace(parameter, unit=declared.unit, mark="default" if is_default else parameter.mark)


def _section_parameters(scenario: Scenario, name: str) -> Iterator[Parameter]:
    # What the rail leaves out is the condition's.
    of_condition = _RAIL_OVERRIDES if name == "rail" else ()
    defaults = {key: getattr(scenario.rail.condition, key) for key in of_condition}
    for parameter in _scenario_parameters(getattr(scenario, name), f"{name}.", defaults):
        if scenario.sanders or not parameter.key.startswith(_OF_SAND):  # without sanders it says nothing
            yield parameter


def _scenario_parameters(model: Model, above: str, defaults: Mapping[str, object]) -> Iterator[Parameter]:
    """Yield the parameters that stand in the scenario file; optional ones are compared with their default."""
    values, optional = dict[str, object](), dict[str, object]()
    for name, declared in type(model).model_fields.items():
        value = getattr(model, name)
        if name not in DESCRIPTIVE and not (name in _SECTIONS and isinstance(value, Model)):
            values[name] = value
            if not declared.is_required():
                optional[name] = defaults.get(name, declared.default)
    library = {row.elements: row for row in described_values(optional, {})}
    for row in described_values(values, {}):
        name = str(row.elements[0])
        setting = "user" if name in model.model_fields_set else "default"
        yield _compared_parameter(above, row, setting, library if name in optional else None)


def _compared_parameter(
    above: str, row: DescribedValue, setting_mark: str, library: _Rows | None
) -> Parameter:
    """Return a parameter compared with the library part; `library` is None without such a part."""
    library_row = None if library is None else library.get(row.elements)
    fields = (f"{above}{row.key}", row.value, row.unit, row.written, row.mark or setting_mark, row.source)
    if library is None or (library_row is not None and library_row.value == row.value):
        return Parameter(*fields)
    if library_row is None:
        return Parameter(*fields, differs=True)
    return Parameter(
        *fields, differs=True, library_value=library_row.value, library_written=library_row.written
    )


_KINDS: Final = get_args(Kind)


@dataclass(frozen=True, slots=True)
class Program:
    """A controller that is not a part of this package.

    Args:
        name: name of its part, as its file calls it, else its class, its file or its address.
        kind: python, library, fmu, connect or registered.
        source: its file as the scenario writes it, its address, or its registered name.
        version: as its scenario, its file or its package states it, else as it said itself; empty where none
            of them does.
        sha256: SHA-256 of its file; empty where there is none.
        told_version: what it said of itself where that is not `version`; empty where both agree.

    """

    name: str
    kind: str
    source: str
    version: str
    sha256: str
    told_version: str = ""

    def telling(self, version: str) -> Program:
        """Return the program once it has said this version of itself in a stop, empty for none."""
        stated = self.version or version
        return replace(self, version=stated, told_version="" if version == stated else version)


def program_of(part: EffectivePart, told: str = "") -> Program | None:
    """Return the program of a controller from outside; None for any other part.

    `told` is the version that it said of itself in a stop, empty where that is not known.
    """
    values = {each.key.removeprefix(f"{part.key}."): str(each.value) for each in part.parameters}
    kind = next((kind for kind in _KINDS if kind in values), None)
    if part.kind != "controller" or kind is None:
        return None
    stated = values.get("version", ""), values.get("sha256", "")
    return Program(part.name, kind, values[kind], *stated).telling(told)


def program_in(parts: Mapping[str, EffectivePart]) -> Program | None:
    """Return the program among the parts of a case, by role; None where its controller is built in."""
    controller = parts.get("controller")
    return None if controller is None else program_of(controller)
