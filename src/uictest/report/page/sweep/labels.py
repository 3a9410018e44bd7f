"""Values of parameters, as they are written, on an axis."""

from __future__ import annotations

from uictest.report.sweep.wording import STRETCH


def number_in(label: str) -> float | None:
    """Return the number that a label begins with, the middle of a stretch; None where there is none."""
    try:
        ends = [float(end.split()[0]) for end in label.split(STRETCH)]
    except (ValueError, IndexError):
        return None
    return sum(ends) / len(ends)


def unit_in(label: str) -> str:
    """Return the unit at the end of a label; empty where there is none."""
    return label.rpartition(STRETCH)[2].partition(" ")[2]


def with_unit(name: str, unit: str) -> str:
    """Return the title of an axis."""
    return f"{name}, {unit}" if unit else name
