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
    MISSING,
    SHARE_PASSED,
    judged_quantities,
    quantities_of_runs,
    run_notes,
    stops_of_series,
)
from uictest.analysis.comparison.tolerance import Scope, Tolerances
from uictest.core.measures import without_wheelset
from uictest.judging import evaluation
from uictest.judging.series import SeriesResult
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
        of_both = quantities_of_runs(self.run, run, self.tolerances)
        files = {case.id: case.scenario for case in (*self.run.results, *run.results)}
        series = {one.id: one.file for one in (*self.run.series, *run.series)}
        file_of = files | series
        of_run = [*(case.id for case in run.results), *(one.id for one in run.series)]
        accepted_alone = [own_id for own_id in of_both if own_id not in of_run]
        missing = [own_id for own_id in accepted_alone if self.scope.misses(own_id, file_of[own_id])]
        left_out = [own_id for own_id in accepted_alone if own_id not in missing]
        quantities = {own_id: of_both[own_id] for own_id in (*of_run, *missing)}
        beyond = {
            own_id: self._out_of_tolerance(of_one, file_of[own_id]) for own_id, of_one in quantities.items()
        }
        judged = self._judged(run.results, run.series)
        decides = {
            own_id: self._deciding(differences, judged.get(own_id, set()))
            for own_id, differences in beyond.items()
        }
        out = [(own_id, difference) for own_id, differences in beyond.items() for difference in differences]
        informing = [difference for own_id, difference in out if difference not in decides[own_id]]
        # As if the accepted run had read nothing that this one did not select.
        manifest, read = self.run.manifest, run.manifest.inputs
        inputs = {name: digest for name, digest in manifest.inputs.items() if name in read}
        limited = dataclasses.replace(self.run, manifest=dataclasses.replace(manifest, inputs=inputs))
        return BaselineComparison(
            without_machine(self.folder),
            self.sha256,
            compared=sum(map(len, quantities.values())),
            within=sum(each.within for of_one in quantities.values() for each in of_one if each),
            differences={own_id: each for own_id, each in decides.items() if each},
            missing={own_id: files[own_id] for own_id in missing if own_id in files},
            series={own_id: file for own_id, file in series.items() if decides.get(own_id)},
            not_run=[each for each in left_out if each in files and each in self.scope.selected],
            not_selected=[each for each in left_out if each in files and each not in self.scope.selected],
            series_not_compared=[each for each in left_out if each in series],
            notes=[*self._parameters_changed(run), *run_notes(limited, run)],
            values={
                result.id: _comparable_values(self.results[result.id], result)
                for result in run.results
                if result.id in self.results
            },
            informing=informing,
        )

    def differences(self, result: evaluation.CaseResult) -> list[Difference]:
        """Return the outcome, verdicts and judged measures of a case that are out of tolerance."""
        accepted = [self.results[result.id]] if result.id in self.results else []
        before, now = (report.RunContent("", results) for results in (accepted, [result]))
        quantities = quantities_of_runs(before, now, self.tolerances)[result.id]
        beyond = self._out_of_tolerance(quantities, result.scenario)
        return self._deciding(beyond, self._judged([result], ())[result.id])

    @staticmethod
    def _out_of_tolerance(quantities: Iterable[Difference | None], file: str) -> list[Difference]:
        """Return the differences out of tolerance; None stands for a quantity that is the same.

        Of a case or series that one side lacks the remark says what `--accept` does.
        """
        beyond = []
        for difference in quantities:
            if difference is None or difference.within:
                continue
            kind, remark = difference.quantity, difference.remark
            if difference.first == MISSING:
                remark = f"the baseline has no such {kind}; --accept adds it"
            elif difference.second == MISSING:
                remark = f"{file} no longer has this {kind}; --accept drops it"
            beyond.append(dataclasses.replace(difference, remark=remark))
        return beyond

    def _judged(
        self, cases: Iterable[evaluation.CaseResult], series: Iterable[SeriesResult]
    ) -> dict[str, set[str]]:
        """Return the quantities that criteria judge, now or when they were accepted: id -> names."""
        verdicts: dict[str, list[evaluation.Verdict]] = {}
        for case in cases:
            accepted = self.results.get(case.id, case)
            verdicts[case.id] = [*accepted.criteria, *case.criteria]
        for one in series:
            verdicts[one.id] = [each.verdict for each in one.criteria]
        return {own_id: judged_quantities(of_one) for own_id, of_one in verdicts.items()}

    def _deciding(self, differences: Iterable[Difference], judged: set[str]) -> list[Difference]:
        """Return the differences of an outcome or a verdict, and of measures that are judged.

        A tolerance that names a quantity makes it decide, too.
        """

        def decides(difference: Difference) -> bool:
            name = difference.quantity
            measure, _ = without_wheelset(name.partition(" from ")[0])
            is_judged = name == SHARE_PASSED or name in judged or measure in judged
            return is_judged or isinstance(difference.first, str) or self.tolerances.names(name)

        return list(filter(decides, differences))

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
