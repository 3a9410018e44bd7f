"""What a page says and holds of the points of a sample."""

import json
import re
from dataclasses import replace

import numpy as np
import pytest

from uictest.report.page.sweep.panels import panels_of_points
from uictest.report.page.sweep.scatter import PointNumbers, Scatter


def scatter(cases, shown, added=0):
    numbers = PointNumbers("gain", "1/s", np.arange(shown) / 3.0, True)
    distance = PointNumbers("distance", "m", np.where(np.arange(shown) % 2, np.nan, np.arange(shown)))
    ids = [f"study[sample={k}]" for k in range(shown)]
    counts = {"fail": 1, "pass": cases - 1}
    return Scatter(cases, added, ids, ["pass"] * shown, counts, [numbers], [distance], ["topology"])


def test_it_is_stated_which_cases_are_shown():
    left_out = "Not numbers of one unit, and not here: topology."
    assert list(panels_of_points(scatter(448, 448), {}).sentences) == [
        "Shown: all 448 cases.",
        left_out,
        "224 points without distance.",
    ]
    assert list(panels_of_points(scatter(10_000, 1003, 3), {}).sentences) == [
        "Shown: 1 000 of 10 000 cases, chosen at random, and 3 drawn stops besides.",
        "Rare cases may be missing here; summary.csv has every case.",
        left_out,
        "501 points without distance.",
    ]


def test_every_point_has_its_place_its_numbers_its_verdict_and_its_stop():
    view = panels_of_points(scatter(448, 4), {"study[sample=2]": "case-2", "other": "case-9"})
    data = json.loads(view.data)
    (gain,), (distance,) = data["parameters"], data["measures"]
    assert (gain["name"], gain["unit"]) == ("gain", "1/s")
    assert gain["values"] == [0.0, 0.3333333, 0.6666667, 1.0]
    assert distance["values"] == [0.0, None, 2.0, None]
    assert data["ids"] == [f"study[sample={k}]" for k in range(4)]
    assert data["stops"] == {"2": "case-2"}
    assert data["words"] == ["pass"] * 4
    # A verdict that no point has is in the key.
    assert [words for _, _, words in view.key] == ["pass: 4 of 447 shown", "fail: 0 of 1 shown"]
    ((name, (panel,)),) = view.measures
    assert (name, panel.data) == ("distance", {"across": 0, "up": 0})
    points, ring = panel.plot.shapes
    assert (ring.words, ring.link) == ("study[sample=2]", "case-2")
    places = [tuple(map(float, each)) for each in re.findall(r"M([\d.]+) ([\d.]+)", points.path)]
    for (x, y), k in zip(places, (0, 2), strict=True):
        assert (x, y) == pytest.approx((pixel(gain, k), pixel(distance, k)), abs=0.06)


def pixel(column, k):
    """Return where the cursor of the page looks for a number."""
    axis = column["axis"]
    share = (column["values"][k] - axis["low"]) / (axis["high"] - axis["low"])
    return axis["start"] + share * (axis["end"] - axis["start"])


def test_a_measure_with_one_value_has_no_panels_and_a_seed_all_its_digits():
    points = scatter(4, 4)
    same = PointNumbers("slide", "%", np.zeros(4))
    seeds = PointNumbers("seed", "", np.arange(4) + 4294967292.0)
    view = panels_of_points(replace(points, measures=[same], parameters=[seeds]), {})
    assert list(view.measures) == []
    assert json.loads(view.data)["parameters"][0]["values"][-1] == 4294967295


def test_the_shapes_of_verdicts_differ_and_a_long_title_ends_with_what_says_most():
    points = replace(scatter(4, 4), words=["pass", "fail", "expected fail", "error"])
    points = replace(points, all_words=dict.fromkeys(points.words, 1))
    long = PointNumbers("brake.system.wsp_valve.vent_conductance", "m3/(s Pa)", np.arange(4) + 1.0, True)
    view = panels_of_points(replace(points, parameters=[long]), {})
    assert len({shape for _, shape, _ in view.key}) == 4
    ((_, (panel,)),) = view.measures
    assert panel.plot.x_title == "…vent_conductance, m3/(s Pa), logarithmic"
