"""What each kind of result must say stands in every report: page, Markdown, JUnit."""

import html
from dataclasses import replace

import pytest

from uictest.judging import series
from uictest.judging.evaluation import EffectivePart
from uictest.report import CaseDescription, publication_of_run
from uictest.report.page import page_html, sweep_page_html
from uictest.report.page.case_view import shown_parts
from uictest.report.page.series_view import series_badge, series_tone
from uictest.report.traces.trace import stop_extremes, trace_of, with_band

from .builders import HOSTILE, make_content, make_recording, make_result, make_verdict
from .made_up_series import MISSED, make_series
from .test_allowances import ALLOWED, BEYOND, NOT_USED, USED
from .test_case_conditions import BAND, CHANGE, CONTROLLER, FAULTS, PLAIN, SLIP, added
from .test_requirements import naming
from .test_robustness import make_repeated
from .test_series_report import UNCERTAIN
from .test_verdict_sentences import READ

REPORTS = {
    "page": lambda content: html.unescape(page_html(content)),
    "md": lambda content: html.unescape(publication_of_run(content).markdown()),
    "junit": lambda content: html.unescape(publication_of_run(content).junit()),
}
FAILED = make_result(outcome="fail", criteria=(), reason="locked", parts={"controller": BAND})
FAULTY = make_result(parts={"scenario": FAULTS}, outcome="fail")
NOT_COUNTED = "1 stop invalid, not counted: energy-balance: 3 % misses < 0.1 %"
READ_RESULT = make_result(criteria=(READ, make_verdict()))
DRAWN_READ = make_content(READ_RESULT, traces={READ_RESULT.id: trace_of(make_recording())})


@pytest.mark.parametrize(
    ("content", "said", "reports"),
    [
        (make_content(USED), ALLOWED, "page md junit"),
        (make_content(FAULTY), "speed sensor of wheelset 1: factor 90 %", "page md junit"),
        (make_content(make_result(parts={"controller": CONTROLLER})), CHANGE, "page md junit"),
        (make_content(FAILED), "slip-band (built into uictest 0.1.0)", "page md junit"),
        (DRAWN_READ, "depth fail: 0 of 4 wheelsets keep", "page md"),
        (DRAWN_READ, "ours alone", "page"),
        (make_content(make_repeated("ppf", outcome="fail")), "pass 2/3", "page md"),
        (make_content(make_repeated("ppf", outcome="fail")), "3 stops, seeds 0..2: 2 pass", "page md junit"),
        (make_content(series=[MISSED]), "dry 2 of 2, wet 5 of 6", "page md junit"),
        (make_content(series=[make_series()]), NOT_COUNTED, "page md junit"),
        (make_content(series=[UNCERTAIN]), "Close or uncertain", "page md"),
        (make_content(make_result(requirements=("BR-7",), outcome="fail")), "BR-7", "page md junit"),
        (make_content(make_result(id="b"), subjects={"b": CaseDescription("A title")}), "A title", "page"),
        (make_content(passed_over=["stop 3: no brake"]), "stop 3: no brake", "page md"),
    ],
)
def test_what_is_known_of_a_result_stands_in_every_report(content, said, reports):
    missing = [name for name in reports.split() if said not in REPORTS[name](content)]
    assert missing == []


UNCOUNTED = (series.UncountedStop(HOSTILE, "wet", 5, "invalid", HOSTILE),)


@pytest.mark.parametrize("report", REPORTS)
@pytest.mark.parametrize(
    "content",
    [
        {"results": [make_result(id=HOSTILE, outcome="fail", criteria=(), reason=HOSTILE, scenario=HOSTILE)]},
        {"results": [replace(USED, id=HOSTILE)], "subjects": {HOSTILE: CaseDescription(HOSTILE, (HOSTILE,))}},
        {"series": [make_series(id=HOSTILE, title=HOSTILE, not_counted=UNCOUNTED, outcome="error",
         reason=HOSTILE)]},
    ],
    ids=["case", "allowance", "series"],
)  # fmt: skip
def test_hostile_texts_stay_texts(content, report):
    run = make_content(**{"name": HOSTILE, "results": []} | content)
    published = publication_of_run(run)
    text = {"page": published.page, "md": published.markdown, "junit": published.junit}[report]()
    assert report == "md" or "<b>&" not in text  # Markdown shows it in code spans, letter by letter
    assert not set("\x00\x1b" if report == "junit" else "\x00\x1b\u202e") & set(text)


@pytest.mark.parametrize(
    ("results", "tone"),
    [
        ([USED, make_result()], "odd"),
        ([NOT_USED], "good"),
        ([BEYOND, NOT_USED], "bad"),
        ([BEYOND, USED], "bad"),
    ],
)
def test_the_headline_of_a_page_has_the_worst_tone(results, tone):
    assert f'<h1 class="tally-{tone}">' in page_html(make_content(*results))


def test_the_page_shows_a_change_beside_the_verdict_all_parts_once_and_counts_those_it_leaves_out():
    results = [make_result(id=name, parts={"controller": CONTROLLER}) for name in ("one", "two")]
    page = page_html(make_content(*results))
    assert page.count(f"changed: {CHANGE}") == 2
    assert page.count(f'id="{CONTROLLER.id}"') == 1
    assert page.count("controller.hold_limit") == 1
    assert "A surrogate." in page
    assert "not shown here" not in page
    parts = [replace(PLAIN, name=f"own-{k}") for k in range(102)]
    page = page_html(make_content(*(make_result(id=each.name, parts={"controller": each}) for each in parts)))
    assert sum(f'id="{each.id}"' in page for each in parts) == 100
    assert "2 more parts not shown here: results.json has all of them." in page
    cars = [EffectivePart("vehicle", "vehicle", name, name, ()) for name in ("wagon", "coach", "wagon")]
    parts = [{"controller": PLAIN, "vehicle": car} for car in cars]
    results = [make_result(id=str(k), parts=own) for k, own in enumerate(parts)]
    page = page_html(make_content(*results))
    assert "car wagon, coach" in page


def test_a_page_tells_sections_of_scenarios_apart_and_keeps_those_of_a_kind_together():
    first, second = (
        EffectivePart("scenario.rail", "rail", "", None, (added("rail.friction", value),))
        for value in ("0.03", "0.08")
    )
    shown = shown_parts([{"rail": first, "controller": PLAIN}, {"rail": second}])
    assert shown == {"parts": {part.id: part for part in (first, second, PLAIN)}, "parts_not_shown": 0}
    content = make_content(*(make_result(id=each.id, parts={"rail": each}) for each in (first, second)))
    headings = [line for line in page_html(content).splitlines() if "<summary>scenario.rail" in line]
    assert ["0.03" in line for line in headings] == [True, False]


def test_the_page_of_a_sweep_says_what_is_changed_in_every_case_and_what_varies(make_sweep):
    def of_varied(key):
        content = make_sweep(varied=[key])
        return sweep_page_html(
            replace(content, result=replace(content.result, base={"controller": CONTROLLER}))
        )

    assert f"changed in every case: {CHANGE}" in of_varied("rail.friction")
    assert f"changed in every case of car 1: {CHANGE}" in of_varied("car")
    page = of_varied(SLIP.key)
    assert "changed in every case" not in page
    assert "3 km/h <small>varied</small>" in page


def test_the_page_has_the_stops_of_each_repeated_case():
    result = make_repeated("ppf", "at_least", 0.6)
    spoiled = replace(result.repeats.stops[2], reason=HOSTILE)
    result = replace(result, repeats=replace(result.repeats, stops=(*result.repeats.stops[:2], spoiled)))
    trace = trace_of(make_recording(), result.drawn_stop.criteria)
    page = page_html(make_content(result, traces={result.id: trace}))
    assert page.count('<i class="seed outcome-fail" title="seed 2: fail">') == 2
    assert "the stop that is recorded and drawn is the first, of seed 0: pass" in page
    assert '<circle class="dot-fail"' in page
    assert "<title>seed 2: 500</title>" in page
    assert "sensitive to definitions or seed: braking-distance" in page
    assert "<script>" not in page.split("</h3>")[-1].split('<script type="application/json"')[0]
    # Those without a recording are listed, and so many stops of one.
    page = page_html(make_content(make_repeated("ppf"), make_result(id="single")))
    assert "<title>seed 2: 500</title>" in page.split("Repeated cases that are not drawn")[1]
    assert "Repeated cases that are not drawn" not in page_html(make_content(make_result()))
    result = make_repeated("p" * 130)
    trace = trace_of(make_recording(), result.drawn_stop.criteria)
    assert "30 more stops are in " in page_html(make_content(result, traces={result.id: trace}))


def test_the_key_says_what_the_band_behind_the_drawn_stop_spans():
    result = make_repeated("p" * 30)
    trace, stop = trace_of(make_recording()), stop_extremes(make_recording())
    page = page_html(make_content(result, traces={result.id: with_band(trace, [stop] * 20)}))
    assert page.count("lowest and highest of the first 20 of 30 repeats, of those still running</label>") == 1
    assert page.count('<path class="band role-train role-band"') == 1
    assert '{"band":{' in page
    assert "Band: lowest and highest sample of every 50 ms." in page
    for alone in (result, make_result()):
        page = page_html(make_content(alone, traces={alone.id: trace}))
        assert not any(words in page for words in ("lowest and highest of", 'class="band', '{"band":'))


def test_the_page_draws_every_stop_of_a_series_and_tells_it_from_a_case_of_the_same_id():
    case = make_result(id="acceptance", requirements=("BR-9",), outcome="fail")
    page = page_html(make_content(case, series=[naming(requirements=("BR-9",), test_case="WSP-TC-7")]))
    assert page.count('<path class="dot"') == 7
    assert page.count('<path class="dot uncounted"') == 1
    for said in ("1 case, 1 series", '<a href="#series-acceptance">series acceptance</a>', "WSP-TC-7: BR-9"):
        assert said in page
    badges = [(series_badge(result), series_tone(result)) for result in (UNCERTAIN, make_series())]
    assert badges == [("pass, not certain", "odd"), ("pass", "good")]
