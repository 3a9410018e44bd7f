"""The equipment of car and rig: brake system, caliper, sensors."""

from collections.abc import Iterator
from typing import Annotated, ClassVar, Literal

from uictest.plans.scenario.yaml import (
    Inconsistency,
    Model,
    Part,
    Quantity,
    Section,
    default,
    field,
    of_kind,
    optional,
    quantity,
    schema_field,
)

GaugePressure = Annotated[Quantity, of_kind("pressure", "0.1 bar .. 20 bar")]
Volume = Annotated[Quantity, of_kind("volume", "0.1 L .. 10 m3")]
Conductance = Annotated[Quantity, of_kind("conductance", "1e-11 m3/(s Pa) .. 1e-5 m3/(s Pa)")]
FilmCoefficient = Annotated[Quantity, of_kind("film coefficient", "0 W/(m2 K) .. 1e5 W/(m2 K)")]
Surface = Annotated[Quantity, of_kind("area", "0 m2 .. 100 m2")]
Ratio = Annotated[Quantity, of_kind("number", "0.01 .. < 1")]
CoulombFriction = Annotated[Quantity, of_kind("force", "0 N .. 5 kN")]
LoadFriction = Annotated[Quantity, of_kind("share", "0 % .. 50 %")]
ValveTime = Annotated[Quantity, of_kind("time", "0 s .. 1 s")]
PadFriction = Annotated[Quantity, of_kind("number", "0.01 .. 1")]


class Position(Section):
    """A brake position (P, R, G): how much pressure, how soon."""

    maximum_pressure: GaugePressure = field("Tank pressure at full service command, gauge.")
    fill_time: Quantity = quantity(
        "Time in which the set pressure rises from zero to the maximum.", "time", "1 ms .. 60 s"
    )
    dead_time: Quantity = quantity(
        "Time between the command and the first rise of pressure.", "time", "0 s .. 10 s"
    )
    release_time: Annotated[Quantity, of_kind("time", "1 ms .. 120 s")] | None = optional(
        "Time in which the set pressure falls from the maximum to zero; fill_time if left out."
    )


class Reservoir(Section):
    """The main air reservoir."""

    volume: Volume = field("Volume of the reservoir.")
    initial_pressure: GaugePressure = field("Pressure at the start of the stop, gauge.")


class Compressor(Section):
    """The compressor with its pressure governor."""

    cut_in_pressure: GaugePressure = field("Below this reservoir pressure it starts, gauge.")
    cut_out_pressure: GaugePressure = field("At this reservoir pressure it stops, gauge.")
    delivery: Quantity = quantity(
        "Air delivered while running; NL are at 20 degC and 1 bar.", "mass flow", "0 kg/s .. 1 kg/s"
    )


class RelayValve(Section):
    """The relay valve of the brake operating unit, between reservoir and brake line."""

    conductance: Conductance = field("Sonic conductance (ISO 6358) when fully open.")
    proportional_band: Quantity = quantity(
        "Deviation from the set pressure at which the valve is fully open.", "pressure", "0.001 bar .. 5 bar"
    )


class BrakeLine(Section):
    """The pipe from the brake operating unit to the WSP valves."""

    volume: Volume = field("Volume of the brake line.")
    surface: Surface = field("Inner surface of its wall.")
    film_coefficient: FilmCoefficient = field("Heat flow from the wall to the air.")


class WspValve(Section):
    """A WSP valve: fill, hold or vent one tank."""

    fill_conductance: Conductance = field("Sonic conductance (ISO 6358) from brake line to tank.")
    vent_conductance: Conductance = field("Sonic conductance (ISO 6358) from tank to atmosphere.")
    switching_delay: ValveTime = field("Time from the command to the start of the valve's movement.")
    travel_time: ValveTime = field("Time in which the valve moves from shut to fully open.")


class Tank(Section):
    """The tank of one module: pipe and brake-cylinder volume."""

    volume: Volume = field("Volume of an empty tank.")
    surface: Surface = field("Inner surface of an empty tank.")
    film_coefficient: FilmCoefficient = field(
        "Heat flow from the wall to the air: 0 adiabatic, very large isothermal."
    )


class CaliperTank(Section):
    """Differences of the tank of a module with a caliper."""

    ball_volume: Quantity = quantity("Volume of the steel balls in the tank.", "volume", "0 L .. 1 m3")
    hose_and_dead_volume: Quantity = quantity(
        "Volume of the hose to the caliper and of the cylinder with its piston fully back.",
        "volume",
        "0 L .. 1 m3",
    )
    ball_surface: Surface = field("Surface of the steel balls.")
    film_coefficient: FilmCoefficient = field("Heat flow from the balls to the air.")


class DiscRing(Section):
    """The ring of a disc under one pad face: a slab with its back insulated, or half of one heated twice."""

    area: Quantity = quantity("Area of the ring that one pad sweeps.", "area", "10 cm2 .. 2 m2")
    thickness: Quantity = quantity(
        "Thickness of the ring that the heat of one pad face goes into.", "length", "1 mm .. 20 cm"
    )
    conductivity: Quantity = quantity(
        "Thermal conductivity of the ring.", "thermal conductivity", "1 W/(m K) .. 500 W/(m K)"
    )
    density: Quantity = quantity("Density of the ring.", "density", "1000 kg/m3 .. 20000 kg/m3")
    specific_heat: Quantity = quantity(
        "Specific heat capacity of the ring.", "specific heat", "100 J/(kg K) .. 2000 J/(kg K)"
    )
    film_coefficient: Quantity = quantity(
        "Heat flow from the ring to the air, per area of the ring.",
        "film coefficient",
        "0 W/(m2 K) .. 1000 W/(m2 K)",
    )


class Disc(Section):
    """The disc brake of one wheelset."""

    mean_radius: Quantity = quantity("Radius at which the pads' friction acts.", "length", "5 cm .. 1 m")
    calipers_per_wheelset: Quantity = quantity("Calipers on one wheelset.", "count", "1 .. 8")
    pads_per_caliper: Quantity = quantity("Friction faces per caliper.", "count", "1 .. 4")
    pad_friction: PadFriction = field(
        "Friction coefficient between pad and disc, where the factors of `brake.pad` are 1."
    )
    thermal: DiscRing | None = optional("What the temperature of the disc is modelled with.")


class Air(Section):
    """The air and its surroundings."""

    temperature: Quantity = quantity(
        "Temperature of air and surroundings.", "temperature", "-60 degC .. 80 degC"
    )
    atmospheric_pressure: Quantity = quantity(
        "Pressure of the surroundings, absolute.", "pressure", "0.5 bar .. 1.2 bar"
    )
    gas_constant: Quantity = quantity(
        "Specific gas constant of air.", "gas constant", "100 J/(kg K) .. 1000 J/(kg K)"
    )
    heat_capacity_ratio: Quantity = quantity(
        "Heat capacity at constant pressure over that at constant volume.", "number", "1.01 .. 1.7"
    )


class LoadValve(Section):
    """The valve that lets the brake pressure follow the load of the car."""

    empty_share: Quantity = quantity(
        "Pressure of the empty car over that of the full one; between them it is linear in the load.",
        "share",
        "10 % .. 100 %",
    )


class BrakeSystem(Part):
    """A pneumatic disc brake with wheel slide protection valves."""

    folder: ClassVar[str] = "brakes"

    schema_id: Literal["uictest/brake/1"] = schema_field("uictest/brake/1")
    positions: dict[str, Position] = field("Brake positions by name, such as P, R, G.", min_length=1)
    reservoir: Reservoir = field("The main air reservoir.")
    compressor: Compressor = field("The compressor with its pressure governor.")
    relay_valve: RelayValve = field("The relay valve of the brake operating unit.")
    brake_line: BrakeLine = field("The pipe from the relay valve to the WSP valves.")
    wsp_valve: WspValve = field("One WSP valve; vehicle.wheelsets says where one differs.")
    critical_pressure_ratio: Ratio = field("Critical pressure ratio b of every orifice (ISO 6358).")
    laminar_pressure_ratio: Ratio = field("Pressure ratio above which the flow is taken as linear.")
    tank: Tank = field("One tank; all four are alike.")
    caliper_tank: CaliperTank = field("What differs in the tank of a module with a caliper.")
    disc: Disc = field("The disc brake of one wheelset.")
    load_valve: LoadValve | None = optional(
        "How the pressure follows vehicle.load; if left out, it does not. Pressures are then of the full car."
    )
    air: Air = field("The air and its surroundings.")

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


class CaliperNumbers(Model):
    """A brake cylinder with its lever and pads."""

    piston_area: Quantity = quantity("Piston area.", "area", "1 cm2 .. 0.5 m2")
    preload: Quantity = quantity(
        "Force of the return spring with the piston fully back.", "force", "0 N .. 20 kN"
    )
    spring_rate: Quantity = quantity("Rate of the return spring.", "stiffness", "0 N/m .. 1e7 N/m")
    coulomb_friction: CoulombFriction = field("Friction that does not depend on the load, at the piston.")
    load_friction: LoadFriction = field("Friction of seals and pins as a share of the load they carry.")
    viscous_friction: Quantity = quantity(
        "Friction that grows with piston speed, at the piston.", "damping", "0 N s/m .. 1e7 N s/m"
    )
    contact_friction: Quantity = quantity(
        "Friction of lever, pins and pads that grows with their speed, at the piston.",
        "damping",
        "0 N s/m .. 1e7 N s/m",
    )
    clearance: Quantity = quantity("Piston stroke until the pads touch the disc.", "length", "0 mm .. 50 mm")
    contact_stiffness: Quantity = quantity(
        "Stiffness of lever, pads and disc once in contact, at the piston.", "stiffness", "1 kN/m .. 1e10 N/m"
    )
    lever_ratio: Quantity = quantity(
        "Clamping force over the net force at the piston.", "number", "0.01 .. 20"
    )


class Caliper(CaliperNumbers, Part):
    """A brake cylinder with its lever and pads."""

    folder: ClassVar[str] = "calipers"

    schema_id: Literal["uictest/caliper/1"] = schema_field("uictest/caliper/1")

    @property
    def closing_force(self) -> float:
        """Force at the squeezing piston with which the pads touch the disc, N."""
        return self.preload + self.spring_rate * self.clearance + self.coulomb_friction

    def squeezing_force(self, pressure: float) -> float:
        """Clamping force of the squeezing caliper at a gauge pressure in Pa, N."""
        net = max(self.piston_area * pressure - self.closing_force, 0.0)
        return self.lever_ratio * net / (1.0 + self.load_friction)

    def inconsistencies(self) -> Iterator[Inconsistency]:
        """Yield a piston that nothing holds before the pads touch."""
        yield from super().inconsistencies()
        if self.spring_rate == 0.0 and self.viscous_friction == 0.0:
            yield Inconsistency(
                ("viscous_friction",),
                "a piston without spring rate and viscous friction has no stroke that follows from its load",
                "give spring_rate or viscous_friction",
            )


PressureOffset = Annotated[Quantity, of_kind("pressure", "-1 bar .. 1 bar")]
PressureNoise = Annotated[Quantity, of_kind("pressure", "1e-6 bar .. 1 bar")]
ForceOffset = Annotated[Quantity, of_kind("force", "-10 kN .. 10 kN")]
ForceNoise = Annotated[Quantity, of_kind("force", "0.001 N .. 10 kN")]
Teeth = Annotated[Quantity, of_kind("count", "1 .. 1000")]
MissingTeeth = Annotated[Quantity, of_kind("count", "0 .. 100")]
TimerResolution = Annotated[Quantity, of_kind("time", "1e-6 ms .. 10 ms")]
LowestSpeed = Annotated[Quantity, of_kind("speed", "0.01 km/h .. 50 km/h")]
SpeedMethod = Literal["momentary", "whole-teeth"]
ErrorShare = Annotated[Quantity, of_kind("share", "-50 % .. 50 %")]
NoiseShare = Annotated[Quantity, of_kind("share", "0 % .. 50 %")]


class SpeedSensor(Section):
    """A toothed wheel on the axle; speed from the time between teeth."""

    teeth: Teeth = field("Teeth of the wheel.")
    timer_resolution: TimerResolution = field("Resolution of the timer between teeth.")
    minimum_speed: LowestSpeed = field("Wheel speed below which the sensor reads zero.")
    noise: NoiseShare = field("Standard deviation of the noise as a share of the reading.")
    gain_error: ErrorShare = field("Error in proportion to the reading.", default=default("0 %", "share"))
    method: SpeedMethod = field(
        "momentary: the speed at the instant of reading; whole-teeth: that of the last whole"
        " teeth, which is older the slower the wheel turns.",
        default="momentary",
    )
    eccentricity: NoiseShare = field(
        "Error once per turn: largest deviation as a share of the reading.", default=default("0 %", "share")
    )
    missing_teeth: MissingTeeth = field(
        "Teeth missing in one gap of the wheel; only with method whole-teeth.", default=default("0", "count")
    )


class PressureSensor(Section):
    """A pressure sensor of a tank or of the reservoir."""

    range: Quantity = quantity("Highest gauge pressure it reads.", "pressure", "0.1 bar .. 100 bar")
    gain_error: ErrorShare = field("Error in proportion to the reading.")
    offset: PressureOffset = field("Reading at zero gauge pressure.")
    noise: PressureNoise = field("Standard deviation of the noise.")
    resolution: Quantity = quantity("Smallest step of the reading.", "pressure", "1e-6 bar .. 1 bar")


class Loadcell(Section):
    """One of the loadcells between pad and disc."""

    range: Quantity = quantity("Highest force it reads.", "force", "0.1 kN .. 1000 kN")
    gain_error: ErrorShare = field("Error in proportion to the reading.")
    offset: ForceOffset = field("Reading without force.")
    noise: ForceNoise = field("Standard deviation of the noise.")
    resolution: Quantity = quantity("Smallest step of the reading.", "force", "0.001 N .. 10 kN")


class TrainSpeedSource(Section):
    """A speed of the train from outside the wheelsets: radar, satellites, the train's computer."""

    most_periods: ClassVar[int] = 3
    """Values that can be on their way, chosen."""

    period: Quantity = quantity(
        "Time from one value to the next, rounded to whole controller cycles.",
        "time",
        "1 ms .. 5 s",
        default="100 ms",
    )
    delay: Quantity = quantity(
        "Age of a value when the controller first gets it, rounded likewise; at most three periods.",
        "time",
        "0 s .. 15 s",
        default="100 ms",
    )
    noise: Quantity = quantity(
        "Standard deviation of the noise of a value.", "speed", "0 km/h .. 20 km/h", default="0.2 km/h"
    )
    gain_error: ErrorShare = field("Error in proportion to the speed.", default=default("0 %", "share"))

    def inconsistencies(self) -> Iterator[Inconsistency]:
        """Yield a delay for which too many values would be on their way."""
        if self.delay > self.most_periods * self.period:
            yield Inconsistency(
                ("delay",),
                f"{self.delay.text} is more than {self.most_periods} periods of {self.period.text}",
                f"at most {self.most_periods} values can be on their way: shorten the delay",
            )


class Accelerometer(Section):
    """An accelerometer on the car body along the track, read in every controller cycle.

    On a gradient it shows the share of gravity, too; that of the body's pitch is not modelled.
    """

    noise: Quantity = quantity(
        "Standard deviation of the noise.", "acceleration", "0 m/s2 .. 5 m/s2", default="0.05 m/s2"
    )
    offset: Quantity = quantity(
        "Reading without acceleration.", "acceleration", "-1 m/s2 .. 1 m/s2", default="0 m/s2"
    )


class Sensors(Part):
    """The sensors of the rig."""

    folder: ClassVar[str] = "sensors"

    schema_id: Literal["uictest/sensors/1"] = schema_field("uictest/sensors/1")
    speed: SpeedSensor = field("Speed sensor of a wheelset.")
    pressure: PressureSensor = field("Pressure sensors.")
    loadcell: Loadcell = field("Loadcells between pad and disc.")
    train_speed: TrainSpeedSource | None = optional(
        "A second source of the train's speed, for controllers of contract version 2."
    )
    acceleration: Accelerometer | None = optional("An accelerometer, for controllers of contract version 2.")
