import re
from datetime import UTC, datetime

import pytest
from hypothesis import given, strategies as st

from uictest import report
from uictest.runs.history.case_history import HEIGHT, case_histories, shape, strip, summary, width
from uictest.runs.history.entry import CaseEntry
from uictest.runs.history.page import _change
from uictest.runs.history.run_in_folder import ListedRun

START = datetime(2026, 11, 22, tzinfo=UTC)
stops = st.none() | st.tuples(st.sampled_from(report.CASE_WORDS), st.none() | st.floats(0.0, 1e5))


def history(*stops):
    cases = [() if each is None else (CaseEntry("a", *each),) for each in stops]
    runs = [ListedRun(str(n), "run", START, cases=each) for n, each in enumerate(cases)]
    [found] = case_histories(runs)
    return found


def corners(path):
    return [(float(x), float(y)) for x, y in re.findall(r"[ML]([\d.]+) ([\d.]+)", path)]


def heights(path):
    return [y for _, y in corners(path)]


@given(stops=st.lists(stops, min_size=1, max_size=40).filter(any))
def test_every_run_has_its_mark_and_everything_lies_inside(stops):
    drawn = strip(history(*stops))
    run = [each for each in stops if each is not None]
    assert sum(path.count("M") for path in drawn.marks.values()) == len(run)
    assert {shape(word) for word, _ in run} == set(drawn.marks)
    places = [place for path in (*drawn.marks.values(), drawn.line) for place in corners(path)]
    assert all(0.0 < x < width(len(stops)) and 0.0 < y < HEIGHT for x, y in places)


def test_a_longer_distance_lies_higher_and_the_range_fills_the_height():
    low, high, middle = heights(strip(history(("pass", 400.0), ("pass", 500.0), ("pass", 450.0))).line)
    assert low > middle > high
    assert middle == pytest.approx((low + high) / 2.0, abs=0.1)


def test_a_change_of_a_tenth_of_a_permille_looks_flat():
    first, second = heights(strip(history(("pass", 500.0), ("pass", 500.05))).line)
    assert abs(first - second) < 1.0
    assert len(set(heights(strip(history(*[("pass", 500.0)] * 3)).line))) == 1


def test_words_say_what_the_drawing_shows():
    found = history(("pass", 470.0), None, ("fail", 480.0), ("fail", 475.0))
    assert summary(found) == "3 runs: 1 pass, 2 fail; the verdict turned 1 time; distance 470.0 .. 480.0 m"


@pytest.mark.parametrize(
    ("distance", "texts"),
    [
        (500.0, ("0", "")),
        (505.5, ("+5.5", "+1.1 %")),
        (499.5, ("-0.5", "-0.1 %")),
        (500.004, ("+0.004", "+0.0008 %")),
        (None, ("", "")),
    ],
)
def test_a_change_is_0_only_where_there_is_none(distance, texts):
    assert _change(history(("pass", 500.0), ("pass", distance))) == texts
