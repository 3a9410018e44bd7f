"""A fault: what of the brake or its controller fails, how, when, and whether it fits its scenario."""

from collections.abc import Iterator
from contextlib import suppress
from typing import Annotated, Any, Final

from pydantic import AfterValidator, Field, PlainSerializer, PlainValidator, ValidationInfo, WithJsonSchema

from uictest.core.units import KINDS
from uictest.plans.faults import (
    DYNAMIC_BRAKE,
    FAULT_KINDS,
    PARTS,
    SANDER,
    TRACK_BRAKE,
    TRAIN_SPEED,
    Effects,
    FaultKind,
)
from uictest.plans.scenario.parts.vehicle import wheelset_value
from uictest.plans.scenario.yaml import (
    QUANTITY_KEYWORD,
    Inconsistency,
    Model,
    Quantity,
    QuantityError,
    field,
    of_kind,
    optional,
    parse_quantity,
    quoted,
    refused,
    suggestion,
    written,
)

_FIELDS: Final = (
    of_kind("time", "0 s .. 3600 s"),
    of_kind("speed", "> 0 km/h .. 600 km/h"),
    of_kind("length", "0 m .. 100 km"),
)
_HINT: Final = "write a time, a speed or a distance: 3 s, 90 km/h, 120 m"
TIME, SPEED, DISTANCE = (each.kind.canonical for each in _FIELDS)
"""Unit of an instant that is a time, a speed or a distance."""


def _parse_instant(value: object) -> Quantity:
    text = getattr(value, "text", str(value))
    for each in _FIELDS:
        with suppress(QuantityError):
            parse_quantity(text, each.kind.name)
            return each.validate(value)
    raise refused(f"{quoted(text)} is no instant of a stop", _HINT)


_SCHEMA: Final[dict[str, Any]] = {
    "anyOf": [{QUANTITY_KEYWORD: name} for name in KINDS if name in ("time", "speed", "length")]
}
Moment = Annotated[
    Quantity, PlainValidator(_parse_instant), PlainSerializer(written), WithJsonSchema(_SCHEMA)
]
"""A quantity whose unit says what it is."""
_NAMES: Final = tuple(dict.fromkeys(name for _, name in FAULT_KINDS))


def _known_part(name: str) -> str:
    if name not in PARTS:
        raise refused(f"unknown part {quoted(name)}", suggestion(name, PARTS))
    return name


def _known_kind(name: str, info: ValidationInfo) -> str:
    part = info.data.get("part")
    if part is not None and (part, name) not in FAULT_KINDS:
        kinds = [kind for of, kind in FAULT_KINDS if of == part]
        raise refused(f"{quoted(part)} has no fault {quoted(name)}", suggestion(name, kinds))
    return name


def _of_the_kind(value: object, info: ValidationInfo) -> object:
    # Without a valid part and kind it is not known what the value must be; the fault is rejected already.
    declared = FAULT_KINDS.get((info.data.get("part", ""), info.data.get("kind", "")))
    if declared is None or value is None:
        return None
    if declared.value is None:
        message = f"{quoted(declared.name)} of {quoted(declared.part)} takes no value"
        raise refused(message, "leave `value` out")
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
        """Changes while the fault is active."""
        return self.declared.effects(None if self.value is None else float(self.value))

    @property
    def label(self) -> str:
        """Part, kind and wheelset in one word, such as `speed-sensor-stuck-2`."""
        number = "" if self.wheelset is None else f"-{self.wheelset}"
        return f"{self.part}-{self.kind}{number}"

    def inconsistencies(self) -> Iterator[Inconsistency]:
        """Yield a wheelset missing or too many, a missing value, an end before the beginning."""
        if self.declared.of_wheelset and self.wheelset is None:
            yield Inconsistency(
                (), f"which {quoted(self.part)} is faulty is not said", "add `wheelset: 1`, 2, 3 or 4"
            )
        if not self.declared.of_wheelset and self.wheelset is not None:
            yield Inconsistency(
                ("wheelset",), f"the train has one {quoted(self.part)}", "leave `wheelset` out"
            )
        takes = self.declared.value
        if takes is not None and self.value is None and not takes.without:
            hint = f"add `value`, a {takes.kind} from {takes.at_least} to {takes.at_most}"
            yield Inconsistency((), f"{quoted(self.kind)} of {quoted(self.part)} needs a value", hint)
        yield from self._order_problems()

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


_OPTIONAL: Final = {
    DYNAMIC_BRAKE: ("dynamic", "{force: 60 kN, power: 1.6 MW}"),
    TRACK_BRAKE: ("track", "{attraction: 100 kN, magnets: 4, off_below: 50 km/h}"),
}
"""Parts that a car need not have: their key below `brake` and an example."""


def impossible_faults(scenario: Any) -> Iterator[Inconsistency]:
    """Yield faults that do not fit the stop of a scenario."""
    for index, fault in enumerate(scenario.faults):
        if fault.at.unit == SPEED and fault.at > scenario.initial_speed:
            yield Inconsistency(
                ("faults", index, "at"),
                f"the train never runs at {fault.at.text}: it begins to brake at"
                f" {scenario.initial_speed.text}",
                "write a lower speed, or `at: 0 s` for a fault throughout the stop",
            )
        if fault.part in _OPTIONAL and getattr(scenario.brake, _OPTIONAL[fault.part][0]) is None:
            key, example = _OPTIONAL[fault.part]
            yield Inconsistency(
                ("faults", index, "part"),
                f"this car has no {fault.part.replace('-', ' ')}",
                f"give it one: brake.{key}: {example}",
            )
        if fault.part == SANDER and all(fault.wheelset != sander.wheelset for sander in scenario.sanders):
            yield Inconsistency(
                ("faults", index, "wheelset"),
                f"wheelset {fault.wheelset} has no sander",
                f"give it one: sanders: [{{wheelset: {fault.wheelset}, density: 7.5 g/m}}]",
            )
        if fault.part == TRAIN_SPEED and scenario.rig.sensors.train_speed is None:
            yield Inconsistency(
                ("faults", index, "part"),
                "this rig has no second source of speed",
                "give it one: rig.sensors.train_speed: {period: 100 ms, delay: 100 ms}",
            )
        if fault.wheelset is not None and fault.effects.lost_teeth > 0.0:
            yield from _without_teeth(scenario, index, fault)


def _without_teeth(scenario: Any, location: int, fault: Any) -> Iterator[Inconsistency]:
    method, teeth, missing = (
        wheelset_value(scenario, fault.wheelset, f"sensors.speed.{name}")
        for name in ("method", "teeth", "missing_teeth")
    )
    if method != "whole-teeth":
        yield Inconsistency(
            ("faults", location, "kind"),
            f"the speed sensor of wheelset {fault.wheelset} counts no teeth",
            "write `rig.sensors.speed.method: whole-teeth`",
        )
    elif missing + fault.effects.lost_teeth >= teeth:
        yield Inconsistency(
            ("faults", location, "value"),
            f"{fault.value.text} and {missing.text} of {teeth.text} teeth: at least one must be left",
        )
