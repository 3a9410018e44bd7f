"""Variation from case to case: the lists of scenarios, and the distributions of sweeps."""

from __future__ import annotations

from collections.abc import Iterator
from itertools import product
from math import prod
from typing import Annotated, Any, Final, Literal, NamedTuple

from pydantic import BeforeValidator, Field, model_validator

from uictest.plans.scenario.yaml import (
    DecimalQuantity,
    DecimalQuantityField,
    Diagnostic,
    Entry,
    Inconsistency,
    List,
    Map,
    Model,
    Node,
    Scalar,
    as_written,
    common_unit,
    count_by_step,
    describe,
    diagnose,
    field,
    is_null,
    optional,
    quoted,
    refused,
    require_none,
    short_example,
    suggestion,
)

MOST_CASES: Final = 10_000
EXPANSION_KEYS: Final = ("matrix", "zip", "include", "exclude")


class Setting(NamedTuple):
    """The value that one case gives to one swept key; ``number`` counts the values of that key from one."""

    key: str
    value: Entry
    number: int


Variant = tuple[Setting, ...]
"""The settings that distinguish one case of a scenario; empty if it is not swept."""


def expand(tree: Map) -> list[Variant]:
    """The cases of a scenario, in order: matrix (first key slowest) times zip, less exclude, then include.

    Raises ScenarioErrors with every error of the four sections.
    """
    diagnostics: list[Diagnostic] = []
    variants = expand_valid(tree, diagnostics)
    require_none(diagnostics)
    return variants


def expand_valid(tree: Map, diagnostics: list[Diagnostic]) -> list[Variant]:
    """As :func:`expand`, but append errors to ``diagnostics`` and return the cases of the valid values.

    If there are too many, every value occurs in at least one case.
    """
    matrix, zipped = _parse_axes(tree, "matrix", diagnostics), _parse_axes(tree, "zip", diagnostics)
    include, exclude = (
        _listed_mappings(tree, "include", diagnostics),
        _listed_mappings(tree, "exclude", diagnostics),
    )
    diagnostics.extend(_unequal_lengths(zipped))
    in_matrix = {axis[0].key for axis in matrix}
    diagnostics.extend(
        diagnose(axis[0].value.key, "the key is under matrix as well", f"zip.{axis[0].key}")
        for axis in zipped
        if axis[0].key in in_matrix
    )
    too_many = list(_too_many(tree, matrix, zipped))
    if too_many:
        diagnostics.extend(too_many)
        return [*_one_at_a_time([*matrix, *zipped]), *_included_variants(include)]
    variants = _combined_axes(matrix, zipped, alone=not include)
    swept = _keys_under(tree, "matrix") | _keys_under(tree, "zip")
    variants = _without_excluded(variants, exclude, swept, diagnostics)
    variants.extend(_included_variants(include))
    if not variants and not diagnostics:
        entry = next(tree.entries[section] for section in reversed(EXPANSION_KEYS) if section in tree.entries)
        diagnostics.append(diagnose(entry.key, "no case remains"))
    return variants


def distinct(variants: list[Variant]) -> list[Variant]:
    """The cases without those that repeat an earlier one."""
    by_values = {_values_by_key(variant): variant for variant in reversed(variants)}
    return [variant for variant in variants if by_values[_values_by_key(variant)] is variant]


def _values_by_key(variant: Variant) -> frozenset[tuple[str, str]]:
    return frozenset((setting.key, as_written(setting.value.node)) for setting in variant)


Axis = tuple[Setting, ...]


def _parse_axes(tree: Map, section: str, diagnostics: list[Diagnostic]) -> list[Axis]:
    node = tree.get(section)
    if node is None or is_null(node):
        return []
    if not isinstance(node, Map) or not node.entries:
        what = "an empty mapping" if isinstance(node, Map) else describe(node)
        diagnostics.append(
            _malformed_section(node, section, f"expected lists of values by dotted key, found {what}")
        )
        return []
    return [
        axis for key, entry in node.entries.items() if (axis := _parse_axis(section, key, entry, diagnostics))
    ]


def _parse_axis(section: str, key: str, entry: Entry, diagnostics: list[Diagnostic]) -> Axis:
    if not isinstance(entry.node, List):
        message = f"expected a list of values, found {describe(entry.node)}"
        diagnostics.append(
            diagnose(
                entry.node.location,
                message,
                f"{section}.{key}",
                short_example(f"write `[{as_written(entry.node)}]`"),
            )
        )
        return (Setting(key, entry, 1),)
    if not entry.node.items:
        diagnostics.append(diagnose(entry.node.location, "an empty list makes no case", f"{section}.{key}"))
        return ()
    return tuple(
        Setting(key, Entry(entry.key, item), number) for number, item in enumerate(entry.node.items, start=1)
    )


def _listed_mappings(tree: Map, section: str, diagnostics: list[Diagnostic]) -> list[Map]:
    node = tree.get(section)
    if node is None or is_null(node):
        return []
    if not isinstance(node, List):
        diagnostics.append(
            _malformed_section(node, section, f"expected a list of mappings, found {describe(node)}")
        )
        return []
    diagnostics.extend(
        _malformed_section(
            item, section, f"expected a mapping of dotted keys to values, found {describe(item)}"
        )
        for item in node.items
        if not isinstance(item, Map) or not item.entries
    )
    return [item for item in node.items if isinstance(item, Map) and item.entries]


def _keys_under(tree: Map, section: str) -> set[str]:
    node = tree.get(section)
    return set(node.entries) if isinstance(node, Map) else set()


_EXAMPLES: Final = {
    "matrix": "matrix: {rail.friction: [0.09, 0.10]}",
    "zip": "zip: {rail.friction: [0.09, 0.10], seed: [1, 2]}",
    "include": "include: [{rail.friction: 0.09}]",
    "exclude": "exclude: [{rail.friction: 0.09}]",
}


def _malformed_section(node: Node, section: str, message: str) -> Diagnostic:
    return diagnose(node.location, message, section, f"write `{_EXAMPLES[section]}`")


def _unequal_lengths(zipped: list[Axis]) -> Iterator[Diagnostic]:
    for axis in zipped[1:]:
        if len(axis) != len(zipped[0]):
            count = "1 value" if len(axis) == 1 else f"{len(axis)} values"
            message = f"{count}, but {quoted(zipped[0][0].key)} has {len(zipped[0])}"
            hint = "lists under zip must be equally long; matrix combines lists of any length"
            yield diagnose(axis[0].value.key, message, f"zip.{axis[0].key}", hint)


def _too_many(tree: Map, matrix: list[Axis], zipped: list[Axis]) -> Iterator[Diagnostic]:
    count = prod(map(len, matrix)) * (len(zipped[0]) if zipped else 1)
    if count > MOST_CASES:
        entry = tree.entries["matrix" if matrix else "zip"]
        yield diagnose(
            entry.key, f"{count} cases; one scenario makes at most {MOST_CASES}", hint="split it, or sweep"
        )


def _combined_axes(matrix: list[Axis], zipped: list[Axis], *, alone: bool) -> list[Variant]:
    if not matrix and not zipped:
        return [()] if alone else []
    # Unequal lengths are already reported; the rows that all lists have are checked nevertheless.
    rows: list[Variant] = list(zip(*zipped, strict=False)) if zipped else [()]
    return [(*combination, *row) for combination in product(*matrix) for row in rows]


def _one_at_a_time(axes: list[Axis]) -> Iterator[Variant]:
    first = tuple(axis[0] for axis in axes)
    yield first
    for index, axis in enumerate(axes):
        for setting in axis[1:]:
            yield (*first[:index], setting, *first[index + 1 :])


def _included_variants(include: list[Map]) -> Iterator[Variant]:
    for number, item in enumerate(include, start=1):
        yield tuple(Setting(key, entry, number) for key, entry in item.entries.items())


def _without_excluded(
    variants: list[Variant], exclude: list[Map], swept: set[str], diagnostics: list[Diagnostic]
) -> list[Variant]:
    sound = not diagnostics
    by_keys: dict[frozenset[str], _ByValues] = {}
    excluded: set[int] = set()
    for item in exclude:
        unknown = [key for key in item.entries if key not in swept]
        for key in unknown:
            message = f"{quoted(key)} is not swept, so no case has it"
            diagnostics.append(diagnose(item.entries[key].key, message, "exclude", suggestion(key, swept)))
        if unknown:
            continue
        keys = frozenset(item.entries)
        if keys not in by_keys:
            by_keys[keys] = _by_values(variants, keys)
        # Popped, so that a repeated exclusion matches no case.
        values = frozenset((key, _comparable(entry.node)) for key, entry in item.entries.items())
        matches = set(by_keys[keys].pop(values, ())) - excluded
        if not matches and sound:
            diagnostics.append(diagnose(item.location, "no case has these values", "exclude"))
        excluded |= matches
    return [variant for index, variant in enumerate(variants) if index not in excluded]


_ByValues = dict[frozenset[tuple[str, object]], list[int]]
"""Values of some keys, as far as they can be compared, and the places of the cases that have them."""


def _by_values(variants: list[Variant], keys: frozenset[str]) -> _ByValues:
    places: _ByValues = {}
    for index, variant in enumerate(variants):
        values = {setting.key: setting.value.node for setting in variant}
        if keys <= values.keys():
            places.setdefault(frozenset((key, _comparable(values[key])) for key in keys), []).append(index)
    return places


def _comparable(node: Node) -> object:
    if isinstance(node, Scalar) and not isinstance(node.value, str):
        return node.value
    return "".join(as_written(node).split())


MOST_POINTS: Final = 2**24
FARTHEST_END: Final = 100_000
"""Deviations from the mean to the nearer end of a normal distribution, at most.

Farther off, the values keep to that end within 1e-10 of its distance, which ten digits do not tell apart.
"""
Method = Literal["random", "sobol", "latin-hypercube", "saltelli"]
_ONE_UNIT = "write all numbers of it with the same unit"


class Range(Model):
    """Numbers from the first to the last, given by a step or by their count."""

    first: DecimalQuantityField = field("First number, with its unit.")
    last: DecimalQuantityField = field("Last number; included if a step reaches it.")
    step: DecimalQuantityField | None = optional("Difference between neighbours.")
    count: Annotated[int, Field(ge=1, le=1_000_000, strict=True)] | None = optional(
        "How many numbers, evenly spaced, both ends included."
    )

    def inconsistencies(self) -> Iterator[Inconsistency]:
        """Yield both or neither of step and count, mixed units, and steps away from the last number."""
        if (self.step is None) == (self.count is None):
            yield Inconsistency((), "give either 'step' or 'count'", "count: 11, or step: 0.01")
            return
        numbers = [self.first, self.last, *([self.step] if self.step else [])]
        if common_unit(numbers) is None:
            yield Inconsistency(("last",), "the numbers of a range have different units", _ONE_UNIT)
        elif self.size == 0:
            yield Inconsistency(
                ("step",), f"steps of {self.step} do not lead from {self.first} to {self.last}"
            )
        elif self.size > MOST_POINTS:
            message = f"{self.size} values; at most {MOST_POINTS} are accepted"
            yield Inconsistency(("step",), message, "choose a larger step")

    @property
    def size(self) -> int:
        """Number of values, counted without making them."""
        if self.step is None:
            return self.count or 0
        return count_by_step(self.first.number, self.last.number, self.step.number)


class Normal(Model):
    """A normal distribution, truncated at both ends."""

    mean: DecimalQuantityField = field("Mean before the ends are cut off.")
    deviation: DecimalQuantityField = field("Standard deviation before the ends are cut off.")
    lower: DecimalQuantityField = field("Smallest value.")
    upper: DecimalQuantityField = field("Largest value.")

    def inconsistencies(self) -> Iterator[Inconsistency]:
        """Yield mixed units, a deviation that is not above zero, bounds in the wrong order."""
        if common_unit([self.mean, self.deviation, self.lower, self.upper]) is None:
            yield Inconsistency(("mean",), "the numbers of a distribution have different units", _ONE_UNIT)
        elif self.deviation.number <= 0:
            yield Inconsistency(("deviation",), f"{self.deviation} is not above zero")
        elif self.lower.number >= self.upper.number:
            yield Inconsistency(("upper",), f"{self.upper} does not lie above {self.lower}")
        else:
            yield from self._ends_too_far_off()

    def _ends_too_far_off(self) -> Iterator[Inconsistency]:
        farthest = FARTHEST_END * self.deviation.number
        above, below = self.lower.number - self.mean.number, self.mean.number - self.upper.number
        hint = "only this value would be drawn; move it or the mean, or widen the deviation"
        for key, end, side, distance in (
            ("lower", self.lower, "above", above),
            ("upper", self.upper, "below", below),
        ):
            if distance > farthest:
                message = f"{end} lies more than {FARTHEST_END} deviations {side} the mean"
                yield Inconsistency((key,), message, hint)


def _list_of_numbers(words: str, *names: str) -> BeforeValidator:

    def check(entry: object) -> object:
        if isinstance(entry, list | tuple) and len(entry) == len(names):
            return entry
        actual = f"{len(entry)}" if isinstance(entry, list | tuple) else "no list"
        raise refused(f"expected {words}, [{', '.join(names)}], found {actual}")

    return BeforeValidator(check)


TwoBounds = Annotated[
    tuple[DecimalQuantityField, DecimalQuantityField], _list_of_numbers("two bounds", "lowest", "highest")
]
ThreeValues = Annotated[
    tuple[DecimalQuantityField, DecimalQuantityField, DecimalQuantityField],
    _list_of_numbers("three values", "lowest", "likeliest", "highest"),
]


class Distribution(Model):
    """The distribution of one parameter: exactly one of five."""

    uniform: TwoBounds | None = optional(
        "Smallest and largest value; everything between is equally likely.", examples=[[0.08, 0.16]]
    )
    log_uniform: TwoBounds | None = optional(
        "Smallest and largest value, above zero; the logarithm is uniform.",
        alias="log-uniform",
        examples=[["0.8e-8 m3/(s Pa)", "1.6e-8 m3/(s Pa)"]],
    )
    triangular: ThreeValues | None = optional(
        "Smallest, likeliest and largest value; the density is a triangle.",
        examples=[["80 %", "100 %", "100 %"]],
    )
    normal: Normal | None = optional(
        "Normal, cut off at both ends; what lies beyond them is not drawn.",
        examples=[{"mean": "32 t", "deviation": "0.5 t", "lower": "30 t", "upper": "34 t"}],
    )
    choice: tuple[Any, ...] | None = optional(
        "Values that the key accepts, each as likely as the others.",
        min_length=1,
        max_length=10_000,
        examples=[["one-caliper", "four-caliper"]],
    )

    @model_validator(mode="before")
    @classmethod
    def _named(cls, value: Any) -> Any:
        if isinstance(value, dict | cls):
            return value
        hint = f"accepted: {', '.join(cls._forms())}; such as {{uniform: [0.08, 0.16]}}"
        raise refused("expected a distribution by its name", hint)

    @classmethod
    def _forms(cls) -> list[str]:
        return [field.alias or name for name, field in cls.model_fields.items()]

    @property
    def form(self) -> str:
        """Name of the distribution that is given."""
        return next(name for name, value in self if value is not None)

    @property
    def quantities(self) -> tuple[DecimalQuantity, ...]:
        """The smallest, the likeliest (if any) and the largest value; a choice has none."""
        if self.normal is not None:
            return self.normal.lower, self.normal.upper
        return self.uniform or self.log_uniform or self.triangular or ()

    @property
    def bounds(self) -> tuple[DecimalQuantity, DecimalQuantity]:
        """The smallest and the largest value of a distribution that is not a choice."""
        first, *_, last = self.quantities
        return first, last

    def inconsistencies(self) -> Iterator[Inconsistency]:
        """Yield none or several distributions at once, mixed units, bounds in the wrong order."""
        if sum(value is not None for _, value in self) != 1:
            yield Inconsistency((), "give exactly one distribution", f"accepted: {', '.join(self._forms())}")
            return
        values = self.uniform or self.log_uniform or self.triangular
        if values is None:
            return
        key = "log-uniform" if self.log_uniform else self.form
        numbers = [quantity.number for quantity in values]
        if common_unit(values) is None:
            yield Inconsistency((key,), "the numbers of a distribution have different units", _ONE_UNIT)
        elif numbers != sorted(numbers) or numbers[0] == numbers[-1]:
            yield Inconsistency((key,), f"the values must rise from {values[0]} to {values[-1]}")
        elif self.log_uniform and numbers[0] <= 0:
            yield Inconsistency((key,), f"{values[0]} has no logarithm")


class Sample(Model):
    """Points drawn from the distributions of several parameters."""

    method: Method = field(
        "random; sobol and latin-hypercube fill space more evenly; saltelli for sensitivities.",
        default="random",
    )
    size: int = field(
        "Number of points; saltelli makes (parameters + 2) cases of each.", ge=1, le=MOST_POINTS, strict=True
    )
    seed: int = field("Seed of the draws.", default=0, ge=0, le=2**32 - 1, strict=True)
    parameters: dict[str, Distribution] = field("Distributions by dotted key.", min_length=1, max_length=64)

    @property
    def cases(self) -> int:
        """Number of cases in the sample."""
        return self.size * (len(self.parameters) + 2) if self.method == "saltelli" else self.size

    def inconsistencies(self) -> Iterator[Inconsistency]:
        """Yield sizes for which a Sobol sequence is unbalanced."""
        if self.method in ("sobol", "saltelli") and self.size & (self.size - 1):
            below = 1 << (self.size.bit_length() - 1)
            yield Inconsistency(
                ("size",),
                f"{self.size} points of a Sobol sequence are unbalanced",
                f"take a power of two: {below} or {2 * below}",
            )


Lists = dict[str, Annotated[tuple[Any, ...], Field(min_length=1)]]


class Vary(Model):
    """A sweep: one scenario, run with many values of some of its parameters.

    The cases are all combinations of `matrix`, `ranges`, the rows of `zip` and the points of `sample`.
    """

    matrix: Lists | None = optional(
        "Lists of values by dotted key; every combination is run, first key slowest."
    )
    ranges: dict[str, Range] | None = optional(
        "Ranges of numbers by dotted key, combined like lists of `matrix`."
    )
    zip: Lists | None = optional("Lists of equal length by dotted key; values at the same place go together.")
    sample: Sample | None = optional("Values drawn from distributions.")
