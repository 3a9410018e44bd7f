"""What lies outside of what was validated, in words."""

from dataclasses import replace

import pytest

from uictest.judging.evaluation import CaseResult, Deviation, DomainOfValidity, Verdict
from uictest.plans.scenario import PASS
from uictest.report import deviation_text, domain_lines, notices

SPEED = Deviation("initial_speed", (160 / 3.6, 160 / 3.6), (80 / 3.6, 120 / 3.6), "m/s")


def result(*outside, asked=True):
    domain = DomainOfValidity("my-train", "0" * 64, outside) if asked else None
    return CaseResult("stop", "stop.yaml", {}, PASS, "pass", domain_of_validity=domain)


@pytest.mark.parametrize(
    ("deviation", "text"),
    [
        (SPEED, "initial_speed 160 km/h > 120 km/h"),
        (Deviation("rail.friction", (0.05, 0.05), (0.08, 0.12), "1"), "rail.friction 0.05 < 0.08"),
        (Deviation("f", (0.05, 0.3), (0.1, 0.2), "1"), "f 0.05 .. 0.3, validated 0.1 .. 0.2"),
        (Deviation("p", (1e5, 4e5), (3.8e5, 3.8e5), "Pa"), "p 1 .. 4 bar, validated 3.8 bar"),
        (Deviation("vehicle", "crh380a", "intercity-180"), "vehicle crh380a, validated intercity-180"),
        (Deviation("faults.0.kind", "stuck", None), "faults.0.kind stuck, validated not set"),
        (Deviation("faults.0.at", None, (3.0, 3.0), "s"), "faults.0.at not set, validated 3 s"),
    ],
)
def test_a_deviation_reads_in_the_units_of_engineers(deviation, text):
    assert deviation_text(deviation) == text


def test_a_run_counts_the_stops_judged_without_a_requirement_that_no_record_shows():
    def judged(reason, layer="requirement"):
        numbers = (None,) * 4
        verdict = Verdict("energy", layer, numbers[0], "kJ", *numbers[1:], "not_applicable", reason)
        return replace(result(asked=False), criteria=(verdict,))

    lacking = "not recorded: wheel_load_1 .. wheel_load_4"
    told = list(notices([judged(lacking), judged(lacking), judged("for another rail")]))
    assert told == [f"2 stops judged without energy, {lacking}"]
    assert list(notices([judged(lacking, layer="rig")])) == []


def test_many_deviations_are_counted():
    [line] = domain_lines(result(*[SPEED] * 9))
    assert line.startswith("outside stop of what my-train validated: initial_speed 160 km/h > 120 km/h; ")
    assert line.endswith("; 3 more in results.json")


def test_a_run_says_how_many_of_its_cases_lie_outside():
    assert [*domain_lines(result()), *domain_lines(result(asked=False))] == []
    assert list(notices([result(asked=False)])) == []
    assert list(notices([result(), result(SPEED)])) == ["1 of 2 cases outside of what my-train validated"]
    assert list(notices([result()])) == ["0 of 1 case outside of what my-train validated"]
