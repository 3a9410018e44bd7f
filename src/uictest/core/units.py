"""Physical constants and units: what users write, what recordings contain and what results show.

One row of the table below describes one unit. Inside the package every quantity is in the SI unit of its
kind, which :attr:`Kind.canonical` names.
"""

import math
from collections.abc import Iterable
from dataclasses import dataclass
from fractions import Fraction
from types import MappingProxyType
from typing import Final, NamedTuple

from uictest.core.physics import REFERENCE_DENSITY

STANDARD_GRAVITY: Final = 9.80665
"""m/s2, exact by definition (ISO 80000-3)."""

NORMAL_DENSITY: Final = REFERENCE_DENSITY
"""kg/m3: air at 20 degC, 1 bar and 65 % humidity (ANR, ISO 8778); one normal litre weighs 1.185 g."""

_CELSIUS_ZERO: Final = Fraction("273.15")
"""K, exact by definition."""


class Unit(NamedTuple):
    """One unit of a kind: ``SI value = number * factor + offset``.

    Attributes:
        symbol: how the package writes it.
        factor: its size in the SI unit of its kind, exact.
        offset: SI value of its zero, exact.
        misspellings: what people often write instead; scenarios reject it with a hint that names the symbol.
        recorded_as: other spellings accepted in recordings and channel maps.
        recorded_only: accepted in recordings and channel maps only.
    """

    symbol: str
    factor: Fraction
    offset: Fraction = Fraction(0)
    misspellings: tuple[str, ...] = ()
    recorded_as: tuple[str, ...] = ()
    recorded_only: bool = False


@dataclass(frozen=True, slots=True, eq=False)
class Kind:
    """A kind of quantity.

    Attributes:
        name: e.g. `speed`.
        canonical: its SI unit, in which the package keeps it.
        units: the units that scenarios accept, by symbol, the most usual one first.
        all_units: those and the units of recordings.
        bare: whether the quantity is a pure number, written without a unit.
    """

    name: str
    canonical: str
    units: MappingProxyType[str, Unit]
    all_units: tuple[Unit, ...]
    bare: bool


def _unit(
    symbol: str,
    factor: str | int | Fraction,
    misspellings: str = "",
    *,
    recorded_as: tuple[str, ...] = (),
    recorded_only: bool = False,
    offset: Fraction = Fraction(0),
) -> Unit:
    written = tuple(misspellings.split())
    return Unit(symbol, Fraction(factor), offset, written, recorded_as, recorded_only)


def _kind(name: str, canonical: str, *units: Unit) -> Kind:
    stated = {unit.symbol: unit for unit in units if not unit.recorded_only}
    return Kind(name, canonical, MappingProxyType(stated), units, bare=not stated)


_PERCENT = _unit("%", "0.01", "percent percentage pct")
_PERMILLE = _unit("permille", "0.001", "‰ promille mm/m")
_KINDS = (
    _kind(
        "speed",
        "m/s",
        _unit("km/h", Fraction(5, 18), "kmh kph kmph km/hr", recorded_as=("kph", "kmh")),
        _unit("m/s", 1, "mps", recorded_as=("mps",)),
        _unit("mph", "0.44704", recorded_only=True),
        _unit("knots", Fraction(1852, 3600), recorded_as=("kn", "knot", "kt"), recorded_only=True),
    ),
    _kind(
        "length",
        "m",
        _unit("m", 1, "metre metres meter meters"),
        _unit("km", 1000),
        _unit("mm", "0.001"),
        _unit("cm", "0.01"),
    ),
    _kind(
        "time",
        "s",
        _unit("s", 1, "sec secs second seconds", recorded_as=("sec",)),
        _unit("ms", "0.001", "msec millisecond milliseconds"),
        _unit("min", 60, "minute minutes mins"),
        _unit("us", "1e-6", recorded_only=True),
        _unit("ns", "1e-9", recorded_only=True),
        _unit("h", 3600, recorded_only=True),
        _unit("d", 86_400, recorded_only=True),
    ),
    _kind("mass", "kg", _unit("kg", 1, "kgs kilogram kilograms"), _unit("t", 1000, "ton tons tonne tonnes")),
    _kind("inertia", "kg m2", _unit("kg m2", 1)),
    _kind(
        "pressure",
        "Pa",
        _unit("bar", 100_000, "barg bar(g) bars", recorded_as=("barg", "bar(g)")),
        _unit("kPa", 1000),
        _unit("Pa", 1),
        _unit("MPa", 1_000_000),
        _unit("mbar", 100, recorded_only=True),
        _unit("hPa", 100, recorded_only=True),
        _unit("psi", "6894.757", recorded_only=True),
    ),
    _kind(
        "force",
        "N",
        _unit("N", 1, "newton newtons"),
        _unit("kN", 1000, "kilonewton kilonewtons"),
        _unit("MN", 1_000_000, recorded_only=True),
    ),
    _kind(
        "torque",
        "N m",
        _unit("N m", 1, recorded_as=("Nm",), recorded_only=True),
        _unit("kN m", 1000, recorded_as=("kNm",), recorded_only=True),
    ),
    _kind(
        "stiffness",
        "N/m",
        _unit("N/m", 1),
        _unit("kN/m", 1000),
        _unit("MN/m", 1_000_000),
        _unit("N/mm", 1000),
    ),
    _kind("damping", "N s/m", _unit("N s/m", 1), _unit("kN s/m", 1000), _unit("MN s/m", 1_000_000)),
    _kind("quadratic resistance", "N s2/m2", _unit("N s2/m2", 1)),
    _kind("conductance", "m3/(s Pa)", _unit("m3/(s Pa)", 1), _unit("dm3/(s bar)", "1e-8")),
    _kind(
        "volume",
        "m3",
        _unit("L", "0.001", "litre litres liter liters ltr dm3"),
        _unit("m3", 1),
        _unit("cm3", "1e-6"),
    ),
    _kind("normal volume", "m3", _unit("NL", "0.001", "normallitre normalliter Ndm3"), _unit("Nm3", 1)),
    _kind("area", "m2", _unit("m2", 1), _unit("cm2", "1e-4"), _unit("mm2", "1e-6")),
    _kind("temperature", "K", _unit("degC", 1, "C celsius °C", offset=_CELSIUS_ZERO), _unit("K", 1)),
    _kind(
        "acceleration",
        "m/s2",
        _unit("m/s2", 1, "m/s/s mps2 ms-2 m/sec2"),
        _unit("g", Fraction(str(STANDARD_GRAVITY))),
    ),
    _kind("share", "1", _PERCENT, _PERMILLE, _unit("1", 1, recorded_as=("-",))),
    _kind("gradient", "1", _PERMILLE, _PERCENT),
    _kind("force per pressure", "N/Pa", _unit("kN/bar", "0.01"), _unit("N/bar", "1e-5"), _unit("N/Pa", 1)),
    _kind("mass flow", "kg/s", _unit("NL/min", Fraction(str(NORMAL_DENSITY)) / 1000 / 60), _unit("kg/s", 1)),
    _kind("sand rate", "kg/s", _unit("kg/min", Fraction(1, 60)), _unit("g/s", "0.001")),
    _kind("line density", "kg/m", _unit("g/m", "0.001"), _unit("kg/m", 1, recorded_only=True)),
    _kind("frequency", "Hz", _unit("Hz", 1)),
    _kind("inverse speed", "s/m", _unit("s/m", 1)),
    _kind("energy", "J", _unit("kJ", 1000), _unit("J", 1), _unit("MJ", 1_000_000)),
    _kind("power", "W", _unit("kW", 1000), _unit("W", 1), _unit("MW", 1_000_000)),
    _kind("energy per length", "J/m", _unit("J/m", 1), _unit("kJ/m", 1000)),
    _kind("film coefficient", "W/(m2 K)", _unit("W/(m2 K)", 1)),
    _kind("heat conductance", "W/K", _unit("W/K", 1)),
    _kind("thermal conductivity", "W/(m K)", _unit("W/(m K)", 1)),
    _kind("density", "kg/m3", _unit("kg/m3", 1)),
    _kind("specific heat", "J/(kg K)", _unit("J/(kg K)", 1)),
    _kind("gas constant", "J/(kg K)", _unit("J/(kg K)", 1)),
    _kind("number", "1"),
    _kind("count", "1"),
)

KINDS: Final = MappingProxyType({kind.name: kind for kind in _KINDS if kind.units or not kind.all_units})
"""Every kind of quantity that a scenario can state, by name."""

_ZEROS: Final = {unit.symbol: float(unit.offset) for kind in _KINDS for unit in kind.all_units if unit.offset}
"""Symbol of a unit that has its own zero -> the SI value of that."""

UNIT_SYMBOLS: Final = frozenset(symbol for kind in _KINDS for symbol in kind.units)
"""Every unit that scenarios accept, as the package writes it."""

SIZES: Final = {
    unit.symbol: float(unit.factor) for kind in _KINDS for unit in kind.all_units if not unit.offset
}
"""Symbol of a unit -> its size in the SI unit of its kind (NL: in normal cubic metres); no temperatures."""

KILOMETRE_PER_HOUR: Final = SIZES["km/h"]
CELSIUS_ZERO: Final = _ZEROS["degC"]
BAR: Final = SIZES["bar"]
KILONEWTON: Final = SIZES["kN"]
KILONEWTON_PER_BAR: Final = SIZES["kN/bar"]
PERCENT: Final = SIZES["%"]

ROTATIONAL_SPEEDS: Final = MappingProxyType(
    {
        **dict.fromkeys(("rpm", "1/min", "U/min", "r/min", "min-1"), 2.0 * math.pi / 60.0),
        **dict.fromkeys(("1/s", "r/s", "rev/s"), 2.0 * math.pi),
        "rad/s": 1.0,
    }
)
"""What recordings may write for a rotational speed -> its size in rad/s."""

_KINDS_IN_RECORDINGS: Final = frozenset(
    {"time", "length", "speed", "pressure", "force", "torque", "share", "temperature", "line density"}
)


def in_unit(value: float, unit: str) -> float:
    """Return an SI value in `unit`."""
    if unit in _ZEROS:
        return value - _ZEROS[unit]
    return value / SIZES[unit]


def all_in_unit(values: Iterable[float], unit: str) -> list[float]:
    """Return SI values in `unit`."""
    if unit in _ZEROS:
        return [value - _ZEROS[unit] for value in values]
    size = SIZES[unit]
    return [value / size for value in values]


def normal_volume(mass: float) -> float:
    """Return the normal volume (m3 at 20 degC and 1 bar) of a mass of air (kg)."""
    return mass / NORMAL_DENSITY


def as_written(value: float, unit: str) -> float:
    """Return an SI value in the unit that it was written in, without the digits that conversion adds."""
    return float(f"{in_unit(value, unit):.12g}")


def value_text(value: float, unit: str) -> str:
    """Return a value in `unit` as text: four significant digits, no unit for a pure number."""
    return with_unit(f"{value:.0f}" if 1e3 <= abs(value) < 1e6 else f"{value:.4g}", unit)


def values_text(values: Iterable[float], unit: str) -> str:
    """Return values in `unit` as text: `0.2, 0.31, 0 s`."""
    return with_unit(", ".join(value_text(value, "1") for value in values), unit)


def with_unit(numbers: str, unit: str) -> str:
    """Return numbers with their unit, or alone where they are pure numbers."""
    return numbers if unit == "1" else f"{numbers} {unit}"


def recorded_spellings(si: str) -> dict[str, float]:
    """Return the spellings of units in recordings whose SI unit is `si`: spelling -> size in SI.

    A unit with a zero of its own is not among them: a channel map states it as SI unit and offset.
    """
    units = [
        unit
        for kind in _KINDS
        if kind.name in _KINDS_IN_RECORDINGS and kind.canonical == si
        for unit in kind.all_units
        if not unit.offset
    ]
    symbols = {unit.symbol: float(unit.factor) for unit in units}
    return symbols | {spelling: float(unit.factor) for unit in units for spelling in unit.recorded_as}


def recorded_unit_size(unit: str, si: str) -> float | None:
    """Return the size of a recording's `unit` in the SI unit `si`; None if it is not such a unit.

    Case and blanks are ignored where the unit stays unambiguous.
    """
    known = recorded_spellings(si)
    if unit in known:
        return known[unit]
    matches = {size for symbol, size in known.items() if _is_same_unit(symbol, unit)}
    return matches.pop() if len(matches) == 1 else None


def is_recorded_unit(text: str) -> bool:
    """Return whether a text is a spelling of a unit of any kind."""
    return text in ROTATIONAL_SPEEDS or any(_is_same_unit(symbol, text) for symbol in _EVERY_SPELLING)


def _is_same_unit(symbol: str, written: str) -> bool:
    # milli and mega differ by their case alone.
    same_prefix = (symbol[:1] == "M") == (written[:1] == "M")
    return same_prefix and _without_blanks_and_case(symbol) == _without_blanks_and_case(written)


def _without_blanks_and_case(symbol: str) -> str:
    return symbol.replace(" ", "").replace("·", "").casefold()


_EVERY_SPELLING: Final = tuple(
    spelling
    for kind in _KINDS
    for unit in kind.all_units
    for spelling in (unit.symbol, *unit.misspellings, *unit.recorded_as)
)
