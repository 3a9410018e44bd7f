"""The table of cases in a browser: what is filtered, sorted, linked to and printed, far out of sight too."""

import base64
import re
import shutil
import subprocess

import pytest

from uictest.report.traces.trace import trace_of

from .builders import make_content, make_recording, make_result, make_verdict
from .chromium import resize, run, wait, written

CASES = 300
ORDER = sorted(range(CASES), key=lambda n: n % 7 != 0)
"""Of the rows, before they are sorted: what is not as expected first."""
REASON = "0 of 4 wheelsets within the limit of 1 s (4 needed): 15.69, 16.19, 13.97, 16.95 s; and so on, " * 4

_SHOWN = """
return [...document.querySelectorAll('.verdicts tbody:not([hidden]) tr:not([hidden]) th')]
  .map((head) => head.textContent.trim().split(/\\s/)[0]);
"""


@pytest.fixture(scope="module")
def long_page(tmp_path_factory):
    """A run of 300 cases, every seventh missed for a long reason; two are drawn."""
    broken = make_verdict(status="fail", margin=-10.0, reason=REASON)
    figures = make_result().measures
    results = [
        make_result(
            id=f"case-{n:03}",
            outcome="pass" if n % 7 else "fail",
            criteria=() if n % 7 else (broken,),
            measures=figures | {"braking_distance_m": 1000.0 - 3 * n},
        )
        for n in range(CASES)
    ]
    trace = trace_of(make_recording())
    return written(
        tmp_path_factory.mktemp("page"), make_content(*results, traces={"case-000": trace, "case-001": trace})
    )


def _ids(*numbers):
    return [f"case-{n:03}" for n in numbers]


def _search(browser, text):
    field = browser.find_element("name", "text")
    field.clear()
    field.send_keys(text)


def _reset(browser):
    run(browser, "document.querySelector('form.filters button[type=reset]').click()")
    wait(browser, "return document.querySelector('.count').classList.contains('all')")


def test_a_filter_leaves_the_rows_it_names_in_their_order(browser, long_page):
    browser.get(long_page.as_uri())
    _search(browser, "case-29")
    assert run(browser, _SHOWN) == _ids(*(n for n in ORDER if n >= 290))
    assert browser.find_element("css selector", ".count").text == "10 of 300 shown"
    _search(browser, "wheelsets CASE-29")
    assert run(browser, _SHOWN) == _ids(294)
    _reset(browser)
    assert run(browser, _SHOWN) == _ids(*ORDER)


def test_a_verdict_that_is_switched_off_and_on_is_back_in_its_place(browser, long_page):
    browser.get(long_page.as_uri())
    word = "document.querySelector('input[name=word][value=pass]').click()"
    run(browser, word)
    assert run(browser, _SHOWN) == _ids(*range(0, CASES, 7))
    run(browser, word)
    assert run(browser, _SHOWN) == _ids(*ORDER)


def test_rows_are_sorted_by_numbers_and_stay_so_while_they_are_filtered(browser, long_page):
    browser.get(long_page.as_uri())
    run(browser, "document.querySelectorAll('.verdicts thead button')[2].click()")
    assert run(browser, _SHOWN) == _ids(*reversed(range(CASES)))
    _search(browser, "case-10")
    assert run(browser, _SHOWN) == _ids(*reversed(range(100, 110)))
    _reset(browser)
    assert run(browser, _SHOWN) == _ids(*reversed(range(CASES)))


def test_a_case_without_a_value_stands_last_however_the_rows_are_sorted(browser, long_page):
    browser.get(long_page.as_uri())
    run(browser, "document.querySelectorAll('.verdicts tbody tr')[5].cells[2].textContent = 'none'")
    others = [n for n in range(CASES) if n != ORDER[5]]
    for expected in (reversed(others), others):
        run(browser, "document.querySelectorAll('.verdicts thead button')[2].click()")
        assert run(browser, _SHOWN) == _ids(*expected, ORDER[5])


def test_no_row_is_lost_or_doubled(browser, long_page):
    browser.get(long_page.as_uri())
    for text in ("case-1", "nothing of the kind", "case-2"):
        _search(browser, text)
    run(browser, "document.querySelectorAll('.verdicts thead button')[0].click()")
    _reset(browser)
    assert sorted(run(browser, _SHOWN)) == _ids(*range(CASES))


_IN_SIGHT = """
const {top, bottom, height} = document.getElementById(arguments[0]).getBoundingClientRect();
return height > 0 && top >= -1 && bottom <= innerHeight;
"""


def test_a_link_leads_to_a_row_that_was_far_out_of_sight(browser, long_page):
    browser.get(f"{long_page.as_uri()}#case-case-299")
    assert wait(browser, _IN_SIGHT, "case-case-299")
    assert not run(browser, _IN_SIGHT, "case-case-002")
    run(browser, "location.hash = '#case-case-002'")
    assert wait(browser, _IN_SIGHT, "case-case-002")


def test_a_link_to_a_row_that_is_filtered_away_shows_all_rows_again(browser, long_page):
    browser.get(long_page.as_uri())
    _search(browser, "case-29")
    run(browser, "location.hash = '#case-case-150'")
    assert wait(browser, _IN_SIGHT, "case-case-150")
    assert run(browser, _SHOWN) == _ids(*ORDER)


def test_the_part_of_a_drawn_case_is_where_its_link_leads(browser, long_page):
    browser.get(f"{long_page.as_uri()}#case-case-001")
    assert wait(browser, "return document.getElementById('case-case-001').open")
    assert wait(browser, "return document.querySelectorAll('[id=case-case-001] .panels-plot canvas').length")


@pytest.mark.parametrize("width", [1600, 1280, 1000, 700, 400])
def test_the_table_with_its_reasons_does_not_scroll_sideways(browser, long_page, width):
    resize(browser, width)
    browser.get(long_page.as_uri())
    inner, outer = run(
        browser,
        "const {scrollWidth, clientWidth} = document.querySelector('.verdicts').parentElement;"
        "return [scrollWidth, clientWidth]",
    )
    assert inner <= outer
    cells = """
      return [...document.querySelectorAll('.verdicts tbody tr:first-child > *')]
        .filter((cell) => cell.scrollWidth > cell.clientWidth + 1).map((cell) => cell.textContent);
    """
    assert run(browser, cells) == []


def _printed(browser, folder):
    """Return the text of the page on paper, without blanks."""
    if shutil.which("pdftotext") is None:
        pytest.skip("no pdftotext on the PATH (Debian: poppler-utils)")
    sheet = browser.execute_cdp_cmd("Page.printToPDF", {"preferCSSPageSize": True})
    (folder / "page.pdf").write_bytes(base64.b64decode(sheet["data"]))
    words = ["pdftotext", "-layout", str(folder / "page.pdf"), "-"]
    return re.sub(r"\s", "", subprocess.run(words, capture_output=True, text=True, check=True).stdout)


def test_on_paper_stand_all_rows(browser, long_page, tmp_path):
    browser.get(long_page.as_uri())
    text = _printed(browser, tmp_path)
    assert [name for name in _ids(*range(CASES)) if name not in text] == []
    assert "300of300shown" not in text


def test_paper_says_that_rows_are_filtered_away(browser, long_page, tmp_path):
    browser.get(long_page.as_uri())
    _search(browser, "case-29")
    text = _printed(browser, tmp_path)
    assert "10of300shown" in text
    assert "case-150" not in text


def test_headings_are_buttons_that_the_keyboard_reaches(browser, long_page):
    browser.get(long_page.as_uri())
    browser.find_element("css selector", ".verdicts thead th:nth-child(2) button").send_keys("\ue007" * 2)
    assert run(browser, _SHOWN) == _ids(*reversed(range(CASES)))
    assert run(browser, "return document.activeElement.closest('th').ariaSort") == "descending"


def test_rows_far_out_of_sight_are_not_laid_out(browser, long_page):
    browser.get(long_page.as_uri())
    skipped = """
      return [...document.querySelectorAll('.verdicts tbody tr')]
        .filter((row) => !row.checkVisibility({contentVisibilityAuto: true})).length;
    """
    assert wait(browser, skipped) > CASES / 2


def test_the_page_says_how_many_cases_are_drawn_and_how_others_are(browser, long_page):
    browser.get(long_page.as_uri())
    assert "298 cases not drawn" in browser.find_element("tag name", "main").text
