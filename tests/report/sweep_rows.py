"""Sweeps with the rows of all their cases, of which everything on a map is known."""

import numpy as np
import pyarrow as pa
import pyarrow.parquet as pq

from uictest.report.sweep.result import read_sweep_document

DISTANCE = {"measure": "braking distance", "unit": "m", "columns": ["braking_distance_m"]}
SLIDE = {"measure": "largest slide", "unit": "%", "columns": ["maximum_slide_1", "maximum_slide_2"]}


def row(case, outcome="pass", met=None, **others):
    """Return the row of a case; what is not stated has no value."""
    figures = dict.fromkeys(("braking_distance_m", "maximum_slide_1", "maximum_slide_2"))
    own = {"id": case, "outcome": outcome, "met": outcome == "pass" if met is None else met}
    return own | figures | others


def write_rows(folder, rows):
    """Write the rows of all cases as a sweep does."""
    pq.write_table(pa.Table.from_pylist([dict(each) for each in rows]), folder / "summary.parquet")


def sweep_result(values, cases, **changes):
    """Return the result of a sweep over some values of its parameters."""
    outcomes = dict.fromkeys(("pass", "fail", "invalid", "inconclusive", "error", "skipped"), 0)
    of_all = {"cases": cases, "minimum": 0.0, "mean": 0.5, "maximum": 1.0}
    rates = {
        key: [{"value": value, "cases": 1, "met": 1, "outcomes": outcomes} for value in own]
        for key, own in values.items()
    }
    form = {"schema": "uictest/result/2", "kind": "sweep", "name": "study", "title": ""}
    form |= {"base": {}, "controllers": [], "parts": {}}
    form |= {"cases": cases, "met": cases, "outcomes": outcomes | {"pass": cases}, "rates": rates}
    form |= {"varied": list(values), "measures": [DISTANCE | of_all, SLIDE | of_all]}
    form |= {name: [] for name in ("missed", "maps", "trends", "worst", "sensitivities", "notes")}
    form |= {"subjects": {}, "frontier": None}
    return read_sweep_document(form | changes)


def drawn_rows(cases, failing=()):
    """Return the rows of a sample of a friction and, log-uniformly, a gain; `failing` fail."""
    generator = np.random.default_rng(4)
    frictions, gains = generator.uniform(0.1, 0.2, cases), 10.0 ** generator.uniform(-2.0, 0.0, cases)
    return [
        row(
            f"study[sample={k}]",
            "fail" if k in failing else "pass",
            **{"parameters.rail.friction": f"{frictions[k]:.6f}", "parameters.gain": f"{gains[k]:.6f} m"},
            **{"values.rail.friction": round(frictions[k], 6), "values.gain": round(gains[k], 6)},
            braking_distance_m=40.0 / frictions[k],
            maximum_slide_1=0.1,
            maximum_slide_2=0.25,
        )
        for k in range(cases)
    ]


INTERVALS = {
    "rail.friction": [
        {"low": round(0.1 + 0.01 * k, 2), "high": round(0.11 + 0.01 * k, 2), "unit": ""} for k in range(10)
    ],
    "gain": [{"low": 0.01, "high": 0.1, "unit": "m"}, {"low": 0.1, "high": 1.0, "unit": "m"}],
}
"""Intervals of the parameters of these rows."""
