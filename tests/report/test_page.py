import base64
import hashlib
import itertools
import re
from html.parser import HTMLParser

import pytest

from uictest.judging.evaluation import Sensitivity, VerdictInterval
from uictest.report import DRAWN, CaseDescription, RunManifest
from uictest.report.page import page_html
from uictest.report.traces.trace import trace_of

from .builders import HOSTILE, make_content, make_recording, make_result, make_verdict


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


@pytest.fixture(scope="module")
def drawn():
    """The page of one stop that is drawn."""
    result = make_result()
    return page_html(make_content(result, traces={result.id: trace_of(make_recording(sliding_time="5"))}))


def test_every_case_has_a_row_with_its_figures():
    missed = make_result(id="b", outcome="invalid", criteria=(), reason="the rail was too dry")
    page = Page(page_html(make_content(make_result(), missed)))
    assert "2 cases: 1 pass, 1 invalid; 1 not as expected" in page.text
    for text in ("dry-120[command=90]", "465.2", "27.5", "invalid", "the rail was too dry"):
        assert text in page.text
    assert page.count("th") >= 12


def test_a_drawn_case_can_be_read_without_javascript(drawn):
    page = Page(drawn)
    assert page.count("path") > 40
    for title in ("Speed of train", "Pressures", "WSP valves"):
        assert title in page.text
    titles = [drawn.index(f'class="plot-{key}"') for key in ("speed", "valves", "pressure")]
    assert titles == sorted(titles)


def test_each_wheelset_has_a_lane_for_each_magnet_of_its_valve(drawn):
    """The valves of the drawn case vent, with both magnets, in one stretch."""
    page = Page(drawn)
    paths = {a.get("class"): a["d"] for tag, a in page.elements if tag == "path"}
    for n, magnet in itertools.product((1, 2, 3, 4), ("hold", "vent")):
        assert f"{n} {magnet}" in page.text.split("\n")
        assert paths[f"magnet {magnet} role-wheelset-{n}"].count("z") == 1


def test_a_stop_that_is_no_test_does_not_look_like_a_failure():
    unmet = make_verdict(id="initial-adhesion", margin=-10.0, status="fail", reason="0.124 g misses < 0.08 g")
    failed = make_verdict(
        id="locked-wheels", layer="requirement", margin=-1.0, status="fail", reason="locked"
    )
    result = make_result(outcome="invalid", criteria=(unmet, failed))
    page = page_html(make_content(result, traces={result.id: trace_of(make_recording(sliding_time="5"))}))
    assert page.count('<span class="word word-odd">invalid</span>') == 3
    assert '<span class="word judgement-inconclusive">not met</span>' in page
    assert '<span class="word judgement-fail">fail</span>' in page
    reasons = re.search(r'<div class="explanation">(.*?)</div>', page).group(1)
    assert "<p>locked-wheels (requirement) fail: locked</p>" in reasons


def test_the_page_loads_nothing_and_runs_only_its_own_scripts(drawn):
    page = Page(drawn)
    places = [attributes.get(name) for _, attributes in page.elements for name in ("src", "href", "action")]
    assert all(place is None or place.startswith("#") for place in places)
    policy = next(a["content"] for tag, a in page.elements if tag == "meta" and "http-equiv" in a)
    assert policy.startswith("default-src 'none'; ")
    executable = [text for attributes, text in page.scripts if not attributes]
    digests = {base64.b64encode(hashlib.sha256(text.encode()).digest()).decode() for text in executable}
    assert len(digests) == 2
    assert set(re.findall(r"'sha256-([^']+)'", policy)) == digests


def test_without_anything_to_draw_the_plotting_script_stays_out():
    html = page_html(make_content(make_result()))
    assert len(html) < 200_000  # the rest of the page is most of it
    assert "1 case not drawn" in html
    assert 'id="requirements"' not in html


def test_hostile_texts_are_shown_and_make_no_element(drawn):
    bad = f"{HOSTILE}</script></td><img src=x onerror=alert(1)>"
    verdict = make_verdict(id=bad, reason=bad, definition={bad: bad}, status="fail", margin=-1.0)
    named = {"requirements": (bad,), "test_case": bad}  # a results.json from elsewhere may hold anything
    result = make_result(
        id=bad, scenario=bad, parameters={bad: bad}, outcome="fail", criteria=(verdict,), reason=bad, **named
    )
    content = make_content(
        result,
        name=bad,
        manifest=RunManifest(command=(bad,), inputs={bad: bad}, versions={bad: bad}),
        subjects={bad: CaseDescription(bad, (bad,), {bad: bad})},
        traces={bad: trace_of(make_recording())},
    )
    html = page_html(content)
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
    trace = trace_of(make_recording(sliding_time="5"))
    content = make_content(
        *results,
        traces={result.id: trace for result in results[:30]},
        subjects={result.id: subject for result in results},
    )
    html = page_html(content)
    assert len(html.encode()) < 10_000_000
    assert html.count('<details class="stop"') == DRAWN
    assert f"{DRAWN} of 1000 cases are drawn" in html


_TURNS = Sensitivity(
    "low_speed_cutoff", "km/h", 10, 60, (VerdictInterval(10, 40, "pass"), VerdictInterval(50, 60, "fail"))
)
_COMMAND = RunManifest(command=("uictest", "run", "-k", "a and b"), versions={})
_GRID = [
    make_result(id=f"{a}{b}", parameters={"rail.friction": a, "brake.command": b})
    for a, b in itertools.product(("0.1", "0.2"), ("80 %", "100 %"))
]
_NOT_DRAWN = make_verdict(id="short-flats", measure="flat_length", status="fail", value=5.0, margin=-1.0)


@pytest.mark.parametrize(
    ("content", "words"),
    [
        (
            make_content(make_result(criteria=(make_verdict(sensitivity=(_TURNS,)),))),
            "sensitive to definitions: braking-distance",
        ),
        (make_content(*_GRID), "rail.friction (down) against brake.command (across)"),
        (make_content(make_result(), complete=False), "not all that was selected was run"),
        (make_content(make_result(), manifest=_COMMAND), "uictest run -k 'a and b'"),
        (
            make_content(
                make_result(outcome="fail", criteria=(_NOT_DRAWN,)),
                traces={make_result().id: trace_of(make_recording())},
            ),
            "short-flats",
        ),
    ],
    ids=["verdict-that-turns", "map-of-two-keys", "incomplete", "command", "criterion-without-a-drawing"],
)
def test_the_page_says(content, words):
    assert words in Page(page_html(content)).text


def test_requirements_stand_in_a_table_and_at_the_cases_and_criteria_that_name_them():
    verdict = make_verdict(requirements=("BR-CRITERION",))
    named = make_result(requirements=("BR-CASE",), test_case="WSP-TC-7", criteria=(verdict,))
    failed = make_result(id="b", outcome="fail", requirements=("BR-CASE",), criteria=())
    traces = {named.id: trace_of(make_recording())}
    page = Page(page_html(make_content(named, failed, traces=traces)))
    table = page.text.partition("\nRequirements\n")[2].partition("\nStops\n")[0]
    cells = " ".join(table.split())
    assert "not met BR-CASE 2 b (fail) 2 cases" in cells
    assert "met BR-CRITERION 1 dry-120[command=90] by braking-distance" in cells
    row, stop = page.text.partition("\nRequirements\n")[0], page.text.partition("\nStops\n")[2]
    assert "WSP-TC-7: BR-CASE" in row
    assert "BR-CRITERION" in stop
    assert re.search(r"test case\s*WSP-TC-7\s*requirements\s*BR-CASE", stop)


def test_the_page_says_how_many_of_the_chosen_cases_it_draws():
    results = [make_result(id=f"case-{n}") for n in range(30)]
    trace = trace_of(make_recording())
    traces = {result.id: trace for result in results[:20]}
    chosen = {result.id for result in results[19:22]}
    html = page_html(make_content(*results, traces=traces, drawn_first=chosen))
    assert "18 of 30 cases are drawn: those chosen with --draw (not 2 of them), then those not" in html
    assert 'id="case-case-19" ' not in html.partition('id="stops"')[0]
    assert '<details class="stop" id="case-case-19"' in html


def test_what_is_not_as_expected_comes_first_then_the_narrowest_margins():
    def case(name, margin, **changes):
        verdict = make_verdict(margin=margin, status="pass" if margin > 0 else "fail")
        return make_result(id=name, criteria=(verdict,), **changes)

    results = [case("wide", 24.0), case("narrow", 1.0), case("missed", -9.0, outcome="fail")]
    traces = {each.id: trace_of(make_recording()) for each in results}
    html = page_html(make_content(*results, traces=traces))
    rows = re.findall(r'<tr[^>]* data-word="[^"]*"[\s\S]*?aria-label="Compare ([^"]*)"', html)
    stops = re.findall(r'<details class="stop"[\s\S]*?<h3>([^<]*)</h3>', html)
    assert rows == stops == ["missed", "narrow", "wide"]
