"""The pages of a run and of a sweep as text: what stands on them, and that nothing in it runs."""

import base64
import hashlib
import itertools
import re
from dataclasses import replace
from html.parser import HTMLParser

import pytest

from uictest.judging.evaluation import EffectivePart, Parameter, Sensitivity, VerdictInterval
from uictest.report import DRAWN, CaseDescription, RunManifest
from uictest.report.page import page_html, sweep_page_html
from uictest.report.page.run_page import maps_of
from uictest.report.sweep.result import SweepContent
from uictest.report.sweep.sweep_tables import rates_table
from uictest.report.traces.trace import trace_of

from .builders import HOSTILE, make_content, make_recording, make_result, make_verdict
from .sweep_rows import INTERVALS, drawn_rows, sweep_result, write_rows

_TRACE = trace_of(make_recording(sliding_time="5"))


class Page(HTMLParser):
    """The elements of a page, its text outside scripts, and the texts of its scripts."""

    def __init__(self, html):
        super().__init__()
        self.elements = []
        self.text = ""
        self.scripts = []
        self.feed(html)

    def handle_starttag(self, tag, attrs):
        self.elements.append((tag, dict(attrs)))
        if tag == "script":
            self.scripts.append((dict(attrs), ""))

    def handle_data(self, data):
        if self.elements and self.elements[-1][0] == "script" and self.cdata_elem == "script":
            attributes, text = self.scripts[-1]
            self.scripts[-1] = (attributes, text + data)
        else:
            self.text += data

    def count(self, tag):
        return sum(1 for name, _ in self.elements if name == tag)

    def part(self, first="", last=""):
        """Return the text between two headings, each blank one space."""
        text = self.text.partition(f"\n{first}\n")[2] if first else self.text
        return " ".join((text.partition(f"\n{last}\n")[0] if last else text).split())


def of(*results, **changes):
    """Return the page of some cases."""
    return page_html(make_content(*results, **changes))


@pytest.fixture(scope="module")
def drawn():
    """The page of one stop that is drawn."""
    result = make_result()
    return of(result, traces={result.id: _TRACE})


_UNMET = make_verdict(id="initial-adhesion", margin=-10.0, status="fail", reason="0.124 g misses < 0.08 g")
_FAILED = make_verdict(id="locked", layer="requirement", margin=-1.0, status="fail", reason="locked")


def test_the_page_of_a_run_in_which_cases_pass_turn_are_no_test_fail_are_swept_and_verify_requirements():
    intervals = VerdictInterval(10, 40, "pass"), VerdictInterval(50, 60, "fail")
    turning = make_verdict(sensitivity=(Sensitivity("low_speed_cutoff", "km/h", 10, 60, intervals),))
    flat = make_verdict(id="short-flats", measure="flat_length", status="fail", value=5.0, margin=-600.0)
    ids = {"requirements": ("BR-CASE",), "test_case": "WSP-TC-7"}
    named = make_result(**ids, criteria=(make_verdict(requirements=("BR-CRITERION",)),))
    grid = [
        make_result(id=f"{a}{b}", scenario="grid.yaml", parameters={"rail.friction": a, "brake.command": b})
        for a, b in itertools.product(("0.1", "0.2"), ("80 %", "100 %"))
    ]
    page = Page(
        of(
            make_result(id="dry", outcome="invalid", criteria=(), reason="the rail was too dry"),
            make_result(id="no-test", outcome="invalid", criteria=(_UNMET, _FAILED)),
            make_result(id="turns", criteria=(turning,)),
            make_result(id="flats", outcome="fail", criteria=(flat,)),
            *(named, make_result(id="b", outcome="fail", requirements=("BR-CASE",), criteria=()), *grid),
            manifest=RunManifest(command=("uictest", "run", "-k", "a and b"), versions={}),
            traces=dict.fromkeys(("no-test", "flats", named.id), _TRACE),
            complete=False,
        )
    )
    for first, last, *said in (
        ("", "Verdicts", "2 of 10 cases failed", "2 are not valid tests",
         "incomplete: not all that was selected was run", "uictest run -k 'a and b'"),
        ("Verdicts", "Requirements", "dry-120[command=90]", "465.2", "27.5", "the rail was too dry",
         "WSP-TC-7: BR-CASE", "sensitive to definitions: braking-distance", "No plots for 7 cases"),
        ("Requirements", "Stops", "not met BR-CASE 2 b (fail) 2 cases",
         "met BR-CRITERION 1 dry-120[command=90] by braking-distance",
         "rail.friction (down), brake.command (across)"),
        ("Stops", "Provenance", "short-flats", "test caseWSP-TC-7", "requirementsBR-CASE", "BR-CRITERION",
         "invalid: initial-adhesion"),
    ):  # fmt: skip
        part = page.part(first, last)
        assert [words for words in said if words not in part] == []
    # A margin beyond the scale has an arrow.
    amounts = [a["d"] for tag, a in page.elements if tag == "path" and a.get("class") == "amount mark-fail"]
    assert amounts == ["M0 5L4 0V10z"]


def test_a_stop_that_is_no_test_does_not_look_like_a_failure_and_without_stops_no_script_plots():
    result = make_result(outcome="invalid", criteria=(_UNMET, _FAILED))
    page = of(result, traces={result.id: _TRACE})
    assert page.count('<span class="word word-odd">invalid</span>') == 2
    assert '<span class="word judgement-inconclusive">not met</span>' in page
    assert '<span class="word judgement-fail">fail</span>' in page
    html = of(make_result())
    assert len(html) < 200_000  # the rest of the page is most of it
    assert "No plots for 1 case" in html
    assert 'id="requirements"' not in html


def test_a_drawn_case_can_be_read_without_javascript_and_loads_nothing(drawn):
    """The valves of the case vent, with both magnets, in one stretch: a lane for each of them."""
    page = Page(drawn)
    assert page.count("path") > 40
    for title in ("Speed of train", "Pressures", "WSP valves"):
        assert title in page.text
    titles = [drawn.index(f'class="plot-{key}"') for key in ("speed", "valves", "pressure")]
    assert titles == sorted(titles)
    paths = {a.get("class"): a["d"] for tag, a in page.elements if tag == "path"}
    for n, magnet in itertools.product((1, 2, 3, 4), ("hold", "vent")):
        assert f"{n} {magnet}" in page.text.split("\n")
        assert paths[f"magnet {magnet} role-wheelset-{n}"].count("h") == 1
    heads = re.findall(r"<th scope=.col.[^>]*>(.*?)</th>", drawn, re.DOTALL)
    assert heads
    assert [head for head in heads if not head.strip()] == []
    # It runs only its own scripts.
    places = [attributes.get(name) for _, attributes in page.elements for name in ("src", "href", "action")]
    assert all(place is None or place.startswith("#") for place in places)
    policy = next(a["content"] for tag, a in page.elements if tag == "meta" and "http-equiv" in a)
    assert policy.startswith("default-src 'none'; ")
    executable = [text for attributes, text in page.scripts if not attributes]
    digests = {base64.b64encode(hashlib.sha256(text.encode()).digest()).decode() for text in executable}
    assert len(digests) == 2
    assert set(re.findall(r"'sha256-([^']+)'", policy)) == digests


def test_hostile_texts_are_shown_and_make_no_element(drawn):
    bad = f"{HOSTILE}</script></td><img src=x onerror=alert(1)>"
    verdict = make_verdict(id=bad, reason=bad, definition={bad: bad}, status="fail", margin=-1.0)
    named = {"requirements": (bad,), "test_case": bad}  # a results.json from elsewhere may hold anything
    result = make_result(
        id=bad, scenario=bad, parameters={bad: bad}, outcome="fail", criteria=(verdict,), reason=bad, **named
    )
    html = of(
        result,
        name=bad,
        manifest=RunManifest(command=(bad,), inputs={bad: bad}, versions={bad: bad}),
        subjects={bad: CaseDescription(bad, (bad,), {bad: bad})},
        traces={bad: trace_of(make_recording())},
    )
    page, ordinary = Page(html), Page(drawn)
    for tag in ("script", "img", "b", "svg", "iframe"):
        assert page.count(tag) == ordinary.count(tag)
    assert page.text.count("<img src=x onerror=alert(1)>") >= 8
    assert not any(name.startswith("on") for _, attributes in page.elements for name in attributes)
    assert not re.search("[\x00\x1b\u202e]", html)
    assert "\\u202e" in page.text


def test_a_thousand_cases_stay_below_ten_megabytes_and_say_what_is_not_drawn():
    reason = "0 of 4 wheelsets within the limit of 1 s (4 needed): 1.27, 1.24, 1.29, 1.32 s"
    broken = make_verdict(status="fail", margin=-10.0, reason=reason)
    results = [
        make_result(id=f"wet-80-friction[friction=0.{n:03}]", outcome="fail", criteria=(broken,) * 7)
        for n in range(1000)
    ]
    subject = CaseDescription(
        "Stop from 80 km/h at full command with initial friction coefficients", ("slide",)
    )
    html = of(
        *results,
        traces={result.id: _TRACE for result in results[:30]},
        subjects={result.id: subject for result in results},
    )
    assert len(html.encode()) < 10_000_000
    assert html.count('<details class="stop"') == DRAWN
    assert f"Plots for {DRAWN} of 1000 cases" in html


def test_what_is_not_as_expected_comes_first_and_the_page_says_how_many_of_the_chosen_cases_it_draws():
    def case(name, margin, **changes):
        verdict = make_verdict(margin=margin, status="pass" if margin > 0 else "fail")
        return make_result(id=name, criteria=(verdict,), **changes)

    results = [case("wide", 24.0), case("narrow", 1.0), case("missed", -9.0, outcome="fail")]
    html = of(*results, traces={each.id: _TRACE for each in results})
    rows = re.findall(r'<tr[^>]* data-word="[^"]*"[\s\S]*?aria-label="Compare ([^"]*)"', html)
    stops = re.findall(r'<details class="stop"[\s\S]*?<h3>([^<]*)</h3>', html)
    assert rows == stops == ["missed", "narrow", "wide"]
    results = [make_result(id=f"case-{n}") for n in range(30)]
    traces = {result.id: _TRACE for result in results[:20]}
    html = of(*results, traces=traces, drawn_first={result.id for result in results[19:22]})
    assert "Plots for 18 of 30 cases. 2 of those chosen with --draw are not among them" in html
    assert 'id="case-case-19" ' not in html.partition('id="stops"')[0]
    assert '<details class="stop" id="case-case-19"' in html


def _swept(**keys):
    """Return the cases of a sweep whose scenario says what each parameter is."""
    cases = []
    for values in itertools.product(*keys.values()):
        texts = dict(zip(keys, values, strict=True))
        parameters = tuple(
            Parameter(key, float(text.split()[0]) if text[0].isdigit() else text, "", text, "user")
            for key, text in texts.items()
        )
        part = EffectivePart("scenario", "", "", None, parameters)
        cases.append(make_result(id=str(texts), parameters=texts, parts={"scenario": part}))
    return cases


def test_two_swept_keys_make_a_map_in_the_order_of_their_numbers_or_as_their_texts_came():
    results = _swept(friction=["0.12", "0.09"], command=["100 %", "80 %"], speed=["80 km/h"])
    (found,) = maps_of(results)
    assert (found.row_key, found.column_key) == ("friction", "command")
    assert (found.rows, found.columns) == (["0.09", "0.12"], ["80 %", "100 %"])
    assert found.cells[0][1] is results[2]
    (found,) = maps_of(_swept(state=["bypassed", "active"], friction=["0.12", "0.09"])[1:])
    assert (found.rows, found.columns) == (["bypassed", "active"], ["0.09", "0.12"])
    assert found.cells[0][1] is None  # it was excluded
    # One key, three keys and repeated cases make none.
    two = ["1", "2"]
    for cases in (_swept(a=two), _swept(a=two, b=two, c=two), _swept(a=two, b=two) * 2):
        assert list(maps_of(cases)) == []


def test_the_page_of_a_sweep_has_every_finding_and_what_was_asked_before_the_maps(make_sweep):
    own = {"name": "my-wsp", "version": "2.1", "kind": "python"}
    controllers = [{"name": "threshold", "version": "uictest 0.3.0"}, own, own | {"version": ""}]
    content = make_sweep((make_result(id="stop[a]"),), controllers=controllers)
    html = sweep_page_html(content)
    page = Page(html)
    for said in (
        *("4 cases: 3 pass, 1 fail; 1 not as expected", "Cases met, %", "Frontier along 90 %"),
        *(
            "Cases met by value of each parameter",
            "Measures over rail.friction",
            "What the measures depend on",
        ),
        "Provenance",
        "WSP controller: threshold (built into uictest 0.3.0), my-wsp (version 2.1), my-wsp",
    ):
        assert said in page.text
    asked = [page.text.index(said) for said in ("Frontier along", "What the measures depend on", "Maps")]
    assert asked == sorted(asked)
    # Of two cases each two and one are met.
    assert [row["share_met"] for row in rates_table(content.result).records] == [1.0, 0.5]
    assert page.text.index("██████████") < page.text.index("█████░░░░░")
    # Without recordings nothing is drawn; where all cases are met no drawing says so again.
    assert not any("var uPlot=" in text for _, text in page.scripts)
    result = replace(content.result, cases=content.result.met, missed=())
    assert "Cases met by value" not in Page(sweep_page_html(replace(content, result=result))).text


def test_of_a_sample_the_outcomes_are_mapped_and_the_measures_drawn_as_trends(tmp_path):
    write_rows(tmp_path, drawn_rows(60, failing=(7, 8, 9)))
    ends = {"minimum": [1.0, 2.0], "mean": [2.0, 3.0], "maximum": [3.0, 4.0]}
    trend = {"parameter": "gain", "values": INTERVALS["gain"], "measure": "braking distance", "unit": "m"}
    result = sweep_result(INTERVALS, 60, trends=[{**trend, "cases": [30, 30], **ends}])
    page = Page(sweep_page_html(SweepContent(tmp_path, result, {})))
    figures = [attributes.get("id") for tag, attributes in page.elements if tag == "figure"]
    assert [each for each in figures if each] == ["map-met-rail.friction-gain"]
    assert "braking distance, m; n = 30" in page.text


def test_a_worst_case_is_drawn_and_linked_from_what_is_missed_and_its_cell(make_sweep):
    parameters = {"brake.90 %": "80 %", "rail.friction": "0.10"}
    worst = make_result(id="stop[a]", parameters=parameters, outcome="fail", criteria=(), reason="locked")
    traces = {"stop[a]": trace_of(make_recording())}
    page = Page(sweep_page_html(make_sweep((worst,), traces=traces)))
    assert any(
        tag == "details" and attributes.get("id") == "case-stop[a]" for tag, attributes in page.elements
    )
    links = [attributes.get("href") for tag, attributes in page.elements if tag == "a"]
    # From the map and from what is not as expected.
    assert links.count("#case-stop%5Ba%5D") == 2


def test_hostile_texts_make_no_element_of_the_page_of_a_sweep(make_sweep):
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
