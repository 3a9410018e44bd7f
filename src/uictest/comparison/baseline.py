"""Compare a run with the results that were accepted before."""

from __future__ import annotations

import dataclasses
import hashlib
import json
from collections.abc import Container, Iterable, Iterator, Mapping, Sequence
from dataclasses import dataclass, field
from pathlib import Path, PurePosixPath
from typing import Any

from uictest import evaluation, report
from uictest.comparison.parameters import parameter_changes, parameter_lines
from uictest.comparison.runs import case_differences, run_notes, unknown_parameters
from uictest.comparison.tolerance import Tolerances
from uictest.report import BaselineComparison, Difference, without_machine

_TABLES = ("subjects", "parts")
"""Mappings by id or name in a results document, besides its cases."""


@dataclass(frozen=True, slots=True)
class Scope:
    """The cases that a run selects.

    Args:
        selected: ids of the cases to be run.
        searched: scenario files and folders of which every case was selected; none where an expression, a tag
            or the last failures chose among them.

    """

    selected: frozenset[str]
    searched: Sequence[str] = ()

    def misses(self, case_id: str, scenario: str) -> bool:
        """Return whether the files searched should contain a case and do not."""
        path = PurePosixPath(scenario)
        places = (path, *path.parents)
        return case_id not in self.selected and any(PurePosixPath(name) in places for name in self.searched)


@dataclass(frozen=True, slots=True)
class Baseline:
    """Accepted results, and how a run is compared with them."""

    folder: str
    sha256: str
    run: report.RunContent
    results: Mapping[str, evaluation.CaseResult] = field(repr=False)
    document: Mapping[str, Any] = field(repr=False)
    scope: Scope
    tolerances: Tolerances

    def compare(self, run: report.RunContent) -> BaselineComparison:
        """Compare every result of a run, and list the cases of the baseline that were not compared."""
        quantities = {result.id: list(self._quantities(result)) for result in run.results}
        all_differences = [
            difference for of_case in quantities.values() for difference in of_case if difference
        ]
        missing, other_ids = self._not_compared(quantities)
        beyond = {case_id: _beyond(of_case) for case_id, of_case in quantities.items()}
        beyond |= {case_id: [_missing(self.results[case_id])] for case_id in missing}
        return BaselineComparison(
            without_machine(self.folder),
            self.sha256,
            compared=sum(map(len, quantities.values())) + len(missing),
            within=sum(difference.within for difference in all_differences),
            differences={case_id: of_case for case_id, of_case in beyond.items() if of_case},
            missing=missing,
            not_run=[case_id for case_id in other_ids if case_id in self.scope.selected],
            not_selected=[case_id for case_id in other_ids if case_id not in self.scope.selected],
            notes=[
                *(["series are not compared with the baseline"] if run.series or self.run.series else []),
                *self._parameters_changed(run),
                *run_notes(self._inputs_limited(run), run),
            ],
        )

    def differences(self, result: evaluation.CaseResult) -> list[Difference]:
        """Return the quantities of a case that are out of tolerance."""
        return _beyond(self._quantities(result))

    def _not_compared(self, compared: Container[str]) -> tuple[dict[str, str], list[str]]:
        """Return the cases that the scenario files no longer have (id -> file), and the ids of the others."""
        results = [result for result in self.run.results if result.id not in compared]
        missing = {
            result.id: result.scenario for result in results if self.scope.misses(result.id, result.scenario)
        }
        return missing, [result.id for result in results if result.id not in missing]

    def _quantities(self, result: evaluation.CaseResult) -> Iterator[Difference | None]:
        """Yield one item per quantity compared: None where both sides are the same."""
        accepted = self.results.get(result.id)
        if accepted is None:
            remark = "the baseline has no such case; --accept adds it"
            yield Difference(result.id, "case", "missing", result.outcome, within=False, remark=remark)
        else:
            yield from case_differences(accepted, result, self.tolerances)

    def _parameters_changed(self, run: report.RunContent) -> Iterator[str]:
        """Yield the parameters that have changed since the cases were accepted."""
        both = [(self.results[result.id], result) for result in run.results if result.id in self.results]
        yield from parameter_lines(parameter_changes(both))
        yield from unknown_parameters(both, ("baseline", "run"))

    def _inputs_limited(self, run: report.RunContent) -> report.RunContent:
        """Return the accepted run as if it had read nothing that this one did not select."""
        accepted = self.run.manifest
        inputs = {name: digest for name, digest in accepted.inputs.items() if name in run.manifest.inputs}
        return dataclasses.replace(self.run, manifest=dataclasses.replace(accepted, inputs=inputs))


def read_baseline(folder: Path, scope: Scope, tolerances: Tolerances) -> Baseline:
    """Return the baseline in a folder. Raises OSError or ValueError where there is none."""
    path = folder / report.RESULTS
    content = path.read_bytes()
    try:
        document = json.loads(content)
        run = report.run_content(document, folder.name)
    except ValueError as error:
        raise ValueError(f"{path}: not the results of a run: {error}") from error
    results = {result.id: result for result in run.results}
    sha256 = hashlib.sha256(content).hexdigest()
    return Baseline(str(folder), sha256, run, results, document, scope, tolerances)


def accepted_document(run: Mapping[str, Any], baseline: Baseline | None) -> dict[str, Any]:
    """Return the results of a run as a baseline: the cases that it did not select stay as they are.

    `run` is the results document. Cases that the scenario files no longer have are dropped.
    """
    cases = {case["id"]: case for case in run["cases"]}
    if baseline is None:
        return dict(run)
    accepted = baseline.document
    kept = [case for case in accepted["cases"] if _stays(case, cases, baseline.scope)]
    if not kept:
        return dict(run)
    order = [case["id"] for case in accepted["cases"]]
    cases |= {case["id"]: case for case in kept}
    ids = sorted(cases, key=lambda case_id: order.index(case_id) if case_id in order else len(order))
    inputs = {**baseline.run.manifest.inputs, **run["manifest"].get("inputs", {})}
    tables = {name: {**accepted.get(name, {}), **run[name]} for name in _TABLES if name in run}
    manifest = {**run["manifest"], "inputs": inputs, "cases": len(ids)}
    return {**run, **tables, "manifest": manifest, "cases": [cases[case_id] for case_id in ids]}


def _stays(case: Mapping[str, Any], run: Mapping[str, Any], scope: Scope) -> bool:
    return case["id"] not in run and not scope.misses(case["id"], case["scenario"])


def _beyond(quantities: Iterable[Difference | None]) -> list[Difference]:
    """Return the differences out of tolerance; None stands for a quantity that is the same."""
    return [quantity for quantity in quantities if quantity and not quantity.within]


def _missing(accepted: evaluation.CaseResult) -> Difference:
    remark = f"{accepted.scenario} no longer has this case; --accept drops it"
    return Difference(accepted.id, "case", accepted.outcome, "missing", within=False, remark=remark)
