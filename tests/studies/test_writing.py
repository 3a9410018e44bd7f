from __future__ import annotations

from collections.abc import Callable
from dataclasses import replace
from pathlib import Path
from typing import Any

import pytest

from studies.study import STUDIES, StudyFindings, StudyResult
from studies.writing import table_text, write_comparison, write_figures, write_tables

QUICK = ("bench-loops", "four-phase-lines", "command-level", "slide-test", "valve-actuations", "appendix-b")


def test_tables_lie_in_the_folder_of_their_study(made_up: StudyResult, tmp_path: Path) -> None:
    assert write_tables(tmp_path, made_up) == [tmp_path / "made-up" / "data.csv"]
    assert (tmp_path / "made-up" / "data.csv").read_text() == 'time_s,what\n0.0,"a, b"\n0.5,\n'


def test_columns_of_different_lengths_are_rejected() -> None:
    with pytest.raises(ValueError, match="shorter"):
        table_text({"a": [1, 2], "b": [1]})


def test_the_comparison_lies_beside_the_studies(made_up: StudyResult, tmp_path: Path) -> None:
    write_comparison(tmp_path / "new", [made_up])
    assert {path.name for path in (tmp_path / "new").iterdir()} == {"comparison.csv", "studies.json"}


def _drawn(result: StudyResult, drawing: Callable[[Any], None]) -> StudyResult:
    return replace(result, findings=StudyFindings(result.findings.values, drawings={"figure": drawing}))


def test_a_figure_is_the_same_to_the_byte_whenever_it_is_drawn(made_up: StudyResult, tmp_path: Path) -> None:
    pytest.importorskip("matplotlib")
    study = _drawn(made_up, lambda figure: figure.subplots().plot([0.0, 1.0], [1.0, 0.0]))
    paths = write_figures(tmp_path, study)
    assert [path.suffix for path in paths] == [".svg", ".png"]
    before = [path.read_bytes() for path in paths]
    write_figures(tmp_path, study)
    assert [path.read_bytes() for path in paths] == before


def test_a_figure_that_cannot_be_drawn_leaves_nothing_behind(made_up: StudyResult, tmp_path: Path) -> None:
    pytest.importorskip("matplotlib")

    def fail(figure: Any) -> None:
        raise ZeroDivisionError

    with pytest.raises(ZeroDivisionError):
        write_figures(tmp_path, _drawn(made_up, fail))
    assert list(tmp_path.rglob("*")) == []


@pytest.mark.parametrize("name", QUICK)
def test_axes_name_their_units(name: str, result: Callable[[str], StudyResult]) -> None:
    figure_module = pytest.importorskip("matplotlib.figure")
    done = result(name)
    assert done.study is STUDIES[name]
    for drawing in done.findings.drawings.values():
        figure = figure_module.Figure()
        drawing(figure)
        labels = {text for axes in figure.axes for text in (axes.get_xlabel(), axes.get_ylabel()) if text}
        assert labels
        assert all(", " in label or label.startswith("%") for label in labels)
