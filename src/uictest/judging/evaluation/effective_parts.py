"""The effective parts of a case, and which program its controller is."""

from __future__ import annotations

from collections.abc import Iterable, Iterator, Mapping
from dataclasses import dataclass, replace
from functools import lru_cache
from typing import Any, Final, get_args

from uictest.controllers import Kind
from uictest.judging.evaluation.parameters import EffectivePart, Parameter
from uictest.plans.scenario import (
    DESCRIPTIVE,
    PART_KEYS,
    PART_KINDS,
    Coupler,
    Scenario,
    Value,
    mark_of,
    values_in,
)
from uictest.plans.scenario.yaml import Key, Model, Part, Quantity, dotted

_PARTS: Final = {kind: dotted(key) for key, kind in PART_KINDS.items() if not PART_KEYS[key].several}
"""Kind of a part -> where it stands in a scenario."""

_CONDITIONS: Final = ("brake.command", "brake.position", "rail.gradient", "rig.wsp")
"""Keys that describe a recorded stop, besides rail condition, criteria and measures."""

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


class EffectiveParts:
    """Computes the effective parts of scenarios; a part that many scenarios share is computed once."""

    def of(self, scenario: Scenario) -> dict[str, EffectivePart]:
        """Return every part of a simulated stop by its role: the kind, and `criteria.0`, ... for profiles."""
        parts = {"scenario": EffectivePart("scenario", "", "", None, tuple(_stop(scenario)))}
        for name in ("brake", "rail", "rig"):
            own = tuple(_section(scenario, name))
            parts[f"scenario.{name}"] = EffectivePart(f"scenario.{name}", name, "", None, own)
        for kind, key in _PARTS.items():
            overridden = _overridden(scenario) if kind == "rail" else ()
            parts[kind] = self.part(_at(scenario, key), kind, key, overridden)
        return parts | self._criteria(scenario.judged_by)

    def of_recorded(self, scenario: Scenario) -> dict[str, EffectivePart]:
        """Return the parts of a recorded stop: conditions, measures and criteria, nothing of a rig."""
        condition = scenario.rail.condition
        stated = [Parameter("rail.condition", condition.name, "", condition.name, "user")]
        for name in ("brake", "rail", "rig"):
            stated += [row for row in _section(scenario, name) if row.key.startswith(_CONDITIONS)]
        stated += _section(scenario, "record")
        return {
            "conditions": EffectivePart("conditions", "", "", None, tuple(stated)),
            "measures": self.part(scenario.measures, "measures", "measures"),
            **self._criteria(scenario.criteria),
        }

    def part(self, part: Part, kind: str, key: str, overridden: Key = ()) -> EffectivePart:
        """Return one part that stands at `key`, without the keys that the scenario overrides."""
        return _effective(_Same(part), kind, key, overridden)

    def _criteria(self, profiles: Iterable[Part]) -> dict[str, EffectivePart]:
        return {
            f"criteria.{place}": self.part(profile, "criteria", "") for place, profile in enumerate(profiles)
        }


_MOST_KEPT: Final = 1000
"""Parts that are kept in a process, those that were asked for last; chosen."""


@lru_cache(_MOST_KEPT)
def _effective(same: _Same, kind: str, key: str, overridden: Key) -> EffectivePart:
    part = same.part
    values, original = (
        {place: value for place, value in values_in(each) if place[0] not in overridden}
        for each in (part, part.original)
    )
    above = f"{key}." if key else ""
    library = original if part.original else None
    parameters = tuple(
        _as_declared(
            part, place, _parameter(above, place, value, library, _mark(part, place, value, original))
        )
        for place, value in values.items()
    )
    removed = tuple(f"{above}{dotted(place)}" for place in _removed(original, values))
    used = {parameter.source for parameter in parameters if parameter.source}
    sources = {name: source.text for name, source in part.sources.items() if name in used}
    return EffectivePart(kind, key, part.label, part.based_on, parameters, removed, sources)


def _overridden(scenario: Scenario) -> Key:
    return tuple(name for name in _RAIL_OVERRIDES if getattr(scenario.rail, name) is not None)


def _removed(original: Mapping[Key, Value], values: Mapping[Key, Value]) -> list[Key]:
    """Return the keys of its original that a part lacks; of a section that it lacks, the section alone."""
    kept = {place[:depth] for place in values for depth in range(len(place) + 1)}
    return list(
        dict.fromkeys(
            next(place[:depth] for depth in range(len(place) + 1) if place[:depth] not in kept)
            for place in original
            if place not in values
        )
    )


def _mark(part: Part, place: Key, value: Value, original: Mapping[Key, Value]) -> str:
    if isinstance(value, Quantity):
        return mark_of(value, part.sources)
    return "" if original.get(place) == value else "user"


def _as_declared(part: Part, place: Key, parameter: Parameter) -> Parameter:
    """Return a parameter of a controller from outside with its unit, marked where it has its default."""
    declared = getattr(part, "declared_parameters", {}).get(place[1]) if place[0] == "parameters" else None
    if declared is None:
        return parameter
    is_default = parameter.mark == "user" and getattr(part, "parameters", {})[place[1]] == declared.default
    return replace(parameter, unit=declared.unit, mark="default" if is_default else parameter.mark)


def _stop(scenario: Scenario) -> Iterator[Parameter]:
    couplers = None if scenario.coupler is None else Coupler()  # a train has some, stated or not
    yield from _own(scenario, "", {"coupler": couplers})
    yield from _own(scenario.simulation, "simulation.", {})


def _section(scenario: Scenario, name: str) -> Iterator[Parameter]:
    # What the rail leaves out is the condition's.
    of_condition = _RAIL_OVERRIDES if name == "rail" else ()
    defaults = {key: getattr(scenario.rail.condition, key) for key in of_condition}
    for parameter in _own(getattr(scenario, name), f"{name}.", defaults):
        if scenario.sanders or not parameter.key.startswith(_OF_SAND):  # without sanders it says nothing
            yield parameter


def _own(model: Model, above: str, defaults: Mapping[str, object]) -> Iterator[Parameter]:
    """Yield the parameters that stand in the scenario file; optional ones are compared with their default."""
    for name, declared in type(model).model_fields.items():
        value = getattr(model, name)
        if name in DESCRIPTIVE or (name in _SECTIONS and isinstance(value, Model)):
            continue
        default = None if declared.is_required() else dict(values_in(defaults.get(name, declared.default)))
        setting = "user" if name in model.model_fields_set else "default"
        for place, part_value in values_in(value, (name,)):
            mark = mark_of(part_value, {}) if isinstance(part_value, Quantity) else setting
            below = None if default is None else {(name, *key): other for key, other in default.items()}
            yield _parameter(above, place, part_value, below, mark)


def _parameter(
    above: str, place: Key, value: Value, library: Mapping[Key, Value] | None, mark: str
) -> Parameter:
    """Return a parameter compared with the library part; `library` is None without such a part."""
    source = value.source if isinstance(value, Quantity) and mark not in ("user", "default") else ""
    other = None if library is None else library.get(place)
    key, unit = f"{above}{dotted(place)}", value.unit if isinstance(value, Quantity) else ""
    own = (key, _plain(value), unit, _written(value), mark, source)
    if library is None or other == value:
        return Parameter(*own)
    if other is None:
        return Parameter(*own, differs=True)
    return Parameter(*own, differs=True, library_value=_plain(other), library_written=_written(other))


def _plain(value: Value) -> float | str:
    return float(value) if isinstance(value, float) else value


def _written(value: Value) -> str:
    if isinstance(value, Quantity):
        return value.text
    return str(value).lower() if isinstance(value, bool) else str(value)


def _at(scenario: Scenario, key: str) -> Any:
    value: Any = scenario
    for element in key.split("."):
        value = getattr(value, element)
    return value


_KINDS: Final = get_args(Kind)


@dataclass(frozen=True, slots=True)
class Program:
    """A controller that is no part of this package.

    Args:
        name: of its part: as its file calls it, else its class, its file or its address.
        kind: python, library, fmu, connect or registered.
        source: its file as the scenario writes it, its address, or its registered name.
        version: as its scenario, its file or its package states it, else as it said itself; empty where none
            of them does.
        sha256: of its file; empty where there is none.
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
