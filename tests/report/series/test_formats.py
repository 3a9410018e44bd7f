"""A series in every format: what a reader must find there."""

import csv
import io
import json
import re
from xml.etree import ElementTree

import pytest

from uictest.judging import series
from uictest.report import junit_text, read_run, run_suites, series_table, write_formats, write_reports
from uictest.report.formats.md import markdown_summary
from uictest.report.series.series_sentences import series_explanation, series_line, series_lines, series_tally

from ..builders import HOSTILE, make_content
from ..workbooks import assert_as_csv
from .made_up import MISSED, make_series


@pytest.fixture
def content():
    return make_content(series=[make_series()])


def test_lines_tell_the_criteria_and_what_does_not_count_and_the_tally_counts_series(content):
    assert content.tally == "1 series: 1 pass"
    assert series_tally([MISSED]) == "1 series: 1 fail; 1 not as expected"
    (result,) = content.series
    assert series_line(result).startswith("pass acceptance outcome=pass expect=pass k_wet=0.86957 ")
    criterion, counted, not_counted = series_lines(result)
    assert criterion.startswith(
        "criterion acceptance k-wet (requirement) pass: 0.86957 from 120 km/h, lower limit 0.8, margin"
    )
    assert "mean of 5 stops over 2 dry, 95 % interval 0.8" in criterion
    assert counted.endswith("Valid stops from 120 km/h: dry 2 of 2, wet 5 of 6 (83.33 %, 80 % needed)")
    assert not_counted == "stops acceptance 1 stop invalid, not counted: energy-balance: 3 % misses < 0.1 %"


def test_a_terminal_shows_the_same_in_its_width():
    for width in (60, 100, 200):
        lines = list(series_table([make_series()], width))
        text = " ".join(" ".join(lines).split())
        assert "pass acceptance" in text
        assert "dry 2 of 2, wet 5 of 6" in text
        assert "1 stop invalid, not counted" in text


def test_tables_have_a_row_per_measure_criterion_and_stop(content, tmp_path):
    write_formats(tmp_path, content, ["csv"])
    files = tmp_path.glob("series*")
    rows = {path.name: list(csv.DictReader(io.StringIO(path.read_text()))) for path in files}
    k_wet = next(row for row in rows["series.csv"] if (row["measure"], row["speed_kmh"]) == ("k_wet", "120"))
    assert (float(k_wet["value"]), k_wet["method"], k_wet["stops"]) == (pytest.approx(100 / 115), "mean", "5")
    (criterion,) = rows["series-criteria.csv"]
    assert k_wet["dry_stops"] == "2"
    assert (criterion["criterion"], criterion["verdict"], criterion["certain"]) == ("k-wet", "pass", "true")
    stops = rows["series-stops.csv"]
    ends = [[each[key] for key in ("role", "seed", "counts", "braking_distance_m")] for each in stops[::7]]
    assert ends == [["dry", "0", "true", "459.99"], ["wet", "5", "false", "2000.0"]]
    assert len(stops) == 8


def test_the_workbook_of_series_holds_what_its_csv_files_hold(content, tmp_path):
    write_formats(tmp_path, content, ["csv", "xlsx"])
    assert {"series.csv", "series-criteria.csv", "series-stops.csv"} <= {p.name for p in tmp_path.iterdir()}
    assert_as_csv(tmp_path, tmp_path / "report.xlsx")


def test_markdown_compares_and_judges(content):
    text = markdown_summary(content)
    assert "| `acceptance` | pass | 5 of 6 |" in text
    assert "| `acceptance` | `k-wet` | **fail** |" in markdown_summary(make_content(series=[MISSED]))
    for limit in (400, 1000, 3000):
        assert len(markdown_summary(content, limit).encode()) <= limit


def test_the_page_draws_every_stop_and_marks_those_that_do_not_count(content, tmp_path):
    write_formats(tmp_path, content, ["html"])
    page = (tmp_path / "index.html").read_text()
    assert len(re.findall(r'<path class="dot"', page)) == 7
    assert len(re.findall(r'<path class="dot uncounted"', page)) == 1
    assert "1 stop invalid, not counted: energy-balance: 3 % misses &lt; 0.1 %" in page


def test_hostile_texts_stay_texts(tmp_path):
    not_counted = (series.UncountedStop(HOSTILE, "wet", 1, "invalid", HOSTILE),)
    result = make_series(id=HOSTILE, title=HOSTILE, not_counted=not_counted, outcome="error", reason=HOSTILE)
    content = make_content(series=[result])
    write_formats(tmp_path, content, ["html", "xlsx", "csv"])
    assert "<b>&" not in (tmp_path / "index.html").read_text()
    lines = [*series_table([result], 80), series_line(result), *series_explanation(result)]
    assert "\x1b" not in "".join([*lines, markdown_summary(content)])
    ElementTree.fromstring(junit_text(run_suites([], series=[result])))


def test_a_finished_run_is_read_back_as_it_was_and_a_spoiled_one_is_none(tmp_path):
    content = make_content(series=[make_series(requirements=("BR-9",), test_case="WSP-TC-7")])
    write_reports(tmp_path, content)
    document = json.loads((tmp_path / "results.json").read_text())
    assert document["cases"] == []
    read = read_run(tmp_path)
    assert series.series_document(read.series) == series.series_document(content.series)
    assert (read.series[0].requirements, read.series[0].test_case) == (("BR-9",), "WSP-TC-7")
    document["series"]["series"][0]["criteria"][0]["estimate"]["stops"] = "many"
    (tmp_path / "results.json").write_text(json.dumps(document))
    with pytest.raises(ValueError, match=r"series.0.criteria.0.estimate.stops"):
        read_run(tmp_path)
