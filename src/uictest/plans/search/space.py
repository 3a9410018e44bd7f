"""The space of a search: vectors of the unit cube, and the values that they stand for, as written."""

from __future__ import annotations

import math
import re
from collections.abc import Iterator, Mapping, Sequence
from contextlib import suppress
from dataclasses import dataclass, replace
from functools import cached_property
from pathlib import Path
from typing import Any, Final, NamedTuple

from uictest.core import files
from uictest.core.units import in_unit
from uictest.plans import library
from uictest.plans.faults import Effects, FaultKind
from uictest.plans.scenario import (
    EXPANSION_KEYS,
    Case,
    Files,
    LoadedCase,
    Parts,
    Roots,
    Scenario,
    ScenarioErrors,
    Search,
    fault_name,
    is_path,
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
from uictest.plans.sweeps import value_at

Point = tuple[str, ...]
"""One value as written for each column of a space; empty: nominal, and for a fault none."""
NOMINAL: Final = ""
FRICTION: Final = "rail.friction"


class Axis(NamedTuple):
    """Numbers from `low` to `high` in a unit.

    `origin` is the number around which the orders of magnitude are as likely as each other, down to a
    thousandth of the range; None: all numbers are.
    """

    name: str
    low: float
    high: float
    unit: str
    origin: float | None = None
    whole: bool = False

    def text_at(self, share: float) -> str:
        """Return the value at a share of the range, 0 to 1, rounded to about a thousandth of it."""
        if self.origin is None:
            return self.text(self.low + share * (self.high - self.low), 3)
        lowest, highest = -float(self.low < self.origin), float(self.origin < self.high)
        signed = lowest + share * (highest - lowest)
        farthest = self.high - self.origin if signed > 0.0 else self.origin - self.low
        return self.text(self.origin + math.copysign(farthest * 1e-3 ** (1.0 - abs(signed)), signed))

    def text(self, number: float, digits: int = 5) -> str:
        """Return a number as written, kept to the range, with some digits of its width."""
        places = 0 if self.whole else max(digits - math.floor(math.log10(self.high - self.low)), 0)
        text = f"{round(min(max(number, self.low), self.high), places) + 0.0:.{places}f}"
        text = text.rstrip("0").rstrip(".") if "." in text else text
        return f"{text} {self.unit}".rstrip()


class FaultAxes(NamedTuple):
    """The four columns of a fault: kind, wheelset, beginning, size; `first` is the index of the kind."""

    first: int
    kinds: tuple[FaultKind, ...]
    begin: Axis

    @property
    def columns(self) -> range:
        """The indices of the columns."""
        return range(self.first, self.first + 4)

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
        kind = self.kind(name)
        assert kind.value is not None
        value, unit = kind.value, parse_decimal_quantity(kind.value.at_most).unit
        ends = (float(parse_quantity(end, value.kind)) for end in (value.at_least, value.at_most))
        low, high = (round(in_unit(end, unit or "1"), 12) for end in ends)
        sizes = {
            each: float(parse_quantity(f"{each} {unit}".rstrip(), value.kind)) for each in (0.0, 1.0, 100.0)
        }
        harmless = (number for number, size in sizes.items() if kind.effects(size) == Effects())
        return Axis("size", low, high, unit, next(harmless, None), whole=not unit)

    def kind(self, name: str) -> FaultKind:
        """Return the kind of a name."""
        return next(kind for kind in self.kinds if fault_name(kind) == name)


@dataclass(frozen=True)
class Space:
    """The space of a search.

    Args:
        loaded: the scenario, with the tree that its stops are resolved from.
        search: its section.
        trusted: folders that scenarios may refer to.
        parts: resolves parts.
        axes: the numbers: those of `ranges`, then those of the profile.
        friction: that of the scenario, which a point of the profile has that is nominal.
        faults: the faults.

    """

    loaded: LoadedCase
    search: Search
    trusted: tuple[Path, ...]
    parts: Parts
    axes: tuple[Axis, ...] = ()
    friction: str = ""
    faults: tuple[FaultAxes, ...] = ()

    @cached_property
    def columns(self) -> tuple[str, ...]:
        """Name of each column, which is a dimension of the space, too."""
        words = ("fault", "wheelset", "from", "size")
        of_faults = (f"{word} {number}" for number in range(1, len(self.faults) + 1) for word in words)
        return (*(axis.name for axis in self.axes), *of_faults)

    @property
    def name(self) -> str:
        """Name of the scenario."""
        return self.loaded.case.scenario.name

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
        faults = (text for axes in self.faults for text in axes.texts_at([vector[k] for k in axes.columns]))
        return (*numbers, *faults)

    def axis_of(self, point: Point, column: int) -> Axis | None:
        """Return the numbers of a column of a point; None where it has none."""
        if column < len(self.axes):
            return self.axes[column]
        axes = self.faults[(column - len(self.axes)) // 4]
        if column == axes.first + 2:
            return axes.begin
        has_size = column == axes.first + 3 and point[column] != NOMINAL
        return axes.size_axis(point[axes.first]) if has_size else None

    def contents(self, point: Point) -> dict[str, Any]:
        """Return the values that are not nominal, by dotted key, as a file has them."""
        ranged = zip(self.search.ranges, point, strict=False)
        contents: dict[str, Any] = {key: scalar_value(text) for key, text in ranged if text != NOMINAL}
        if any(point[k] for k in self.profile):
            points = [
                {
                    "position": self.axes[k].name.partition(" at ")[2],
                    "friction": float(point[k] or self.friction),
                }
                for k in self.profile
            ]
            alike = len({each["friction"] for each in points}) == 1
            contents[FRICTION] = points[0]["friction"] if alike else {"points": points}
        if faults := [self._fault(axes, point) for axes in self.faults if point[axes.first] != NOMINAL]:
            own = self.loaded.tree.get("faults")
            contents["faults"] = [*(plain(own) if isinstance(own, List) else ()), *faults]
        return contents

    def numbers_off_nominal(self, point: Point) -> list[tuple[str, str]]:
        """Return name and value of the numbers that are not nominal; an even profile is one.

        The name is the last of the key, the whole key where that is another's, too, or in a list.
        """
        last = [key.rpartition(".")[2] for key in self.search.ranges]
        names = [
            key if last.count(name) > 1 or re.search(r"\.\d+\.", key) else name.replace("_", " ")
            for key, name in zip(self.search.ranges, last, strict=True)
        ]
        profile = [(self.axes[column].name, point[column]) for column in self.profile]
        if len({text for _, text in profile}) == 1:
            profile = [("friction", profile[0][1])]
        numbers = (*zip(names, point, strict=False), *profile)
        return [(name, text) for name, text in numbers if text != NOMINAL]

    def off_nominal(self, point: Point) -> int:
        """Return how many values of a point are not nominal; a fault is one."""
        of_faults = sum(point[axes.first] != NOMINAL for axes in self.faults)
        return of_faults + len(self.numbers_off_nominal(point))

    def _fault(self, axes: FaultAxes, point: Point) -> dict[str, Any]:
        name, wheelset, begin, size = (point[k] for k in axes.columns)
        kind = axes.kind(name)
        fault: dict[str, Any] = {"part": kind.part, "kind": kind.name}
        fault |= {"wheelset": int(wheelset)} if wheelset else {}
        fault["at"] = begin or axes.begin.text(axes.begin.low)
        return fault | ({"value": scalar_value(size)} if size else {})

    def case(self, point: Point, seed: int = 0) -> Case:
        """Return the case at a point under one of its seeds, from 0. Raises ScenarioErrors: it is refused."""
        return self.with_contents(self.contents(point), seed)

    def with_contents(self, contents: Mapping[str, Any], seed: int = 0) -> Case:
        """Return the case with other values at dotted keys. Raises ScenarioErrors."""
        scenario, _ = resolve(self._tree(contents), self.parts)
        own = {"seed": scenario.seed + seed, "repeat": 1}
        return replace(self.loaded.case, scenario=scenario.model_copy(update=own))

    def scenario(self, point: Point, folder: Path) -> dict[str, Any]:
        """Return the keys of a scenario in `folder` that extends this one and has the values of a point."""
        case, tree = self.loaded.case, self._tree(self.contents(point))
        begin = {"extends": files.relative_path(case.path, folder), "search": None}
        begin |= dict.fromkeys(EXPANSION_KEYS) if case.parameters else {}
        changes: dict[str, Any] = _changes(self.loaded.written, tree, folder)
        return begin | changes

    def _tree(self, contents: Mapping[str, Any]) -> Map:
        tree = self.loaded.tree
        for key in sorted(contents, key=lambda key: key.count(".")):
            location = self.location_of(key)
            tree = with_value(tree, key, Entry(location, _node(contents[key], location)))
        return tree

    def location_of(self, key: str = "") -> Location:
        """Return the location of a key of `ranges`, of other keys that of the section."""
        section = self.loaded.search
        assert section is not None
        ranges = section.node.get("ranges") if isinstance(section.node, Map) else None
        return ranges.entries[key].key if isinstance(ranges, Map) and key in ranges.entries else section.key


def _node(content: Any, location: Location) -> Node:
    """Return plain content as a tree, all of it at one location."""
    if isinstance(content, Mapping):
        entries = {key: Entry(location, _node(value, location)) for key, value in content.items()}
        return Map(entries, location)
    if isinstance(content, list | tuple):
        return List(tuple(_node(each, location) for each in content), location)
    return Scalar(content, str(content), location)


def _changes(before: Node | None, after: Node, folder: Path) -> Any:
    """Return what a file in `folder` that extends `before` has to say to be `after`, as plain content."""
    if isinstance(after, Map):
        own = before.entries if isinstance(before, Map) else {}
        changed = {
            key: each.node
            for key, each in after.entries.items()
            if key not in own or own[key].node != each.node
        }
        return {
            key: _changes(own[key].node if key in own else None, node, folder)
            for key, node in changed.items()
        }
    if isinstance(after, List):
        return [_changes(None, item, folder) for item in after.items]
    if isinstance(after.value, str) and is_path(after.value):
        return files.relative_path(after.location.document.folder / after.value, folder)
    return float(after.value) if isinstance(after.value, float) else after.value


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
    parts = Parts(Files(Roots.of([path], trusted)))
    cases = load_with_trees(path, parse_overrides(overrides, None), parts)
    loaded, entry = cases[0], cases[0].search
    if entry is None:
        hint = (
            "say where to search: search: {criteria: [locked-wheels], ranges: {rail.friction: [0.05, 0.20]}}"
        )
        raise single_error(whole_file(path), "the scenario has no 'search'", "search", hint)
    if len(cases) > 1:
        what = "the cars of a train" if loaded.case.train is not None else f"{len(cases)} cases"
        hint = "a search is of one car alone, with one value at each key: --set KEY=VALUE chooses"
        raise single_error(entry.key, f"the scenario has {what}", "search", hint)
    search = validated(Search, plain(entry.node), entry.node, ("search",))
    given_instead = {"seed": seed, "stops": stops}
    search = search.model_copy(update={key: each for key, each in given_instead.items() if each is not None})
    space = Space(loaded, search, tuple(trusted), parts)
    _require_criteria(space)
    space = _with_profile(replace(space, axes=tuple(_axes_of_ranges(space))))
    return replace(space, faults=_fault_axes(space, len(space.axes)))


def searches_in(paths: Sequence[Path], trusted: Sequence[Path]) -> list[Diagnostic]:
    """Return the errors of the searches of scenario files at or below paths."""
    diagnostics: list[Diagnostic] = []
    folders = [path for path in paths if path.is_dir()]
    for path, tree in scenario_trees(paths, Files(Roots.of(paths, trusted)), []):
        search = tree.entries.get("search")
        if search is not None and not (isinstance(search.node, Scalar) and search.node.value is None):
            with collecting(diagnostics, whole_file(path)):
                load_search(path, trusted=(*trusted, *folders))
    return diagnostics


def _require_criteria(space: Space) -> None:
    """Raise ScenarioErrors for a criterion that does not judge the scenario, or checks the rig."""
    known = {
        criterion.id: criterion.measure
        for profile in space.loaded.case.scenario.judged_by
        for criterion in profile.criteria
        if criterion.layer in ("requirement", "validity")
    }
    for name in space.search.criteria:
        if name not in known:
            message = f"{quoted(name)} is no criterion of this scenario"
            raise single_error(space.location_of(), message, "search.criteria", suggestion(name, known))
        if known[name] == "standstill":
            message = (
                f"{quoted(name)} cannot be searched: a stop that does not end is inconclusive, not a failure"
            )
            raise single_error(
                space.location_of(), message, "search.criteria", "search distance-over-reference"
            )


def _axes_of_ranges(space: Space) -> Iterator[Axis]:
    """Yield the numbers of `ranges`. Raises ScenarioErrors for a key or a unit that is refused."""
    scenario = space.loaded.case.scenario
    for key, (low, high) in space.search.ranges.items():
        examples = [space.with_contents({key: scalar_value(str(low))}).scenario, scenario]
        numbers = [number for each in examples if (number := _number_at(each, key)) is not None]
        if not numbers:
            message = f"{quoted(key)} is not a number"
            raise single_error(space.location_of(), message, f"search.ranges.{key}")
        whole = isinstance(numbers[-1], int)  # as the scenario has it: `[0, 1]` may bound a float
        yield Axis(key, float(low.number), float(high.number), low.unit, whole=whole)


def _number_at(scenario: Scenario, key: str) -> Quantity | float | int | None:
    with suppress(KeyError):  # a number for a controller from outside, which has it from nowhere else
        value = value_at(scenario, key)
        return value if isinstance(value, Quantity | float | int) and not isinstance(value, bool) else None
    return None


def _with_profile(space: Space) -> Space:
    """Return the space with the friction along the track. Raises ScenarioErrors."""
    profile, rail = space.search.profile, space.loaded.case.scenario.rail
    if profile is None:
        return space
    friction = rail.condition.friction if rail.friction is None else rail.friction
    if not isinstance(friction, int | float):
        message = f"`{FRICTION}` of the scenario is not one number, to which shrinking could go back"
        raise single_error(space.location_of(), message, "search.profile", f"write {FRICTION}: 0.10")
    low, high = (float(bound.number) for bound in profile.friction)
    spacing = parse_decimal_quantity(profile.spacing.text)
    names = (f"friction at {k * spacing.number:f} {spacing.unit}" for k in range(profile.points))
    axes = (*space.axes, *(Axis(name, low, high, "") for name in names))
    return replace(space, axes=axes, friction=f"{float(friction):.10g}")


def _fault_axes(space: Space, first: int) -> tuple[FaultAxes, ...]:
    """Return the faults, of the kinds that the car can have. Raises ScenarioErrors where it can have none."""
    searched = space.search.faults
    if searched is None:
        return ()
    low, high = searched.begin
    begin = Axis("from", float(low.number), float(high.number), low.unit)
    rows = {fault_name(kind): kind for name in searched.kinds for kind in kinds_named(name)}
    problems: list[Diagnostic] = []
    possible = []
    for kind in rows.values():
        with collecting(problems, space.location_of()):
            axes = FaultAxes(first, (kind,), begin)
            replace(space, faults=(axes,)).case((*space.nominal, *axes.texts_at((0.0, 0.0, 0.0, 0.6))))
            possible.append(kind)
    if not possible:
        raise ScenarioErrors(problems)
    return tuple(FaultAxes(first + 4 * k, tuple(possible), begin) for k in range(searched.count))
