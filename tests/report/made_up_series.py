"""Series to report on, judged from results that are written down."""

from dataclasses import replace

from uictest.core.measures import STOP_COLUMNS, WHEELSET_COLUMNS
from uictest.core.series_measures import SERIES_MEASURES, SpeedStops
from uictest.judging import evaluation, series
from uictest.judging.evaluation import CaseResult, RepeatedStop, Repeats, Verdict
from uictest.plans.scenario import PASS, expectation_of


def _stop(seed, distance, outcome="pass"):
    measures = dict.fromkeys(STOP_COLUMNS, 1.0) | {
        "braking_distance_m": distance,
        "corrected_distance_m": distance,
        "mean_deceleration_mps2": (120.0 / 3.6) ** 2 / (2.0 * distance),
        "deceleration_distance_m": distance - 60.0,
    }
    wheelsets = (dict.fromkeys(WHEELSET_COLUMNS, 0.0),) * 4
    reason = "" if outcome == "pass" else "3 % misses < 0.1 %"
    wrong = Verdict("energy-balance", "rig", 3.0, "%", None, 0.1, -2.9, "fail", reason)
    criteria = () if outcome == "pass" else (wrong,)
    return RepeatedStop(seed, outcome, evaluation.reasons_of(criteria), criteria, measures, wheelsets)


def _case(name, stops, role):
    first = stops[0]
    result = CaseResult(name, "wet.yaml", {"rail.friction": "0.08"}, PASS, first.outcome, first.reason)
    case = replace(result, measures=first.measures, wheelsets=first.wheelsets, repeats=Repeats("all", stops))
    return series.SeriesCase(role, 120.0, case)


def make_series(**changes):
    """A series of two dry stops and six wet ones, the last of them no test, with whatever is to be different.

    Its K_wet is 0.870; the criterion `k-wet` wants 0.80.
    """
    dry = _case("acceptance.dry", (_stop(0, 459.99), _stop(1, 460.01)), "dry")
    valid = [_stop(seed, distance) for seed, distance in enumerate((500.0, 510.0, 520.0, 530.0, 540.0))]
    wet = _case("acceptance.wet", (*valid, _stop(5, 2000.0, "invalid")), "wet")
    figures = [stop.figures for stop in series.observed_stops([wet], 3.0)][:5]
    of_dry = [stop.figures for stop in series.observed_stops([dry], 3.0)]
    speed = SpeedStops(120.0 / 3.6, tuple(of_dry), tuple(figures))
    measures = {name: each.of_series([speed], 0.95) for name, each in SERIES_MEASURES.items()}
    k_wet = measures["k_wet"].estimate
    margin = k_wet.value - 0.8
    verdict = Verdict(
        *("k-wet", "requirement", k_wet.value, "1", 0.8, None, margin, "pass", ""),
        definition={"measure": SERIES_MEASURES["k_wet"].meaning},
        measure="k_wet",
    )
    content = {"id": "acceptance", "file": "tests/acceptance.series.yaml", "title": "Acceptance of a WSP"}
    content |= {"parameters": {"controller": "threshold"}}
    content |= {"expect": "pass", "outcome": "pass", "reason": ""}
    content |= {"confidence": 0.95, "valid_stops": 0.8, "speed_tolerance_kmh": 3.0}
    content |= {
        "criteria": (series.SeriesVerdict(verdict, k_wet, confident=True, speed_kmh=120.0),),
        "measures": measures,
        "speeds": (series.SpeedResult(120.0, series.StopCounts(2, 2), series.StopCounts(6, 5), measures),),
        "not_counted": (
            series.UncountedStop("acceptance.wet", "wet", 5, "invalid", "energy-balance: 3 % misses < 0.1 %"),
        ),
        "cases": (dry, wet),
    }
    content |= changes
    return series.SeriesResult(**content | {"expect": expectation_of(content["expect"])})


def _missed():
    result = make_series()
    (each,) = result.criteria
    verdict = replace(
        each.verdict, status="fail", lower=0.9, margin=-0.03, reason="0.87 misses >= 0.9 by 0.03"
    )
    criteria = (replace(each, verdict=verdict),)
    outcome, reason = evaluation.outcome_of([verdict])
    return make_series(criteria=criteria, outcome=outcome, reason=reason)


MISSED = _missed()
"""The series with a criterion that it misses."""
