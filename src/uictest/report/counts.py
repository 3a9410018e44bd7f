"""Counts with their nouns."""

from __future__ import annotations


def counted(count: int, noun: str, plural: str = "") -> str:
    """Return a count with its noun, e.g. `1 case`, `2 cases`; `plural` where it is not the noun with an s."""
    return f"{count} {noun}" if count == 1 else f"{count} {plural or f'{noun}s'}"


def counted_in(cases: int, series: int) -> str:
    """Return counts of cases and series, e.g. `2 cases, 1 series`; without any series the cases alone."""
    of_cases = [counted(cases, "case")] if cases or not series else []
    return ", ".join([*of_cases, *([f"{series} series"] if series else [])])
