"""The results of a run as those of a baseline."""

from __future__ import annotations

from collections.abc import Container, Mapping
from typing import Any

from uictest.analysis.comparison.baseline import Baseline
from uictest.analysis.comparison.scope import Scope

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
    kept = [case for case in accepted["cases"] if _stays(case, "scenario", cases, baseline.scope)]
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
    own = dict(run) if run else {}
    if not accepted:
        return own or None
    ids = {result["id"] for result in own.get("series", ())}
    kept = [result for result in accepted["series"] if _stays(result, "file", ids, scope)]
    if not kept:
        return own or None
    stops = {each["case"] for result in kept for each in result["cases"]}
    cases = [case for case in accepted["cases"] if case["id"] in stops]
    return {
        "schema": accepted["schema"],
        "parts": {**accepted["parts"], **own.get("parts", {})},
        "cases": [*cases, *own.get("cases", ())],
        "series": [*kept, *own.get("series", ())],
    }


def _stays(item: Mapping[str, Any], file: str, run: Container[str], scope: Scope) -> bool:
    return item["id"] not in run and not scope.misses(item["id"], item[file])
