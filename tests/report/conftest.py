"""Sweeps and pages to report on, and the browser that shows them."""

from dataclasses import replace

import pytest

from uictest.report.sweep.result import SweepContent, read_sweep_document
from uictest.report.traces.trace import trace_of

from .builders import make_content, make_recording, make_result, make_verdict
from .chromium import emulate, requests, started, written


@pytest.fixture
def make_sweep(tmp_path):
    """A finished sweep over two parameters, with whatever is to be different in its findings."""

    def make(worst=(), text="90 %", traces=None, **findings):
        (tmp_path / "sweep").mkdir(exist_ok=True)
        manifest = {"file": f"scenarios/{text}.sweep.yaml", "versions": {"uictest": "0.1.0"}, "set": [text]}
        result = replace(read_sweep_document(_document(text) | findings), worst=worst)
        return SweepContent(tmp_path / "sweep", result, manifest, traces or {})

    return make


@pytest.fixture(scope="session")
def chromium():
    """A browser for all tests of pages in this process."""
    browser = started()
    yield browser
    browser.quit()


@pytest.fixture
def browser(chromium):
    """The browser, as it starts: scripts allowed, light, its window wide, its logs read."""
    chromium.get("about:blank")  # lest the page of the test before only scrolls to another place
    chromium.execute_cdp_cmd("Emulation.setScriptExecutionDisabled", {"value": False})
    chromium.execute_cdp_cmd("Emulation.clearDeviceMetricsOverride", {})
    emulate(chromium, scheme="light")
    for log in ("browser", "performance"):
        chromium.get_log(log)
    yield chromium
    assert [entry for entry in chromium.get_log("browser") if entry["level"] in ("SEVERE", "WARNING")] == []
    assert requests(chromium) == []


@pytest.fixture(scope="session")
def page(tmp_path_factory):
    """A run of three cases, one of them missed, all drawn."""
    distance = make_verdict(measure="braking_distance")
    results = [
        make_result(id="dry-120"),
        make_result(id="slip-120", scenario="scenarios/slip.yaml", outcome="invalid", criteria=(distance,)),
        make_result(id="wet-80", expect="fail", outcome="fail"),
    ]
    trace = trace_of(make_recording(sliding_time="5.0"))
    traces = {result.id: trace for result in results}
    return written(tmp_path_factory.mktemp("run"), make_content(*results, traces=traces))


def _document(text):
    """What results.json holds of four cases, one of which missed; `text` stands wherever a user's may."""
    outcomes = {"pass": 3, "fail": 1, "invalid": 0, "error": 0, "skipped": 0}
    counts = [("80 %", 2, outcomes | {"pass": 2, "fail": 0}), (text, 1, outcomes | {"pass": 1})]
    axes = {
        "rows": {"parameter": f"brake.{text}", "values": ["80 %", text]},
        "columns": {"parameter": "rail.friction", "values": ["0.10", "0.12"]},
    }
    index = {"value": 0.5, "low": 0.4, "high": 0.6}
    flips = [{"low": text, "high": "0.11", "met_at_low": False}]
    rates = [{"value": value, "cases": 2, "met": met, "outcomes": each} for value, met, each in counts]
    cells = axes | {"met": [[1, 1], [0, 1]], "cases": [[1, 1], [1, 1]]}
    return {
        "schema": "uictest/result/2",
        "kind": "sweep",
        "name": text,
        "title": text,
        "cases": 4,
        "met": 3,
        "outcomes": outcomes,
        "rates": {f"brake.{text}": rates},
        "base": {},
        "controllers": [],
        "parts": {},
        "worst": [],
        "subjects": {},
        "notes": [text],
        "missed": [{"id": f"lost[{text}]", "outcome": "invalid", "reason": text}],
        "maps": [
            {"measure": "met", **cells, "means": [[1.0, 1.0], [0.0, 1.0]]},
            {"measure": "braking_distance_m", **cells, "means": [[1.5, 2.5], [None, 3.5]]},
        ],
        "sensitivities": [
            {"measure": "met", "circumstances": {text: text}, "key": text, "first": index, "total": index}
        ],
        "frontier": {
            "parameter": text,
            "stretches": [{"circumstances": {text: text}, "flips": flips, "note": text}],
        },
        "measures": [
            {"measure": text, "unit": text, "cases": 4, "minimum": 1.0, "mean": 2.0, "maximum": 3.0}
        ],
        "trends": [
            {"parameter": f"brake.{text}", "values": ["80 %", "90 %"], "measure": text, "unit": text}
            | {"cases": [2, 1], "minimum": [1.0, 4.0], "mean": [2.0, 4.0], "maximum": [3.0, 4.0]}
        ],
    }
