"""Runs in a folder, published as commands publish them."""

from collections.abc import Callable, Mapping
from pathlib import Path

import pytest

from uictest import report, runs
from uictest.core.measures import STOP_COLUMNS
from uictest.judging import evaluation

FIGURES = dict.fromkeys(STOP_COLUMNS, float("nan"))
VERSIONS = {"uictest": "0.1.0", "numpy": "2.0.0"}

Publish = Callable[..., Path]


def part(kind: str, name: str) -> evaluation.EffectivePart:
    """A part whose id follows from its name."""
    return evaluation.EffectivePart(kind, kind, name, None, ())


def case(
    case_id: str,
    outcome: str = "pass",
    distance: float = 470.0,
    expect: str = "pass",
    parts: Mapping[str, evaluation.EffectivePart] | None = None,
) -> evaluation.CaseResult:
    """A judged stop with a vehicle and a controller."""
    return evaluation.CaseResult(
        id=case_id,
        scenario="scenarios/dry.yaml",
        parameters={},
        expect=expect,  # type: ignore[arg-type]
        outcome=outcome,  # type: ignore[arg-type]
        measures=FIGURES | {"braking_distance_m": distance},  # type: ignore[arg-type]
        parts={"vehicle": part("vehicle", "coach"), "controller": part("controller", "threshold")}
        if parts is None
        else parts,
    )


@pytest.fixture
def reports(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> Path:
    """The folder of all runs, below the working folder."""
    monkeypatch.chdir(tmp_path)
    return tmp_path / "reports"


@pytest.fixture
def publish(reports: Path) -> Publish:
    """Publish a run of some cases, one stop that passes where there is none; return its folder."""

    def published(
        *cases: evaluation.CaseResult,
        command: tuple[str, ...] = ("run", "scenarios"),
        inputs: Mapping[str, str] | None = None,
        versions: Mapping[str, str] = VERSIONS,
        formats: tuple[str, ...] = ("html",),
        **changes: object,
    ) -> Path:
        manifest = report.RunManifest(
            command=("uictest", *command), cases=len(cases) or 1, versions=versions, inputs=inputs or {}
        )
        content = report.RunContent("", cases or (case("dry-120"),), manifest, **changes)  # type: ignore[arg-type]
        return runs.publish_run(content, {}, reports, formats).place

    return published
