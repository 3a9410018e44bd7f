"""The vehicle: a car on two bogies and four wheelsets, what a wheelset has of its own, couplers between cars.

The ranges catch a wrong unit or digit; they do not judge a design. They are chosen: about ten times beyond
the cars of the library, so that the lightest tram and half of the heaviest six-axle locomotive are accepted.
"""

import math
from collections.abc import Iterator, Mapping
from functools import cache
from operator import attrgetter
from types import MappingProxyType
from typing import Annotated, Any, ClassVar, Final, Literal

from pydantic import AfterValidator, Discriminator, Field, Tag

from uictest.plans.scenario.parts.equipment import (
    Caliper,
    Conductance,
    CoulombFriction,
    ErrorShare,
    ForceNoise,
    ForceOffset,
    Loadcell,
    LoadFriction,
    LoadValve,
    LowestSpeed,
    MissingTeeth,
    NoiseShare,
    PadFriction,
    PressureNoise,
    PressureOffset,
    PressureSensor,
    SpeedMethod,
    SpeedSensor,
    Teeth,
    TimerResolution,
    ValveTime,
    WspValve,
)
from uictest.plans.scenario.yaml import (
    Inconsistency,
    Key,
    Model,
    Part,
    Quantity,
    Section,
    default,
    field,
    of_kind,
    optional,
    quantity,
    quoted,
    refused,
    schema_field,
)

NUMBERS: Final = ("1", "2", "3", "4")
"""Numbers of the wheelsets from the leading end, as keys."""
Radius = Annotated[Quantity, of_kind("length", "> 0.1 m .. 1 m")]
Inertia = Annotated[Quantity, of_kind("inertia", "1 kg m2 .. 1e4 kg m2")]


def _require_wheelset_number(number: str) -> str:
    if number not in NUMBERS:
        raise refused(f"no wheelset {quoted(number)}", f"accepted: {', '.join(NUMBERS)}")
    return number


WheelsetNumber = Annotated[
    str, AfterValidator(_require_wheelset_number), Field(json_schema_extra={"enum": list(NUMBERS)})
]
"""Key of a wheelset."""


def _own_field(regular: type[Model], name: str) -> Any:
    return optional(regular.model_fields[name].description or "")


class OwnCaliper(Section):
    """A brake cylinder with its lever and pads."""

    load_friction: LoadFriction | None = _own_field(Caliper, "load_friction")
    coulomb_friction: CoulombFriction | None = _own_field(Caliper, "coulomb_friction")


class OwnWspValve(Section):
    """A WSP valve: fill, hold or vent one tank."""

    fill_conductance: Conductance | None = _own_field(WspValve, "fill_conductance")
    vent_conductance: Conductance | None = _own_field(WspValve, "vent_conductance")
    switching_delay: ValveTime | None = _own_field(WspValve, "switching_delay")
    travel_time: ValveTime | None = _own_field(WspValve, "travel_time")


class OwnSpeedSensor(Section):
    """A toothed wheel on the axle; speed from the time between teeth."""

    teeth: Teeth | None = _own_field(SpeedSensor, "teeth")
    timer_resolution: TimerResolution | None = _own_field(SpeedSensor, "timer_resolution")
    minimum_speed: LowestSpeed | None = _own_field(SpeedSensor, "minimum_speed")
    noise: NoiseShare | None = _own_field(SpeedSensor, "noise")
    gain_error: ErrorShare | None = _own_field(SpeedSensor, "gain_error")
    method: SpeedMethod | None = _own_field(SpeedSensor, "method")
    eccentricity: NoiseShare | None = _own_field(SpeedSensor, "eccentricity")
    missing_teeth: MissingTeeth | None = _own_field(SpeedSensor, "missing_teeth")


class OwnPressureSensor(Section):
    """A pressure sensor of a tank or of the reservoir."""

    gain_error: ErrorShare | None = _own_field(PressureSensor, "gain_error")
    offset: PressureOffset | None = _own_field(PressureSensor, "offset")
    noise: PressureNoise | None = _own_field(PressureSensor, "noise")


class OwnLoadcell(Section):
    """One of the loadcells between pad and disc."""

    gain_error: ErrorShare | None = _own_field(Loadcell, "gain_error")
    offset: ForceOffset | None = _own_field(Loadcell, "offset")
    noise: ForceNoise | None = _own_field(Loadcell, "noise")


class OwnSensors(Section):
    """The sensors of one wheelset and its module."""

    speed: OwnSpeedSensor = field("Its speed sensor.", default=OwnSpeedSensor())
    pressure: OwnPressureSensor = field("The pressure sensor of its tank.", default=OwnPressureSensor())
    loadcell: OwnLoadcell = field("The loadcells of its caliper.", default=OwnLoadcell())


class OwnValues(Section):
    """Values of one wheelset that differ from the regular ones."""

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


def _completed_wheelsets(own: dict[str, OwnValues]) -> dict[str, OwnValues]:
    return {number: own.get(number, OwnValues()) for number in NUMBERS}


Wheelsets = Annotated[dict[WheelsetNumber, OwnValues], AfterValidator(_completed_wheelsets)]
"""The own values of all four wheelsets, those that a file leaves out empty."""
ALIKE: Final = MappingProxyType(_completed_wheelsets({}))
"""Wheelsets without values of their own."""
REGULAR: Final[Mapping[str, str]] = MappingProxyType(
    {
        **dict.fromkeys(("wheel_radius", "configured_radius"), "vehicle.wheelset.radius"),
        "rotational_inertia": "vehicle.wheelset.rotational_inertia",
        "pad_friction": "brake.system.disc.pad_friction",
        **{
            f"{own}.{name}": f"{regular}.{own}.{name}"
            for regular, own, section in (
                ("rig", "caliper", OwnCaliper),
                ("brake.system", "wsp_valve", OwnWspValve),
                ("rig", "sensors.speed", OwnSpeedSensor),
                ("rig", "sensors.pressure", OwnPressureSensor),
                ("rig", "sensors.loadcell", OwnLoadcell),
            )
            for name in section.model_fields
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
    return _regular_section(scenario, name) if own is None else own


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
        written[tuple((regular if value is _regular_section(scenario, name) else own).split("."))] = value
    yield from written.items()


def _regular_section(scenario: Model, name: str) -> Any:
    return _getter(REGULAR[name])(scenario) if name in REGULAR else _WHOLE


Height = Annotated[Quantity, of_kind("length", "1 cm .. 5 m")]
Stiffness = Annotated[Quantity, of_kind("stiffness", "1 kN/m .. 1000 MN/m")]
Damping = Annotated[Quantity, of_kind("damping", "0 N s/m .. 1e7 N s/m")]


class Body(Section):
    """The car body."""

    mass: Quantity = quantity(
        "Mass of the car body; with `load: empty`, loaded as tested.", "mass", "1 t .. 200 t"
    )
    pitch_inertia: Quantity = quantity(
        "Moment of inertia in pitch about the centre of gravity.", "inertia", "1e3 kg m2 .. 1e8 kg m2"
    )
    height: Height = field("Height of the centre of gravity above the rail.")


class Bogie(Section):
    """One of the two bogies, without its wheelsets."""

    mass: Quantity = quantity("Mass of one bogie without wheelsets.", "mass", "100 kg .. 50 t")
    pitch_inertia: Quantity = quantity(
        "Moment of inertia in pitch about the centre of gravity.", "inertia", "10 kg m2 .. 1e6 kg m2"
    )
    height: Height = field("Height of the centre of gravity above the rail.")
    half_wheelbase: Quantity = quantity(
        "Half the distance between the axles of a bogie.", "length", "> 0.3 m .. 5 m"
    )


class Wheelset(Section):
    """One of the four wheelsets, with its brake discs."""

    mass: Quantity = quantity("Mass of one wheelset with axle boxes.", "mass", "100 kg .. 10 t")
    rotational_inertia: Inertia = field("Moment of inertia about the axle.")
    radius: Radius = field("Rolling radius.")


class PrimarySuspension(Section):
    """Springs and dampers between axle box and bogie frame, per axle box."""

    longitudinal_stiffness: Stiffness = field("Longitudinal stiffness per axle box.")
    vertical_stiffness: Stiffness = field("Vertical stiffness per axle box.")
    longitudinal_damping: Damping = field("Longitudinal damping per axle box.")
    vertical_damping: Damping = field("Vertical damping per axle box.")


class SecondarySuspension(Section):
    """Springs and dampers between bogie and body, per side of a bogie."""

    longitudinal_stiffness: Stiffness = field("Longitudinal stiffness per side of a bogie.")
    vertical_stiffness: Stiffness = field("Vertical stiffness per side of a bogie.")
    longitudinal_damping: Damping = field("Longitudinal damping per side of a bogie.")
    vertical_damping: Damping = field("Vertical damping per side of a bogie.")
    height: Height = field("Height above the rail at which the longitudinal force acts.")


class TractionLink(Section):
    """The rod that carries longitudinal force between a bogie and the body."""

    stiffness: Stiffness = field("Longitudinal stiffness of the link of one bogie.")
    damping: Damping = field("Longitudinal damping of the link of one bogie.")
    height: Height = field("Height of the link above the rail.")


class RunningResistance(Section):
    """Resistance of the whole car: constant + linear v + quadratic v2."""

    constant: Quantity = quantity("Part that does not depend on speed.", "force", "0 N .. 100 kN")
    linear: Quantity = quantity("Part that grows with speed.", "damping", "0 N s/m .. 10 kN s/m")
    quadratic: Quantity = quantity(
        "Part that grows with the square of speed (air drag).",
        "quadratic resistance",
        "0 N s2/m2 .. 1000 N s2/m2",
    )


Load = Annotated[
    Annotated[Literal["empty", "full"], Tag("word")]
    | Annotated[Quantity, of_kind("mass", "0 t .. 200 t"), Tag("mass")],
    Discriminator(lambda value: "word" if isinstance(value, str) and value[:1].isalpha() else "mass"),
]
"""A word, or a mass."""


class Vehicle(Part):
    """A car of two bogies and four wheelsets."""

    folder: ClassVar[str] = "vehicles"
    lowest_frequency: ClassVar[float] = 0.3
    """Hz, chosen: half of what the library's cars have at least (0.66 Hz, bounce of the CRH380A)."""

    schema_id: Literal["uictest/vehicle/1"] = schema_field("uictest/vehicle/1")
    body: Body = field("The car body.")
    bogie: Bogie = field("One bogie; both are alike.")
    half_pivot_distance: Quantity = quantity(
        "Half the distance between the bogie pivots.", "length", "> 0.5 m .. 20 m"
    )
    wheelset: Wheelset = field("One wheelset; `wheelsets` says where one differs.")
    wheelsets: Wheelsets = field(
        "What single wheelsets have of their own, by their number from the leading end.",
        default_factory=lambda: dict(ALIKE),
    )
    primary: PrimarySuspension = field("Primary suspension, per axle box.")
    secondary: SecondarySuspension = field("Secondary suspension, per side of a bogie.")
    traction_link: TractionLink = field("Traction rod between bogie and body, one per bogie.")
    running_resistance: RunningResistance = field("Running resistance of the whole car.")
    payload: Annotated[Quantity, of_kind("mass", "> 0 t .. 200 t")] | None = optional(
        "What the full car carries besides `body.mass`; its centre of gravity lies at that of the body."
    )
    load: Load | None = optional(
        "What the car carries: empty, full (the payload), or a mass; empty if left out."
    )

    @property
    def carried_mass(self) -> float:
        """Mass of the load, kg."""
        if self.load is None or self.load == "empty":
            return 0.0
        carried = self.payload if self.load == "full" else self.load
        return 0.0 if carried is None else carried  # without a payload no car is full

    @property
    def loaded_body(self) -> Body:
        """The car body with its load, which leaves its radius of gyration as it is."""
        if self.load in (None, "empty"):
            return self.body
        mass = self.body.mass + self.carried_mass
        inertia = self.body.pitch_inertia * (mass / self.body.mass)
        return self.body.model_copy(update={"mass": mass, "pitch_inertia": inertia})

    @property
    def wheel_radii(self) -> tuple[float, ...]:
        """Rolling radius of each wheelset, m."""
        own = (each.wheel_radius for each in self.wheelsets.values())
        return tuple(self.wheelset.radius if radius is None else radius for radius in own)

    @property
    def rotational_inertias(self) -> tuple[float, ...]:
        """Moment of inertia of each wheelset about its axle, kg m2."""
        regular = self.wheelset.rotational_inertia
        own = (each.rotational_inertia for each in self.wheelsets.values())
        return tuple(regular if inertia is None else inertia for inertia in own)

    @property
    def total_mass(self) -> float:
        """Mass of the car, kg."""
        return self.loaded_body.mass + 2.0 * self.bogie.mass + 4.0 * self.wheelset.mass

    def inconsistencies(self) -> Iterator[Inconsistency]:
        """Yield impossible vehicles: wheels or bogies that overlap, more inertia than the mass allows."""
        yield from super().inconsistencies()
        yield from self._impossible_wheels(self.wheelset.radius, ("wheelset", "radius"))
        for number, own in self.wheelsets.items():
            if own.wheel_radius is not None:
                yield from self._impossible_wheels(own.wheel_radius, ("wheelsets", number, "wheel_radius"))
        yield from self._springs_too_soft()
        if self.load not in (None, "empty") and self.payload is None:
            yield Inconsistency(
                ("load",), "this car has no payload", "say what it carries when full: payload: 8 t"
            )
        elif self.payload is not None and self.carried_mass > self.payload:
            yield Inconsistency(("load",), f"more than the payload of {self.payload.text}")

    def _impossible_wheels(self, radius: float, key: Key) -> Iterator[Inconsistency]:
        name, regular = ".".join(map(str, key)), key[0] == "wheelset"
        if self.bogie.half_wheelbase <= radius:
            yield Inconsistency(
                ("bogie", "half_wheelbase") if regular else key,
                f"the wheels of a bogie overlap: half_wheelbase must exceed {name}",
            )
        if self.half_pivot_distance <= self.bogie.half_wheelbase + radius:
            yield Inconsistency(
                ("half_pivot_distance",) if regular else key,
                f"the bogies overlap: it must exceed bogie.half_wheelbase + {name}",
            )
        if self.wheelset.rotational_inertia > self.wheelset.mass * radius**2:
            yield Inconsistency(
                ("wheelset", "rotational_inertia") if regular else key,
                "no wheelset of this mass and radius has this inertia",
                f"at most mass x radius2 = {self.wheelset.mass * radius**2:.4g} kg m2",
            )

    def _springs_too_soft(self) -> Iterator[Inconsistency]:
        body = self.loaded_body.mass
        sprung = body + 2.0 * self.bogie.mass
        primary, secondary, link = self.primary, self.secondary, self.traction_link
        pull = 2.0 * link.stiffness + 4.0 * secondary.longitudinal_stiffness
        for key, stiffness, mass in (
            (("primary", "longitudinal_stiffness"), 8.0 * primary.longitudinal_stiffness, sprung),
            (("primary", "vertical_stiffness"), 8.0 * primary.vertical_stiffness, sprung),
            (("secondary", "vertical_stiffness"), 4.0 * secondary.vertical_stiffness, body),
            (("traction_link", "stiffness"), pull, body),
        ):
            frequency = (stiffness / mass) ** 0.5 / math.tau
            if frequency < self.lowest_frequency:
                yield Inconsistency(
                    key,
                    f"too soft: {mass / 1000.0:.4g} t swing at {frequency:.2g} Hz on these springs",
                    f"at least {self.lowest_frequency} Hz are accepted, a stiffness"
                    f" {(self.lowest_frequency / frequency) ** 2:.3g} times as large",
                )


class Coupler(Model):
    """The couplers of a train, all alike: a spring and a damper without slack."""

    largest_steadiness: ClassVar[float] = 1.0
    """Largest dt^2 K + 2 dt C with K = 4 k/m and C = 4 c/m; chosen: a chain of masses is stable up to 4, and
    the springs of the cars come on top."""

    distance: Quantity = quantity(
        "Between the centres of neighbouring cars; 26.4 m is the usual length of a coach over its buffers.",
        "length",
        "5 m .. 60 m",
        default="26.4 m",
    )
    stiffness: Quantity = quantity(
        "Stiffness of a coupler; the default is that of open data of an eight-car unit. The least is chosen:"
        " one much softer lets cars run through each other.",
        "stiffness",
        "100 kN/m .. 100 MN/m",
        default="5 MN/m",
    )
    damping: Quantity = quantity(
        "Damping of a coupler; the default is that of open data of an eight-car unit.",
        "damping",
        "0 N s/m .. 10 MN s/m",
        default="0.8 MN s/m",
    )
    height: Quantity = quantity(
        "Height of a coupler above the rail; the default is chosen.",
        "length",
        "0 m .. 3 m",
        default="1.025 m",
    )


def load_share(valve: LoadValve | None, vehicle: Vehicle) -> float:
    """Return the pressure that the load of a vehicle leaves, over that of the full one."""
    if valve is None or vehicle.payload is None:
        return 1.0
    return valve.empty_share + (1.0 - valve.empty_share) * (vehicle.carried_mass / vehicle.payload)
