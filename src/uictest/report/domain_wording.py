"""What of cases lies outside of the domain in which the model was validated, in words."""

from __future__ import annotations

from collections.abc import Iterator, Sequence
from functools import cache
from typing import Final

from uictest.core.units import KINDS, in_unit, value_text
from uictest.judging import evaluation
from uictest.report.escaping import printable
from uictest.report.wording import counted

_MOST_NAMED: Final = 6
"""Deviations of a case that are listed before the rest is counted."""
_PURE: Final = ("", "1")


def domain_sentences(result: evaluation.CaseResult) -> Iterator[str]:
    """Yield what of a case lies outside of what was validated; nothing where all of it lies inside."""
    domain = result.domain_of_validity
    if domain is None or not domain.outside:
        return
    shown = [deviation_text(each) for each in domain.outside[:_MOST_NAMED]]
    more = len(domain.outside) - len(shown)
    rest = f"; {more} more in results.json" if more else ""
    yield printable(f"outside of what {domain.validation} validated: {'; '.join(shown)}{rest}")


def domain_lines(result: evaluation.CaseResult) -> Iterator[str]:
    """Yield the same as lines for grep: the word `outside`, the id of the case, and what lies outside."""
    for sentence in domain_sentences(result):
        yield f"outside {printable(result.id)} {sentence.removeprefix('outside ')}"


def domain_notices(results: Sequence[evaluation.CaseResult]) -> Iterator[str]:
    """Yield how many of some cases lie outside of what was validated, for each validation."""
    asked = [each.domain_of_validity for each in results if each.domain_of_validity is not None]
    for name in dict.fromkeys(each.validation for each in asked):
        of_validation = [each for each in asked if each.validation == name]
        outside = sum(bool(each.outside) for each in of_validation)
        among = counted(len(of_validation), "case")
        yield printable(f"{outside} of {among} outside of what {name} validated")


def deviation_text(deviation: evaluation.Deviation) -> str:
    """Return one condition in the units of engineers, e.g. `initial_speed 160 km/h > 120 km/h`."""
    found, validated = deviation.found, deviation.validated
    if isinstance(found, tuple) and isinstance(validated, tuple):
        return f"{deviation.key} {_beyond(found, validated, deviation.unit)}"
    return f"{deviation.key} {_text(found, deviation.unit)}, validated {_text(validated, deviation.unit)}"


def interval_text(lowest: float, highest: float, unit: str) -> str:
    """Return an interval of SI values in the units of engineers; one value where both ends are the same."""
    low, high = _value(lowest, unit), _value(highest, unit)
    return high if low == high else f"{low.removesuffix(f' {_usual(unit)}')} .. {high}"


def _beyond(found: tuple[float, float], validated: tuple[float, float], unit: str) -> str:
    above, below = found[1] > validated[1], found[0] < validated[0]
    if above and below:
        return f"{interval_text(*found, unit)}, validated {interval_text(*validated, unit)}"
    end, sign, bound = (found[1], ">", validated[1]) if above else (found[0], "<", validated[0])
    return f"{_value(end, unit)} {sign} {_value(bound, unit)}"


def _text(value: str | tuple[float, float] | None, unit: str) -> str:
    if value is None:
        return "not set"
    return value if isinstance(value, str) else interval_text(*value, unit)


def _value(value: float, unit: str) -> str:
    if unit in _PURE:
        return f"{value:.4g}"
    return value_text(in_unit(value, _usual(unit)), _usual(unit))


@cache
def _usual(si: str) -> str:
    """Return the unit that engineers use for an SI unit."""
    kinds = (kind for kind in KINDS.values() if kind.canonical == si and kind.units)
    return next((next(iter(kind.units)) for kind in kinds), si)
