"""The car of a case in words: its mass, axle load and braked weight percentage, and what is implausible."""

from __future__ import annotations

from collections.abc import Iterator

from uictest.judging import evaluation
from uictest.report.escaping import printable


def car_facts(result: evaluation.CaseResult) -> dict[str, str]:
    """Return the figures of the car by their names; none of a recorded stop."""
    if (car := result.car) is None:
        return {}
    masses = {"car mass": f"{car.mass_t:.4g} t", "axle load": f"{car.axle_load_t:.4g} t"}
    return masses | {"braked weight percentage": f"{car.braked_weight_percentage:.0f} %"}


def implausible_sentences(result: evaluation.CaseResult) -> Iterator[str]:
    """Yield what of the car is implausible, and the mistake that is likely."""
    for each in () if result.car is None else result.car.implausible:
        yield printable(f"implausible: {each}: {each.likely}")
