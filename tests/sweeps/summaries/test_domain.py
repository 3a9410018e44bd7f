"""Cases of a sweep outside of what was validated: by column as one by one."""

from collections import Counter
from pathlib import Path

import numpy as np
import pyarrow as pa
import pytest

from uictest.analysis.summaries import full_cases
from uictest.analysis.summaries.domain import OUTSIDE, DomainTally
from uictest.analysis.validation import Validation, ValidationReference, conditions_of, domains_of
from uictest.plans.scenario import load as load_scenarios
from uictest.report import domain_notes
from uictest.running.campaign import parts_of_cases
from uictest.running.chunked.table import number_column, text_column

from ..conftest import SCENARIO


def rows_of(plan, indices):
    """Return the columns that a chunk has of its cases."""
    settings = plan.settings(np.array(indices))
    columns = {"index": pa.array(indices, pa.int64())}
    for key, column in settings.items():
        columns[text_column(key)] = column.written
    for key in plan.numeric_keys:
        columns[number_column(key)] = pa.array(settings[key].numbers, pa.float64())
    return pa.table(columns)


def reference(*stops):
    """Return a validation of which every stop is `stop.yaml` with some changes; alike ones make a domain."""
    domains = domains_of(
        [conditions_of(parts_of_cases([case])[case.id])]
        for changes in stops
        for case in load_scenarios([Path("stop.yaml")], changes)
    )
    validation = Validation("my-train", "", "0", 0.95, {}, (), (), (), domains)
    return ValidationReference(validation, "validation.json", "00")


STOPS = (
    ("rail.friction=0.09",),
    ("rail.friction=0.11", "brake.command=90 %"),
    ("rail.friction=0.10", "controller=slip-band", "initial_speed=40 km/h"),
    ("rail.friction=0.10", "controller=slip-band", "initial_speed=25 km/h"),
)
SAMPLE = "sample:\n  size: 40\n  parameters:\n"
LISTS = "matrix:\n  brake.command: [80 %, 90 %, 100 %]\n"
PLANS = {
    "listed numbers": f"{LISTS}  rail.friction: [0.08, 0.09, 0.10, 0.11, 0.12]\n",
    "drawn numbers": f"{SAMPLE}    rail.friction: {{uniform: [0.08, 0.12]}}\n"
    "    initial_speed: {uniform: [20 km/h, 45 km/h]}\n",
    "names": "matrix:\n  controller: [threshold, slip-band]\n  brake.command: [80 %, 100 %]\n"
    "  initial_speed: [25 km/h, 30 km/h, 45 km/h]\n",
    "settings": "matrix:\n  rig.wsp: [active, bypassed]\n  brake.position: [R, P]\n",
    "a number of one wheelset": "matrix:\n  vehicle.wheelsets.2.wheel_radius: [0.45 m, 0.46 m]\n",
    "friction of the condition": "matrix:\n  rail.friction: [null, 0.1]\n"
    "  rail.condition.friction: [0.05, 0.09, 0.1]\n",
    "points along the track": "matrix:\n  rail.friction:\n"
    "    - points: [{position: 0 m, friction: 0.1}, {position: 50 m, friction: 0.05}]\n    - 0.1\n",
    "what says nothing of the conditions": "matrix:\n  seed: [0, 1, 2]\n  rail.friction: [0.1]\n",
    "numbers inside of another part": "matrix:\n  controller: [slip-band, threshold]\n"
    "  controller.cycle_time: [10 ms, 20 ms]\n",
}


@pytest.mark.parametrize("plan", PLANS.values(), ids=PLANS)
def test_by_column_is_what_each_case_alone_comes_to(load, plan):
    compare_with_each_alone(load(plan), reference(*STOPS))


def test_friction_of_the_condition_is_a_column_like_any_other_and_one_over_time_spans_its_factors(load):
    text = f"{SAMPLE}    rail.condition.friction: {{uniform: [0.05, 0.15]}}\n"
    plan = load(text, stop=SCENARIO.replace(", friction: 0.1", ""))
    compare_with_each_alone(plan, reference(("rail.condition.friction=0.1",), ("rail.friction=0.12",)))
    course = "friction_over_time: {points: [{time: 0 s, factor: 1}, {time: 5 s, factor: 1.5}]}"
    stop = SCENARIO.replace("0.1}", f"0.1, {course}}}")
    plan = load("matrix:\n  rail.friction: [0.08, 0.1]\n", stop=stop)
    compare_with_each_alone(plan, reference(("rail.friction=0.09",)))


def compare_with_each_alone(plan, validated):
    """Compare texts and counts with those of every case alone, over two chunks."""
    indices = list(range(plan.size))
    alone = [
        {each.key for each in domain.outside}
        for domain in validated.domains_of(parts_of_cases(full_cases(plan, indices))).values()
    ]
    tally = DomainTally(plan, validated)
    halves = [half for half in (indices[: plan.size // 2], indices[plan.size // 2 :]) if half]
    tables = [tally.with_column(rows_of(plan, half)) for half in halves]
    texts = [text for table in tables for text in table[OUTSIDE].to_pylist()]
    assert [set(text.split()) for text in texts] == alone
    result = tally.result()
    assert result.outside == sum(map(bool, alone))
    cases = Counter({each.deviation.key: 0 for each in result.conditions})
    for each in result.conditions:
        cases[each.deviation.key] += each.cases
    assert cases == Counter(key for keys in alone for key in keys)


def test_a_condition_spans_the_numbers_of_its_cases_and_a_sweep_inside_says_so(load):
    plan = load("matrix:\n  initial_speed: [30 km/h, 50 km/h, 70 km/h]\n  rail.friction: [0.1, 0.2]\n")
    tally = DomainTally(plan, reference(("rail.friction=0.1",)))
    for index in range(plan.size):
        tally.with_column(rows_of(plan, [index]))
    result = tally.result()
    assert (result.outside, [each.cases for each in result.conditions]) == (5, [4, 3])
    speed = result.conditions[0].deviation
    assert speed.found == pytest.approx((50 / 3.6, 70 / 3.6))
    [note] = domain_notes(result, plan.size)
    assert note == (
        "5 of 6 cases outside of what my-train validated: initial_speed 70 km/h > 30 km/h in 4;"
        " rail.friction 0.2 > 0.1 in 3"
    )
    plan = load("matrix:\n  rail.friction: [0.1]\n")
    tally = DomainTally(plan, reference(("rail.friction=0.1",)))
    assert tally.with_column(rows_of(plan, [0]))[OUTSIDE].to_pylist() == [""]
    assert list(domain_notes(tally.result(), 1)) == ["0 of 1 case outside of what my-train validated"]
    assert list(domain_notes(None, 1)) == []
