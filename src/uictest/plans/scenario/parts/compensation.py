"""The compensation: cylinder dynamics or modelled air, and four-phase hysteresis, in place of a caliper."""

from collections.abc import Iterator
from types import MappingProxyType
from typing import TYPE_CHECKING, Annotated, Any, ClassVar, Final, Literal, NamedTuple, TypeAlias

from pydantic import Field, create_model

from uictest.core.units import BAR
from uictest.plans.scenario.parts.brake import Caliper, Volume, WspValve
from uictest.plans.scenario.yaml import Inconsistency, Model, Part, Quantity, Section, total
from uictest.plans.scenario.yaml.quantity_field import field, of_kind, optional, quantity, schema_field

Coefficient = Annotated[Quantity, of_kind("number", "-1e6 .. 1e6")]

HeatConductance = Annotated[Quantity, of_kind("heat conductance", "0 W/K .. 1e4 W/K")]
ClosingPressure = Annotated[Quantity, of_kind("pressure", "0.001 bar .. 10 bar")]

UNITY_GAIN_TOLERANCE: Final = 1e-6
"""How far the gain at rest may be from one."""
HIGHEST_PRESSURE: Final = 10.0 * BAR
"""Gauge pressure in Pa up to which the lines of a pair must keep their order."""


class CompensationSetting(NamedTuple):
    """What computes the clamping force of a module without a caliper.

    Attributes:
        hysteresis: whether its force follows the four lines, or a single one.
        pressure: where the cylinder pressure comes from: the tank's reading as it is, the transfer function
            of equation (8), or the modelled air of the caliper's module.
    """

    hysteresis: bool
    pressure: Literal["tank", "filter", "air"]


COMPENSATION_SETTINGS: Final = MappingProxyType(
    {
        "none": CompensationSetting(hysteresis=False, pressure="tank"),
        "hysteresis": CompensationSetting(hysteresis=True, pressure="tank"),
        "cylinder": CompensationSetting(hysteresis=False, pressure="filter"),
        "full": CompensationSetting(hysteresis=True, pressure="filter"),
        "thermal": CompensationSetting(hysteresis=True, pressure="air"),
    }
)
"""Settings of ``rig.compensation``; all but `thermal` are those of Lee and Kang (2015)."""


class ForceLine(Section):
    """Clamping force as a straight line over gauge pressure, where it is positive."""

    slope: Quantity = quantity("Force per pressure.", "force per pressure", "0.001 kN/bar .. 1000 kN/bar")
    intercept: Quantity = quantity(
        "Force at zero gauge pressure; negative, because the spring must be overcome first.",
        "force",
        "-100 kN .. 100 kN",
    )

    def force(self, pressure: float) -> float:
        """Force in N at a gauge pressure in Pa."""
        return max(0.0, self.slope * pressure + self.intercept)


class FourPhaseHysteresis(Section):
    """Equations (4)-(7): a squeezing and a releasing line, one pair without and one with the WSP acting."""

    bc_squeezing: ForceLine = field("Pressure rising, WSP not acting.")
    bc_releasing: ForceLine = field("Pressure falling, WSP not acting.")
    wsp_squeezing: ForceLine = field("Pressure rising, WSP acting.")
    wsp_releasing: ForceLine = field("Pressure falling, WSP acting.")
    transition_time: Quantity = quantity(
        "Time in which one pair of lines turns into the other, so that the force does not jump.",
        "time",
        "0 s .. 10 s",
    )
    wsp_acting_time: Quantity = quantity(
        "Time of uninterrupted filling after which the WSP no longer counts as acting.", "time", "0 s .. 60 s"
    )

    def inconsistencies(self) -> Iterator[Inconsistency]:
        """Yield the pairs whose squeezing line is not below the releasing line."""
        pairs = (
            ("bc_squeezing", self.bc_squeezing, "bc_releasing", self.bc_releasing),
            ("wsp_squeezing", self.wsp_squeezing, "wsp_releasing", self.wsp_releasing),
        )
        for squeezing_key, squeezing, releasing_key, releasing in pairs:
            # Straight where positive: their order at the first force of the lower one and at the end decides.
            start = max(0.0, -squeezing.intercept / squeezing.slope)
            if any(squeezing.force(at) > releasing.force(at) for at in (start, HIGHEST_PRESSURE)):
                yield Inconsistency(
                    (squeezing_key,),
                    "the squeezing line must lie below the releasing line wherever there is force",
                    f"compare its slope and intercept with {releasing_key}",
                )


class CylinderDynamics(Section):
    """Equation (8): (b0 + b1/z + b2/z2 + b3/z3) / (1 + a1/z + a2/z2 + a3/z3)."""

    numerator: tuple[Coefficient, Coefficient, Coefficient, Coefficient] = field("b0, b1, b2, b3.")
    denominator: tuple[Coefficient, Coefficient, Coefficient] = field("a1, a2, a3.")

    def inconsistencies(self) -> Iterator[Inconsistency]:
        """Yield an unstable denominator or a gain at rest that is not one."""
        if not _stable(*self.denominator):
            yield Inconsistency(
                ("denominator",),
                "the transfer function is unstable",
                "every pole must lie inside the unit circle",
            )
            return
        gain = total(self.numerator) / (1.0 + total(self.denominator))
        if abs(gain - 1.0) > UNITY_GAIN_TOLERANCE:
            yield Inconsistency(
                ("numerator",),
                f"the gain at rest is {gain:.9g}, not 1",
                "sum of numerator must equal 1 + sum of denominator",
            )


def _stable(a1: float, a2: float, a3: float) -> bool:
    """Jury's criterion for z3 + a1 z2 + a2 z + a3."""
    return (
        abs(a3) < 1.0
        and 1.0 + a1 + a2 + a3 > 0.0
        and 1.0 - a1 + a2 - a3 > 0.0
        and abs(a2 - a1 * a3) < 1.0 - a3 * a3
    )


class ModuleAir(Section):
    """The air of the caliper's module, followed beside a tank: ours, not an equation of the paper."""

    tank_heat_conductance: HeatConductance = field("From the wall of a tank to its air.")
    caliper_heat_conductance: HeatConductance = field(
        "From the wall, and the balls, of the caliper's module to its air."
    )
    swept_volume: Quantity = quantity(
        "Volume that the piston sweeps until the pads touch the disc.", "volume", "0.001 L .. 10 L"
    )
    closing_pressure: ClosingPressure = field("At which the piston moves to the disc, gauge.")
    opening_pressure: ClosingPressure = field("At which the piston moves back, gauge.")

    def inconsistencies(self) -> Iterator[Inconsistency]:
        """Yield a piston that would move back before it moves out."""
        if self.opening_pressure > self.closing_pressure:
            yield Inconsistency(
                ("opening_pressure",),
                f"the piston would move back at {self.opening_pressure.text} and out at"
                f" {self.closing_pressure.text}",
                "opening_pressure must not exceed closing_pressure",
            )


Tolerance = Annotated[Quantity, of_kind("share", "> 0 % .. 100 %")]


def _numbers_of(name: str, model: type[Model], kind: Any = None) -> Any:
    """Return a section with the quantities of a model, or with one of `kind` for each of them."""
    fields: dict[str, Any] = {}
    for key, declared in model.model_fields.items():
        if declared.annotation is Quantity:
            own = kind or Annotated[(Quantity, *declared.metadata)]
            fields[key] = (own, Field(description=declared.description))
    return create_model(name, __base__=Section, __doc__=model.__doc__, __module__=__name__, **fields)


if TYPE_CHECKING:
    CaliperAsBuilt: TypeAlias = Section
    ValveAsBuilt: TypeAlias = Section
    CaliperTolerances: TypeAlias = Section
    ValveTolerances: TypeAlias = Section
else:
    CaliperAsBuilt = _numbers_of("CaliperAsBuilt", Caliper)
    ValveAsBuilt = _numbers_of("ValveAsBuilt", WspValve)
    CaliperTolerances = _numbers_of("CaliperTolerances", Caliper, Tolerance)
    ValveTolerances = _numbers_of("ValveTolerances", WspValve, Tolerance)


class RigTolerances(Section):
    """How far a rig may differ from the one that a compensation was identified for, as shares."""

    caliper: CaliperTolerances = field("Of the caliper.")
    wsp_valve: ValveTolerances = field("Of the WSP valve.")
    tank_volume: Tolerance = field("Of the volume of an empty tank.")


class RigAsBuilt(Section):
    """The rig that a compensation was identified for, as built: without faults."""

    caliper: CaliperAsBuilt = field("Its caliper.")
    wsp_valve: ValveAsBuilt = field("Its WSP valves.")
    tank_volume: Volume = field("Volume of an empty tank.")
    tolerances: RigTolerances = field("How far another rig may differ from it.")


class Compensation(Part):
    """The model that computes clamping force from the tank pressure of a module without caliper."""

    folder: ClassVar[str] = "compensations"

    schema_id: Literal["uictest/compensation/1"] = schema_field("uictest/compensation/1")
    sampling_time: Quantity = quantity("Sampling time of the cylinder dynamics.", "time", "0.01 ms .. 10 ms")
    linear: ForceLine = field("Force over pressure without hysteresis, used by the setting 'none'.")
    hysteresis: FourPhaseHysteresis = field("Four-phase hysteresis.")
    cylinder: CylinderDynamics = field("Tank pressure to cylinder pressure.")
    air: ModuleAir = field("Air of the caliper's module, used by the setting 'thermal'.")
    identified_for: RigAsBuilt | None = optional(
        "The rig that it was identified for; none: not known, so that no stop is checked for it."
    )
    to_identify: bool = field(
        "Whether the numbers only stand in: others are identified from the bench for the rig.",
        default=False,
        strict=True,
    )
    provenance: dict[str, str] = field(
        "How the numbers were identified, as text by topic.", default_factory=dict
    )

    def inconsistencies(self) -> Iterator[Inconsistency]:
        """Yield a compensation to identify whose tolerances, which the identified one takes, are missing."""
        yield from super().inconsistencies()
        if self.to_identify and self.identified_for is None:
            yield Inconsistency(
                ("identified_for",),
                "a compensation with `to_identify` has no `identified_for`, whose tolerances it is held to",
                "extend `identify`, or list the rig of the numbers that stand in",
            )
