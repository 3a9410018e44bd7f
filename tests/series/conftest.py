"""Series made of stops whose results are written down, and files in a folder of their own."""

from dataclasses import replace

import pytest

from uictest.core.measures import STOP_COLUMNS, WHEELSET_COLUMNS
from uictest.judging import series
from uictest.judging.evaluation import CaseResult, RepeatedStop, Repeats, Verdict
from uictest.plans import series as series_plans
from uictest.plans.scenario import PASS

SCENARIO = "schema: uictest/scenario/1\nname: {name}\ninitial_speed: 120 km/h\n{text}"
SERIES = "schema: uictest/series/1\nname: campaign\n{text}"
PAIR = "dry: dry.yaml\nwet: wet.yaml\n"


@pytest.fixture
def write(write):
    """Write a file into the working folder, which holds dry.yaml and wet.yaml."""
    write("dry.yaml", SCENARIO.format(name="dry", text="rail: {condition: dry}\ncriteria: uictest-stop\n"))
    wet = "rail: {condition: wet, friction: 0.08}\ncriteria: uictest-stop\n"
    write("wet.yaml", SCENARIO.format(name="wet", text=wet))
    return write


@pytest.fixture
def load(write):
    """The series of a file that says this besides its schema and name."""

    def read(text=PAIR, *overrides, seed=None):
        return series_plans.load_series(
            write("campaign.series.yaml", SERIES.format(text=text)), overrides, seed
        )

    return read


def columns(distance, speed_kmh=120.0, **changes):
    """The columns of a stop with this braking distance; its deceleration distance is 60 m shorter."""
    own = {
        "braking_distance_m": distance,
        "corrected_distance_m": distance,
        "mean_deceleration_mps2": (speed_kmh / 3.6) ** 2 / (2.0 * distance),
        "deceleration_distance_m": distance - 60.0,
    }
    return dict.fromkeys(STOP_COLUMNS, 1.0) | own | changes


def judge(planned, distances, outcomes=None, bypassed=None, **changes):
    """Judge a series whose stops have these distances (m), outcomes and verdicts, dry ones first.

    A list of distances makes a repeated case. Stops with the WSP bypassed have `bypassed`, if there is one.
    """
    cases = []
    tested = [stop for stop in planned.stops if stop.role != "bypassed"]
    without = [stop for stop in planned.stops if stop.role == "bypassed" and bypassed is not None]
    pairs = [*zip(tested, distances, strict=True), *((stop, bypassed) for stop in without)]
    for stop, given in pairs:
        speed = round(stop.speed * 3.6, 6)
        stops = [
            _stop(seed, each, speed, (outcomes or {}).get(each, "pass"), changes)
            for seed, each in enumerate(given if isinstance(given, list) else [given])
        ]
        result = CaseResult(stop.case.id, "x.yaml", {}, PASS, stops[0].outcome, stops[0].reason)
        result = replace(
            result,
            criteria=stops[0].criteria,
            measures=stops[0].measures,
            wheelsets=stops[0].wheelsets,
            repeats=Repeats("all", tuple(stops)) if isinstance(given, list) else None,
        )
        cases.append(series.SeriesCase(stop.role, speed, result, stop.rail))
    return series.judge_series(planned, cases)


def _stop(seed, distance, speed, outcome, changes):
    wheelsets = (dict.fromkeys(WHEELSET_COLUMNS, 0.0),) * 4
    reason = "" if outcome == "pass" else f"because it is {outcome}"
    criteria = (no_test(reason),) if outcome == "invalid" else ()
    return RepeatedStop(seed, outcome, reason, criteria, columns(distance, speed, **changes), wheelsets)


def no_test(reason):
    """The verdict of a criterion of validity that a stop misses."""
    return Verdict("slippery", "validity", 0.09, "g", None, 0.08, -0.01, "fail", reason)
