"""Maps of two parameters: what a cell says, its colour, and where the verdict turns."""

import numpy as np
import pytest
from hypothesis import given, strategies as st
from hypothesis.extra.numpy import array_shapes, arrays
from plotly.colors import sequential

from uictest.report.page.sweep_maps import ColourScale, boundaries, is_dark, luminance, maps_of_pair
from uictest.report.sweep.sweep_maps import CellAxis, MapCells
from uictest.report.sweep.values import WrittenValue


def axis(key, count):
    return CellAxis(key, [(WrittenValue(str(k + 1)),) for k in range(count)])


def cells(met, cases, outcomes=None, **means):
    met, cases = np.array(met), np.array(cases)
    known = {name: np.array(counts) for name, counts in (outcomes or {}).items()}
    rows, columns = cases.shape
    figures = {name: np.array(each, float) for name, each in means.items()}
    valid = sum((known.get(name, 0 * cases) for name in ("pass", "fail")), 0 * cases) if known else cases
    return MapCells(axis("a", rows), axis("b", columns), cases, met, valid, known, figures)


def maps_of(found, stops=None, varied=("a", "b"), units=None):
    return maps_of_pair(found, units or {}, stops or {}, varied, with_measures=True)


def texts(shown):
    return [[cell.text for cell in row] for _, row in shown.rows]


def test_the_boundary_of_a_known_grid():
    """Met below a diagonal: three steps, each an upright and a level line."""
    verdicts = np.array([[1, 1, 1], [1, 1, 0], [1, 0, 0]])
    sides = [[boundaries(verdicts, row, column) for column in range(3)] for row in range(3)]
    assert sides == [
        [[], [], []],
        [[], [], ["turns-above", "turns-left"]],
        [[], ["turns-above", "turns-left"], []],
    ]


@given(
    arrays(np.int8, array_shapes(min_dims=2, max_dims=2, min_side=2, max_side=7), elements=st.integers(-1, 1))
)
def test_the_boundary_runs_between_met_and_not_met_and_nowhere_else(verdicts):
    found = sum(len(boundaries(verdicts, *place)) for place in np.ndindex(verdicts.shape))
    pairs = [(verdicts[:-1], verdicts[1:]), (verdicts[:, :-1], verdicts[:, 1:])]
    turned = [np.sum((before >= 0) & (after >= 0) & (before != after)) for before, after in pairs]
    assert found == sum(turned)


def test_a_map_that_says_the_same_everywhere_is_left_out():
    assert maps_of(cells([[1, 1]], [[1, 1]])) is None
    assert maps_of(cells([[0, 0]], [[1, 1]])) is None
    assert [shown.title for shown in maps_of(cells([[1, 1]], [[1, 1]], distance=[[1.0, 2.0]])).maps] == [
        "Distance"
    ]


def test_a_cell_of_one_case_says_its_outcome_and_others_their_share():
    outcomes = {"pass": [[1, 0]], "fail": [[0, 0]], "skipped": [[0, 1]]}
    (single,) = maps_of(cells([[1, 0]], [[1, 1]], outcomes), stops={(0, 0): "case-3"}).maps
    assert (single.title, texts(single)) == ("Outcome", [["pass", "skipped"]])
    assert [cell.stop for cell in single.rows[0][1]] == ["case-3", ""]
    outcomes = {"pass": [[3, 0, 2]], "fail": [[1, 0, 0]], "error": [[1, 3, 0]]}
    (several,) = maps_of(cells([[3, 0, 2]], [[5, 3, 2]], outcomes)).maps
    assert (several.title, texts(several)) == ("Cases met, %", [["60", "0", "100"]])
    assert [cell.detail for cell in several.rows[0][1]] == [
        "3 of 5 met, 1 fail, 1 error",
        "0 of 3 met, 3 error",
        "2 of 2 met",
    ]
    assert [cell.kind for cell in several.rows[0][1]] == ["mixed", "no-test", "all-met turns-left"]
    outcomes = {"fail": [[2, 0, 1]], "invalid": [[0, 2, 1]], "pass": [[0, 0, 1]]}
    (apart,) = maps_of(cells([[0, 0, 1]], [[2, 2, 3]], outcomes)).maps
    assert [cell.kind for cell in apart.rows[0][1]] == ["none-met", "no-test", "mixed"]


def test_a_cell_without_a_case_and_one_without_the_measure_have_no_colour():
    found = cells([[1, 0, 1]], [[1, 0, 1]], distance=[[2.0, np.nan, np.nan]])
    (distances,) = maps_of(found).maps
    assert [(cell.text, cell.kind) for cell in distances.rows[0][1][1:]] == [
        ("", "no-case"),
        ("–", "no-value"),  # noqa: RUF001
    ]
    assert [bool(cell.colour) for cell in distances.rows[0][1]] == [True, False, False]


def test_what_a_cell_stands_for_is_stated():
    folded = CellAxis("a", [(WrittenValue("1"), WrittenValue("2")), (WrittenValue("3"),)])
    fours = np.full((2, 2), 4)
    found = MapCells(folded, axis("b", 2), fours, fours, fours, {}, {"distance": np.ones((2, 2))})
    shown = maps_of(found, varied=("a", "b", "c", "d"), units={"distance": "m"})
    assert shown.name == "a (down) against b (across)"
    assert shown.notes == [
        "A cell has all cases with its two values, whatever their c, d.",
        "Folded: neighbours of 3 values of a share 2 cells.",
    ]
    assert [(each.title, each.anchor) for each in shown.maps] == [("Mean distance, m", "map-distance-a-b")]


def test_what_differs_by_rounding_has_one_colour_and_what_differs_little_digits_and_colours_of_its_own():
    """0.1 + 0.2 is not 0.3 in floats: a mean over other cases would have the other end of the scale."""
    [found] = maps_of(cells([[1, 1]], [[1, 1]], distance=[[0.3, 0.1 + 0.2]])).maps
    assert len({cell.colour for cell in found.rows[0][1]}) == 1
    [found] = maps_of(cells([[1, 1]], [[1, 1]], distance=[[469.61, 469.63]])).maps
    shown = [(cell.text, cell.colour, cell.kind) for cell in found.rows[0][1]]
    assert shown == [("469.61", "#440154", "light"), ("469.63", "#fde725", "dark")]


def rgb(colour):
    return np.array([int(colour[k : k + 2], 16) for k in (1, 3, 5)])


def test_colours_are_those_of_viridis():
    """As plotly has it."""
    published = sequential.Viridis
    scale = ColourScale(0.0, len(published) - 1.0)
    for place, colour in enumerate(published):
        assert np.abs(rgb(scale.colour(place)) - rgb(colour)).max() <= 6
    assert (scale.colour(-5.0), scale.colour(99.0)) == ("#440154", "#fde725")


def test_lightness_rises_evenly():
    """L* of CIELAB, in every step by 1.2 on average and never by less than a half or more than twice that."""
    colours = map(ColourScale(0.0, 1.0).colour, np.linspace(0.0, 1.0, 64).tolist())
    steps = np.diff([116.0 * np.cbrt(luminance(each)) - 16.0 for each in colours])
    assert np.all(steps > 0.4 * steps.mean())
    assert np.all(steps < 2.0 * steps.mean())
    assert steps.sum() > 70.0


@pytest.mark.parametrize("place", np.linspace(0.0, 1.0, 41).tolist())
def test_text_on_every_colour_can_be_read(place):
    """WCAG 2.1, 1.4.3: 4.5 to 1."""
    colour = ColourScale(0.0, 1.0).colour(place)
    dark, light = sorted((luminance(colour), 1.0 if is_dark(colour) else 0.0))
    assert (light + 0.05) / (dark + 0.05) >= 4.5
