"""What one wheelset has of its own: a worn wheel, a weak brake, sensors that err."""

from collections.abc import Mapping
from types import MappingProxyType
from typing import TYPE_CHECKING, Annotated, Any, Final, TypeAlias

from pydantic import AfterValidator, Field, create_model
from pydantic_core import PydanticCustomError

from uictest.plans.scenario.parts.brake import PadFriction, WspValve
from uictest.plans.scenario.parts.caliper import Caliper
from uictest.plans.scenario.parts.sensors import Loadcell, PressureSensor, SpeedSensor
from uictest.plans.scenario.yaml import Model, Quantity, Section, of_kind, quoted

NUMBERS: Final = ("1", "2", "3", "4")
"""Numbers of the wheelsets from the leading end, as keys."""
_ERRORS: Final = ("gain_error", "offset", "noise")
Radius = Annotated[Quantity, of_kind("length", above="0.1 m", at_most="1 m")]


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

    speed: OwnSpeedSensor = Field(default=OwnSpeedSensor(), description="Its speed sensor.")
    pressure: OwnPressureSensor = Field(
        default=OwnPressureSensor(), description="The pressure sensor of its tank."
    )
    loadcell: OwnLoadcell = Field(default=OwnLoadcell(), description="The loadcells of its caliper.")


class OwnValues(Section):
    """What one wheelset has of its own; everything else is as on the others."""

    wheel_radius: Radius | None = Field(
        default=None, description="Rolling radius of its wheels; vehicle.wheelset.radius if left out."
    )
    configured_radius: Radius | None = Field(
        default=None,
        description="Radius that the WSP was configured with: measured speed is rotation times this;"
        " vehicle.wheelset.radius if left out.",
    )
    brake_force: Annotated[Quantity, of_kind("share", at_least="0 %", at_most="300 %")] | None = Field(
        default=None, description="Its brake force as a share of the regular one; 100 % if left out."
    )
    pad_friction: PadFriction | None = Field(
        default=None, description="Friction coefficient between its pads and discs."
    )
    caliper: OwnCaliper = Field(default=OwnCaliper(), description="Its caliper.")
    wsp_valve: OwnWspValve = Field(default=OwnWspValve(), description="Its WSP valve.")
    sensors: OwnSensors = Field(default=OwnSensors(), description="Its sensors.")


def _completed(own: dict[str, OwnValues]) -> dict[str, OwnValues]:
    return {number: own.get(number, OwnValues()) for number in NUMBERS}


Wheelsets = Annotated[dict[WheelsetNumber, OwnValues], AfterValidator(_completed)]
"""The own values of all four wheelsets, those that a file leaves out empty."""
ALIKE: Final = MappingProxyType(_completed({}))
"""Wheelsets without values of their own."""

REGULAR: Final[Mapping[str, str]] = MappingProxyType(
    {
        **dict.fromkeys(("wheel_radius", "configured_radius"), "vehicle.wheelset.radius"),
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
