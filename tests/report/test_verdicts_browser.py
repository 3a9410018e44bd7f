"""The table of cases in a browser: what is filtered, sorted, linked to and printed, far out of sight too."""

import base64
import re
import shutil
import subprocess

import pytest

from uictest.report.traces.trace import trace_of

from .builders import make_content, make_recording, make_result, make_verdict
from .chromium import click, resize, run, wait, written

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
    outcomes = {"criteria": (broken,), "outcome": "fail"}, {"criteria": ()}
    distances = [figures | {"braking_distance_m": 1000.0 - 3 * n} for n in range(CASES)]
    results = [
        make_result(id=f"case-{n:03}", measures=own, **outcomes[n % 7 > 0]) for n, own in enumerate(distances)
    ]
    trace = trace_of(make_recording())
    content = make_content(*results, traces={"case-000": trace, "case-001": trace})
    return written(tmp_path_factory.mktemp("page"), content)


@pytest.fixture
def table(browser, long_page):
    """The browser, in which that page is open."""
    browser.get(long_page.as_uri())
    return browser


def _ids(*numbers):
    return [f"case-{n:03}" for n in numbers]


def _search(browser, text):
    field = browser.find_element("name", "text")
    field.clear()
    field.send_keys(text)


def _reset(browser):
    click(browser, "form.filters button[type=reset]")
    wait(browser, "return document.querySelector('.count').classList.contains('all')")


def _sort_by(browser, column):
    click(browser, f".verdicts thead th:nth-child({column}) button")


def test_a_filter_leaves_the_rows_it_names_in_their_order_and_loses_and_doubles_none(table):
    _search(table, "case-29")
    assert run(table, _SHOWN) == _ids(*(n for n in ORDER if n >= 290))
    assert table.find_element("css selector", ".count").text == "10 of 300 shown"
    _search(table, "expected CASE-29")
    assert run(table, _SHOWN) == _ids(294)
    _reset(table)
    # A verdict that is switched off and on is back in its place.
    for shown in (range(0, CASES, 7), ORDER):
        click(table, "input[name=word][value=pass]")
        assert run(table, _SHOWN) == _ids(*shown)
    _search(table, "nothing of the kind")
    assert run(table, _SHOWN) == []
    _sort_by(table, 1)
    _reset(table)
    assert sorted(run(table, _SHOWN)) == _ids(*range(CASES))


def test_rows_are_sorted_by_numbers_and_stay_so_while_they_are_filtered_and_by_the_keyboard(table):
    table.find_element("css selector", ".verdicts thead th:nth-child(2) button").send_keys("\ue007" * 2)
    assert run(table, _SHOWN) == _ids(*reversed(range(CASES)))
    assert run(table, "return document.activeElement.closest('th').ariaSort") == "descending"
    _reset(table)
    _sort_by(table, 3)
    assert run(table, _SHOWN) == _ids(*reversed(range(CASES)))
    _search(table, "case-10")
    assert run(table, _SHOWN) == _ids(*reversed(range(100, 110)))
    _reset(table)
    assert run(table, _SHOWN) == _ids(*reversed(range(CASES)))


def test_a_case_without_a_value_stands_last_however_the_rows_are_sorted(table):
    run(table, "document.querySelectorAll('.verdicts tbody tr')[5].cells[2].textContent = 'none'")
    others = [n for n in range(CASES) if n != ORDER[5]]
    for expected in (reversed(others), others):
        _sort_by(table, 3)
        assert run(table, _SHOWN) == _ids(*expected, ORDER[5])


_IN_SIGHT = """
const {top, bottom, height} = document.getElementById(arguments[0]).getBoundingClientRect();
return height > 0 && top >= -1 && bottom <= innerHeight;
"""


def test_a_link_leads_to_a_row_far_out_of_sight_or_filtered_away_and_to_the_part_of_a_drawn_case(
    browser, long_page
):
    browser.get(f"{long_page.as_uri()}#case-case-299")
    assert wait(browser, _IN_SIGHT, "case-case-299")
    assert not run(browser, _IN_SIGHT, "case-case-002")
    # Rows far out of sight are not laid out.
    skipped = """
      return [...document.querySelectorAll('.verdicts tbody tr')]
        .filter((row) => !row.checkVisibility({contentVisibilityAuto: true})).length;
    """
    assert wait(browser, skipped) > CASES / 2
    run(browser, "location.hash = '#case-case-002'")
    assert wait(browser, _IN_SIGHT, "case-case-002")
    _search(browser, "case-29")
    run(browser, "location.hash = '#case-case-150'")
    assert wait(browser, _IN_SIGHT, "case-case-150")
    assert run(browser, _SHOWN) == _ids(*ORDER)
    run(browser, "location.hash = '#case-case-001'")
    assert wait(browser, "return document.getElementById('case-case-001').open")
    assert wait(browser, "return document.querySelectorAll('[id=case-case-001] .panels-plot canvas').length")


@pytest.mark.parametrize("width", [1600, 1280, 1000, 700, 400])
def test_the_table_with_its_reasons_does_not_scroll_sideways(browser, long_page, width):
    resize(browser, width)
    browser.get(long_page.as_uri())
    beyond = """
      const table = document.querySelector('.verdicts').parentElement;
      const cells = [...document.querySelectorAll('.verdicts tbody tr:first-child > *')];
      return [table, ...cells.filter((cell) => cell.scrollWidth > cell.clientWidth + 1)]
        .filter((each) => each.scrollWidth > each.clientWidth).map((each) => each.textContent);
    """
    assert run(browser, beyond) == []


def test_on_paper_stand_all_rows_or_how_many_are_filtered_away(table, tmp_path):
    text = _printed(table, tmp_path)
    assert [name for name in _ids(*range(CASES)) if name not in text] == []
    assert "300of300shown" not in text
    _search(table, "case-29")
    text = _printed(table, tmp_path)
    assert "10of300shown" in text
    assert "case-150" not in text


def _printed(browser, folder):
    """Return the text of the page on paper, without blanks."""
    if shutil.which("pdftotext") is None:
        pytest.skip("no pdftotext on the PATH (Debian: poppler-utils)")
    sheet = browser.execute_cdp_cmd("Page.printToPDF", {"preferCSSPageSize": True})
    (folder / "page.pdf").write_bytes(base64.b64decode(sheet["data"]))
    words = ["pdftotext", "-layout", str(folder / "page.pdf"), "-"]
    return re.sub(r"\s", "", subprocess.run(words, capture_output=True, text=True, check=True).stdout)
