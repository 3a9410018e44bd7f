"""What one wheelset has of its own: a worn wheel, a weak brake, sensors that err."""

from collections.abc import Iterator, Mapping
from functools import cache
from operator import attrgetter
from types import MappingProxyType
from typing import TYPE_CHECKING, Annotated, Any, Final, TypeAlias

from pydantic import AfterValidator, BaseModel, Field, create_model
from pydantic_core import PydanticCustomError

from uictest.plans.scenario.parts.brake import Caliper, PadFriction, WspValve
from uictest.plans.scenario.parts.sensors import Loadcell, PressureSensor, SpeedSensor
from uictest.plans.scenario.program_files import ProgramFile
from uictest.plans.scenario.yaml import (
    DEFAULT_SOURCE,
    SCENARIO_SOURCE,
    Key,
    Model,
    Part,
    Quantity,
    Section,
    Source,
    quoted,
)
from uictest.plans.scenario.yaml.quantity_field import (
    default,
    field,
    of_kind,
    optional,
)

NUMBERS: Final = ("1", "2", "3", "4")
"""Numbers of the wheelsets from the leading end, as keys."""
_ERRORS: Final = ("gain_error", "offset", "noise")
Radius = Annotated[Quantity, of_kind("length", "> 0.1 m .. 1 m")]
Inertia = Annotated[Quantity, of_kind("inertia", "1 kg m2 .. 1e4 kg m2")]


def _known(number: str) -> str:
    if number not in NUMBERS:
        context = {"message": f"no wheelset {quoted(number)}", "hint": f"accepted: {', '.join(NUMBERS)}"}
        raise PydanticCustomError("wheelset", "{message}", context)
    return number


WheelsetNumber = Annotated[str, AfterValidator(_known), Field(json_schema_extra={"enum": list(NUMBERS)})]
"""Key of a wheelset."""


def _own(name: str, regular: type[Model], keys: tuple[str, ...]) -> Any:
    """Return a section of values that each replace the one of the same name in the regular section."""
    fields: dict[str, Any] = {}
    for key in keys:
        declared = regular.model_fields[key]
        kind: Any = declared.annotation
        if declared.metadata:
            kind = Annotated[(kind, *declared.metadata)]
        fields[key] = (kind | None, Field(default=None, description=declared.description))
    return create_model(name, __base__=Section, __doc__=regular.__doc__, __module__=__name__, **fields)


if TYPE_CHECKING:
    OwnCaliper: TypeAlias = Section
    OwnWspValve: TypeAlias = Section
    OwnSpeedSensor: TypeAlias = Section
    OwnPressureSensor: TypeAlias = Section
    OwnLoadcell: TypeAlias = Section
else:
    OwnCaliper = _own("OwnCaliper", Caliper, ("load_friction", "coulomb_friction"))
    OwnWspValve = _own("OwnWspValve", WspValve, tuple(WspValve.model_fields))
    OwnSpeedSensor = _own("OwnSpeedSensor", SpeedSensor, tuple(SpeedSensor.model_fields))
    OwnPressureSensor = _own("OwnPressureSensor", PressureSensor, _ERRORS)
    OwnLoadcell = _own("OwnLoadcell", Loadcell, _ERRORS)


class OwnSensors(Section):
    """The sensors of one wheelset and its module."""

    speed: OwnSpeedSensor = field("Its speed sensor.", default=OwnSpeedSensor())
    pressure: OwnPressureSensor = field("The pressure sensor of its tank.", default=OwnPressureSensor())
    loadcell: OwnLoadcell = field("The loadcells of its caliper.", default=OwnLoadcell())


class OwnValues(Section):
    """What one wheelset has of its own; everything else is as on the others."""

    wheel_radius: Radius | None = optional(
        "Rolling radius of its wheels; vehicle.wheelset.radius if left out."
    )
    rotational_inertia: Inertia | None = optional(
        "Moment of inertia about its axle, with that of a motor and its gear, seen from the axle;"
        " vehicle.wheelset.rotational_inertia if left out."
    )
    configured_radius: Radius | None = optional(
        "Radius that the WSP was configured with: measured speed is rotation times this;"
        " vehicle.wheelset.radius if left out."
    )
    brake_force: Annotated[Quantity, of_kind("share", "0 % .. 300 %")] | None = optional(
        "Its brake force as a share of the regular one; 100 % if left out."
    )
    pad_friction: PadFriction | None = optional("Friction coefficient between its pads and discs.")
    caliper: OwnCaliper = field("Its caliper.", default=OwnCaliper())
    wsp_valve: OwnWspValve = field("Its WSP valve.", default=OwnWspValve())
    sensors: OwnSensors = field("Its sensors.", default=OwnSensors())


def _completed(own: dict[str, OwnValues]) -> dict[str, OwnValues]:
    return {number: own.get(number, OwnValues()) for number in NUMBERS}


Wheelsets = Annotated[dict[WheelsetNumber, OwnValues], AfterValidator(_completed)]
"""The own values of all four wheelsets, those that a file leaves out empty."""
ALIKE: Final = MappingProxyType(_completed({}))
"""Wheelsets without values of their own."""

REGULAR: Final[Mapping[str, str]] = MappingProxyType(
    {
        **dict.fromkeys(("wheel_radius", "configured_radius"), "vehicle.wheelset.radius"),
        "rotational_inertia": "vehicle.wheelset.rotational_inertia",
        "pad_friction": "brake.system.disc.pad_friction",
        **{f"caliper.{name}": f"rig.caliper.{name}" for name in OwnCaliper.model_fields},
        **{f"wsp_valve.{name}": f"brake.system.wsp_valve.{name}" for name in OwnWspValve.model_fields},
        **{f"sensors.speed.{name}": f"rig.sensors.speed.{name}" for name in OwnSpeedSensor.model_fields},
        **{
            f"sensors.{kind}.{name}": f"rig.sensors.{kind}.{name}"
            for kind in ("pressure", "loadcell")
            for name in _ERRORS
        },
    }
)
"""Own value -> key in the scenario of the regular value that it replaces; the regular brake force is 1."""


WHEELSET_NUMBERS: Final = tuple(map(int, NUMBERS))
"""Numbers of the wheelsets from the leading end."""
_getter: Final = cache(attrgetter)
_WHEELSETS: Final = attrgetter("vehicle.wheelsets")
_WHOLE: Final = default("100 %", "share")


def wheelset_value(scenario: Model, number: int, name: str) -> Any:
    """Return a quantity or setting of wheelset ``number`` (1 to 4) by its name below ``vehicle.wheelsets.N``.

    Names are those of :class:`~uictest.plans.scenario.parts.wheelsets.OwnValues`, e.g.
    ``caliper.load_friction``.
    """
    own = _getter(name)(_WHEELSETS(scenario)[str(number)])
    return _regular(scenario, name) if own is None else own


def wheelset_keys(number: int, name: str) -> tuple[str, ...]:
    """Return the keys of a scenario that decide a value of a wheelset."""
    own = f"vehicle.wheelsets.{number}.{name}"
    return (own, REGULAR[name]) if name in REGULAR else (own,)


def deciding_key(scenario: Model, number: int, *names: str) -> Key:
    """Return the key of the first value that the wheelset has of its own, else of the first, regular."""
    for name in names:
        if _getter(name)(_WHEELSETS(scenario)[str(number)]) is not None:
            return tuple(wheelset_keys(number, name)[0].split("."))
    return tuple(REGULAR[names[0]].split("."))


def distinct_values(scenario: Model, name: str) -> Iterator[tuple[Key, Quantity]]:
    """Yield the values that wheelsets have under a name of `REGULAR` and their keys, the regular one once."""
    written: dict[Key, Quantity] = {}
    for number in WHEELSET_NUMBERS:
        value = wheelset_value(scenario, number, name)
        own, regular = wheelset_keys(number, name)
        written[tuple((regular if value is _regular(scenario, name) else own).split("."))] = value
    yield from written.items()


def _regular(scenario: Model, name: str) -> Any:
    return _getter(REGULAR[name])(scenario) if name in REGULAR else _WHOLE


Value = Quantity | str | int | float

DESCRIPTIVE: Final = frozenset(
    {
        *("schema_id", "id", "name", "title", "description", "tags", "extends"),
        *("sources", "source", "clause", "scope", "provenance"),
        *("requirements", "test_case", "validated", "declared_parameters", "free_parameters"),
        *("matrix", "zip", "include", "exclude", "expect", "repeat", "outcome_of_repeats", "firm"),
    }
)
"""Fields that a stop cannot depend on: names, sources, expectations, repeats and references to results.

Declarations of a controller's parameters are among them: their defaults stand in `parameters`.
"""


def values_in(value: object, key: Key = ()) -> list[tuple[Key, Value]]:
    """Return every number and setting inside a model, tuple or mapping with its key.

    A criterion is named by its id. Parts inside are skipped, and so are values that are not set. Beside the
    path of a program stands the SHA-256 of its file.
    """
    found: list[tuple[Key, Value]] = []
    _collect(value, key, found)
    return found


def _collect(value: object, key: Key, found: list[tuple[Key, Value]]) -> None:
    if isinstance(value, (str, int, float)):
        found.append((key, value))
        if isinstance(value, ProgramFile):
            found.append(((*key[:-1], "sha256"), value.sha256))
    elif isinstance(value, BaseModel):
        names = {} if key and isinstance(value, Part) else _written_names(type(value))
        for name, each in vars(value).items():
            if name in names:
                _collect(each, (*key, names[name]), found)
    elif isinstance(value, dict):
        for name, each in value.items():
            _collect(each, (*key, name), found)
    elif isinstance(value, tuple):
        for index, each in enumerate(value):
            _collect(each, (*key, getattr(each, "id", index)), found)


@cache
def _written_names(model: type[BaseModel]) -> dict[str, str]:
    """Return the fields that a stop can depend on -> their names in a file."""
    fields = model.model_fields.items()
    return {name: field.alias or name for name, field in fields if name not in DESCRIPTIVE}


def mark_of(quantity: Quantity, sources: Mapping[str, Source]) -> str:
    """The mark of the source; `user` for a number without one, `default` for a number that the file omits."""
    if quantity.source in sources:
        return sources[quantity.source].mark
    return {SCENARIO_SOURCE: "user", DEFAULT_SOURCE: "default"}[quantity.source]


def is_changed(part: Part) -> bool:
    """Whether a value of a part differs from the part at the root of its `extends`."""
    original = part.original
    return original is not None and dict(values_in(part)) != dict(values_in(original))
