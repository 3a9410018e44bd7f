"""Every kind of page against the rules of axe-core, in light and dark, wide and narrow."""

from __future__ import annotations

from collections.abc import Callable
from importlib.resources import files
from pathlib import Path
from typing import Any

import pytest

from uictest import comparison
from uictest.evaluation import CaseResult
from uictest.recording import Recording
from uictest.report.page import sweep_page_html
from uictest.report.sweep.content import SweepContent
from uictest.report.traces.trace import trace_of

from .chromium import PLOTTED, emulate, resize, run, wait

_CHECK = """
const done = arguments[arguments.length - 1];
axe.run({exclude: [['svg.main-svg']]}, {resultTypes: ['violations'], preload: false}).then(
  ({violations}) => done(
    violations.flatMap(({id, nodes}) => nodes.map((node) => `${id}: ${node.target.join(' ')}`))),
  (error) => done([String(error)]));
"""
"""What plotly draws is no text of ours; its values are read at the cursor and from the tables."""


def violations(browser: Any) -> list[str]:
    """Return what violates a rule on the page that is shown: the rule and the element."""
    run(browser, files("axe_core_python").joinpath("axe.min.js").read_text("utf-8"))
    browser.set_script_timeout(110)
    found: list[str] = browser.execute_async_script(_CHECK)
    return found


appearances = pytest.mark.parametrize(("scheme", "width"), [("light", 1400), ("dark", 390)])


def _shown(browser: Any, page: Path, scheme: str, width: int) -> None:
    resize(browser, width)
    emulate(browser, scheme)
    browser.get(page.as_uri())


@appearances
def test_the_page_of_a_run(browser: Any, page: Path, scheme: str, width: int) -> None:
    """With two cases compared, and with every fold open."""
    _shown(browser, page, scheme, width)
    run(browser, "document.querySelectorAll('input.compare').forEach((box, k) => k < 2 && box.click())")
    wait(browser, "return document.querySelectorAll('.compared-plot .scatterlayer .trace').length")
    run(browser, "document.querySelectorAll('details').forEach((each) => { each.open = true; })")
    wait(browser, "return document.querySelectorAll('.plots[data-ready]').length === 3")
    assert violations(browser) == []


@appearances
def test_the_page_of_a_sweep(
    browser: Any,
    tmp_path: Path,
    make_sweep: Callable[..., SweepContent],
    make_result: Callable[..., CaseResult],
    make_recording: Callable[..., Recording],
    scheme: str,
    width: int,
) -> None:
    worst = make_result(id="study[a]", outcome="fail")
    page = tmp_path / "index.html"
    sweep = make_sweep((worst,), "x", traces={worst.id: trace_of(make_recording())})
    page.write_text(sweep_page_html(sweep), encoding="utf-8")
    _shown(browser, page, scheme, width)
    wait(browser, PLOTTED)
    assert violations(browser) == []


@appearances
def test_the_page_of_a_comparison(
    browser: Any,
    tmp_path: Path,
    make_recording: Callable[..., Recording],
    scheme: str,
    width: int,
) -> None:
    first, second = make_recording(), make_recording()
    second["speed"][:] *= 1.1
    compared = comparison.compare_recordings(first, second, ("a", "b"), comparison.Tolerances())
    page = tmp_path / "comparison.html"
    page.write_text(comparison.comparison_html(compared), encoding="utf-8")
    _shown(browser, page, scheme, width)
    wait(browser, PLOTTED)
    assert violations(browser) == []
