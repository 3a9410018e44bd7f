"""Units as measurement files write them, and what one of each is in SI."""

from __future__ import annotations

from fractions import Fraction
from types import MappingProxyType
from typing import Final

from uictest.units import KINDS

_KIND_OF_SI: Final = MappingProxyType(
    {"s": "time", "m": "length", "m/s": "speed", "Pa": "pressure", "N": "force", "1": "share"}
)
_FURTHER: Final = MappingProxyType(
    {
        "s": {"us": Fraction("1e-6"), "ns": Fraction("1e-9"), "sec": Fraction(1)},
        "m/s": {
            "kph": Fraction(5, 18),
            "kmh": Fraction(5, 18),
            "mps": Fraction(1),
            "mph": Fraction("0.44704"),
        },
        "Pa": {"mbar": Fraction(100), "barg": Fraction(100_000), "bar(g)": Fraction(100_000)},
        "N": {"MN": Fraction(1_000_000)},
        "N m": {"N m": Fraction(1), "Nm": Fraction(1), "kN m": Fraction(1000), "kNm": Fraction(1000)},
        "1": {"-": Fraction(1)},
    }
)


def accepted(si: str) -> dict[str, Fraction]:
    """Return the units accepted where the SI unit is `si`, each with its size in it."""
    kind = KINDS.get(_KIND_OF_SI.get(si, ""))
    known = {} if kind is None else {unit.symbol: unit.factor for unit in kind.units.values()}
    return {**known, **_FURTHER.get(si, {})}


def factor(unit: str, si: str) -> float | None:
    """Return how much of `si` one `unit` is; None where it is no unit of that kind.

    Case and blanks are free where that leaves no doubt.
    """
    known = accepted(si)
    if unit in known:
        return float(known[unit])
    matches = {size for symbol, size in known.items() if _alike(symbol, unit)}
    return float(matches.pop()) if len(matches) == 1 else None


def _alike(symbol: str, written: str) -> bool:
    # milli and mega differ by their case alone.
    same_prefix = (symbol[:1] == "M") == (written[:1] == "M")
    return same_prefix and _plain(symbol) == _plain(written)


def _plain(symbol: str) -> str:
    return symbol.replace(" ", "").replace("·", "").casefold()
