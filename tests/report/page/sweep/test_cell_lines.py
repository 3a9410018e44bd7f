"""Lines of a measure over a parameter, one for each value of a second: places, gaps, when there are none."""

from __future__ import annotations

import numpy as np
import pytest

from uictest.report.page.sweep.cell_lines import MOST_LINES, CellLines, cell_lines
from uictest.report.sweep.map_cells import CellAxis, MapCells
from uictest.report.sweep.values import WrittenValue

NAN = float("nan")


def _axis(key: str, *texts: str) -> CellAxis:
    return CellAxis(key, [(WrittenValue(text),) for text in texts])


def _lines(rows: CellAxis, columns: CellAxis, means: list[list[float]], cases: int = 1) -> list[CellLines]:
    counts = np.full((len(rows.groups), len(columns.groups)), cases)
    cells = MapCells(rows, columns, counts, counts, {}, {"distance": np.array(means)})
    return list(cell_lines(cells, {"distance": "m"}, ()))


def test_every_point_is_the_value_of_one_cell() -> None:
    command = _axis("command", "80 %", "100 %")
    friction = _axis("friction", "0.12", "0.08", "0.10")
    (drawn,) = _lines(command, friction, [[3.0, 1.0, 2.0], [6.0, 4.0, 5.0]])
    assert [line.label for line in drawn.lines] == ["80 %", "100 %"]
    assert (drawn.x_title, drawn.second, drawn.title) == ("friction", "command", "distance, m")
    for line, lowest in zip(drawn.lines, (1.0, 4.0), strict=True):
        across = [x for x, _, _ in line.points]
        assert across == sorted(across)
        assert np.diff(across) == pytest.approx(np.diff(across)[0])
        values = enumerate(("0.08", "0.10", "0.12"))
        words = [f"{line.label}, {at}: {lowest + k:g}, 1 case" for k, at in values]
        assert [each for _, _, each in line.points] == words
    (_, low, _), (_, high, _) = drawn.lines[0].points[0], drawn.lines[1].points[0]
    assert low > high  # pixels count downwards


def test_a_cell_without_the_measure_is_a_gap() -> None:
    (drawn,) = _lines(_axis("a", "1", "2"), _axis("b", "1", "2", "3"), [[1.0, NAN, 3.0], [1.0, 2.0, 3.0]])
    assert [line.path.count("M") for line in drawn.lines] == [2, 1]
    assert [len(line.points) for line in drawn.lines] == [2, 3]


def test_the_parameter_with_few_values_has_the_lines_and_names_can_be_one() -> None:
    many = _axis("many", *(str(k) for k in range(MOST_LINES + 1)))
    (drawn,) = _lines(many, _axis("adhesion", "de Pater", "other"), [[float(k), k + 1.0] for k in range(7)])
    assert drawn.second == "adhesion"
    assert [line.label for line in drawn.lines] == ["de Pater", "other"]
    assert drawn.of_cases == "; cells of 1 case"


def test_names_across_and_too_many_values_of_both_have_no_lines() -> None:
    named = _axis("a", "de Pater", "other")
    assert _lines(named, _axis("b", "first", "second"), [[1.0, 2.0], [3.0, 4.0]]) == []
    many = [str(k) for k in range(MOST_LINES + 1)]
    assert _lines(_axis("a", *many), _axis("b", *many), np.ones((7, 7)).tolist()) == []
