"""The brake system: air supply, brake operating unit, valves, tanks and disc brake."""

from collections.abc import Iterator
from typing import Annotated, ClassVar, Literal

from pydantic import Field

from uictest.plans.scenario.yaml import Inconsistency, Part, Quantity, Section, of_kind

GaugePressure = Annotated[Quantity, of_kind("pressure", at_least="0.1 bar", at_most="20 bar")]
Volume = Annotated[Quantity, of_kind("volume", at_least="0.1 L", at_most="10 m3")]
Conductance = Annotated[
    Quantity, of_kind("conductance", at_least="1e-11 m3/(s Pa)", at_most="1e-5 m3/(s Pa)")
]
FilmCoefficient = Annotated[
    Quantity, of_kind("film coefficient", at_least="0 W/(m2 K)", at_most="1e5 W/(m2 K)")
]
Surface = Annotated[Quantity, of_kind("area", at_least="0 m2", at_most="100 m2")]
Ratio = Annotated[Quantity, of_kind("number", at_least="0.01", below="1")]
PadFriction = Annotated[Quantity, of_kind("number", at_least="0.01", at_most="1")]


class Position(Section):
    """A brake position (P, R, G): how much pressure, how soon."""

    maximum_pressure: GaugePressure = Field(description="Tank pressure at full service command, gauge.")
    fill_time: Annotated[Quantity, of_kind("time", at_least="1 ms", at_most="60 s")] = Field(
        description="Time in which the set pressure rises from zero to the maximum."
    )
    dead_time: Annotated[Quantity, of_kind("time", at_least="0 s", at_most="10 s")] = Field(
        description="Time between the command and the first rise of pressure."
    )


class Reservoir(Section):
    """The main air reservoir."""

    volume: Volume = Field(description="Volume of the reservoir.")
    initial_pressure: GaugePressure = Field(description="Pressure at the start of the stop, gauge.")


class Compressor(Section):
    """The compressor with its pressure governor."""

    cut_in_pressure: GaugePressure = Field(description="Below this reservoir pressure it starts, gauge.")
    cut_out_pressure: GaugePressure = Field(description="At this reservoir pressure it stops, gauge.")
    delivery: Annotated[Quantity, of_kind("mass flow", at_least="0 kg/s", at_most="1 kg/s")] = Field(
        description="Air delivered while running; NL are at 20 degC and 1 bar."
    )


class RelayValve(Section):
    """The relay valve of the brake operating unit, between reservoir and brake line."""

    conductance: Conductance = Field(description="Sonic conductance (ISO 6358) when fully open.")
    proportional_band: Annotated[Quantity, of_kind("pressure", at_least="0.001 bar", at_most="5 bar")] = (
        Field(description="Deviation from the set pressure at which the valve is fully open.")
    )


class BrakeLine(Section):
    """The pipe from the brake operating unit to the WSP valves."""

    volume: Volume = Field(description="Volume of the brake line.")
    surface: Surface = Field(description="Inner surface of its wall.")
    film_coefficient: FilmCoefficient = Field(description="Heat flow from the wall to the air.")


class WspValve(Section):
    """A WSP valve: fill, hold or vent one tank."""

    fill_conductance: Conductance = Field(description="Sonic conductance (ISO 6358) from brake line to tank.")
    vent_conductance: Conductance = Field(description="Sonic conductance (ISO 6358) from tank to atmosphere.")
    switching_delay: Annotated[Quantity, of_kind("time", at_least="0 s", at_most="1 s")] = Field(
        description="Time from the command to the start of the valve's movement."
    )
    travel_time: Annotated[Quantity, of_kind("time", at_least="0 s", at_most="1 s")] = Field(
        description="Time in which the valve moves from shut to fully open."
    )


class Tank(Section):
    """The tank of one module: pipe and brake-cylinder volume."""

    volume: Volume = Field(description="Volume of an empty tank.")
    surface: Surface = Field(description="Inner surface of an empty tank.")
    film_coefficient: FilmCoefficient = Field(
        description="Heat flow from the wall to the air: 0 adiabatic, very large isothermal."
    )


class CaliperTank(Section):
    """What makes the tank of a module with a caliper different."""

    ball_volume: Annotated[Quantity, of_kind("volume", at_least="0 L", at_most="1 m3")] = Field(
        description="Volume of the steel balls in the tank."
    )
    hose_and_dead_volume: Annotated[Quantity, of_kind("volume", at_least="0 L", at_most="1 m3")] = Field(
        description="Volume of the hose to the caliper and of the cylinder with its piston fully back."
    )
    ball_surface: Surface = Field(description="Surface of the steel balls.")
    film_coefficient: FilmCoefficient = Field(description="Heat flow from the balls to the air.")


class DiscRing(Section):
    """The ring of a disc under one pad face: a slab with its back insulated, or half of one heated twice."""

    area: Annotated[Quantity, of_kind("area", at_least="10 cm2", at_most="2 m2")] = Field(
        description="Area of the ring that one pad sweeps."
    )
    thickness: Annotated[Quantity, of_kind("length", at_least="1 mm", at_most="20 cm")] = Field(
        description="Thickness of the ring that the heat of one pad face goes into."
    )
    conductivity: Annotated[
        Quantity, of_kind("thermal conductivity", at_least="1 W/(m K)", at_most="500 W/(m K)")
    ] = Field(description="Thermal conductivity of the ring.")
    density: Annotated[Quantity, of_kind("density", at_least="1000 kg/m3", at_most="20000 kg/m3")] = Field(
        description="Density of the ring."
    )
    specific_heat: Annotated[
        Quantity, of_kind("specific heat", at_least="100 J/(kg K)", at_most="2000 J/(kg K)")
    ] = Field(description="Specific heat capacity of the ring.")
    film_coefficient: Annotated[
        Quantity, of_kind("film coefficient", at_least="0 W/(m2 K)", at_most="1000 W/(m2 K)")
    ] = Field(description="Heat flow from the ring to the air, per area of the ring.")


class Disc(Section):
    """The disc brake of one wheelset."""

    mean_radius: Annotated[Quantity, of_kind("length", at_least="5 cm", at_most="1 m")] = Field(
        description="Radius at which the pads' friction acts."
    )
    calipers_per_wheelset: Annotated[Quantity, of_kind("count", at_least="1", at_most="8")] = Field(
        description="Calipers on one wheelset."
    )
    pads_per_caliper: Annotated[Quantity, of_kind("count", at_least="1", at_most="4")] = Field(
        description="Friction faces per caliper."
    )
    pad_friction: PadFriction = Field(
        description="Friction coefficient between pad and disc, where the factors of `brake.pad` are 1."
    )
    thermal: DiscRing | None = Field(
        default=None, description="What the temperature of the disc is modelled with."
    )


class Air(Section):
    """The air and its surroundings."""

    temperature: Annotated[Quantity, of_kind("temperature", at_least="-60 degC", at_most="80 degC")] = Field(
        description="Temperature of air and surroundings."
    )
    atmospheric_pressure: Annotated[Quantity, of_kind("pressure", at_least="0.5 bar", at_most="1.2 bar")] = (
        Field(description="Pressure of the surroundings, absolute.")
    )
    gas_constant: Annotated[
        Quantity, of_kind("gas constant", at_least="100 J/(kg K)", at_most="1000 J/(kg K)")
    ] = Field(description="Specific gas constant of air.")
    heat_capacity_ratio: Annotated[Quantity, of_kind("number", at_least="1.01", at_most="1.7")] = Field(
        description="Heat capacity at constant pressure over that at constant volume."
    )


class BrakeSystem(Part):
    """A pneumatic disc brake with wheel slide protection valves."""

    folder: ClassVar[str] = "brakes"

    schema_id: Literal["uictest/brake/1"] = Field(
        default="uictest/brake/1", alias="schema", description="What the file holds: uictest/brake/1."
    )
    positions: dict[str, Position] = Field(
        min_length=1, description="Brake positions by name, such as P, R, G."
    )
    reservoir: Reservoir = Field(description="The main air reservoir.")
    compressor: Compressor = Field(description="The compressor with its pressure governor.")
    relay_valve: RelayValve = Field(description="The relay valve of the brake operating unit.")
    brake_line: BrakeLine = Field(description="The pipe from the relay valve to the WSP valves.")
    wsp_valve: WspValve = Field(description="One WSP valve; vehicle.wheelsets says where one differs.")
    critical_pressure_ratio: Ratio = Field(
        description="Critical pressure ratio b of every orifice (ISO 6358)."
    )
    laminar_pressure_ratio: Ratio = Field(
        description="Pressure ratio above which the flow is taken as linear."
    )
    tank: Tank = Field(description="One tank; all four are alike.")
    caliper_tank: CaliperTank = Field(description="What differs in the tank of a module with a caliper.")
    disc: Disc = Field(description="The disc brake of one wheelset.")
    air: Air = Field(description="The air and its surroundings.")

    def inconsistencies(self) -> Iterator[Inconsistency]:
        """Yield pressures, volumes and ratios that no air system can have."""
        yield from super().inconsistencies()
        yield from self._supply_inconsistencies()
        if self.laminar_pressure_ratio <= self.critical_pressure_ratio:
            yield Inconsistency(("laminar_pressure_ratio",), "it must lie above critical_pressure_ratio")
        if self.caliper_tank.ball_volume >= self.tank.volume:
            yield Inconsistency(("caliper_tank", "ball_volume"), "the balls do not fit into tank.volume")

    def _supply_inconsistencies(self) -> Iterator[Inconsistency]:
        if self.compressor.cut_in_pressure >= self.compressor.cut_out_pressure:
            yield Inconsistency(
                ("compressor", "cut_in_pressure"),
                f"the compressor would start at {self.compressor.cut_in_pressure.text} and stop at"
                f" {self.compressor.cut_out_pressure.text}",
                "cut_in_pressure must be below cut_out_pressure",
            )
        for name, position in self.positions.items():
            if position.maximum_pressure >= self.reservoir.initial_pressure:
                yield Inconsistency(
                    ("positions", name, "maximum_pressure"),
                    f"the brake line cannot reach {position.maximum_pressure.text} from a reservoir at"
                    f" {self.reservoir.initial_pressure.text}",
                    "it must be below reservoir.initial_pressure",
                )


class Caliper(Part):
    """A brake cylinder with its lever and pads."""

    folder: ClassVar[str] = "calipers"

    schema_id: Literal["uictest/caliper/1"] = Field(
        default="uictest/caliper/1", alias="schema", description="What the file holds: uictest/caliper/1."
    )
    piston_area: Annotated[Quantity, of_kind("area", at_least="1 cm2", at_most="0.5 m2")] = Field(
        description="Piston area."
    )
    preload: Annotated[Quantity, of_kind("force", at_least="0 N", at_most="20 kN")] = Field(
        description="Force of the return spring with the piston fully back."
    )
    spring_rate: Annotated[Quantity, of_kind("stiffness", at_least="0 N/m", at_most="1e7 N/m")] = Field(
        description="Rate of the return spring."
    )
    coulomb_friction: Annotated[Quantity, of_kind("force", at_least="0 N", at_most="5 kN")] = Field(
        description="Friction that does not depend on the load, at the piston."
    )
    load_friction: Annotated[Quantity, of_kind("share", at_least="0 %", at_most="50 %")] = Field(
        description="Friction of seals and pins as a share of the load they carry."
    )
    viscous_friction: Annotated[Quantity, of_kind("damping", at_least="0 N s/m", at_most="1e7 N s/m")] = (
        Field(description="Friction that grows with piston speed, at the piston.")
    )
    contact_friction: Annotated[Quantity, of_kind("damping", at_least="0 N s/m", at_most="1e7 N s/m")] = (
        Field(description="Friction of lever, pins and pads that grows with their speed, at the piston.")
    )
    clearance: Annotated[Quantity, of_kind("length", at_least="0 mm", at_most="50 mm")] = Field(
        description="Piston stroke until the pads touch the disc."
    )
    contact_stiffness: Annotated[Quantity, of_kind("stiffness", at_least="1 kN/m", at_most="1e10 N/m")] = (
        Field(description="Stiffness of lever, pads and disc once in contact, at the piston.")
    )
    lever_ratio: Annotated[Quantity, of_kind("number", at_least="0.01", at_most="20")] = Field(
        description="Clamping force over the net force at the piston."
    )

    def inconsistencies(self) -> Iterator[Inconsistency]:
        """Yield a piston that nothing holds before the pads touch."""
        yield from super().inconsistencies()
        if self.spring_rate == 0.0 and self.viscous_friction == 0.0:
            yield Inconsistency(
                ("viscous_friction",),
                "a piston without spring rate and viscous friction has no stroke that follows from its load",
                "give spring_rate or viscous_friction",
            )
