"""A programme: tests from several speeds and positions, each with a limit of its own, shown in one table."""

from __future__ import annotations

from collections.abc import Iterator, Mapping, Sequence
from dataclasses import dataclass, replace
from pathlib import Path
from typing import Annotated, Any, Final, Literal, NamedTuple

from pydantic import Field

from uictest.plans.scenario import (
    Case,
    Expectation,
    Files,
    NamedFile,
    Override,
    Roots,
    Scenario,
    parse_overrides,
)
from uictest.plans.scenario.yaml import (
    PROGRAMME_SCHEMA,
    Diagnostic,
    Inconsistency,
    List,
    Map,
    Model,
    Quantity,
    Scalar,
    diagnose,
    display_name,
    entry_at,
    field,
    of_kind,
    optional,
    plain,
    quoted,
    read_each,
    read_file,
    require_none,
    require_schema,
    single_error,
    suggestion,
    validated,
)
from uictest.plans.series.stops import read_entry, values_set_by

FRICTION: Final = "rail.friction"
"""The key along which it is sought where a test is valid and met."""
_Distance = Annotated[Quantity, of_kind("length", "1 m .. 100 km")]
_Friction = Annotated[Quantity, of_kind("number", "0.001 .. 1")]
_Name = Annotated[str, Field(pattern=r"^[a-z0-9][a-z0-9-]{0,39}$")]


class DistanceLimit(Model):
    """Between which distances a test must stop, both excluded; or at most a share of another test's."""

    above: _Distance | None = optional("Distance that must be exceeded.")
    below: _Distance | None = optional("Distance that must not be reached.")
    at_most: Annotated[Quantity, of_kind("share", "100 % .. 1000 %")] | None = optional(
        "Largest distance as a share of the mean distance of the test that `of` names."
    )
    of: _Name | None = optional("Name of the test whose distance `at_most` is a share of.")

    def inconsistencies(self) -> Iterator[Inconsistency]:
        """Yield a limit without a distance, in the wrong order, or of nothing."""
        if (self.at_most is None) != (self.of is None):
            yield Inconsistency((), "`at_most` and `of` belong together", "write {at_most: 150 %, of: NAME}")
        elif self.above is None and self.below is None and self.at_most is None:
            yield Inconsistency((), "a limit without a distance", "write {below: 700 m}, or leave it out")
        if self.at_most is not None and (self.above is not None or self.below is not None):
            yield Inconsistency(("at_most",), "a share and distances are two limits", "keep one of them")
        if self.above is not None and self.below is not None and self.above >= self.below:
            yield Inconsistency(("above",), f"{self.above.text} is not below {self.below.text}")


class ProgrammeTest(Model):
    """One test of a programme: a stop, how often it is repeated, and its limit."""

    name: _Name = field("Name of the test: lower-case letters, digits and dashes.")
    title: str = field("The test as the table shows it.", default="", max_length=60)
    scenario: str = field("Relative path of the scenario, or one that ships.")
    set: dict[str, Any] = field("Values by dotted key of the scenario.", default={})
    stops: Annotated[int, Field(ge=1, le=100, strict=True)] = field(
        "How many stops are made, under this seed and those that follow it.", default=1
    )
    distance: DistanceLimit | None = optional("Limit of the braking distance; none if left out.")
    note: str = field("What is to be said of the test.", default="", max_length=300)


class FrictionScan(Model):
    """Frictions and rails over which it is sought where a test on a slippery rail is valid and met."""

    values: tuple[_Friction, ...] = field("Friction coefficients, rising.", min_length=2, max_length=64)
    rails: tuple[str, ...] = field("Rail conditions.", min_length=1, max_length=16)

    def inconsistencies(self) -> Iterator[Inconsistency]:
        """Yield frictions out of order."""
        for index, (before, after) in enumerate(zip(self.values, self.values[1:], strict=False), start=1):
            if after <= before:
                yield Inconsistency(("values", index), f"{after.text} does not exceed {before.text}")
        for index, rail in enumerate(self.rails):
            if rail in self.rails[:index]:
                yield Inconsistency(("rails", index), f"{quoted(rail)} appears twice", "remove one")


class ProgrammeFile(NamedFile):
    """Tests that are shown in one table."""

    schema_id: Literal["uictest/programme/1"] = field(
        "What the file holds: uictest/programme/1.", alias="schema"
    )
    description: str = field("What it is for.", default="", max_length=5000)
    mark: str = field("Where the limits come from, in a few words.", max_length=200)
    notes: tuple[str, ...] = field("What is to be said below the table.", default=())
    set: dict[str, Any] = field("Values by dotted key of the scenarios, for all tests.", default={})
    tests: tuple[ProgrammeTest, ...] = field(
        "The tests, in the order of the table.", min_length=1, max_length=64
    )
    friction: FrictionScan | None = optional("Where it is sought that a test on a slippery rail is met.")

    def inconsistencies(self) -> Iterator[Inconsistency]:
        """Yield tests of one name, and limits of tests that are not there."""
        names = [test.name for test in self.tests]
        for index, test in enumerate(self.tests):
            if test.name in names[:index]:
                yield Inconsistency(("tests", index, "name"), f"a second test {quoted(test.name)}")
            of = None if test.distance is None else test.distance.of
            if of is not None and (of not in names or of == test.name):
                hint = suggestion(of, [name for name in names if name != test.name])
                yield Inconsistency(("tests", index, "distance", "of"), f"no other test {quoted(of)}", hint)


class RailStops(NamedTuple):
    """The stops of a test on another rail, one repeated case, whose friction is varied."""

    rail: str
    case: Case


@dataclass(frozen=True, slots=True)
class PlannedTest:
    """A test of a programme with its stops.

    Args:
        test: what the file says of it.
        stops: one case for each stop.
        scanned: its stops on each rail on which it is sought where it is met; none on a dry rail and
            without a limit.
        frictions: at which they are made there, rising.

    """

    test: ProgrammeTest
    stops: tuple[Case, ...]
    scanned: tuple[RailStops, ...] = ()
    frictions: tuple[Quantity, ...] = ()


@dataclass(frozen=True, slots=True)
class Programme:
    """A programme of tests: its file, as shown to users, and what it says."""

    path: Path
    file: ProgrammeFile
    tests: tuple[PlannedTest, ...]
    inputs: Mapping[str, str]

    @property
    def cases(self) -> list[Case]:
        """The stops of all tests."""
        return [case for planned in self.tests for case in planned.stops]


def load_programme(
    path: Path, overrides: Sequence[str] = (), seed: int | None = None, trusted: Sequence[Path] = ()
) -> Programme:
    """Return the programme of a file.

    Args:
        path: a ``*.programme.yaml``.
        overrides: ``key=value`` texts for the scenarios of all tests, one value each, at keys that no test
            sets itself.
        seed: of the first stop of every test.
        trusted: folders that references may lead into, besides that of the file and the working folder.

    Raises:
        ScenarioErrors: with all errors of the file, or of the scenarios that it names.

    """
    files = Files(Roots.of([path], trusted))
    tree = read_file(path, PROGRAMME_SCHEMA)
    require_schema(tree, PROGRAMME_SCHEMA)
    file: ProgrammeFile = validated(ProgrammeFile, plain(tree), tree)
    last = parse_overrides(overrides, seed)
    require_none(_unsuitable_overrides(file, last))
    nodes = tree.get("tests")
    assert isinstance(nodes, List)
    reader = _TestReader(Path(display_name(path)), file, files, [*values_set_by(tree, swept=False)], last)
    tests = read_each(lambda pair: reader.planned(*pair), zip(file.tests, nodes.items, strict=True))
    document = tree.location.document
    inputs = {document.display: document.sha256} if document.sha256 else {}
    for case in (case for test in tests for case in test.stops):
        inputs |= case.inputs
    return Programme(Path(display_name(path)), file, tuple(tests), inputs)


def _unsuitable_overrides(file: ProgrammeFile, overrides: Sequence[Override]) -> Iterator[Diagnostic]:
    """Yield keys with several values, and those that tell the tests apart."""
    for each in overrides:
        if len(each.values) != 1:
            message = f"{each.key} has {len(each.values)} values"
            yield diagnose(each.location, message, each.key, "a programme takes one: run it for each")
        by_test = [test.name for test in file.tests if any(_overlap(each.key, key) for key in test.set)]
        if by_test:
            message = f"the test {quoted(by_test[0])} sets {each.key} itself"
            yield diagnose(each.location, message, each.key, "change a copy of the file")


def _overlap(key: str, other: str) -> bool:
    """Return whether one of two dotted keys is the other, or a part of what the other sets."""
    return f"{key}.".startswith(f"{other}.") or f"{other}.".startswith(f"{key}.")


class _TestReader(NamedTuple):
    path: Path
    file: ProgrammeFile
    files: Files
    common: Sequence[Override]
    last: Sequence[Override]

    def planned(self, test: ProgrammeTest, node: Any) -> PlannedTest:
        first = self._case(test, node, self.last)
        stops = [
            _stop_of(first, f"{first.id}[stop={number}]" if test.stops > 1 else first.id, number - 1)
            for number in range(1, test.stops + 1)
        ]
        scan = self.file.friction
        is_dry = first.scenario.rail.condition.name == "dry"
        if scan is None or is_dry or test.distance is None or isinstance(first.scenario.rail.friction, Model):
            return PlannedTest(test, tuple(stops))
        on_rails = [self._case(test, node, [*self.last, *self._on_rail(node, rail)]) for rail in scan.rails]
        scanned = [
            RailStops(rail, case.with_values(repeat=test.stops, test_validity="measured"))
            for rail, case in zip(scan.rails, on_rails, strict=True)
        ]
        return PlannedTest(test, tuple(stops), tuple(scanned), scan.values)

    def _case(self, test: ProgrammeTest, node: Any, last: Sequence[Override]) -> Case:
        """Return the one case of a test, in which everything may be missed: the programme judges."""
        stop = read_entry(node, "tests", self.files, self.common, last)
        if len(stop.cases) != 1 or stop.cases[0].train is not None:
            message = f"{quoted(test.name)} is {len(stop.cases)} cases; a test is one stop of a car alone"
            raise single_error(stop.reference.location, message, "scenario")
        case = stop.cases[0]
        if case.scenario.repeat > 1:
            message = f"{quoted(test.name)} repeats its stop {case.scenario.repeat} times"
            raise single_error(
                stop.reference.location, message, "repeat", "write `stops` of the test instead"
            )
        ends_early = case.scenario.drag is not None or case.scenario.until is not None
        if test.distance is not None and ends_early:
            message = f"{quoted(test.name)} is not braked to standstill, so that it has no braking distance"
            raise single_error(stop.reference.location, message, "distance", "leave out `distance`")
        return replace(case, id=f"{self.file.name}.{test.name}", path=self.path).changed(_judged_by_programme)

    def _on_rail(self, node: Map, rail: str) -> Iterator[Override]:
        assert self.file.friction is not None
        entry, _ = entry_at(node, ("scenario",))
        for key, text in (("rail.condition", rail), (FRICTION, self.file.friction.values[0].text)):
            yield Override(key, entry.key, (Scalar(text, text, entry.key),))


def _stop_of(case: Case, case_id: str, further: int) -> Case:
    seed = case.scenario.seed + further
    return replace(case, id=case_id).with_values(seed=seed)


def _judged_by_programme(scenario: Scenario) -> Scenario:
    """Return the scenario of a test: all of its criteria may be missed, and the rail is looked at as well.

    A stop that cannot be run and one that fails a check of the rig stay errors and failures.
    """
    of_layer = {
        layer: tuple(
            criterion.id
            for profile in scenario.criteria
            for criterion in profile.criteria
            if criterion.layer == layer and not criterion.needs_series
        )
        for layer in ("requirement", "validity")
    }
    outcome: Literal["fail", "invalid"] = "fail" if of_layer["requirement"] else "invalid"
    expect = Expectation(outcome, of_layer["requirement"], of_layer["validity"], is_allowance=True)
    return scenario.model_copy(update={"expect": expect, "repeat": 1, "test_validity": "both"})
