"""A printed page: values, a summary and a table on two pages, then each failing stop with its plots."""

import base64
import re

import pytest

from uictest.report import RunManifest
from uictest.report.traces.trace import trace_of

from .builders import make_content, make_recording, make_result, make_verdict
from .chromium import emulate, run, written

CASES, FAILING = 34, 2


@pytest.fixture(scope="module")
def printed(tmp_path_factory):
    """A page of 34 cases, two of which fail; these and a third one are drawn, the first one is open."""
    missed = make_verdict(status="fail", layer="requirement", value=500.0, margin=-10.0, missed_by=())
    results = [
        make_result(id=f"case-{n:02}", **({"outcome": "fail", "criteria": (missed,)} if n < FAILING else {}))
        for n in range(CASES)
    ]
    traces = {f"case-{n:02}": trace_of(make_recording(), [missed]) for n in range(FAILING + 1)}
    content = make_content(
        *results,
        name="20261128T114913Z-9ef598fa",
        manifest=RunManifest(command=("uictest", "run", "a.yaml"), versions={"uictest": "9.8.7"}),
        traces=traces,
    )
    return written(tmp_path_factory.mktemp("page"), content)


def test_on_paper_the_values_of_failing_stops_stand_and_what_a_reader_would_click_does_not(browser, printed):
    browser.get(printed.as_uri())
    emulate(browser, media="print")
    try:
        seen = """
          return [...document.querySelectorAll(arguments[0])]
            .filter((each) => each.checkVisibility({contentVisibilityAuto: true, visibilityProperty: true}))
            .map((each) => each.closest('details.stop')?.id ?? each.textContent.trim());
        """
        failing = [f"case-case-{n:02}" for n in range(FAILING)]
        assert run(browser, seen, "details.stop svg.panels") == failing
        assert run(browser, seen, "details.stop .margins .of-limit summary") == failing
        assert run(browser, seen, ".needs-js, .filters, .about, .parts, .vents, .inputs, #parameters") == []
        head = run(browser, "return document.querySelector('.masthead').innerText")
        assert "2026-11-28 11:49 UTC" in head
        assert "uictest 9.8.7" in head
    finally:
        emulate(browser, media="")


def test_34_cases_are_at_most_two_pages_and_one_for_each_failing_stop(browser, printed):
    browser.get(printed.as_uri())
    sheet = browser.execute_cdp_cmd("Page.printToPDF", {"preferCSSPageSize": True})
    pages = re.findall(rb"/Type /Page\b", base64.b64decode(sheet["data"]))
    assert FAILING < len(pages) <= FAILING + 2
