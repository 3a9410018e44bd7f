"""Quantiles and K_dry as readers meet them: on the terminal, in Markdown, in a workbook, on the page."""

import html
import io

import pyarrow as pa
import pyarrow.parquet as pq
import pytest
from hypothesis import given, strategies as st

from uictest.report import titled_lines
from uictest.report.page import sweep_page_html
from uictest.report.sweep.formats import sweep_markdown
from uictest.report.sweep.tail_tables import (
    MOST_TABLES,
    k_dry_rows,
    k_dry_text,
    k_dry_yaml,
    tables_left_out,
    tail_tables,
)
from uictest.report.sweep.workbook import sweep_workbook_bytes

from ..test_page import Page

openpyxl = pytest.importorskip("openpyxl")

BASIS = "95 % confidence, 200 draws; nominal 1.2 m/s2, stated in the sweep file"
REFUSAL = "needs 299 draws, has 200"


def tail_lines(result):
    return [*titled_lines(tail_tables(result), None), *tables_left_out(result)]


def tails(at, without_value=0):
    """What sweep.json holds of a sweep with quantiles and K_dry."""
    sample = {"draws": 200, "without_value": without_value}
    refused = {"draws_needed": 299, "estimate": None, "lower": None, "upper": None}
    common = {"circumstances": at, "confidence": 0.95, "sample": sample}
    quantiles = [
        {"level": 0.01, "side": "lower", **refused},
        {"level": 0.5, "side": "both", "draws_needed": 6, "estimate": 1.1, "lower": 1.05, "upper": 1.15},
        {"level": 0.9, "side": "upper", "draws_needed": 29, "estimate": 1.3, "lower": None, "upper": 1.35},
    ]
    levels = [
        {"ebcl": 0, "shortfall": 0.5, "draws_needed": 5, "deceleration": 1.08, "k_dry": 0.9},
        {"ebcl": 2, "shortfall": 0.01, "draws_needed": 299, "deceleration": None, "k_dry": None},
    ]
    return {
        "quantiles": [{"measure": "speed_mps2", "unit": "m/s2", **common, "quantiles": quantiles}],
        "k_dry": [
            {"measure": "speed_mps2", "nominal": 1.2, "nominal_is_stated": True, **common, "levels": levels}
        ],
    }


def test_the_terminal_shows_bounds_and_refusals(make_sweep):
    lines = list(tail_lines(make_sweep(**tails({"speed": "80 km/h"})).result))
    assert lines == [
        "quantiles of speed_mps2, m/s2 at speed = 80 km/h: 95 % confidence, 200 draws",
        "  level  draws needed  estimate  bound",
        f"  1 %    299           -         {REFUSAL}",
        "  50 %   6             1.1       1.05 .. 1.15",
        "  90 %   29            1.3       at most 1.35",
        "",
        f"K_dry of speed_mps2 at speed = 80 km/h: {BASIS}",
        "  EBCL  probability  draws needed  m/s2  K_dry",
        "  0     50 %         5             1.08  0.900",
        f"  2     99 %         299           -     {REFUSAL}",
        "",
    ]


def test_draws_without_a_value_are_stated_everywhere(make_sweep):
    content = make_sweep(**tails({}, without_value=3))
    words = "200 draws; 3 without a value count as the worst"
    assert words in "\n".join(tail_lines(content.result))
    assert words in sweep_markdown(content)
    assert words in Page(sweep_page_html(content)).text
    assert "draws_without_value: 3" in k_dry_yaml(content.result)


def test_every_report_shows_the_same(make_sweep):
    content = make_sweep(**tails({"speed": "80 km/h"}))
    pq.write_table(
        pa.table({"id": ["a"], "met": [True], "outcome": ["pass"]}), content.folder / "summary.parquet"
    )
    workbook = openpyxl.load_workbook(io.BytesIO(sweep_workbook_bytes(content)))
    header, *rows = workbook["K_dry"].iter_rows(values_only=True)
    first, second = (dict(zip(header, row, strict=True)) for row in rows)
    assert (first["at speed"], first["ebcl"], first["k_dry"], first["nominal_mps2"]) == (
        "80 km/h",
        0,
        0.9,
        1.2,
    )
    assert (second["k_dry"], second["note"]) == (None, REFUSAL)
    assert workbook["Quantiles"].max_row == 1 + 3
    for text in (sweep_markdown(content), Page(sweep_page_html(content)).text):
        assert REFUSAL in text
        assert "0.900" in text
        assert "at most 1.35" in text


def test_many_combinations_are_counted_and_left_to_the_tables(make_sweep):
    one = tails({"speed": "80 km/h"})
    many = {name: tables * (MOST_TABLES + 2) for name, tables in one.items()}
    content = make_sweep(**many)
    lines = list(tail_lines(content.result))
    assert sum(line.startswith("quantiles of") for line in lines) == MOST_TABLES
    for sentence in ("2 more tables are in quantiles.csv", "2 more tables are in k_dry.csv"):
        assert sentence in lines
        assert sentence in Page(sweep_page_html(content)).text
        assert sentence in html.unescape(sweep_markdown(content))


def test_draws_in_which_a_wheelset_slides_are_no_k_dry_in_any_report(make_sweep):
    of_sweep = tails({})
    (k_dry,) = of_sweep["k_dry"]
    content = make_sweep(**{**of_sweep, "k_dry": [{**k_dry, "sliding": 12}]})
    words = "a wheelset slides in 12 of 200 draws, so that this is no K_dry"
    assert words in "\n".join(tail_lines(content.result))
    assert words in Page(sweep_page_html(content)).text
    assert "in 12 of 200 draws" in sweep_markdown(content)
    assert "draws_sliding: 12" in k_dry_yaml(content.result)
    first, second = k_dry_rows(content.result)
    assert (first["sliding"], first["note"][: len(words)]) == (12, words)
    assert str(second["note"]).startswith(f"{REFUSAL}; {words}")


def test_a_sweep_without_tails_says_nothing_of_them(make_sweep):
    content = make_sweep()
    assert list(tail_lines(content.result)) == []
    assert "Tails" not in Page(sweep_page_html(content)).text


@given(st.integers(0, 2000))
def test_k_dry_is_never_rounded_up(thousandths):
    assert k_dry_text(thousandths / 1000) == f"{thousandths / 1000:.3f}"
    assert float(k_dry_text((thousandths + 0.9) / 1000)) == thousandths / 1000
