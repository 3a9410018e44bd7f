"""The variants of one run: cases and series that differ in the values of some keys."""

from __future__ import annotations

from collections.abc import Mapping, Sequence

from uictest.analysis.comparison.paired.groups import Side
from uictest.analysis.comparison.paired.pairing import PairedComparison, compare_sides
from uictest.plans.scenario.yaml import nearest
from uictest.report import RunContent

Variant = tuple[tuple[str, str], ...]
"""Keys and values, as written."""


def compare_variants(run: RunContent, keys: Sequence[str]) -> list[PairedComparison]:
    """Return the differences of every variant of a run from the first one, as the keys tell them apart.

    Cases and series without any of the keys are left out. Raises ValueError where there are no two variants,
    for a key that none of them has and for one that is given twice.
    """
    parameters: list[Mapping[str, str]] = [case.parameters for case in run.results]
    parameters += [series.parameters for series in run.series]
    known = list(dict.fromkeys(key for of_item in parameters for key in of_item))
    for key in keys:
        if keys.count(key) > 1:
            raise ValueError(f"{key!r} is given {keys.count(key)} times; give every key once")
        if key not in known:
            guess = nearest(key, known)
            hint = f"did you mean {guess!r}? " if guess else ""
            listed = ", ".join(known) or "nothing"
            raise ValueError(f"no case or series has a value of {key!r}; {hint}they differ in: {listed}")
    variants = list(dict.fromkeys(variant for each in parameters if (variant := _variant(each, keys))))
    if len(variants) < 2:
        raise ValueError(f"there is one variant only, {_variant_name(variants[0])}")
    first, *others = (_side(run, variant, keys) for variant in variants)
    return [compare_sides(first, other, keys) for other in others]


def _variant(parameters: Mapping[str, str], keys: Sequence[str]) -> Variant:
    return tuple((key, parameters[key]) for key in keys if key in parameters)


def _side(run: RunContent, variant: Variant, keys: Sequence[str]) -> Side:
    return Side(
        _variant_name(variant),
        [case for case in run.results if _variant(case.parameters, keys) == variant],
        [series for series in run.series if _variant(series.parameters, keys) == variant],
    )


def _variant_name(variant: Variant) -> str:
    return ", ".join(f"{key}={value}" for key, value in variant)
