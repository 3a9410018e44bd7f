"""Runs in a folder, published as commands publish them."""

import pytest

from uictest import report, runs
from uictest.core.measures import STOP_COLUMNS
from uictest.judging import evaluation
from uictest.plans.scenario import expectation_of

FIGURES = dict.fromkeys(STOP_COLUMNS, float("nan"))
VERSIONS = {"uictest": "0.1.0", "numpy": "2.0.0"}
PARTS = {"controller": evaluation.EffectivePart("controller", "controller", "threshold", None, ())}


def case(case_id, outcome="pass", distance=470.0, expect="pass"):
    """A judged stop with a vehicle and a controller."""
    measures = FIGURES | {"braking_distance_m": distance}
    file = "scenarios/dry.yaml"
    return evaluation.CaseResult(
        case_id, file, {}, expectation_of(expect), outcome, measures=measures, parts=PARTS
    )


@pytest.fixture
def reports(tmp_path, monkeypatch):
    """The folder of all runs, below the working folder."""
    monkeypatch.chdir(tmp_path)
    return tmp_path / "reports"


@pytest.fixture
def publish(reports):
    """Publish a run of some cases, one stop that passes where there is none; return its folder."""

    def published(
        *cases, command=("run", "scenarios"), inputs=None, versions=VERSIONS, formats=("html",), **changes
    ):
        cases, command = cases or (case("dry-120"),), ("uictest", *command)
        counted = {"command": command, "cases": len(cases)}
        manifest = report.RunManifest(**counted, versions=versions, inputs=inputs or {})
        content = report.RunContent("", cases, manifest, **changes)
        return runs.publish_run(content, {}, reports, formats).place

    return published
