"""Two logs compared group by group."""

import json
import math
import random
from dataclasses import replace

import numpy as np
import pytest
from hypothesis import given, strategies as st
from scipy import stats

from tests.service_log import logs
from uictest.analysis.logged_stops import compare_logs
from uictest.cli.entry import execute
from uictest.core.statistics import difference_interval, mean_interval, proportion_interval
from uictest.report import read_run


def of_means(first, second, confidence):
    return difference_interval(*((np.mean(own), *mean_interval(own, confidence)) for own in (first, second)))


@pytest.mark.parametrize("confidence", [0.95, 0.995])
@pytest.mark.parametrize(("counts", "scatters"), [((3, 20), (1, 1)), ((3, 5), (3, 1)), ((5, 5), (1, 3))])
def test_the_interval_of_a_difference_of_means_holds_it_with_few_stops(confidence, counts, scatters):
    """By Welch 2.2 % of the first would be missed at 99.5 %, and 1.3 % of the second."""
    draw = np.random.default_rng(12)
    missed = 0
    for _ in range(2000):
        low, high = of_means(*map(lambda n, s: list(draw.normal(0.0, s, n)), counts, scatters), confidence)
        missed += not low <= 0.0 <= high
    nominal = 1.0 - confidence
    assert missed / 2000 <= nominal + 3.0 * math.sqrt(nominal * confidence / 2000)


@given(*[st.lists(st.floats(-100.0, 100.0), min_size=2, max_size=9)] * 2)
def test_an_exchange_of_the_sides_turns_the_interval_around(first, second):
    low, high = of_means(first, second, 0.9)
    assert of_means(second, first, 0.9) == pytest.approx((-high, -low), nan_ok=True)


def test_samples_without_spread_have_no_interval():
    assert all(map(math.isnan, of_means([1.0, 1.0], [2.0, 2.0], 0.95)))
    assert all(map(math.isnan, of_means([1.0], [2.0, 3.0], 0.95)))


@pytest.mark.parametrize(("p1", "p2"), [(0.5, 0.5), (0.9, 0.6), (0.97, 0.97), (0.1, 0.8)])
def test_the_interval_of_a_difference_of_shares_holds_it_often_enough(p1, p2):
    """The chance of every outcome of 12 and 9 stops is known: no sampling."""
    covered = 0.0
    for x in range(13):
        for y in range(10):
            sides = ((k / n, *proportion_interval(k, n)) for k, n in ((x, 12), (y, 9)))
            low, high = difference_interval(*sides)
            if low <= p2 - p1 <= high:
                covered += stats.binom.pmf(x, 12, p1) * stats.binom.pmf(y, 9, p2)
    assert covered >= 0.95


def judged(folder, name, seed, controller):
    draw = random.Random(seed)
    stops = [
        logs.simulated(
            logs.wet(draw.uniform(0.08, 0.11)), 80.0, draw.randrange(10**6), {"controller": controller}
        )
        for _ in range(7)
    ]
    logs.write_log(stops, folder / f"{name}.parquet")
    execute(
        [
            "log",
            f"{name}.parquet",
            "--scenario",
            "night.yaml",
            "-q",
            "-o",
            name,
            "--recordings",
            f"{name}-stops",
        ]
    )


@pytest.fixture(name="nights", scope="module")
def _nights(tmp_path_factory):
    """Logs of one controller in two nights, and of another."""
    folder = tmp_path_factory.mktemp("nights")
    (folder / "night.yaml").write_text(logs.CONDITIONS, "utf-8")
    with pytest.MonkeyPatch.context() as patch:
        patch.chdir(folder)
        judged(folder, "a", 1, "threshold")
        judged(folder, "again", 2, "threshold")
        judged(folder, "b", 3, "slip-band")
    return folder


def compared(nights, first, second, capsys):
    code = execute(
        ["compare", str(nights / first / "latest"), str(nights / second / "latest"), "--format", "json"]
    )
    document = json.loads(capsys.readouterr().out)
    assert code == 0
    return {row["quantity"]: row for row in document["rows"]}


def test_another_controller_is_told_apart(nights, capsys):
    rows = compared(nights, "a", "b", capsys)
    assert rows["braking_distance_m"]["finding"] == "B larger"
    assert rows["friction"]["finding"] == "not told apart"
    assert rows["braking_distance_m"]["first_stops"] == rows["braking_distance_m"]["second_stops"] == 7


def test_the_same_controller_in_another_night_is_not(nights, capsys):
    assert {row["finding"] for row in compared(nights, "a", "again", capsys).values()} == {"not told apart"}


def test_the_other_way_round_every_difference_changes_its_sign(nights, capsys):
    there, back = (compared(nights, *pair, capsys) for pair in (("a", "b"), ("b", "a")))
    for name, row in there.items():
        assert back[name]["difference"] == pytest.approx(-row["difference"], abs=1e-12)
        assert back[name]["low"] == pytest.approx(-row["high"], abs=1e-9)


def test_logs_have_no_tolerance(nights, capsys):
    place = str(nights / "a" / "latest")
    assert execute(["compare", place, place, "--tolerance", "braking_distance_m=1 m"]) == 4
    assert "no pairs" in capsys.readouterr().err


def test_no_share_is_told_where_both_sides_were_judged_by_different_criteria(nights):
    one = read_run((nights / "a" / "latest").resolve())
    fewer = [replace(each, criteria=each.criteria[1:]) for each in one.results]
    table = compare_logs(one, replace(one, results=fewer))
    assert "stops that pass" not in {row["quantity"] for row in table.data.rows}
    assert "different criteria" in table.basis
    assert "stops that pass" in {row["quantity"] for row in compare_logs(one, one).data.rows}


def test_another_speed_within_the_group_is_no_difference_of_distances(nights):
    """Two per cent less speed at the same deceleration, and all that goes with its square."""
    one = read_run((nights / "a" / "latest").resolve())
    share = 0.98**2

    def slower(result):
        measures = {**result.measures, "braking_distance_m": share * result.measures["braking_distance_m"]}
        wheelsets = [
            {**each, "slid_distance_m": share * each["slid_distance_m"]} for each in result.wheelsets
        ]
        return replace(result, measures=measures, wheelsets=tuple(wheelsets))

    table = compare_logs(one, replace(one, results=[slower(each) for each in one.results]))
    rows = {row["quantity"]: row for row in table.data.rows}
    for name in ("braking_distance_m", "largest_slid_distance_m"):
        assert rows[name]["difference"] == pytest.approx(0.0, abs=1e-9 * float(rows[name]["first"]))


@pytest.mark.parametrize("inconclusive", [7, 1])
def test_no_share_is_told_where_stops_could_not_be_judged(nights, inconclusive):
    """A stop that lacks a channel can still fail: those that are left are no sample."""
    one = read_run((nights / "a" / "latest").resolve())
    results = [
        replace(each, outcome="inconclusive" if k < inconclusive else each.outcome)
        for k, each in enumerate(one.results)
    ]
    names = {
        row["quantity"]: row["finding"] for row in compare_logs(one, replace(one, results=results)).data.rows
    }
    assert "stops that pass" not in names
    assert set(names.values()) == {"not told apart"}
