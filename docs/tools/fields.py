"""Tables of fields, made from the models that read the files."""

from __future__ import annotations

from collections.abc import Iterator
from types import NoneType, UnionType
from typing import Annotated, Any, Literal, Union, get_args, get_origin

from markup import table
from pydantic import BaseModel
from pydantic.fields import FieldInfo
from pydantic_core import PydanticUndefined

from uictest.core.measures import MEASURES
from uictest.core.series_measures import SERIES_MEASURES
from uictest.core.units import KINDS
from uictest.plans.faults import FAULT_KINDS, FaultKind
from uictest.plans.scenario.model import Scenario
from uictest.plans.scenario.parts.brake import BrakeSystem
from uictest.plans.scenario.parts.caliper import Caliper
from uictest.plans.scenario.parts.compensation import Compensation
from uictest.plans.scenario.parts.controller import CONTROLLER_MODELS
from uictest.plans.scenario.parts.criteria import Criterion
from uictest.plans.scenario.parts.measures import MeasureDefinitions
from uictest.plans.scenario.parts.pad import Pad
from uictest.plans.scenario.parts.rail import RailCondition
from uictest.plans.scenario.parts.sensors import Sensors
from uictest.plans.scenario.parts.vehicle import Vehicle
from uictest.plans.scenario.yaml.model import Part, PartReference
from uictest.plans.scenario.yaml.quantities import Quantity
from uictest.plans.scenario.yaml.quantity_field import QuantityField
from uictest.plans.series import SeriesFile
from uictest.plans.sweeps.model import Distribution, Sample
from uictest.plans.sweeps.tail_model import KDryRequest, QuantileRequest

HEADINGS = ("key", "written as", "default", "range", "meaning")
PARTS: dict[str, type[BaseModel]] = {
    "vehicle": Vehicle,
    "brake": BrakeSystem,
    "pad": Pad,
    "caliper": Caliper,
    "compensation": Compensation,
    **{f"{name} controller": model for name, model in CONTROLLER_MODELS.items()},
    "sensors": Sensors,
    "rail": RailCondition,
    "measures": MeasureDefinitions,
    "criterion": Criterion,
    "series": SeriesFile,
}
_COURSES = {"grows": "can only grow", "falls": "can only fall", "settles": "is final once there is one"}
_OF_EVERY_PART = frozenset(Part.model_fields)
_BOUNDS = (("above", "> "), ("at_least", "≥ "), ("below", "< "), ("at_most", "≤ "))


def scenario_table() -> str:
    """Return the fields of a scenario, those of parts left out."""
    return table(HEADINGS, list(_rows(Scenario, "", frozenset())))


def part_table(name: str) -> str:
    """Return the fields of a part, those that every part has left out."""
    model = PARTS[name]
    return table(HEADINGS, list(_rows(model, "", _OF_EVERY_PART if issubclass(model, Part) else frozenset())))


def units_table() -> str:
    """Return every kind of quantity with the units accepted for it."""
    rows = [
        (kind.name, ", ".join(f"`{unit}`" for unit in kind.units), f"`{kind.canonical}`")
        for kind in KINDS.values()
        if not kind.bare
    ]
    return table(("quantity", "units accepted", "kept as"), rows)


def measures_table() -> str:
    """Return the measures that a criterion can bound."""
    rows = [
        (
            f"`{name}`",
            "" if measure.unit == "1" else measure.unit,
            "each wheelset" if measure.of_wheelsets else "the stop",
            measure.meaning,
            _COURSES[measure.course],
            ", ".join(f"`{each}`" for each in measure.definitions),
        )
        for name, measure in MEASURES.items()
    ]
    return table(("measure", "unit", "of", "meaning", "until standstill it", "definitions it needs"), rows)


def series_measures_table() -> str:
    """Return the measures that a criterion with `scope: series` can bound."""
    rows = [
        (
            f"`{name}`",
            "" if measure.unit == "1" else measure.unit,
            measure.meaning,
            "all stops together" if measure.pooled else f"the {measure.worse} one of the speeds",
            "yes" if measure.figure else "",
        )
        for name, measure in SERIES_MEASURES.items()
    ]
    return table(("measure", "unit", "meaning", "of several speeds", "`of the dry stop`"), rows)


def faults_table() -> str:
    """Return every kind of fault that a scenario can inject."""
    rows = [
        (f"`{kind.part}`", f"`{kind.name}`", _value_of(kind), kind.description)
        for kind in FAULT_KINDS.values()
    ]
    return table(("part", "kind", "value", "what it does"), rows)


def _value_of(kind: FaultKind) -> str:
    value = kind.value
    if value is None:
        return "none"
    words = f"{value.kind}, {value.at_least} to {value.at_most}"
    return f"{words}; without one {value.without}" if value.without else words


def sample_table() -> str:
    """Return the fields of a sample, its parameters left out."""
    return table(HEADINGS, list(_rows(Sample, "", frozenset({"parameters"}))))


def quantiles_table() -> str:
    """Return the fields of a request for quantiles."""
    return table(HEADINGS, list(_rows(QuantileRequest, "", frozenset())))


def k_dry_table() -> str:
    """Return the fields of a request for K_dry."""
    return table(HEADINGS, list(_rows(KDryRequest, "", frozenset())))


def distributions_table() -> str:
    """Return every distribution that a parameter of a sample can have, with its entries and an example."""
    rows = [
        row
        for name, field in Distribution.model_fields.items()
        for row in _spread_by(field.alias or name, field)
    ]
    return table(("distribution", "written as", "example", "meaning"), rows)


def _spread_by(name: str, field: FieldInfo) -> Iterator[tuple[str, ...]]:
    example = f"`{{{name}: {_flow((field.examples or [''])[0])}}}`"
    inner = _model_in(field.annotation)
    yield f"`{name}`", "mapping" if inner else _numbers(field.annotation), example, field.description or ""
    for key, entry in inner.model_fields.items() if inner else ():
        yield f"`{name}.{key}`", "number with its unit", "", entry.description or ""


def _numbers(annotation: Any) -> str:
    entries = _spread(annotation)
    return (
        "list of values"
        if get_origin(entries[0]) is tuple
        else f"list of {len(entries)} numbers with their unit"
    )


def _flow(value: Any) -> str:
    """A value as a scenario has it in one line."""
    if isinstance(value, dict):
        return "{" + ", ".join(f"{key}: {_flow(each)}" for key, each in value.items()) + "}"
    return "[" + ", ".join(map(_flow, value)) + "]" if isinstance(value, list) else str(value)


def _rows(model: type[BaseModel], above: str, left_out: frozenset[str]) -> Iterator[tuple[str, ...]]:
    for name, field in model.model_fields.items():
        key = f"{above}{field.alias or name}"
        if name in left_out:
            continue
        inner = None if _reference(field) else _model_in(field.annotation)
        if inner is None or _short_form(field.annotation):
            yield _row(key, field)
        if inner is not None:
            yield from _rows(inner, _inner_prefix(key, field.annotation), frozenset())


def _short_form(annotation: Any) -> bool:
    """Whether a single value may stand in the place of a mapping."""
    return any(each is Quantity or get_origin(each) is Literal for each in _spread(annotation))


def _inner_prefix(key: str, annotation: Any) -> str:
    origins = {get_origin(each) for each in _spread(annotation)}
    if dict in origins:
        return f"{key}.<name>."
    return f"{key}[]." if tuple in origins else f"{key}."


def _row(key: str, field: FieldInfo) -> tuple[str, ...]:
    return (f"`{key}`", _form(field), _default(field), _range(field), field.description or "")


def _reference(field: FieldInfo) -> PartReference | None:
    return next((mark for mark in field.metadata if isinstance(mark, PartReference)), None)


def _form(field: FieldInfo) -> str:
    if reference := _reference(field):
        return "part, or list of parts" if reference.several else "part"
    return _form_of(field.annotation, _physical(field))


def _physical(field: FieldInfo) -> QuantityField | None:
    marks = [*field.metadata, *_marks(field.annotation)]
    return next((mark for mark in marks if isinstance(mark, QuantityField)), None)


def _marks(annotation: Any) -> Iterator[Any]:
    if get_origin(annotation) is Annotated:
        yield from annotation.__metadata__
    for inner in get_args(annotation):
        if not isinstance(inner, str):
            yield from _marks(inner)


def _form_of(annotation: Any, physical: QuantityField | None) -> str:
    if physical is not None:
        words = _quantity(physical)
        count = _spread(annotation).count(Quantity)
        return words if count < 2 else f"{count} x {words}"
    forms = [_plain(each) for each in _spread(annotation)]
    return " or ".join(dict.fromkeys(form for form in forms if form)) or "text"


def _quantity(physical: QuantityField) -> str:
    kind = physical.kind
    if kind.bare:
        return "whole number" if kind.name == "count" else "number"
    return ", ".join(kind.units)


def _plain(annotation: Any) -> str:
    if get_origin(annotation) is Literal:
        return ", ".join(f"`{choice}`" for choice in get_args(annotation))
    names = {str: "text", int: "whole number", bool: "`true`, `false`", Quantity: "quantity"}
    if annotation in names:
        return names[annotation]
    return {tuple: "list", dict: "mapping"}.get(get_origin(annotation), "")


def _spread(annotation: Any) -> list[Any]:
    """The members of a union, without marks; a list and a mapping count as themselves."""
    origin = get_origin(annotation)
    if origin is Annotated:
        return _spread(get_args(annotation)[0])
    if origin in (Union, UnionType):
        return [each for member in get_args(annotation) for each in _spread(member)]
    if origin is tuple and Ellipsis not in get_args(annotation):
        return [each for member in get_args(annotation) for each in _spread(member)]
    return [] if annotation is NoneType else [annotation]


def _model_in(annotation: Any) -> type[BaseModel] | None:
    """The one model inside an annotation, through lists, mappings and marks; a choice of several is none."""
    for each in _spread(annotation):
        inner = [each] if isinstance(each, type) else [_model_in(member) for member in get_args(each)]
        for member in inner:
            if isinstance(member, type) and issubclass(member, BaseModel):
                return member
    return None


def _default(field: FieldInfo) -> str:
    if reference := _reference(field):
        return f"`{reference.default}`"
    if field.is_required():
        return "required"
    if field.default is PydanticUndefined or field.default is None or field.default in ((), "", {}):
        return ""
    if isinstance(field.default, bool):
        return f"`{field.default}`".lower()
    return f"`{getattr(field.default, 'text', field.default)}`"


def _range(field: FieldInfo) -> str:
    if physical := _physical(field):
        texts = [
            f"{sign}{bound.text}" for name, sign in _BOUNDS if (bound := getattr(physical, name)) is not None
        ]
        return ", ".join(texts)
    found = []
    for mark in field.metadata:
        for name, sign in (("ge", "≥ "), ("le", "≤ ")):
            if hasattr(mark, name):
                found.append(f"{sign}{getattr(mark, name)}")
        if hasattr(mark, "max_length"):
            what = "characters" if field.annotation is str else "entries"
            found.append(f"at most {mark.max_length} {what}")
    return ", ".join(found)
