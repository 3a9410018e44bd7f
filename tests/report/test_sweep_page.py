"""The page of a sweep: what stands on it, and that nothing in it runs."""

import re
from dataclasses import replace

from uictest.report.page import sweep_page_html
from uictest.report.sweep.result import SweepContent
from uictest.report.sweep.sweep_tables import rates_table
from uictest.report.traces.trace import trace_of

from .builders import HOSTILE, make_recording, make_result
from .sweep_rows import DRAWN, drawn_rows, sweep_result, write_rows
from .test_page import Page


def test_every_finding_has_a_heading_and_what_was_asked_comes_before_the_maps(make_sweep):
    content = make_sweep()
    html = sweep_page_html(content)
    text = Page(html).text
    for heading in (
        *("4 cases: 3 pass, 1 fail; 1 not as expected", "Cases met, %", "Frontier along 90 %"),
        *("Cases met by parameter", "Measures over rail.friction", "What the measures depend on"),
        *("Cases most worth looking at", "Provenance"),
    ):
        assert heading in text
    asked = [text.index(heading) for heading in ("Frontier along", "What the measures depend on", "Maps")]
    assert asked == sorted(asked)
    # Of two cases each two and one are met.
    assert [row["share_met"] for row in rates_table(content.result).records] == [1.0, 0.5]
    assert re.findall(r'class="bar[^"]*" style="width: ([\d.]+)%"', html) == ["100.0", "50.0"]


def test_of_a_sample_the_outcomes_are_mapped_and_the_measures_drawn_as_trends(tmp_path):
    write_rows(tmp_path, drawn_rows(60, failing=(7, 8, 9)))
    ends = {"minimum": [1.0, 2.0], "mean": [2.0, 3.0], "maximum": [3.0, 4.0]}
    trend = {"parameter": "gain", "values": DRAWN["gain"], "measure": "braking distance", "unit": "m"}
    result = sweep_result(DRAWN, 60, trends=[{**trend, "cases": [30, 30], **ends}])
    page = Page(sweep_page_html(SweepContent(tmp_path, result, {})))
    figures = [attributes.get("id") for tag, attributes in page.elements if tag == "figure"]
    assert [each for each in figures if each] == ["map-met-rail.friction-gain"]
    assert "braking distance, m; n = 30" in page.text


def test_the_controllers_under_test_are_named_as_on_the_page_of_a_run(make_sweep):
    own = {"name": "my-wsp", "version": "2.1", "kind": "python"}
    controllers = [{"name": "threshold", "version": "uictest 0.3.0"}, own, own | {"version": ""}]
    text = Page(sweep_page_html(make_sweep(controllers=controllers))).text
    assert "WSP controller: threshold (built into uictest 0.3.0), my-wsp (version 2.1), my-wsp" in text


def test_where_all_cases_are_met_no_drawing_says_so_again(make_sweep):
    content = make_sweep()
    result = replace(content.result, cases=content.result.met, missed=())
    text = Page(sweep_page_html(replace(content, result=result))).text
    assert "Cases met by parameter" not in text


def test_a_worst_case_is_drawn_and_linked_from_its_row_and_its_cell(make_sweep):
    parameters = {"brake.90 %": "80 %", "rail.friction": "0.10"}
    worst = make_result(id="stop[a]", parameters=parameters)
    traces = {"stop[a]": trace_of(make_recording())}
    page = Page(sweep_page_html(make_sweep((worst,), traces=traces)))
    assert ("details", {"class": "stop", "id": "case-stop[a]"}) in page.elements
    links = [attributes.get("href") for tag, attributes in page.elements if tag == "a"]
    # From the map and from the table of cases.
    assert links.count("#case-stop%5Ba%5D") == 2


def test_without_recordings_there_is_nothing_to_draw(make_sweep):
    page = Page(sweep_page_html(make_sweep((make_result(id="stop[a]"),))))
    assert "stop[a]" in page.text
    assert not any("var uPlot=" in text for _, text in page.scripts)


def test_hostile_texts_are_shown_and_make_no_element(make_sweep):
    harmless = Page(sweep_page_html(make_sweep((make_result(),))))
    page = Page(sweep_page_html(make_sweep((make_result(id=HOSTILE, reason=HOSTILE),), text=HOSTILE)))
    assert [tag for tag, _ in page.elements if tag == "b"] == []
    assert [tag for tag, _ in page.elements] == [tag for tag, _ in harmless.elements]
    assert "<b>&" in page.text
    assert "\u202e" not in page.text


def test_a_map_of_a_million_cells_is_bundled(make_sweep):
    values = [str(k) for k in range(1000)]
    cells = {"means": [[0.5] * 1000] * 1000, "met": [[1] * 1000] * 1000, "cases": [[2] * 1000] * 1000}
    axes = {name: {"parameter": name, "values": values} for name in ("rows", "columns")}
    html = sweep_page_html(make_sweep(maps=[{"measure": "met", **axes, **cells}]))
    assert len(html) < 1_000_000
    assert "Folded: neighbours of 1000 values of rows share 59 cells." in html
