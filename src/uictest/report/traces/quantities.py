"""What is drawn of a stop: the quantities, the panels over time, any channel of a recording."""

from __future__ import annotations

import re
from collections.abc import Sequence
from typing import Final, NamedTuple

from uictest.core.units import BAR, CELSIUS_ZERO, KILOMETRE_PER_HOUR, KILONEWTON, KINDS, PERCENT, SIZES

WHEELSETS = (1, 2, 3, 4)
ORDINARY_CREEP = 10.0
"""%: the axis of the slide reaches at least so far, so that a wheel that only creeps is seen to; chosen."""


class PlotQuantity(NamedTuple):
    """A channel as a page shows it: label, unit, how many SI units one of that is, its zero in SI units.

    `decimals` are shown of its values, and samples are rounded to the share `rounding` of the last of them.
    """

    label: str
    unit: str
    scale: float = 1.0
    of_wheelsets: bool = False
    zero: float = 0.0
    decimals: int = 1
    rounding: float = 0.5

    @property
    def step(self) -> float:
        """To multiples of this a page rounds the samples it holds."""
        return self.rounding * 10.0**-self.decimals


PLOT_QUANTITIES = {
    "distance": PlotQuantity("distance", "m"),
    "speed": PlotQuantity("train", "km/h", KILOMETRE_PER_HOUR),
    "reference_speed": PlotQuantity("reference", "km/h", KILOMETRE_PER_HOUR),
    "wheel_speed": PlotQuantity("wheelset", "km/h", KILOMETRE_PER_HOUR, of_wheelsets=True),
    "slide": PlotQuantity("slide", "%", PERCENT, of_wheelsets=True),
    "reservoir_pressure": PlotQuantity("reservoir", "bar", BAR, decimals=2, rounding=1.0),
    "brake_line_pressure": PlotQuantity("brake line", "bar", BAR, decimals=2, rounding=1.0),
    "tank_pressure": PlotQuantity("tank", "bar", BAR, of_wheelsets=True, decimals=2, rounding=1.0),
    "cylinder_pressure": PlotQuantity("cylinder", "bar", BAR, of_wheelsets=True, decimals=2, rounding=1.0),
    "clamping_force": PlotQuantity(
        "clamping force", "kN", KILONEWTON, of_wheelsets=True, decimals=2, rounding=1.0
    ),
    "dynamic_torque": PlotQuantity("dynamic brake", "N m", of_wheelsets=True, decimals=0),
    "dynamic_reduction": PlotQuantity("reduction", "%", PERCENT, of_wheelsets=True, decimals=0),
    "track_brake_force": PlotQuantity("track brake", "kN", KILONEWTON),
    "deceleration": PlotQuantity("deceleration", "g", decimals=3),
    "adhesion": PlotQuantity("adhesion", "1", of_wheelsets=True, decimals=3),
    "friction": PlotQuantity("friction", "1", of_wheelsets=True, decimals=3),
    "cleaned_share": PlotQuantity("cleaned share", "1", of_wheelsets=True, decimals=2),
    "sand_density": PlotQuantity("sand met", "g/m", SIZES["g/m"], of_wheelsets=True, decimals=2),
    "disc_temperature": PlotQuantity("disc", "degC", of_wheelsets=True, zero=CELSIUS_ZERO, decimals=0),
    "disc_surface_temperature": PlotQuantity(
        "disc surface", "degC", of_wheelsets=True, zero=CELSIUS_ZERO, decimals=0
    ),
    "valve_command": PlotQuantity("valve", "1", of_wheelsets=True),
}
"""Channel, less the number of the wheelset -> how it is shown. The deceleration is derived from the speed.

Pressures and forces are rounded to 0.01 bar and 0.01 kN, finer than sensors of a train.
"""

OF_RAIL = ("friction", "cleaned_share")
"""Quantities that are drawn where sliding has cleaned the rail; the first also where it varies otherwise."""


class Panel(NamedTuple):
    """Quantities that share a vertical axis over time.

    `height` is relative; the axis holds the values in `include`, whatever the quantities reach.
    """

    key: str
    title: str
    unit: str
    quantities: tuple[str, ...]
    height: float = 1.0
    include: tuple[float, ...] = (0.0,)


PANELS = (
    Panel("speed", "Speed of train and wheelsets", "km/h", ("wheel_speed", "reference_speed", "speed"), 1.5),
    Panel("slide", "Slide", "%", ("slide",), include=(0.0, ORDINARY_CREEP)),
    Panel(
        "pressure",
        "Pressures (cylinder dotted)",
        "bar",
        ("reservoir_pressure", "brake_line_pressure", "cylinder_pressure", "tank_pressure"),
        1.3,
    ),
    Panel("force", "Clamping force of one caliper", "kN", ("clamping_force",)),
    Panel("torque", "Dynamic brake torque of a wheelset", "N m", ("dynamic_torque",)),
    Panel("reduction", "Dynamic brake reduced by the WSP", "%", ("dynamic_reduction",), include=(0.0, 100.0)),
    Panel("track", "Force of the track brake", "kN", ("track_brake_force",)),
    Panel("deceleration", "Deceleration (bold) and adhesion", "g", ("adhesion", "deceleration"), 1.2),
    Panel("rail", "Friction met (cleaned share dotted)", "dimensionless", ("cleaned_share", "friction")),
    Panel("sand", "Sand before each wheelset", "g/m", ("sand_density",)),
    Panel(
        "temperature",
        "Disc temperature (bulk dotted)",
        "degC",
        ("disc_temperature", "disc_surface_temperature"),
    ),
)
"""Panels over time from top to bottom; strips stand between and below them."""


class Lane(NamedTuple):
    """Bars of one magnet within the row of a wheelset: while its valve is in one of the `states`.

    A row is 1 high; `offset` is that of the lane below its middle.
    """

    label: str
    offset: float
    states: tuple[int, ...]


FILL, HOLD, VENT = 0, 1, 2
"""States of a valve."""
MAGNETS = (Lane("hold", -0.22, (HOLD, VENT)), Lane("vent", 0.22, (VENT,)))
"""The magnets of a WSP valve: neither fills, hold alone holds, both vent."""


class Strip(NamedTuple):
    """Bars in a row for each wheelset over time; `note` explains them.

    A strip stands below the panel `below`, else below all panels. `lanes` divide the row of a wheelset.
    """

    key: str
    title: str
    note: str = ""
    below: str = ""
    lanes: tuple[Lane, ...] = ()

    @property
    def heading(self) -> str:
        """The title with the note."""
        return f"{self.title}: {self.note}" if self.note else self.title

    @property
    def rows(self) -> list[tuple[float, str]]:
        """Place and label of every row: the number of the wheelset, or with lanes each of these."""
        if not self.lanes:
            return [(float(n), str(n)) for n in WHEELSETS]
        return [(n + lane.offset, f"{n} {lane.label}") for n in WHEELSETS for lane in self.lanes]


STRIPS = (
    Strip("valves", "WSP valves", "commands, hold and vent", below="speed", lanes=MAGNETS),
    Strip("locked", "Locked wheelsets"),
    Strip("sliding", "Sliding wheelsets"),
)
"""Strips from top to bottom; one without bars is left out."""


def in_order(panels: Sequence[Panel]) -> list[Panel | Strip]:
    """Return panels from top to bottom with the strips below each of them, then the other strips."""
    placed: list[Panel | Strip] = []
    for panel in panels:
        placed += [panel, *(strip for strip in STRIPS if strip.below == panel.key)]
    return [*placed, *(strip for strip in STRIPS if strip not in placed)]


class PlotLoop(NamedTuple):
    """One quantity over another, whose axis holds the values in `include`.

    `dots`: the samples as dots, where lines between them would mislead. `directed`: the line shows where the
    lower quantity rises and where it falls.
    """

    key: str
    title: str
    across: str
    up: str
    across_title: str
    up_title: str
    dots: bool = False
    include: tuple[float, ...] = (0.0,)
    directed: bool = False


LOOPS = (
    PlotLoop(
        "force-loop",
        "Clamping force over tank pressure",
        "tank_pressure",
        "clamping_force",
        "tank pressure, bar",
        "clamping force, kN",
        directed=True,
    ),
    PlotLoop(
        "adhesion-loop",
        "Adhesion over slide",
        "slide",
        "adhesion",
        "slide, %",
        "adhesion",
        True,
        (0.0, ORDINARY_CREEP),
    ),
)


class PlotLine(NamedTuple):
    """One series in a panel: its name, what it is called, the role that colours it, dotted or not."""

    series: str
    label: str
    role: str
    dotted: bool = False


_ROLES = {
    "speed": "train",
    "deceleration": "train",
    "reference_speed": "reference",
    "reservoir_pressure": "reservoir",
    "brake_line_pressure": "brake-line",
}
_DOTTED = frozenset({"reference_speed", "cylinder_pressure", "cleaned_share", "disc_temperature"})


def lines_of(key: str) -> tuple[PlotLine, ...]:
    """Return the lines that show a quantity: one, or one per wheelset."""
    quantity = PLOT_QUANTITIES[key]
    if not quantity.of_wheelsets:
        return (PlotLine(key, quantity.label, _ROLES.get(key, "train"), key in _DOTTED),)
    return tuple(
        PlotLine(f"{key}_{n}", f"{quantity.label} {n}", f"wheelset-{n}", key in _DOTTED) for n in WHEELSETS
    )


def channel_names(key: str) -> tuple[str, ...]:
    """Return the channels of a quantity: one, or one per wheelset."""
    return tuple(f"{key}_{n}" for n in WHEELSETS) if PLOT_QUANTITIES[key].of_wheelsets else (key,)


_KEYS: Final = {name: key for key in PLOT_QUANTITIES for name in channel_names(key)}
"""Channel -> its quantity on every page."""


def key_of(name: str) -> str:
    """Return the quantity of a channel."""
    return _KEYS[name]


def loop_lines(loop: PlotLoop) -> list[tuple[str, PlotLine]]:
    """Return the lines of a loop, each with the channel that it is drawn over."""
    across = channel_names(loop.across)
    return [(across[k % len(across)], line) for k, line in enumerate(lines_of(loop.up))]


def panel_lines(panel: Panel) -> tuple[PlotLine, ...]:
    """Return the lines of a panel, the last one in front."""
    return tuple(line for key in panel.quantities for line in lines_of(key))


_BY_SI_UNIT: Final = {
    kind.canonical: quantity.unit
    for quantity in PLOT_QUANTITIES.values()
    if quantity.scale != 1.0 or quantity.zero != 0.0
    for kind in KINDS.values()
    if quantity.unit in kind.units and kind.canonical != "1"
}
"""SI unit -> the unit that every page shows it in; what a pure number is shown in depends on its channel."""
_WHEELSET: Final = re.compile(rf"(.+)_([{WHEELSETS[0]}-{WHEELSETS[-1]}])")


def shown_unit(channel: str, unit: str) -> str:
    """Return the unit in which a page shows a channel that is recorded in `unit`."""
    if unit == "1" and channel in _KEYS:
        return PLOT_QUANTITIES[_KEYS[channel]].unit
    return _BY_SI_UNIT.get(unit, unit)


def channel_title(channel: str) -> str:
    """Return the title of a channel, e.g. `Tank pressure of wheelset 1`; names that are not phrases stay."""
    match = _WHEELSET.fullmatch(channel)
    name, wheelset = match.groups() if match else (channel, "")
    if not re.fullmatch(r"[a-z][a-z_]*", name):
        return channel
    title = name.replace("_", " ").capitalize()
    return f"{title} of wheelset {wheelset}" if wheelset else title
