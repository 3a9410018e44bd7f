"""What a search has found: the sentence, the scenario that runs alone, and how much the stops exclude."""

from __future__ import annotations

import math
import statistics
from collections.abc import Mapping, Sequence
from dataclasses import asdict, dataclass
from pathlib import Path
from typing import Any, Final

import yaml

from uictest import runs
from uictest.core.units import value_text
from uictest.judging.evaluation import CaseResult, is_expected, json_form, missed_requirements
from uictest.plans.scenario import Expectation
from uictest.plans.search import NOMINAL, Point, Space
from uictest.searching.engine import Engine, Findings
from uictest.searching.shrinking import Shrinking
from uictest.searching.trials import ERROR, Stop

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
        stops: simulated until the search ended.
        stops_of_shrinking: simulated to make the cases small.
        folder: with the files; None where none were written.
        page: of the found cases; None where there is none.

    """

    name: str
    criteria: tuple[str, ...]
    found: tuple[FoundCase, ...]
    findings: Findings
    stops: int
    stops_of_shrinking: int
    folder: Path | None = None
    page: Path | None = None

    @property
    def judges_nothing(self) -> bool:
        """Whether a criterion judged no stop at all, so that nothing is known of it."""
        found, margins = self.findings.found, self.findings.margins
        return any(
            name not in found and not math.isfinite(margins.get(name, math.inf)) for name in self.criteria
        )

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
            if share := self.findings.largest_share.get(criterion):
                judged = self.findings.judged[criterion]
                bound = f"at most {100.0 * share:.2g} % of the searched space fails (95 %)"
                others = self.findings.random - judged
                beside = f"; {others} more were not judged" if others else ""
                lines.append(f"    {bound}: none of {judged} random points did{beside}")
        refused = f"; {self.findings.refused} points could not be run" if self.findings.refused else ""
        more = f" and {self.stops_of_shrinking} to make it small" if self.stops_of_shrinking else ""
        return [*lines, f"{self.stops} stops{more}{refused}"]

    def document(self) -> dict[str, Any]:
        """Return the outcome as JSON; a margin that no stop has is None."""
        form: dict[str, Any] = json_form({"schema": SCHEMA, **asdict(self)})
        form["findings"]["largest_share"] = self.findings.largest_share
        del form["folder"], form["page"]
        for case in form["found"]:
            del case["text"]
        return form


def shrunk_cases(engine: Engine, folder: Path) -> list[FoundCase]:
    """Return the cases that a search has found made small, each once, as files of `folder`."""
    cases: dict[tuple[object, ...], FoundCase] = {}
    for target, points in engine.findings.found.items():
        shrinking = Shrinking(engine, target)
        for point in points:
            small = shrinking.smallest(point)
            kinds = tuple(small[axes.first] for axes in engine.trials.space.faults)
            alike = target, kinds, *(text == NOMINAL for text in small)
            if alike not in cases:
                cases[alike] = _found_case(shrinking, small, len(cases) + 1, folder)
    return list(cases.values())


def _found_case(shrinking: Shrinking, point: Point, number: int, folder: Path) -> FoundCase:
    """Return a case that was made small. Raises InvalidInputError where its stops do not fail again."""
    trials, target = shrinking.engine.trials, shrinking.target
    space, index = trials.space, trials.targets.index(target)
    needed, stops = space.search.fails_in
    results = trials.simulate([Stop(point, seed, own_noise=True) for seed in range(stops)])
    failing = {k: each for k, each in enumerate(results) if each and trials.trial(each).margins[index] < 0.0}
    if len(failing) < needed:
        raise runs.InvalidInputError(
            f"{_conditions(space, point)}: the same stops do not fail again: the controller is not"
            " deterministic (see `uictest controller check`), or search.csv was edited"
        )
    beside = " and ".join(shrinking.neighbours(point))
    passes = f"; passes at {beside}" if beside else ""
    what = f"{_what_fails(target, list(failing.values()))} in {len(failing)} of {stops} stops"
    sentence = f"{_conditions(space, point)}: {what}{passes}"
    content = {
        "schema": "uictest/scenario/1",
        "name": f"{space.name[:80]}-found-{number}",
        "title": sentence[:200],
        **space.scenario(point, folder),
        **_expectation(space, target, failing),
    }
    text = yaml.safe_dump(content, sort_keys=False, allow_unicode=True, width=110)
    values, off_nominal = space.contents(point), space.off_nominal(point)
    return FoundCase(target, values, off_nominal, len(failing), stops, sentence, text)


def _conditions(space: Space, point: Point) -> str:
    """Return the values that are not nominal: `speed sensor offset of wheelset 1 +11 km/h, friction 0.08`."""
    words = []
    for axes in space.faults:
        name, wheelset, begin, size = (point[column] for column in axes.columns)
        if name != NOMINAL:
            signed = f"+{size}" if "offset" in name and size[:1] not in ("", "-") else size
            of_wheelset = f"of wheelset {wheelset}" if wheelset else ""
            fault = " ".join(filter(None, [name.replace("-", " "), of_wheelset, signed]))
            words += [fault, f"from {begin} on"] if begin else [fault]
    words += [f"{name} {text}" for name, text in space.numbers_off_nominal(point)]
    return ", ".join(words) or "the scenario as it is"


def _what_fails(target: str, failing: Sequence[CaseResult]) -> str:
    """Return the criterion with the median of the values that miss it, or why the controller fails."""
    if target == ERROR:
        return f"{failing[0].reason},"
    missed = [verdict for each in failing for verdict in each.decided if verdict.id == target]
    values = [verdict.value for verdict in missed if verdict.value is not None]
    value = value_text(statistics.median(values), missed[0].unit) if values else "missed"
    return f"{target} {value}"


def _expectation(space: Space, target: str, failing: Mapping[int, CaseResult]) -> dict[str, Any]:
    """Return what the scenario expects: all criteria that its stops miss, in as many stops as are asked for.

    A controller that fails is never expected. Where too few stops miss the same, the first that fails is the
    one stop of the scenario.
    """
    seed, (needed, stops) = space.loaded.case.scenario.seed, space.search.fails_in
    first = min(failing)
    first_alone = {"seed": seed + first, "repeat": 1}
    if target == ERROR:
        return {**first_alone, "expect": "pass"}
    expect = _named(list(failing.values()))
    if sum(is_expected(each.outcome, each.decided, expect) for each in failing.values()) < needed:
        return {**first_alone, "expect": _named([failing[first]]).form()}
    share = {"at_least": f"{100.0 * needed / stops:.6g} %"}
    return {"seed": seed, "repeat": stops, "outcome_of_repeats": share, "expect": expect.form()}


def _named(results: Sequence[CaseResult]) -> Expectation:
    """Return the expectation that names what results miss: of validity only what most of them do."""
    fail = [verdict.id for each in results for verdict in missed_requirements(each.decided)]
    decided = (verdict for each in results for verdict in each.decided)
    validity = [each.id for each in decided if each.layer == "validity" and each.status == "fail"]
    frequent = [name for name in dict.fromkeys(validity) if 2 * validity.count(name) > len(results)]
    return Expectation("fail" if fail else "invalid", tuple(dict.fromkeys(fail)), tuple(frequent))
