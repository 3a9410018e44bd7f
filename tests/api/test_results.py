"""Results as data frames: nothing that the CSV files have is lost."""

import contextlib
import csv
import io
import math
from dataclasses import replace
from html.parser import HTMLParser
from pathlib import Path

import pytest

import uictest
from uictest import report
from uictest.api.results import column_units
from uictest.core import measures
from uictest.plans.scenario import PASS

from .conftest import write_stop

HOSTILE = "<script>alert(1)</script> & \x1b[31m"


@pytest.fixture(scope="module")
def results(tmp_path_factory):
    """Two cases, one of them repeated, one not as expected."""
    with contextlib.chdir(tmp_path_factory.mktemp("results")):
        write_stop("many", "repeat: 3\nrequirements: [BR-1]\n")
        write_stop("one", "expect: fail\nmatrix: {rail.friction: [0.06, 0.1]}\n")
        return uictest.run()


def cells(frame):
    return frame.reset_index().to_dict("records")


def as_csv(value):
    """Return a value as the CSV files write it."""
    if value is None or value != value:
        return ""
    return str(value).lower() if isinstance(value, bool) else value if isinstance(value, str) else repr(value)


@pytest.fixture(scope="module")
def saved(results, tmp_path_factory):
    """The folder that those results are saved in."""
    return results.save(tmp_path_factory.mktemp("saved"), formats=["xlsx", "md"])


@pytest.mark.parametrize("name", ["summary", "wheelsets", "criteria", "repeats", "requirements"])
def test_a_table_has_every_cell_of_its_file(results, saved, name):
    file = f"{name}.csv" if name in ("summary", "wheelsets", "criteria") else f"tables/{name}.csv"
    written = list(csv.DictReader(io.StringIO((saved / file).read_text())))
    rows = cells(results.table(name))
    assert [set(row) for row in rows] == [set(row) for row in written]
    for row, line in zip(rows, written, strict=True):
        for column, value in row.items():
            assert as_csv(value) == line[column] or float(value) == float(line[column]), column


def test_numbers_are_numbers_and_texts_are_as_written(results):
    frame = results.frame()
    assert frame.index.name == "id"
    assert {str(frame[name].dtype) for name in measures.STOP_COLUMNS} == {"float64"}
    assert frame["met"].dtype == bool
    assert list(frame["parameters.rail.friction"].dropna()) == ["0.06", "0.1"]
    distance = results["one[friction=0.1]"].measures["braking_distance_m"]
    assert frame.loc["one[friction=0.1]", "braking_distance_m"] == distance
    crashed = uictest.CaseResult("a", "a.yaml", {}, PASS, "error", reason="no wheel load")
    frame = uictest.Results(report.RunContent("run", [crashed])).frame()
    assert math.isnan(frame.loc["a", "braking_distance_m"])
    assert frame["braking_distance_m"].dtype == float


def test_units_stand_beside_the_columns_and_the_index_tells_rows_apart(results):
    units = results.frame().attrs["units"]
    assert units["braking_distance_m"] == units["braking_distance_m_highest"] == "m"
    assert "outcome" not in units
    assert results.wheelsets().attrs["units"]["locked_time_s"] == "s"
    for name, column in {**measures.STOP_COLUMNS, **measures.WHEELSET_COLUMNS}.items():
        names = (name, f"{name}_lowest")
        assert column_units(names) == dict.fromkeys(names, column.unit)
    for frame in (results.frame(), results.wheelsets(), results.criteria(), results.repeats()):
        assert frame.index.is_unique
    assert list(results.wheelsets().loc["many"].index) == [1, 2, 3, 4]
    assert list(results.repeats().index.get_level_values("seed")) == [0, 1, 2]
    assert not results.met
    assert results.tally == "3 cases: 1 pass, 2 unexpected pass; 2 not as expected"
    assert repr(results).splitlines()[0] == results.tally
    assert any(line.split()[:2] == ["many", "pass"] for line in repr(results).splitlines())
    assert "2 cases should not have passed" in repr(results)
    many = [replace(results[1], id=f"c[k={k}]", outcome="pass") for k in range(12)]
    text = repr(uictest.Results(report.RunContent("run", many)))
    assert text.index("and 2 more cases") < text.index("12 cases should not have passed")


def test_a_table_that_is_not_there_is_named_and_one_of_a_series_without_criteria_empty(write):
    path = write("wet")
    results = uictest.run(path)
    with pytest.raises(KeyError, match="no table 'repeats' in this run; accepted: criteria, summary"):
        results.repeats()
    with pytest.raises(KeyError, match="did you mean 'criteria'"):
        results.table("criterias")
    write("dry", rail="{condition: dry}")
    path = path.with_name("free.series.yaml")
    path.write_text("schema: uictest/series/1\nname: free\ndry: dry.yaml\nwet: wet.yaml\ncriteria: []\n")
    table = uictest.run(path).table("series-criteria")
    assert (len(table), table.index.names) == (0, ["series", "criterion"])


def test_cases_by_place_by_slice_and_by_id(results):
    assert len(results) == 3
    assert results[0] is results["many"] is next(iter(results))
    assert [each.id for each in results[1:]] == ["one[friction=0.06]", "one[friction=0.1]"]
    assert results[-1].id == "one[friction=0.1]"
    with pytest.raises(KeyError, match=r"no case 'one\[friction=0\.05\]'; did you mean"):
        results["one[friction=0.05]"]
    with pytest.raises(IndexError):
        results[3]
    with pytest.raises(KeyError, match=r"many was not recorded: run it with record='all'"):
        results.recording("many")
    assert len(results.recording("one[friction=0.06]")) > 100


def test_the_table_for_notebooks_escapes_what_users_wrote_and_has_what_failed_first():
    hostile = uictest.CaseResult(HOSTILE, "a.yaml", {}, PASS, "fail", reason=HOSTILE)
    results, tags = uictest.Results(report.RunContent("run", [hostile])), set()
    text, page = results._repr_html_(), HTMLParser()
    page.handle_starttag = lambda tag, attributes: tags.add(tag)
    page.feed(text)
    assert tags <= {"p", "table", "thead", "tbody", "tr", "th", "td"}
    assert "\x1b" not in text + repr(results)
    many = [uictest.CaseResult(f"case-{n}", "a.yaml", {}, PASS, "pass") for n in range(200)]
    failed = uictest.CaseResult("failed", "a.yaml", {}, PASS, "fail", reason="locked")
    text = uictest.Results(report.RunContent("run", [*many, failed]))._repr_html_()
    assert text.index("failed") < text.index("case-0")
    assert "and 151 more cases" in text
    assert text.count("<tr>") == 51


def test_saving_in_an_unknown_format_names_the_nearest(results, saved):
    with pytest.raises(ValueError, match="no format 'xslx'; did you mean 'xlsx'"):
        results.save(formats=["xslx"])
    assert not Path("reports").exists()
    assert (saved / "report.xlsx").is_file()
