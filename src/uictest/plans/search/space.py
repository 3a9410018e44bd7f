"""The space of a search: vectors of the unit cube, and the values that they stand for, as written."""

from __future__ import annotations

import math
from collections.abc import Iterator, Mapping, Sequence
from dataclasses import dataclass, replace
from functools import cached_property
from pathlib import Path
from typing import Any, Final, NamedTuple

from uictest.core.units import in_unit
from uictest.plans import library
from uictest.plans.faults import Effects, FaultKind, FaultValue
from uictest.plans.scenario import (
    Case,
    Files,
    LoadedCase,
    Override,
    Parts,
    Roots,
    Scenario,
    ScenarioErrors,
    Search,
    fault_name,
    kinds_named,
    load_with_trees,
    parse_overrides,
    resolve,
    with_value,
)
from uictest.plans.scenario.yaml import (
    Diagnostic,
    Entry,
    List,
    Location,
    Map,
    Node,
    Quantity,
    Scalar,
    collecting,
    diagnose,
    parse_decimal_quantity,
    parse_quantity,
    plain,
    quoted,
    scalar_value,
    scenario_trees,
    single_error,
    suggestion,
    validated,
    whole_file,
)
from uictest.plans.sweeps import is_free, value_at

Point = tuple[str, ...]
"""One value as written for each column of a space; empty: nominal, and for a fault none."""
NOMINAL: Final = ""
FRICTION: Final = "rail.friction"


class Axis(NamedTuple):
    """Numbers from `low` to `high` in a unit.

    `nominal` is the value of the scenario, in the same unit; NaN where it is none. `origin` is the number
    around which the orders of magnitude are as likely as each other, down to a thousandth of the range; None:
    all numbers are.
    """

    name: str
    low: float
    high: float
    unit: str
    nominal: float = math.nan
    origin: float | None = None
    whole: bool = False

    def text_at(self, share: float) -> str:
        """Return the value at a share of the range, 0 to 1, rounded to about a thousandth of it."""
        if self.origin is None:
            return self.text(self.low + share * (self.high - self.low), 3)
        below, above = self.origin - self.low, self.high - self.origin
        parts = sum(side > 0.0 for side in (below, above))
        is_below = below > 0.0 and share < 1.0 / parts
        side, farthest = (-1.0, below) if is_below else (1.0, above)
        place = share * parts - (parts == 2 and not is_below)
        place = 1.0 - place if is_below else place
        return self.text(self.origin + side * farthest * 1e-3 ** (1.0 - min(place, 1.0)), 5)

    def text(self, number: float, digits: int = 5) -> str:
        """Return a number as written, kept to the range, with some digits of its width."""
        places = 0 if self.whole else max(digits - math.floor(math.log10(self.high - self.low)), 0)
        number = round(min(max(number, self.low), self.high), places)
        text = f"{number + 0.0:.{places}f}"
        text = text.rstrip("0").rstrip(".") if "." in text else text
        return f"{text} {self.unit}".rstrip()

    def number(self, text: str) -> float:
        """Return the number of a value; the nominal one for none."""
        return self.nominal if text == NOMINAL else float(parse_decimal_quantity(text).number)


class FaultAxes(NamedTuple):
    """The four columns of a fault: kind, wheelset, beginning, size; `first` is the index of the kind."""

    first: int
    kinds: tuple[FaultKind, ...]
    begin: Axis

    def texts_at(self, shares: Sequence[float]) -> tuple[str, ...]:
        """Return the fault at four shares, each from 0 to 1."""
        kind = self.kinds[min(int(shares[0] * len(self.kinds)), len(self.kinds) - 1)]
        wheelset = str(1 + min(int(4.0 * shares[1]), 3)) if kind.of_wheelset else NOMINAL
        size, share = NOMINAL, shares[3]
        if kind.value is not None:
            if kind.value.without:  # half of them are without a size
                share = 2.0 * share - 1.0
            size = self.size_axis(fault_name(kind)).text_at(share) if share >= 0.0 else NOMINAL
        return fault_name(kind), wheelset, self.begin.text_at(shares[2]), size

    def size_axis(self, name: str) -> Axis:
        """Return the sizes of a kind, around the one that changes nothing, where there is one."""
        kind = next(kind for kind in self.kinds if fault_name(kind) == name)
        assert kind.value is not None
        unit = parse_decimal_quantity(kind.value.at_most).unit
        ends = (parse_quantity(end, kind.value.kind) for end in (kind.value.at_least, kind.value.at_most))
        low, high = (round(in_unit(float(end), unit or "1"), 12) for end in ends)
        origin = next((n for n in (0.0, 1.0, 100.0) if _is_harmless(kind, kind.value, n, unit)), None)
        return Axis("size", low, high, unit, origin=origin, whole=not unit)


def _is_harmless(kind: FaultKind, value: FaultValue, number: float, unit: str) -> bool:
    return kind.effects(float(parse_quantity(f"{number} {unit}".rstrip(), value.kind))) == Effects()


@dataclass(frozen=True)
class Space:
    """The space of a search.

    Args:
        loaded: the scenario, with the tree that its stops are resolved from.
        search: its section.
        overrides: values of the command line, which every stop has.
        parts: resolves parts.
        axes: the numbers: those of `ranges`, then those of the profile.
        faults: the faults.
        location: of the section.

    """

    loaded: LoadedCase
    search: Search
    overrides: tuple[Override, ...]
    parts: Parts
    axes: tuple[Axis, ...]
    faults: tuple[FaultAxes, ...]
    location: Location

    @cached_property
    def columns(self) -> tuple[str, ...]:
        """Name of each column, which is a dimension of the space, too."""
        words = ("fault", "wheelset", "from", "size")
        of_faults = (f"{word} {number}" for number in range(1, len(self.faults) + 1) for word in words)
        return (*(axis.name for axis in self.axes), *of_faults)

    @property
    def nominal(self) -> Point:
        """The point of the scenario itself."""
        return (NOMINAL,) * len(self.columns)

    @property
    def profile(self) -> range:
        """The columns of the friction along the track."""
        return range(len(self.search.ranges), len(self.axes))

    def point(self, vector: Sequence[float]) -> Point:
        """Return the values at a vector of the unit cube."""
        numbers = [axis.text_at(share) for axis, share in zip(self.axes, vector, strict=False)]
        faults = (text for axes in self.faults for text in axes.texts_at(vector[axes.first : axes.first + 4]))
        return (*numbers, *faults)

    def contents(self, point: Point) -> dict[str, Any]:
        """Return the values that are not nominal, by dotted key, as a file has them."""
        contents: dict[str, Any] = {
            axis.name: scalar_value(text)
            for axis, text in zip(self.axes[: self.profile.start], point, strict=False)
            if text != NOMINAL
        }
        frictions = [point[k] or _number_text(self.axes[k].nominal) for k in self.profile]
        if any(point[k] for k in self.profile):
            positions = (axis.name.partition(" at ")[2] for axis in self.axes[self.profile.start :])
            points = [
                {"position": position, "friction": float(text)}
                for position, text in zip(positions, frictions, strict=True)
            ]
            contents[FRICTION] = float(frictions[0]) if len(set(frictions)) == 1 else {"points": points}
        if faults := [fault for axes in self.faults if (fault := self._fault(axes, point))]:
            own = self.loaded.tree.get("faults")
            contents["faults"] = [*(plain(own) if isinstance(own, List) else ()), *faults]
        return contents

    def _fault(self, axes: FaultAxes, point: Point) -> dict[str, Any]:
        name, wheelset, begin, size = point[axes.first : axes.first + 4]
        if name == NOMINAL:
            return {}
        kind = next(kind for kind in axes.kinds if fault_name(kind) == name)
        fault: dict[str, Any] = {"part": kind.part, "kind": kind.name}
        fault |= {"wheelset": int(wheelset)} if wheelset else {}
        fault["at"] = begin or axes.begin.text(axes.begin.nominal)
        return fault | ({"value": scalar_value(size)} if size else {})

    def case(self, point: Point, seed: int = 0) -> Case:
        """Return the case at a point under one of its seeds, from 0. Raises ScenarioErrors: it is refused."""
        return self.with_contents(self.contents(point), seed)

    def with_contents(self, contents: Mapping[str, Any], seed: int = 0) -> Case:
        """Return the case with other values at dotted keys. Raises ScenarioErrors."""
        tree = self.loaded.tree
        for key in sorted(contents, key=lambda key: key.count(".")):
            location = self.location_of(key)
            tree = with_value(tree, key, Entry(location, _node(contents[key], location)))
        scenario, _ = resolve(tree, self.parts)
        own = {"seed": scenario.seed + seed, "repeat": 1}
        return replace(self.loaded.case, scenario=scenario.model_copy(update=own))

    def location_of(self, key: str) -> Location:
        """Return the location of a key of `ranges`, of other keys that of the section."""
        section = self.loaded.search and self.loaded.search.node
        ranges = section.get("ranges") if isinstance(section, Map) else None
        return ranges.entries[key].key if isinstance(ranges, Map) and key in ranges.entries else self.location


def _number_text(number: float) -> str:
    return f"{number:.10g}"


def _node(content: Any, location: Location) -> Node:
    """Return plain content as a tree, all of it at one location."""
    if isinstance(content, Mapping):
        entries = {key: Entry(location, _node(value, location)) for key, value in content.items()}
        return Map(entries, location)
    if isinstance(content, list | tuple):
        return List(tuple(_node(each, location) for each in content), location)
    return Scalar(content, str(content), location)


def load_search(
    path: Path,
    overrides: Sequence[str] = (),
    seed: int | None = None,
    trusted: Sequence[Path] = (),
    stops: int | None = None,
) -> Space:
    """Return the space of the search in a scenario file, all of it checked.

    `seed`, that of the points, and `stops` stand in place of the section's. Raises ScenarioErrors.
    """
    path = library.named_scenario(path)
    given = parse_overrides(overrides, None)
    parts = Parts(Files(Roots.of([path], trusted)))
    cases = load_with_trees(path, given, parts)
    loaded = cases[0]
    if loaded.search is None:
        hint = (
            "say where to search: search: {criteria: [locked-wheels], ranges: {rail.friction: [0.05, 0.20]}}"
        )
        raise single_error(whole_file(path), "the scenario has no 'search'", "search", hint)
    entry = loaded.search
    if len(cases) > 1:
        what = "the cars of a train" if loaded.case.train is not None else f"{len(cases)} cases"
        hint = "a search is of one car alone, with one value at each key: --set KEY=VALUE chooses"
        raise single_error(entry.key, f"the scenario has {what}", "search", hint)
    if not isinstance(entry.node, Map):
        raise single_error(entry.node.location, "expected a mapping", "search")
    search = validated(Search, plain(entry.node), entry.node, ("search",))
    given_instead = {"seed": seed, "stops": stops}
    search = search.model_copy(update={key: each for key, each in given_instead.items() if each is not None})
    space = Space(loaded, search, given, parts, (), (), entry.key)
    _require_criteria(space)
    axes = (*_axes_of_ranges(space), *_axes_of_profile(space))
    return replace(space, axes=axes, faults=_fault_axes(space, len(axes)))


def searches_in(paths: Sequence[Path], trusted: Sequence[Path]) -> tuple[list[Space], list[Diagnostic]]:
    """Return the searches of scenario files at or below paths, and the errors of their sections."""
    spaces: list[Space] = []
    diagnostics: list[Diagnostic] = []
    for path, tree in scenario_trees(paths, Files(Roots.of(paths, trusted)), []):
        search = tree.entries.get("search")
        if search is not None and not (isinstance(search.node, Scalar) and search.node.value is None):
            with collecting(diagnostics, whole_file(path)):
                spaces.append(load_search(path, (), None, (*trusted, *paths_of(paths))))
    return spaces, diagnostics


def paths_of(paths: Sequence[Path]) -> list[Path]:
    """Return the folders among paths."""
    return [path for path in paths if path.is_dir()]


def _require_criteria(space: Space) -> None:
    """Raise ScenarioErrors for a criterion that does not judge the scenario, or checks the rig."""
    known = [
        criterion.id
        for profile in space.loaded.case.scenario.judged_by
        for criterion in profile.criteria
        if criterion.layer in ("requirement", "validity")
    ]
    for name in space.search.criteria:
        if name not in known:
            message = f"{quoted(name)} is no criterion of this scenario"
            raise single_error(space.location, message, "search.criteria", suggestion(name, known))


def _axes_of_ranges(space: Space) -> Iterator[Axis]:
    """Yield the numbers of `ranges`. Raises ScenarioErrors for a key or a unit that is refused."""
    scenario = space.loaded.case.scenario
    for key, (low, high) in space.search.ranges.items():
        if is_free(scenario, key):
            example: Any = value_at(scenario, key)
        else:
            example = value_at(_accepted(space, key, (str(low), str(high))), key)
        if not isinstance(example, Quantity | int | float) or isinstance(example, bool):
            message = f"{quoted(key)} is not a number"
            raise single_error(space.location_of(key), message, f"search.ranges.{key}")
        nominal = _nominal_number(scenario, key, low.unit)
        yield Axis(
            key, float(low.number), float(high.number), low.unit, nominal, None, isinstance(example, int)
        )


def _accepted(space: Space, key: str, texts: Sequence[str]) -> Scenario:
    """Return the scenario with the first of some values that is accepted. Raises ScenarioErrors."""
    refused: list[ScenarioErrors] = []
    for text in texts:
        try:
            return space.with_contents({key: scalar_value(text)}).scenario
        except ScenarioErrors as errors:
            refused.append(errors)
    raise refused[0]


def _nominal_number(scenario: Scenario, key: str, unit: str) -> float:
    """Return the value of the scenario in a unit; NaN where it is written in another, or is no number."""
    try:
        value = value_at(scenario, key)
    except KeyError:
        return math.nan
    if value is None and key == FRICTION:
        value = scenario.rail.condition.friction
    if isinstance(value, Quantity):
        written = parse_decimal_quantity(value.text)
        return float(written.number) if written.unit == unit else math.nan
    return float(value) if isinstance(value, int | float) else math.nan


def _axes_of_profile(space: Space) -> Iterator[Axis]:
    profile = space.search.profile
    if profile is None:
        return
    nominal = _nominal_number(space.loaded.case.scenario, FRICTION, "")
    if math.isnan(nominal):
        message = f"`{FRICTION}` of the scenario is not one number, to which shrinking could go back"
        raise single_error(space.location, message, "search.profile", f"write {FRICTION}: 0.10")
    low, high = (float(bound.number) for bound in profile.friction)
    spacing = parse_decimal_quantity(profile.spacing.text)
    for k in range(profile.points):
        yield Axis(f"friction at {k * spacing.number:f} {spacing.unit}", low, high, "", nominal)


def _fault_axes(space: Space, first: int) -> tuple[FaultAxes, ...]:
    """Return the faults, of the kinds that the car can have. Raises ScenarioErrors where it can have none."""
    searched = space.search.faults
    if searched is None:
        return ()
    low, high = searched.begin
    begin = Axis("from", float(low.number), float(high.number), low.unit, float(low.number))
    rows = {fault_name(kind): kind for name in searched.kinds for kind in kinds_named(name)}
    problems: list[Diagnostic] = []
    possible = []
    for kind in rows.values():
        axes = FaultAxes(0, (kind,), begin)
        alone = replace(space, faults=(axes,))
        try:
            alone.case(axes.texts_at((0.0, 0.0, 0.0, 0.6)))
            possible.append(kind)
        except ScenarioErrors as errors:
            problems.extend(errors.diagnostics)
    if not possible:
        raise ScenarioErrors(problems or [diagnose(space.location, "no fault", "search.faults")])
    return tuple(FaultAxes(first + 4 * k, tuple(possible), begin) for k in range(searched.count))
