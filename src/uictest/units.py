"""The units a user may write, per kind of quantity: a small whitelist, exact factors to SI."""

from dataclasses import dataclass
from fractions import Fraction
from types import MappingProxyType
from typing import Final

# One normal litre is 1 dm3 of air at 20 degC and 1 bar (ANR): 1.185 kg/m3.
_NORMAL_LITRE = Fraction("0.001185")
_CELSIUS_ZERO = Fraction("273.15")
_STANDARD_GRAVITY = Fraction("9.80665")


@dataclass(frozen=True, slots=True)
class Unit:
    """One way to write a quantity: ``SI value = number * factor + offset``."""

    symbol: str
    factor: Fraction
    offset: Fraction = Fraction(0)


@dataclass(frozen=True, slots=True, eq=False)
class Kind:
    """A kind of quantity: its canonical unit and every unit accepted for it, the most usual one first."""

    name: str
    canonical: str
    units: MappingProxyType[str, Unit]

    @property
    def bare(self) -> bool:
        """Whether the quantity is a pure number, written without a unit."""
        return not self.units


def _kind(name: str, canonical: str, *units: tuple[str, str | int | Fraction] | Unit) -> Kind:
    accepted = (unit if isinstance(unit, Unit) else Unit(unit[0], Fraction(unit[1])) for unit in units)
    return Kind(name, canonical, MappingProxyType({unit.symbol: unit for unit in accepted}))


_KINDS = (
    _kind("speed", "m/s", ("km/h", Fraction(5, 18)), ("m/s", 1)),
    _kind("length", "m", ("m", 1), ("km", 1000), ("mm", "0.001"), ("cm", "0.01")),
    _kind("time", "s", ("s", 1), ("ms", "0.001"), ("min", 60)),
    _kind("mass", "kg", ("kg", 1), ("t", 1000)),
    _kind("inertia", "kg m2", ("kg m2", 1)),
    _kind("pressure", "Pa", ("bar", 100_000), ("kPa", 1000), ("Pa", 1), ("MPa", 1_000_000)),
    _kind("force", "N", ("N", 1), ("kN", 1000)),
    _kind("stiffness", "N/m", ("N/m", 1), ("kN/m", 1000), ("MN/m", 1_000_000), ("N/mm", 1000)),
    _kind("damping", "N s/m", ("N s/m", 1), ("kN s/m", 1000)),
    _kind("quadratic resistance", "N s2/m2", ("N s2/m2", 1)),
    _kind("conductance", "m3/(s Pa)", ("m3/(s Pa)", 1), ("dm3/(s bar)", "1e-8")),
    _kind("volume", "m3", ("L", "0.001"), ("m3", 1), ("cm3", "1e-6")),
    _kind("normal volume", "m3", ("NL", "0.001"), ("Nm3", 1)),
    _kind("area", "m2", ("m2", 1), ("cm2", "1e-4"), ("mm2", "1e-6")),
    _kind("temperature", "K", Unit("degC", Fraction(1), _CELSIUS_ZERO), ("K", 1)),
    _kind("acceleration", "m/s2", ("m/s2", 1), ("g", _STANDARD_GRAVITY)),
    _kind("share", "1", ("%", "0.01"), ("permille", "0.001"), ("1", 1)),
    _kind("gradient", "1", ("permille", "0.001"), ("%", "0.01")),
    _kind("force per pressure", "N/Pa", ("kN/bar", "0.01"), ("N/bar", "1e-5"), ("N/Pa", 1)),
    _kind("mass flow", "kg/s", ("NL/min", _NORMAL_LITRE / 60), ("kg/s", 1)),
    _kind("frequency", "Hz", ("Hz", 1)),
    _kind("inverse speed", "s/m", ("s/m", 1)),
    _kind("gas constant", "J/(kg K)", ("J/(kg K)", 1)),
    _kind("number", "1"),
    _kind("count", "1"),
)

KINDS: Final = MappingProxyType({kind.name: kind for kind in _KINDS})
"""Every kind of quantity by name."""

SPELLINGS: Final = MappingProxyType(
    {
        "%": ("percent", "percentage", "pct"),
        "permille": ("‰", "promille", "mm/m"),
        "km/h": ("kmh", "kph", "kmph", "km/hr"),
        "m/s": ("mps",),
        "m/s2": ("m/s/s", "mps2", "ms-2", "m/sec2"),
        "s": ("sec", "secs", "second", "seconds"),
        "ms": ("msec", "millisecond", "milliseconds"),
        "min": ("minute", "minutes", "mins"),
        "m": ("metre", "metres", "meter", "meters"),
        "kg": ("kgs", "kilogram", "kilograms"),
        "t": ("ton", "tons", "tonne", "tonnes"),
        "L": ("litre", "litres", "liter", "liters", "ltr", "dm3"),
        "NL": ("normallitre", "normalliter", "Ndm3"),
        "degC": ("C", "celsius", "°C"),
        "bar": ("barg", "bar(g)", "bars"),
        "N": ("newton", "newtons"),
        "kN": ("kilonewton", "kilonewtons"),
    }
)
"""What a unit is often called; named in the hint, never accepted: one way to write a thing is enough."""
