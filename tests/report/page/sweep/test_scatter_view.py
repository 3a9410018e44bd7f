"""What a page says and holds of the points of a sample."""

import json
import math
from dataclasses import replace

import numpy as np

from uictest.report.page.sweep.scatter import PointNumbers, Scatter, scatter_view


def scatter(cases, shown, added=0):
    numbers = PointNumbers("gain", "1/s", np.arange(shown) / 3.0, True)
    distance = PointNumbers("distance", "m", np.where(np.arange(shown) % 2, np.nan, 1.5))
    ids = [f"study[sample={k}]" for k in range(shown)]
    counts = {"fail": 1, "pass": cases - 1}
    return Scatter(cases, added, ids, ["pass"] * shown, counts, [numbers], [distance], ["topology"])


def test_it_is_stated_which_cases_are_shown():
    left_out = "Not numbers of one unit, and not here: topology."
    assert list(scatter_view(scatter(448, 448), {}).sentences) == ["Shown: all 448 cases.", left_out]
    assert list(scatter_view(scatter(10_000, 2003, 3), {}).sentences) == [
        "Shown: 2 000 of 10 000 cases, chosen at random, and 3 drawn stops besides.",
        "Rare cases may be missing here; summary.csv has every case.",
        left_out,
    ]


def test_every_point_has_its_numbers_its_verdict_and_its_stop():
    view = scatter_view(scatter(448, 4), {"study[sample=2]": "case-2", "other": "case-9"})
    data = json.loads(view.data)
    assert data["parameters"] == [
        {"name": "gain", "unit": "1/s", "logarithmic": True, "values": [0.0, 0.3333333, 0.6666667, 1.0]}
    ]
    seeds = PointNumbers("seed", "", np.array([4294967295.0]))
    (seed,) = json.loads(scatter_view(replace(scatter(1, 1), parameters=[seeds]), {}).data)["parameters"]
    assert seed["values"] == [4294967295]
    assert data["measures"][0]["values"] == [1.5, None, 1.5, None]
    assert data["ids"] == [f"study[sample={k}]" for k in range(4)]
    assert data["stops"] == {"2": "case-2"}
    # The commonest verdict lies below the others; one that no point has is in the legend.
    assert [(each["word"], each["tone"], each["all"]) for each in data["words"]] == [
        ("pass", "good", 447),
        ("fail", "bad", 1),
    ]
    assert data["word"] == [0] * 4
    assert math.isfinite(data["limits"]["parameter"])
