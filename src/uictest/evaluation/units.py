"""The units results are written in: how many SI units one of each is."""

from __future__ import annotations

STANDARD_GRAVITY = 9.80665
"""m/s2, exact by definition."""

NORMAL_DENSITY = 1.185
"""kg/m3: air at 20 degC, 1 bar and 65 % humidity (ANR, ISO 8778); one normal litre weighs 1.185 g."""

UNITS = {
    "1": 1.0,
    "%": 0.01,
    "permille": 0.001,
    "s": 1.0,
    "m": 1.0,
    "km/h": 1.0 / 3.6,
    "m/s2": 1.0,
    "g": STANDARD_GRAVITY,
    "bar": 1e5,
    "kN": 1e3,
    "NL": 1e-3,
}
"""Unit -> its size in the SI unit of its kind (NL: in normal cubic metres)."""


def in_unit(value: float, unit: str) -> float:
    """Return an SI value in `unit`."""
    return value / UNITS[unit]


def normal_volume(mass: float) -> float:
    """Return the normal volume (m3 at 20 degC and 1 bar) of a mass of air (kg)."""
    return mass / NORMAL_DENSITY


def tidy(value: float) -> float:
    """Return a bound or a definition as it was written: without the last digits that unit conversion left."""
    return float(f"{value:.12g}")


def text(value: float, unit: str) -> str:
    """Return a value with its unit for a reader: four significant digits, no unit for a pure number."""
    return with_unit(f"{value:.0f}" if 1e3 <= abs(value) < 1e6 else f"{value:.4g}", unit)


def with_unit(numbers: str, unit: str) -> str:
    """Return numbers with their unit, or alone where they are pure numbers."""
    return numbers if unit == "1" else f"{numbers} {unit}"
