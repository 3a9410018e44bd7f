"""A fault: what of the brake or its controller fails, how, and when."""

from collections.abc import Iterator
from typing import Annotated, Any, Final

from pydantic import (
    AfterValidator,
    Field,
    PlainSerializer,
    PlainValidator,
    ValidationInfo,
    WithJsonSchema,
)
from pydantic_core import PydanticCustomError

from uictest.core.units import KINDS
from uictest.plans.fault_effects import Effects, FaultKind
from uictest.plans.faults import FAULT_KINDS, PARTS
from uictest.plans.scenario.yaml import (
    QUANTITY_KEYWORD,
    Inconsistency,
    Model,
    Quantity,
    QuantityError,
    parse_quantity,
    quoted,
    suggestion,
    written,
)
from uictest.plans.scenario.yaml.quantity_field import field, of_kind, optional

_FIELDS: Final = (
    of_kind("time", "0 s .. 3600 s"),
    of_kind("speed", "> 0 km/h .. 600 km/h"),
    of_kind("length", "0 m .. 100 km"),
)
_HINT: Final = "write a time, a speed or a distance: 3 s, 90 km/h, 120 m"
TIME, SPEED, DISTANCE = (each.kind.canonical for each in _FIELDS)
"""Unit of an instant that is a time, a speed or a distance."""


def _read(value: object) -> Quantity:
    if isinstance(value, Quantity):
        text, unit = value.text, value.unit
    else:
        text = getattr(value, "text", value if isinstance(value, str) else str(value))
        unit = _unit_of(text)
    for each in _FIELDS:
        if each.kind.canonical == unit:
            return each.validate(value)
    context = {"message": f"{quoted(text)} is no instant of a stop", "hint": _HINT}
    raise PydanticCustomError("moment", "{message}", context)


def _unit_of(text: str) -> str:
    for each in _FIELDS:
        try:
            parse_quantity(text, each.kind.name)
        except QuantityError:
            continue
        return each.kind.canonical
    return ""


_SCHEMA: Final[dict[str, Any]] = {
    "anyOf": [{QUANTITY_KEYWORD: name} for name in KINDS if name in ("time", "speed", "length")]
}

Moment = Annotated[Quantity, PlainValidator(_read), PlainSerializer(written), WithJsonSchema(_SCHEMA)]
"""A quantity whose unit says what it is."""


_NAMES: Final = tuple(dict.fromkeys(name for _, name in FAULT_KINDS))


def _known_part(name: str) -> str:
    if name not in PARTS:
        context = {"message": f"unknown part {quoted(name)}", "hint": suggestion(name, PARTS)}
        raise PydanticCustomError("fault_part", "{message}", context)
    return name


def _kinds_of(part: str) -> list[str]:
    return [name for of, name in FAULT_KINDS if of == part]


def _known_kind(name: str, info: ValidationInfo) -> str:
    part = info.data.get("part")
    if part is not None and (part, name) not in FAULT_KINDS:
        context = {
            "message": f"{quoted(part)} has no fault {quoted(name)}",
            "hint": suggestion(name, _kinds_of(part)),
        }
        raise PydanticCustomError("fault_kind", "{message}", context)
    return name


def _of_the_kind(value: object, info: ValidationInfo) -> object:
    # Without a valid part and kind it is not known what the value must be; the fault is rejected already.
    declared = FAULT_KINDS.get((info.data.get("part", ""), info.data.get("kind", "")))
    if declared is None or value is None:
        return None
    if declared.value is None:
        context = {
            "message": f"{quoted(declared.name)} of {quoted(declared.part)} takes no value",
            "hint": "leave `value` out",
        }
        raise PydanticCustomError("fault_value", "{message}", context)
    takes = declared.value
    return of_kind(takes.kind, f"{takes.at_least} .. {takes.at_most}").validate(value)


Value = Annotated[
    Quantity,
    PlainValidator(_of_the_kind),
    PlainSerializer(written),
    WithJsonSchema({"type": ["string", "number", "object"]}),
]
"""A quantity of whatever kind the fault takes."""


class Fault(Model):
    """A fault of one part, from one instant of the stop to another."""

    at: Moment = field(
        "When it begins: a time since the brake command, the speed to which the train has slowed"
        " or the distance since the command; decided at the beginning of each controller cycle."
    )
    until: Moment | None = optional("When it ends, in the same ways; with the stop if left out.")
    wheelset: Annotated[int, Field(ge=1, le=4, strict=True)] | None = optional(
        "Wheelset whose part it is, 1 to 4 from the leading end."
    )
    part: Annotated[
        str, AfterValidator(_known_part), WithJsonSchema({"type": "string", "enum": list(PARTS)})
    ] = field("What is faulty.")
    kind: Annotated[
        str, AfterValidator(_known_kind), WithJsonSchema({"type": "string", "enum": list(_NAMES)})
    ] = field("How it is faulty; each part has its own kinds.")
    value: Value | None = optional("The size of the fault, as its kind needs it.")

    @property
    def declared(self) -> FaultKind:
        """The row of the catalogue."""
        return FAULT_KINDS[self.part, self.kind]

    @property
    def effects(self) -> Effects:
        """What it changes while it is active."""
        return self.declared.effects(None if self.value is None else float(self.value))

    @property
    def label(self) -> str:
        """Part, kind and wheelset in one word, such as `speed-sensor-stuck-2`."""
        number = "" if self.wheelset is None else f"-{self.wheelset}"
        return f"{self.part}-{self.kind}{number}"

    def inconsistencies(self) -> Iterator[Inconsistency]:
        """Yield an unknown kind, a value or a wheelset missing or too many, an end before the beginning."""
        if (self.part, self.kind) not in FAULT_KINDS:
            hint = suggestion(self.kind, _kinds_of(self.part))
            yield Inconsistency(("kind",), f"{quoted(self.part)} has no fault {quoted(self.kind)}", hint)
            return
        yield from self._wheelset_problems()
        yield from self._value_problems()
        yield from self._order_problems()

    def _wheelset_problems(self) -> Iterator[Inconsistency]:
        if self.declared.of_wheelset and self.wheelset is None:
            yield Inconsistency(
                (), f"which {quoted(self.part)} is faulty is not said", "add `wheelset: 1`, 2, 3 or 4"
            )
        if not self.declared.of_wheelset and self.wheelset is not None:
            yield Inconsistency(
                ("wheelset",), f"the train has one {quoted(self.part)}", "leave `wheelset` out"
            )

    def _value_problems(self) -> Iterator[Inconsistency]:
        what, takes = f"{quoted(self.kind)} of {quoted(self.part)}", self.declared.value
        if takes is None:
            if self.value is not None:
                yield Inconsistency(("value",), f"{what} takes no value", "leave `value` out")
        elif self.value is None:
            if not takes.without:
                hint = f"add `value`, a {takes.kind} from {takes.at_least} to {takes.at_most}"
                yield Inconsistency((), f"{what} needs a value", hint)
        elif self.value.unit != KINDS[takes.kind].canonical:
            yield Inconsistency(("value",), f"{what} takes a {takes.kind}, not {self.value.text}")

    def _order_problems(self) -> Iterator[Inconsistency]:
        """Yield an end before the beginning, where both are of one kind; a train only gets slower."""
        if self.until is None or self.until.unit != self.at.unit:
            return
        ends_after = self.until < self.at if self.at.unit == SPEED else self.until > self.at
        if not ends_after:
            needed = "below" if self.at.unit == SPEED else "above"
            yield Inconsistency(
                ("until",),
                f"the fault would end at {self.until.text}, before it begins at {self.at.text}",
                f"`until` must be {needed} `at`",
            )
