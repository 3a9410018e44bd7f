import re
from dataclasses import replace
from pathlib import Path

import pytest

from studies.stop_runner import StopRunner
from studies.study import Study, StudyFindings, run_study
from studies.writing import table_text, write_comparison, write_figures, write_pages, write_tables


def test_tables_lie_in_the_folder_of_their_study_and_the_comparison_beside_them(made_up, tmp_path):
    assert write_tables(tmp_path, made_up) == [tmp_path / "made-up" / "data.csv"]
    assert (tmp_path / "made-up" / "data.csv").read_text() == 'time_s,what\n0.0,"a, b"\n0.5,\n'
    write_comparison(tmp_path / "new", [made_up])
    assert {path.name for path in (tmp_path / "new").iterdir()} == {"comparison.csv", "studies.json"}


def test_columns_of_different_lengths_are_rejected():
    with pytest.raises(ValueError, match="same length"):
        table_text({"a": [1, 2], "b": [1]})


ARGUMENTS = ("made-up",)


def page_of(folder, name="made-up"):
    return (folder / name / "index.html").read_text("utf-8")


def _line(figure):
    figure.subplots().plot([0.0, 1.0], [1.0, 0.0])


def _drawn(result, drawing=_line):
    return replace(result, findings=replace(result.findings, drawings={"figure": drawing}))


def test_a_figure_is_the_same_to_the_byte_whenever_it_is_drawn_and_the_page_holds_it(made_up, tmp_path):
    pytest.importorskip("matplotlib")
    study = _drawn(made_up)
    paths = write_figures(tmp_path, study)
    assert [path.suffix for path in paths] == [".svg", ".png"]
    before = [path.read_bytes() for path in paths]
    again = write_figures(tmp_path, study)
    assert [path.read_bytes() for path in again] == before
    write_pages(tmp_path, [study], [], ARGUMENTS, again)
    assert re.search(r'<img src="data:image/(svg\+xml|png);base64,[A-Za-z0-9+/=]+"', page_of(tmp_path))
    # The figures of an earlier run are not shown as those of this one.
    write_pages(tmp_path, [study], [], ARGUMENTS, ())
    assert "data:image" not in page_of(tmp_path).split("<main", 1)[1]


def test_a_figure_that_cannot_be_drawn_leaves_nothing_behind(made_up, tmp_path):
    pytest.importorskip("matplotlib")

    def fail(figure):
        raise ZeroDivisionError

    with pytest.raises(ZeroDivisionError):
        write_figures(tmp_path, _drawn(made_up, fail))
    assert list(tmp_path.rglob("*")) == []


def test_a_page_shows_the_papers_values_beside_ours(made_up, tmp_path):
    assert write_pages(tmp_path, [made_up], [], ARGUMENTS) == []
    page = page_of(tmp_path)
    assert "its text says: 17.6 s." in page
    for text in ("18.1 (17.9 .. 18.3) s", "16.5 .. 19 s", "&lt; 2 %", "2.00 %", "not public", "Made up."):
        assert text in page
    assert re.findall(r'word-(\w+)">(holds|misses|shown)<', page) == [
        ("bad", "misses"),
        ("good", "holds"),
        ("bad", "misses"),
        ("none", "shown"),
    ]
    for text in ("calibrated", "predicted", "3 values: 1 hold, 1 miss (0 declared), 1 shown"):
        assert text in page


def test_markup_in_a_study_is_text(made_up, tmp_path):
    hostile = replace(made_up, study=replace(made_up.study, title="<script>x</script>", paper="<b>1</b>"))
    write_pages(tmp_path, [hostile], [], ARGUMENTS)
    assert "<script>x" not in page_of(tmp_path)
    assert "<b>1" not in page_of(tmp_path)


def test_without_a_figure_the_page_says_why(made_up, tmp_path):
    write_pages(tmp_path, [_drawn(made_up)], [], ARGUMENTS)
    assert "matplotlib is not installed" in page_of(tmp_path)


def test_the_list_leads_to_every_page_and_names_those_of_earlier_runs(made_up, tmp_path):
    other = replace(made_up, study=replace(made_up.study, name="other"))
    never = replace(made_up.study, name="never")
    known = [made_up.study, other.study, never]
    write_pages(tmp_path, [made_up, other], known, ARGUMENTS)
    assert "earlier runs" not in (tmp_path / "index.html").read_text("utf-8")
    write_pages(tmp_path, [made_up], known, ARGUMENTS)
    page = (tmp_path / "index.html").read_text("utf-8")
    for link in re.findall(r'href="([^"#]+)"', page):
        assert (tmp_path / link).exists() or link in ("comparison.csv", "studies.json")
    assert page.index("made-up/index.html") < page.index("earlier runs") < page.index("other/index.html")
    assert "never" not in page.split("<main", 1)[1].replace("it is never the paper", "")


def test_a_page_of_somebody_else_is_left_alone(made_up, tmp_path):
    (tmp_path / "index.html").write_text("mine")
    [problem] = write_pages(tmp_path, [made_up], [], ARGUMENTS)
    assert "is left as it is" in problem
    assert (tmp_path / "index.html").read_text() == "mine"
    assert "17.6 s" in page_of(tmp_path)


def test_the_files_of_the_simulated_stops_are_those_of_the_study_alone():
    def run(scenario):
        def simulate(runner):
            runner.cases(scenario)
            return StudyFindings({})

        return simulate

    runner = StopRunner()
    inputs = [
        run_study(Study(name, "", "", (), run(name)), runner).inputs for name in ("slide-80", "slip-120")
    ]
    files = [{Path(name).name for name in each} for each in inputs]
    assert "slide-80.yaml" in files[0]
    assert "slide-80.yaml" not in files[1]
