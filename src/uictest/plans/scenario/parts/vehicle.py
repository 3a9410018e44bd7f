"""The vehicle: one car on two bogies and four wheelsets, in the vertical plane along the track.

The ranges catch a wrong unit or digit; they do not judge a design. They are chosen: about ten times beyond
the cars of the library, so that the lightest tram and half of the heaviest six-axle locomotive are accepted.
"""

import math
from collections.abc import Iterator
from typing import Annotated, ClassVar, Literal

from pydantic import Discriminator, Tag

from uictest.plans.scenario.parts.wheelsets import ALIKE, Inertia, Radius, Wheelsets
from uictest.plans.scenario.yaml import Inconsistency, Key, Part, Quantity, Section
from uictest.plans.scenario.yaml.quantity_field import field, of_kind, optional, quantity, schema_field

Height = Annotated[Quantity, of_kind("length", "1 cm .. 5 m")]
Stiffness = Annotated[Quantity, of_kind("stiffness", "1 kN/m .. 1000 MN/m")]
Damping = Annotated[Quantity, of_kind("damping", "0 N s/m .. 1e7 N s/m")]

LOWEST_FREQUENCY = 0.3
"""Hz, chosen: half the lowest natural frequency of the library's cars (0.66 Hz, bounce of the CRH380A)."""


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


def _load_form(value: object) -> str:
    # Any word is to be one of the two; what begins with a digit is to be a mass.
    return "word" if isinstance(value, str) and value[:1].isalpha() else "mass"


Load = Annotated[
    Annotated[Literal["empty", "full"], Tag("word")]
    | Annotated[Quantity, of_kind("mass", "0 t .. 200 t"), Tag("mass")],
    Discriminator(_load_form),
]
"""A word, or a mass."""


class Vehicle(Part):
    """A car of two bogies and four wheelsets."""

    folder: ClassVar[str] = "vehicles"

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

    def _impossible_wheels(self, radius: float, place: Key) -> Iterator[Inconsistency]:
        """Yield wheels of a radius, given at a key, that overlap or have too much inertia."""
        name, regular = ".".join(map(str, place)), place[0] == "wheelset"
        if self.bogie.half_wheelbase <= radius:
            yield Inconsistency(
                ("bogie", "half_wheelbase") if regular else place,
                f"the wheels of a bogie overlap: half_wheelbase must exceed {name}",
            )
        if self.half_pivot_distance <= self.bogie.half_wheelbase + radius:
            yield Inconsistency(
                ("half_pivot_distance",) if regular else place,
                f"the bogies overlap: it must exceed bogie.half_wheelbase + {name}",
            )
        if self.wheelset.rotational_inertia > self.wheelset.mass * radius**2:
            yield Inconsistency(
                ("wheelset", "rotational_inertia") if regular else place,
                "no wheelset of this mass and radius has this inertia",
                f"at most mass x radius2 = {self.wheelset.mass * radius**2:.4g} kg m2",
            )

    def _springs_too_soft(self) -> Iterator[Inconsistency]:
        """Yield springs on which the car would oscillate more slowly than any real car."""
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
            if frequency < LOWEST_FREQUENCY:
                yield Inconsistency(
                    key,
                    f"too soft: {mass / 1000.0:.4g} t swing at {frequency:.2g} Hz on these springs",
                    f"at least {LOWEST_FREQUENCY} Hz are accepted, a stiffness"
                    f" {(LOWEST_FREQUENCY / frequency) ** 2:.3g} times as large",
                )
