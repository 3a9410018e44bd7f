from __future__ import annotations

import re
from collections.abc import Callable
from dataclasses import replace
from pathlib import Path
from typing import Any

import pytest

from studies.page import write_pages
from studies.stop_runner import StopRunner
from studies.study import Study, StudyFindings, StudyResult, run_study
from studies.writing import write_figures

ARGUMENTS = ("made-up",)


def page_of(folder: Path, name: str = "made-up") -> str:
    return (folder / name / "index.html").read_text("utf-8")


def test_a_page_shows_the_papers_values_beside_ours(made_up: StudyResult, tmp_path: Path) -> None:
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


def test_markup_in_a_study_is_text(made_up: StudyResult, tmp_path: Path) -> None:
    hostile = replace(made_up, study=replace(made_up.study, title="<script>x</script>", paper="<b>1</b>"))
    write_pages(tmp_path, [hostile], [], ARGUMENTS)
    assert "<script>x" not in page_of(tmp_path)
    assert "<b>1" not in page_of(tmp_path)


def _drawn(result: StudyResult) -> StudyResult:
    def draw(figure: Any) -> None:
        figure.subplots().plot([0.0, 1.0], [1.0, 0.0])

    findings = replace(result.findings, drawings={"figure": draw})
    return replace(result, findings=findings)


def test_the_page_holds_its_figure(made_up: StudyResult, tmp_path: Path) -> None:
    pytest.importorskip("matplotlib")
    drawn = _drawn(made_up)
    write_pages(tmp_path, [drawn], [], ARGUMENTS, write_figures(tmp_path, drawn))
    assert re.search(r'<img src="data:image/(svg\+xml|png);base64,[A-Za-z0-9+/=]+"', page_of(tmp_path))


def test_the_figure_of_an_earlier_run_is_not_shown_as_that_of_this_one(
    made_up: StudyResult, tmp_path: Path
) -> None:
    pytest.importorskip("matplotlib")
    drawn = _drawn(made_up)
    write_figures(tmp_path, drawn)
    write_pages(tmp_path, [drawn], [], ARGUMENTS, ())
    assert "data:image" not in page_of(tmp_path).split("<main", 1)[1]


def test_without_a_figure_the_page_says_why(made_up: StudyResult, tmp_path: Path) -> None:
    write_pages(tmp_path, [_drawn(made_up)], [], ARGUMENTS)
    assert "matplotlib is not installed" in page_of(tmp_path)


def test_the_list_leads_to_every_page_and_names_those_of_earlier_runs(
    made_up: StudyResult, tmp_path: Path
) -> None:
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


def test_a_page_of_somebody_else_is_left_alone(made_up: StudyResult, tmp_path: Path) -> None:
    (tmp_path / "index.html").write_text("mine")
    [problem] = write_pages(tmp_path, [made_up], [], ARGUMENTS)
    assert "is left as it is" in problem
    assert (tmp_path / "index.html").read_text() == "mine"
    assert "17.6 s" in page_of(tmp_path)


def test_the_files_of_the_simulated_stops_are_those_of_the_study_alone() -> None:
    def run(scenario: str) -> Callable[[StopRunner], StudyFindings]:
        def simulate(runner: StopRunner) -> StudyFindings:
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
