"""What a search has found: the sentence, the scenario that runs alone, and how much the stops exclude."""

from __future__ import annotations

import math
import statistics
from collections.abc import Mapping, Sequence
from dataclasses import dataclass
from pathlib import Path
from typing import Any, Final

import yaml

from uictest.core import files
from uictest.core.units import value_text
from uictest.judging.evaluation import CaseResult, is_expected, json_form, missed_requirements
from uictest.plans import library
from uictest.plans.scenario import EXPANSION_KEYS, Expectation, is_path
from uictest.plans.scenario.yaml import List, Map, Node, Scalar, plain
from uictest.plans.search import NOMINAL, Point, Space
from uictest.searching.engine import Findings
from uictest.searching.shrinking import Neighbour, Shrinking
from uictest.searching.trials import ERROR, Stop, Trials

SCHEMA: Final = "uictest/search/1"


@dataclass(frozen=True)
class FoundCase:
    """A case that fails, made as small as possible.

    Args:
        target: criterion that it fails, or `error` where its controller does.
        values: the values that are not nominal, by dotted key, as a file has them.
        off_nominal: how many values are not nominal; a fault is one.
        failing: in how many stops it fails.
        stops: of so many under different seeds.
        sentence: what fails, and beside which values it does not.
        text: the scenario.

    """

    target: str
    values: dict[str, Any]
    off_nominal: int
    failing: int
    stops: int
    sentence: str
    text: str


@dataclass(frozen=True)
class SearchOutcome:
    """What a search has come to.

    Args:
        name: of the scenario.
        criteria: that were searched.
        found: the cases, each smaller one once.
        findings: of the search, before it was made smaller.
        stops: simulated until the search ended; those of shrinking come on top.
        all_stops: all that were simulated.
        folder: with the files; None where none were written.
        page: of the found cases; None where there is none.

    """

    name: str
    criteria: tuple[str, ...]
    found: tuple[FoundCase, ...]
    findings: Findings
    stops: int
    all_stops: int
    folder: Path | None = None
    page: Path | None = None

    @property
    def lines(self) -> list[str]:
        """The answer in words: what was found, or what the stops exclude."""
        lines = [f"found: {case.sentence}" for case in self.found]
        left = [criterion for criterion in self.criteria if criterion not in self.findings.found]
        for criterion in left:
            margin = self.findings.margins.get(criterion, math.inf)
            known = math.isfinite(margin)
            nearest = f"smallest margin {margin:.3g} (fails below 0)" if known else "it judged no stop"
            lines.append(f"{criterion}: nothing found; {nearest}")
        if left:
            share, by_these = self.findings.largest_share, " by what was not found" if self.found else ""
            lines.append(
                f"At most {100.0 * share:.2g} % of the searched space fails{by_these} (95 %): none of"
                f" {self.findings.random} random points did"
            )
        refused = f"; {self.findings.refused} points could not be run" if self.findings.refused else ""
        shrinking = self.all_stops - self.stops
        more = f" and {shrinking} to make it small" if shrinking else ""
        return [*lines, f"{self.stops} stops{more}{refused}"]

    def document(self) -> dict[str, Any]:
        """Return the outcome as JSON; a margin that no stop has is None."""
        findings = self.findings
        content = {
            "schema": SCHEMA,
            "name": self.name,
            "criteria": list(self.criteria),
            "stops": self.stops,
            "stops_of_shrinking": self.all_stops - self.stops,
            "random_points": findings.random,
            "refused_points": findings.refused,
            "largest_failing_share": findings.largest_share,
            "smallest_margins": findings.margins,
            "found_after_stops": findings.found_after,
            "found": [
                {name: value for name, value in vars(case).items() if name != "text"} for case in self.found
            ],
        }
        form: dict[str, Any] = json_form(content)
        return form


def shrunk_cases(trials: Trials, findings: Findings, path: Path, folder: Path) -> list[FoundCase]:
    """Return the found cases of the search at `path` made small, each once, as files of `folder`."""
    cases: list[FoundCase] = []
    known: set[tuple[str, frozenset[int], tuple[str, ...]]] = set()
    for target, points in findings.found.items():
        shrinking = Shrinking(trials, target)
        for point in points:
            small = shrinking.smallest(point)
            changed = frozenset(column for column, text in enumerate(small) if text != NOMINAL)
            kinds = tuple(small[axes.first] for axes in trials.space.faults)
            if (target, changed, kinds) not in known:
                known.add((target, changed, kinds))
                cases.append(_found_case(shrinking, small, len(cases) + 1, path, folder))
    return cases


def _found_case(shrinking: Shrinking, point: Point, number: int, path: Path, folder: Path) -> FoundCase:
    space, target = shrinking.trials.space, shrinking.target
    failing, stops = shrinking.failing(point), space.search.fails_in.stops
    neighbours = shrinking.neighbours(point)
    own = [Stop(point, seed, own_noise=True) for seed in range(stops)]
    results = [result for result in shrinking.trials.simulate(own) if result is not None]
    sentence = _sentence(shrinking, point, failing, neighbours, results)
    content = _scenario(space, point, number, path, folder, sentence) | _expectation(space, target, results)
    text = yaml.safe_dump(content, sort_keys=False, allow_unicode=True, width=110)
    of_faults = sum(point[axes.first] != NOMINAL for axes in space.faults)
    numbers = _distinct_numbers(space, point)
    return FoundCase(target, space.contents(point), of_faults + len(numbers), failing, stops, sentence, text)


def _distinct_numbers(space: Space, point: Point) -> dict[str, str]:
    """Return the numbers that are not nominal, by the last name of their key; an even profile is one."""
    numbers = {axis.name: text for axis, text in zip(space.axes, point, strict=False) if text != NOMINAL}
    profile = [point[column] for column in space.profile]
    if profile and NOMINAL not in profile and len(set(profile)) == 1:
        numbers = {name: text for name, text in numbers.items() if not name.startswith("friction at ")}
        numbers["friction"] = profile[0]
    return {name.rpartition(".")[2].replace("_", " "): text for name, text in numbers.items()}


def _sentence(
    shrinking: Shrinking,
    point: Point,
    failing: int,
    neighbours: Sequence[Neighbour],
    results: Sequence[CaseResult],
) -> str:
    """Return what fails, how often, and beside which values it does not."""
    space, target = shrinking.trials.space, shrinking.target
    words = [_fault_text(point[axes.first : axes.first + 4]) for axes in space.faults if point[axes.first]]
    words += [f"{name} {text}" for name, text in _distinct_numbers(space, point).items()]
    conditions = ", ".join(words) or "the scenario as it is"
    counted = f"in {failing} of {space.search.fails_in.stops} stops"
    if target == ERROR:
        reason = next(result.reason for result in results if result.outcome == "error")
        return f"{conditions}: {reason}, {counted}"
    verdicts = [verdict for each in results for verdict in each.decided if verdict.id == target]
    values = [each.value for each in verdicts if each.status == "fail" and each.value is not None]
    value = f" {value_text(statistics.median(values), verdicts[0].unit)}" if values else " missed"
    passes = f"; passes at {' and '.join(each.text for each in neighbours)}" if neighbours else ""
    return f"{conditions}: {target}{value} {counted}{passes}"


def _fault_text(fault: Sequence[str]) -> str:
    """Return a fault in words: `speed sensor offset of wheelset 1, 11 km/h`."""
    name, wheelset, begin, size = fault
    words = name.replace("-", " ") + (f" of wheelset {wheelset}" if wheelset else "")
    signed = size if not size or size.startswith("-") else f"+{size}" if "offset" in name else size
    return ", ".join(filter(None, [f"{words} {signed}".rstrip(), f"from {begin} on" if begin else ""]))


def _scenario(
    space: Space, point: Point, number: int, path: Path, folder: Path, sentence: str
) -> dict[str, Any]:
    """Return what the scenario of a point says, but for what it expects."""
    ships = library.named_scenario(path) != path
    case = space.loaded.case
    content: dict[str, Any] = {
        "schema": "uictest/scenario/1",
        "name": f"{case.scenario.name[:80]}-found-{number}",
        "title": sentence[:200],
        "extends": path.as_posix() if ships else files.relative_path(path, folder),
        "search": None,
        **(dict.fromkeys(EXPANSION_KEYS) if case.parameters else {}),
    }
    overridden = {each.key: plain(each.values[0]) for each in space.overrides}
    for key, value in {**case.parameters, **overridden, **space.contents(point)}.items():
        _assign(content, space.loaded.tree, key.split("."), value, folder)
    return content


def _assign(content: Any, node: Node | None, names: Sequence[str], value: Any, folder: Path) -> None:
    """Set a value at a dotted key of the plain content of a scenario, whose parent has `node` there."""
    name, *below = names
    key: Any = int(name) if isinstance(content, list) else name
    if not below:
        content[key] = _plain(value)
        return
    inner = node.get(name) if isinstance(node, Map) else None
    if isinstance(content, dict) and key not in content:
        content[key] = _begun(inner, folder)
    _assign(content[key], inner, below, value, folder)


def _begun(node: Node | None, folder: Path) -> Any:
    """Return what a value is set in: the list, which replaces its parent's; a part that extends its name."""
    if isinstance(node, List):
        return _plain(plain(node))
    if not isinstance(node, Scalar) or not isinstance(node.value, str):
        return {}
    reference = node.text
    if is_path(reference):
        reference = files.relative_path(node.location.document.folder / reference, folder)
    return {"extends": reference}


def _plain(content: Any) -> Any:
    """Return content as YAML writes it: lists, and floats without their text."""
    if isinstance(content, Mapping):
        return {key: _plain(value) for key, value in content.items()}
    if isinstance(content, list | tuple):
        return [_plain(value) for value in content]
    return float(content) if isinstance(content, float) else content


def _expectation(space: Space, target: str, results: Sequence[CaseResult]) -> dict[str, Any]:
    """Return what the scenario expects: all criteria that its stops miss, in as many stops as are asked for.

    A controller that fails is never expected. Where too few stops miss the same, the first that fails is the
    one stop of the scenario.
    """
    if target == ERROR:
        return {"repeat": 1, "expect": "pass"}
    fails_in, failing = space.search.fails_in, [each for each in results if _misses(each, target)]
    expect = _named(failing)
    met = [is_expected(each.outcome, each.decided, expect) for each in results]
    if sum(met) >= fails_in.needed:
        share = f"{100.0 * fails_in.needed / fails_in.stops:.6g} %"
        return {
            "seed": space.loaded.case.scenario.seed,
            "repeat": fails_in.stops,
            "outcome_of_repeats": {"at_least": share},
            "expect": expect.form(),
        }
    first = next(index for index, each in enumerate(results) if _misses(each, target))
    seed = space.loaded.case.scenario.seed + first
    return {"seed": seed, "repeat": 1, "expect": _named([results[first]]).form()}


def _misses(result: CaseResult, target: str) -> bool:
    return any(verdict.id == target and verdict.status == "fail" for verdict in result.decided)


def _named(results: Sequence[CaseResult]) -> Expectation:
    """Return the expectation that names what results miss: of validity only what most of them do."""
    requirements = [verdict.id for each in results for verdict in missed_requirements(each.decided)]
    validity = [
        verdict.id
        for each in results
        for verdict in each.decided
        if verdict.layer == "validity" and verdict.status == "fail"
    ]
    frequent = [name for name in dict.fromkeys(validity) if 2 * validity.count(name) > len(results)]
    fail = tuple(dict.fromkeys(requirements))
    return Expectation("fail" if fail else "invalid", fail, tuple(frequent))
