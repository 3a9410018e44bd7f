"""Every kind of page against the rules of axe-core, in light and dark, wide and narrow."""

import dataclasses
from importlib.resources import files

import pytest

from studies.quantity import OwnBand, SourceBand, StudyQuantity, StudyValue
from studies.study import Study, StudyFindings, StudyResult
from studies.writing import write_figures, write_pages
from uictest import report, runs
from uictest.analysis import comparison
from uictest.analysis.comparison.runs import compare_runs
from uictest.core.recording import Recording
from uictest.judging.evaluation import RepeatedStop, Repeats
from uictest.report import Campaign, CampaignColumn, CampaignTable, RunContent, RunManifest
from uictest.report.page import page_html, sweep_page_html
from uictest.report.sweep.result import SweepContent
from uictest.report.traces.trace import trace_of

from .builders import make_recording, make_result
from .chromium import COMPARED, READY, choose, emulate, resize, run, unfold, wait, written
from .sweep_rows import INTERVALS, drawn_rows, sweep_result, write_rows

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


def _assert_fit_for_all(browser):
    """Hold the page that is shown to the rules, contrasts among them, and to the width of its window."""
    run(browser, files("axe_core_python").joinpath("axe.min.js").read_text("utf-8"))
    browser.set_script_timeout(110)
    assert browser.execute_async_script(_CHECK) == []
    assert run(browser, "return document.documentElement.scrollWidth <= innerWidth")


def _log(folder):
    """The page of a log with a table at each place."""
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
    yield page_html(RunContent("log", [result], traces=traces, campaign=together))


def _sample(folder):
    """The page of a sample, with maps and sensitivities."""
    write_rows(folder, drawn_rows(60, failing=(7, 8, 9)))
    index = {"value": 0.5, "low": 0.4, "high": 0.6}
    parts = {"measure": "met", "circumstances": {}, "first": index, "total": index}
    sensitivities = [{**parts, "key": key} for key in INTERVALS]
    result = sweep_result(INTERVALS, 60, logarithmic=["gain"], sensitivities=sensitivities)
    yield sweep_page_html(SweepContent(folder, result, {}))


def _paired_stops(folder):
    """The pages of two runs that differ in everything a page lists, and of two variants of one run."""
    sides = [
        RunContent(name, [_repeated(distance, name)], RunManifest(seed=seed))
        for seed, (name, distance) in enumerate((("one", 465.0), ("other", 470.0)))
    ]
    compared = compare_runs(*sides, comparison.Tolerances())
    both = RunContent("both", [case for side in sides for case in side.results])
    variants = comparison.compare_variants(both, ["controller"], comparison.Tolerances())
    for text in (comparison.comparison_html(compared), comparison.comparison_html(*variants, run="both")):
        assert 'class="conditions"' in text
        yield text


def _repeated(distance, controller):
    result = make_result(id="slip", parameters={"controller": controller})
    measures = [{**result.measures, "braking_distance_m": distance + seed} for seed in (1, 2, 3)]
    stops = [RepeatedStop(k, "pass", "", (), own, result.wheelsets) for k, own in enumerate(measures, 1)]
    changes = {"noise_key": "00c0ffee", "repeats": Repeats("all", tuple(stops))}
    return dataclasses.replace(result, id=f"slip[controller={controller}]", **changes)


def _index(folder):
    """The index of three runs of which the second fails, of a sweep that is not finished, and of a folder."""
    reports = folder / "reports"
    for outcome in ("pass", "fail", "pass"):
        results = [make_result(id="slip-120", outcome=outcome), make_result(id="dry-120")]
        manifest = RunManifest(command=("uictest", "run", outcome), versions={"uictest": "0.1.0"})
        runs.publish_run(RunContent("", results, manifest), {}, reports, ("html",))
    (reports / "mine").mkdir()
    runs.publish_run(report.RunContent("", [make_result(id="dry-120")]), {}, reports, ())
    yield (reports / "index.html").read_text("utf-8")


def _studies(folder):
    """The pages of a study with a value that holds, one that misses, one that is only shown, and a figure."""
    pytest.importorskip("matplotlib")
    ours = OwnBand(lower=16.5, upper=19.0, reason="ours")
    below = SourceBand(upper=2.0, below=True, declared_miss="Heat.")
    quantities = (
        StudyQuantity("time", "braking time", "s", "17.6 s", status="calibrated", band=ours),
        StudyQuantity("share", "share", "%", "below 2 %", status="predicted", band=below),
        StudyQuantity("count", "actuations", status="predicted", digits=0),
    )
    values = {"time": StudyValue(18.1, 17.9, 18.3), "share": StudyValue(2.5), "count": StudyValue(11.0)}
    figures = {"figure": lambda figure: figure.subplots().plot([0.0, 1.0], [1.0, 0.0])}
    findings = StudyFindings(values, {"data": {"time_s": [0.0]}}, figures, ("Made up.",))
    study = Study("made-up", "A made-up study", "17.6 s", quantities, lambda _: findings)
    result = StudyResult(study, findings)
    write_figures(folder, result)
    write_pages(folder, [result], [], [])
    for page in (folder / "made-up" / "index.html", folder / "index.html"):
        yield page.read_text("utf-8")


APPEARANCES = [("light", 1400), ("dark", 390)]


def _sweep(folder, make_sweep):
    """The page of a sweep whose worst case is drawn."""
    worst = make_result(id="study[a]", outcome="fail")
    yield sweep_page_html(make_sweep((worst,), "x", traces={worst.id: trace_of(make_recording())}))


@pytest.mark.parametrize(("scheme", "width"), APPEARANCES)
@pytest.mark.parametrize("pages", [_log, _sample, _sweep, _paired_stops, _index, _studies])
def test_a_page_with_every_fold_open(browser, tmp_path, make_sweep, pages, scheme, width):
    resize(browser, width)
    emulate(browser, scheme)
    for page in pages(tmp_path, *([make_sweep] if pages is _sweep else [])):
        browser.get(written(tmp_path, page).as_uri())
        unfold(browser)
        wait(browser, _ALL_PLOTTED)
        _assert_fit_for_all(browser)


@pytest.mark.parametrize(("scheme", "width"), APPEARANCES)
def test_the_page_of_a_run(browser, page, scheme, width):
    """With two cases compared, and with every fold open."""
    resize(browser, width)
    emulate(browser, scheme)
    browser.get(page.as_uri())
    run(browser, "document.querySelectorAll('input.compare').forEach((box, k) => k < 2 && box.click())")
    wait(browser, COMPARED)
    unfold(browser)
    wait(browser, _ALL_PLOTTED)
    _assert_fit_for_all(browser)


@pytest.mark.parametrize(("scheme", "width"), APPEARANCES)
def test_the_page_of_a_comparison(browser, tmp_path, scheme, width):
    """With a band, a channel that only one side has, other rates, and over distance."""
    first, second = make_recording(), make_recording(1701)
    second["speed"][:] *= 1.1
    fewer = {name: samples for name, samples in second.channels.items() if name != "adhesion_4"}
    units = {name: second.units[name] for name in fewer}
    tolerances = comparison.Tolerances.read(["speed=2"])
    compared = comparison.compare_recordings(first, Recording(fewer, units), ("a", "b"), tolerances)
    resize(browser, width)
    emulate(browser, scheme)
    browser.get(written(tmp_path, comparison.comparison_html(compared)).as_uri() + "#case-Recordings")
    wait(browser, READY)
    unfold(browser)
    _assert_fit_for_all(browser)
    choose(browser, "across", "distance")
    _assert_fit_for_all(browser)
