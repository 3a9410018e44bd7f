"""Compare a run with the results that were accepted before, and accept them."""

from __future__ import annotations

import dataclasses
import hashlib
import json
import math
from collections.abc import Container, Iterable, Iterator, Mapping
from dataclasses import dataclass, field
from pathlib import Path
from typing import Any

from uictest import report
from uictest.analysis.comparison.parameters import parameter_changes, parameter_lines
from uictest.analysis.comparison.runs import (
    case_differences,
    compare_accepted_series,
    run_notes,
    stops_of_series,
)
from uictest.analysis.comparison.tolerance import Scope, Tolerances
from uictest.judging import evaluation
from uictest.report import BaselineComparison, Difference, without_machine


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
        """Compare every case and series of a run, and list those of the baseline that were not compared."""
        quantities = {result.id: list(self._compared_quantities(result)) for result in run.results}
        missing, other_ids = self._not_compared(quantities)
        of_series = compare_accepted_series(self.run.series, run.series, self.scope, self.tolerances)
        compared = [*quantities.values(), *of_series.quantities.values()]
        beyond = {
            own_id: _out_of_tolerance(each)
            for side in (quantities, of_series.quantities)
            for own_id, each in side.items()
        }
        beyond |= {case_id: [_missing_case(self.results[case_id])] for case_id in missing}
        # As if the accepted run had read nothing that this one did not select.
        manifest, read = self.run.manifest, run.manifest.inputs
        inputs = {name: digest for name, digest in manifest.inputs.items() if name in read}
        limited = dataclasses.replace(self.run, manifest=dataclasses.replace(manifest, inputs=inputs))
        return BaselineComparison(
            without_machine(self.folder),
            self.sha256,
            compared=sum(map(len, compared)) + len(missing),
            within=sum(each.within for of_one in compared for each in of_one if each),
            differences={own_id: each for own_id, each in beyond.items() if each},
            missing=missing,
            series={own_id: file for own_id, file in of_series.files.items() if beyond[own_id]},
            not_run=[case_id for case_id in other_ids if case_id in self.scope.selected],
            not_selected=[case_id for case_id in other_ids if case_id not in self.scope.selected],
            series_not_compared=of_series.not_compared,
            notes=[*self._parameters_changed(run), *run_notes(limited, run)],
            values={
                result.id: _comparable_values(self.results[result.id], result)
                for result in run.results
                if result.id in self.results
            },
        )

    def differences(self, result: evaluation.CaseResult) -> list[Difference]:
        """Return the quantities of a case that are out of tolerance."""
        return _out_of_tolerance(self._compared_quantities(result))

    def _not_compared(self, compared: Container[str]) -> tuple[dict[str, str], list[str]]:
        """Return the cases that the scenario files no longer have (id -> file), and the ids of the others."""
        results = [result for result in self.run.results if result.id not in compared]
        missing = {
            result.id: result.scenario for result in results if self.scope.misses(result.id, result.scenario)
        }
        return missing, [result.id for result in results if result.id not in missing]

    def _compared_quantities(self, result: evaluation.CaseResult) -> Iterator[Difference | None]:
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
        yield from parameter_lines(parameter_changes([*both, *stops_of_series(self.run, run)]))


def read_baseline(folder: Path, scope: Scope, tolerances: Tolerances) -> Baseline:
    """Return the baseline in a folder. Raises OSError or ValueError where there is none."""
    path = folder / report.RESULTS
    content = path.read_bytes()
    try:
        document = json.loads(content)
        run = report.run_content(document, folder.name)
    except (ValueError, RecursionError) as error:
        raise ValueError(f"{path}: not the results of a run: {error}") from error
    results = {result.id: result for result in run.results}
    sha256 = hashlib.sha256(content).hexdigest()
    return Baseline(str(_linked_run(folder)), sha256, run, results, document, scope, tolerances)


def _linked_run(folder: Path) -> Path:
    """Return the run that `latest` names now: after this run it names another."""
    if folder.name != "latest" or not folder.is_symlink():
        return folder
    run = folder.parent / folder.readlink()
    return run if run.is_dir() else folder


def _out_of_tolerance(quantities: Iterable[Difference | None]) -> list[Difference]:
    """Return the differences out of tolerance; None stands for a quantity that is the same."""
    return [quantity for quantity in quantities if quantity and not quantity.within]


def _comparable_values(accepted: evaluation.CaseResult, result: evaluation.CaseResult) -> dict[str, float]:
    """Return the accepted values of the criteria of a case that count in the same unit now."""
    units = {verdict.id: verdict.unit for verdict in result.criteria}
    return {
        verdict.id: verdict.value
        for verdict in accepted.criteria
        if verdict.value is not None
        and math.isfinite(verdict.value)
        and units.get(verdict.id) == verdict.unit
    }


def _missing_case(accepted: evaluation.CaseResult) -> Difference:
    remark = f"{accepted.scenario} no longer has this case; --accept drops it"
    return Difference(accepted.id, "case", accepted.outcome, "missing", within=False, remark=remark)


_TABLES = ("subjects", "parts")
"""Mappings by id or name in a results document, besides its cases."""


def accepted_document(run: Mapping[str, Any], baseline: Baseline | None) -> dict[str, Any]:
    """Return the results of a run as a baseline: what it did not select stays as it is.

    `run` is the results document. Cases and series that their files no longer have are dropped.
    """
    if baseline is None:
        return dict(run)
    accepted = baseline.document
    cases = {case["id"]: case for case in run["cases"]}
    kept = [case for case in accepted["cases"] if _stays_accepted(case, "scenario", cases, baseline.scope)]
    of_series = _with_series(run.get("series"), accepted.get("series"), baseline.scope)
    if not kept and of_series == run.get("series"):
        return dict(run)
    order = [case["id"] for case in accepted["cases"]]
    cases |= {case["id"]: case for case in kept}
    ids = sorted(cases, key=lambda case_id: order.index(case_id) if case_id in order else len(order))
    inputs = {**baseline.run.manifest.inputs, **run["manifest"].get("inputs", {})}
    tables = {name: {**accepted.get(name, {}), **run[name]} for name in _TABLES if name in run}
    count = len(ids) + len(of_series["cases"] if of_series else ())
    manifest = {**run["manifest"], "inputs": inputs, "cases": count}
    series = {"series": of_series} if of_series else {}
    return {**run, **tables, "manifest": manifest, "cases": [cases[case_id] for case_id in ids], **series}


def _with_series(
    run: Mapping[str, Any] | None, accepted: Mapping[str, Any] | None, scope: Scope
) -> dict[str, Any] | None:
    """Return the series of a run and those accepted before that stay; None where there is none."""
    current = dict(run) if run else {}
    if not accepted:
        return current or None
    ids = {result["id"] for result in current.get("series", ())}
    kept = [result for result in accepted["series"] if _stays_accepted(result, "file", ids, scope)]
    if not kept:
        return current or None
    stops = {each["case"] for result in kept for each in result["cases"]}
    cases = [case for case in accepted["cases"] if case["id"] in stops]
    return {
        "parts": {**accepted["parts"], **current.get("parts", {})},
        "cases": [*cases, *current.get("cases", ())],
        "series": [*kept, *current.get("series", ())],
    }


def _stays_accepted(item: Mapping[str, Any], file: str, run: Container[str], scope: Scope) -> bool:
    return item["id"] not in run and not scope.misses(item["id"], item[file])
