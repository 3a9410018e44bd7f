from __future__ import annotations

from typing import Any

import pytest
from hypothesis import given, strategies as st

from uictest.report.sweep.bundles import bundled, is_large


def _map(rows: int, columns: int) -> dict[str, Any]:
    axes = {
        axis: {"parameter": axis, "values": [str(k) for k in range(count)]}
        for axis, count in (("rows", rows), ("columns", columns))
    }
    cells = [[row * columns + column for column in range(columns)] for row in range(rows)]
    means = [[float(cell) if cell else None for cell in row] for row in cells]
    return {"measure": "met", **axes, "means": means, "met": cells, "cases": cells}


def test_a_small_map_stays_as_it_is() -> None:
    assert bundled(_map(24, 2)) == _map(24, 2)


@given(st.integers(1, 60), st.integers(1, 60), st.integers(1, 30))
def test_bundles_hold_every_case_once_in_few_cells(rows: int, columns: int, most: int) -> None:
    shown = bundled(_map(rows, columns), most)
    assert not is_large(shown, most)
    assert sum(map(sum, shown["cases"])) == sum(range(rows * columns))
    assert len(shown["cases"]) == len(shown["means"]) == len(shown["rows"]["values"])
    assert {len(row) for row in shown["means"]} == {len(shown["columns"]["values"])}


def test_a_bundle_is_named_by_its_ends_and_has_the_mean_of_its_cases() -> None:
    shown = bundled(_map(3, 2), most=2)
    assert shown["rows"]["values"] == ["0 … 1", "2"]
    # Cells 0 (no case, no mean) and 2 (two cases), then 1 and 3.
    assert shown["means"][0] == [2.0, pytest.approx((1 + 9) / 4)]
    assert shown["means"][1] == [4.0, 5.0]


def test_a_bundle_without_a_figure_has_no_mean() -> None:
    found = _map(4, 1) | {"means": [[None]] * 4}
    assert bundled(found, most=2)["means"] == [[None], [None]]
