"""Every kind of page against the rules of axe-core, in light and dark, wide and narrow."""

import dataclasses
from importlib.resources import files

import pytest

from uictest.analysis import comparison
from uictest.core.recording import Recording
from uictest.judging.evaluation import RepeatedStop, Repeats
from uictest.report import Campaign, CampaignColumn, CampaignTable, RunContent, RunManifest
from uictest.report.page import page_html, sweep_page_html
from uictest.report.sweep.folder import SweepContent
from uictest.report.traces.trace import trace_of

from .builders import make_recording, make_result
from .chromium import COMPARED, PLOTTED, emulate, resize, run, wait
from .sweep_rows import DRAWN, drawn_rows, sweep_result, write_rows

_CHECK = """
const done = arguments[arguments.length - 1];
const sizes = ['scrollWidth', 'clientWidth', 'scrollHeight', 'clientHeight'].map(
  (name) => [name, Object.getOwnPropertyDescriptor(Element.prototype, name)]);
for (const [name, own] of sizes) {
  const known = new WeakMap();
  Object.defineProperty(Element.prototype, name, {...own, get() {
    if (!known.has(this)) known.set(this, own.get.call(this));
    return known.get(this);
  }});
}
const end = (found) => {
  for (const [name, own] of sizes) Object.defineProperty(Element.prototype, name, own);
  done(found);
};
axe.run({exclude: [['svg.main-svg']]}, {resultTypes: ['violations'], preload: false}).then(
  ({violations}) => end(
    violations.flatMap(({id, nodes}) => nodes.map((node) => `${id}: ${node.target.join(' ')}`))),
  (error) => end([String(error)]));
"""
"""What a canvas shows is no text of ours; its values are read at the cursor and from the tables.

The page stands still meanwhile: the size of an element is measured once, not for each text inside.
"""

_ALL_PLOTTED = """
const missing = document.querySelector('details.stop .plots:not([data-ready])');
missing?.scrollIntoView({block: 'nearest', behavior: 'instant'});
return !missing;
"""


def violations(browser):
    """Return what violates a rule on the page that is shown: the rule and the element."""
    run(browser, files("axe_core_python").joinpath("axe.min.js").read_text("utf-8"))
    browser.set_script_timeout(110)
    return browser.execute_async_script(_CHECK)


appearances = pytest.mark.parametrize(("scheme", "width"), [("light", 1400), ("dark", 390)])


def shown(browser, page, scheme="light", width=1400):
    """Open a page in a colour scheme and in a window of so many pixels."""
    resize(browser, width)
    emulate(browser, scheme)
    browser.get(page.as_uri())


def assert_fit_for_all(browser):
    """Hold the page that is shown to the rules, contrasts among them, and to the width of its window."""
    assert violations(browser) == []
    assert run(browser, "return document.documentElement.scrollWidth <= innerWidth")


@appearances
def test_the_page_of_a_run(browser, page, scheme, width):
    """With two cases compared, and with every fold open."""
    shown(browser, page, scheme, width)
    run(browser, "document.querySelectorAll('input.compare').forEach((box, k) => k < 2 && box.click())")
    wait(browser, COMPARED)
    run(browser, "document.querySelectorAll('details').forEach((each) => { each.open = true; })")
    wait(browser, _ALL_PLOTTED)
    assert_fit_for_all(browser)


@appearances
def test_the_page_of_a_log(browser, tmp_path, scheme, width):
    """With a table at each place, and every fold open."""
    word, figure = CampaignColumn("what", "what"), CampaignColumn("number", "number\nm", 2)
    stops, long = CampaignColumn("stops", "stops"), CampaignColumn("why", "why", wraps=True)
    rows = ("dry", 0.5, "stop-0001, stop-0002", "a long reason " * 9), ("wet", 0.1, "", "")
    tables = (
        CampaignTable("dry", "Dry stops", "By chance.", "first", (word, figure, stops, long), rows),
        CampaignTable("more", "More", "By chance.", "detail", (word, figure, stops, long), rows),
    )
    result = make_result(id="stop-0001", outcome="fail")
    traces = {result.id: trace_of(make_recording())}
    together = Campaign(("friction found in 1 of 2 stops",), tables)
    page = tmp_path / "index.html"
    page.write_text(
        page_html(RunContent("log", [result], traces=traces, campaign=together)), encoding="utf-8"
    )
    shown(browser, page, scheme, width)
    run(browser, "document.querySelectorAll('details').forEach((each) => { each.open = true; })")
    wait(browser, _ALL_PLOTTED)
    assert_fit_for_all(browser)


@appearances
def test_the_page_of_a_sweep(browser, tmp_path, make_sweep, scheme, width):
    worst = make_result(id="study[a]", outcome="fail")
    page = tmp_path / "index.html"
    sweep = make_sweep((worst,), "x", traces={worst.id: trace_of(make_recording())})
    page.write_text(sweep_page_html(sweep), encoding="utf-8")
    shown(browser, page, scheme, width)
    wait(browser, PLOTTED)
    assert_fit_for_all(browser)


@appearances
def test_the_maps_and_sensitivities_of_a_sample(browser, tmp_path, scheme, width):
    """With every map unfolded."""
    write_rows(tmp_path, drawn_rows(60, failing=(7, 8, 9)))
    index = {"value": 0.5, "low": 0.4, "high": 0.6}
    parts = {"measure": "met", "circumstances": {}, "first": index, "total": index}
    sensitivities = [{**parts, "key": key} for key in DRAWN]
    result = sweep_result(DRAWN, 60, logarithmic=["gain"], sensitivities=sensitivities)
    page = tmp_path / "index.html"
    page.write_text(sweep_page_html(SweepContent(tmp_path, result, {})), encoding="utf-8")
    shown(browser, page, scheme, width)
    run(browser, "document.querySelectorAll('details').forEach((each) => { each.open = true; })")
    assert_fit_for_all(browser)


@appearances
def test_the_page_of_a_comparison(browser, tmp_path, scheme, width):
    """With a band, a channel that only one side has, other rates, and over distance."""
    first, second = make_recording(), make_recording(1701)
    second["speed"][:] *= 1.1
    fewer = {name: samples for name, samples in second.channels.items() if name != "adhesion_4"}
    units = {name: second.units[name] for name in fewer}
    tolerances = comparison.Tolerances.read(["speed=2"])
    compared = comparison.compare_recordings(first, Recording(fewer, units), ("a", "b"), tolerances)
    page = tmp_path / "comparison.html"
    page.write_text(comparison.comparison_html(compared), encoding="utf-8")
    shown(browser, page, scheme, width)
    browser.get(page.as_uri() + "#case-Recordings")
    wait(browser, "return document.querySelector('.laid-over[data-ready]') !== null")
    run(browser, "document.querySelectorAll('details').forEach((each) => { each.open = true; })")
    assert_fit_for_all(browser)
    run(
        browser,
        "const choice = document.querySelector('[data-choice=across]'); choice.value = 'distance';"
        "choice.dispatchEvent(new Event('change'))",
    )
    assert_fit_for_all(browser)


@appearances
def test_the_pages_of_paired_stops(browser, tmp_path, scheme, width):
    """Two runs that differ in everything a page lists, and two variants of one run."""
    sides = [
        RunContent(name, [_repeated(distance, name)], RunManifest(seed=seed))
        for seed, (name, distance) in enumerate((("one", 465.0), ("other", 470.0)))
    ]
    compared = comparison.compare_runs(*sides, comparison.Tolerances())
    both = RunContent("both", [case for side in sides for case in side.results])
    variants = comparison.compare_variants(both, ["controller"])
    for text in (comparison.comparison_html(compared), comparison.variants_html("both", variants)):
        assert "Stops under the same noise" in text
        page = tmp_path / "comparison.html"
        page.write_text(text, encoding="utf-8")
        shown(browser, page, scheme, width)
        assert_fit_for_all(browser)


def _repeated(distance, controller):
    result = make_result(id="slip", parameters={"controller": controller})
    assert result.measures is not None
    stops = tuple(
        RepeatedStop(
            seed, "pass", "", (), {**result.measures, "braking_distance_m": distance + seed}, result.wheelsets
        )
        for seed in (1, 2, 3)
    )
    return dataclasses.replace(
        result, id=f"slip[controller={controller}]", noise_key="00c0ffee", repeats=Repeats("all", stops)
    )
