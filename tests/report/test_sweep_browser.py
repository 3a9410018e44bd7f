"""Maps of a sweep in a browser: what is drawn and led to."""

import pytest

from uictest.report.page import sweep_page_html
from uictest.report.sweep.folder import SweepContent

from .chromium import run
from .sweep_rows import row, sweep_result, write_rows

_MAP = """
const map = document.getElementById(arguments[0]);
const empty = map.querySelector('.no-case');
return [map.checkVisibility(), [...map.querySelectorAll('tbody tr')].map((row) =>
  [...row.cells].map((cell) => cell.textContent)), getComputedStyle(empty).backgroundImage];
"""


@pytest.fixture(scope="module")
def with_a_gap(tmp_path_factory):
    """The page of a sweep of three parameters without the cases of a = 1, b = 1; one case fails."""
    folder = tmp_path_factory.mktemp("page")
    values = {key: ["0", "1"] for key in ("a", "c", "b")}
    rows = [
        row(
            f"{a}{b}{c}",
            "fail" if (a, b, c) == (0, 0, 0) else "pass",
            **{"parameters.a": str(a), "parameters.b": str(b), "parameters.c": str(c)},
        )
        for a, b, c in ((0, 0, 0), (0, 0, 1), (0, 1, 0), (0, 1, 1), (1, 0, 0), (1, 0, 1))
    ]
    write_rows(folder, rows)
    path = folder / "index.html"
    path.write_text(sweep_page_html(SweepContent(folder, sweep_result(values, 6), {})), encoding="utf-8")
    return path


def test_a_link_unfolds_its_map_and_a_cell_without_a_case_is_hatched(browser, with_a_gap):
    browser.get(f"{with_a_gap.as_uri()}#map-met-a-b")
    shown, table, ground = run(browser, _MAP, "map-met-a-b")
    assert shown
    assert table == [["0", "50", "100"], ["1", "100", ""]]
    assert "gradient" in ground
