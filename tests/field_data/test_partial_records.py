"""Parts of a record: what they decide is what the whole record decides."""

import math
from dataclasses import replace
from itertools import pairwise

import numpy as np
import pytest

from uictest.core.measures import MEASURES
from uictest.core.units import KINDS
from uictest.plans.scenario import corrections
from uictest.plans.scenario.parts.criteria import Criteria, Criterion
from uictest.recorded.field_data import stated_case
from uictest.recorded.field_data.judgement import observe

from .conftest import channels_of, judge_stop, kept

ROUNDING = 1e-9
_WRITTEN = {
    "first_phase_duration": (3.0, "3 s"),
    "low_speed_cutoff": (10.0 / 3.6, "10 km/h"),
    "sliding_below": (0.9, "90 %"),
    "end_speed": (20.0 / 3.6, "20 km/h"),
}
DEFINITION = {name: value for name, (value, _) in _WRITTEN.items()}
_WORDS = {name: {"value": text, "range": [text, text]} for name, (_, text) in _WRITTEN.items()}


def _of_part(part, channels):
    time = channels["speed"].time
    name, _, number = part.partition(" ")
    at = float(number)
    chosen = {"until": time <= at, "from": time >= at, "without": (time < at) | (time > at + 0.5)}
    return kept(channels, chosen[name])


def _values(stop, case):
    observed = observe(stop, case.scenario)
    records = observed.measures, observed.wheelset_measures
    definition = {**DEFINITION, **corrections(case.scenario)}
    return {name: measure.read(*records, definition).values for name, measure in MEASURES.items()}


def test_every_measure_of_a_train_lacks_something_in_a_record_that_begins_late(channels, case, prepared):
    """A measure whose channels nobody states would be judged on whatever is there."""
    late = observe(prepared(_of_part("from 3", channels)), case.scenario)
    of_a_train = {name for name, measure in MEASURES.items() if not measure.of_simulation}
    assert late.coverage.missing.keys() == of_a_train - {"standstill"}


def test_what_can_only_grow_never_falls_while_a_stop_goes_on(case, channels, prepared):
    ends = (0.5, 2.0, 4.0, 6.0, 9.0, 12.0, 15.0, 30.0)
    stages = [_values(prepared(_of_part(f"until {end}", channels)), case) for end in ends]
    for name, measure in MEASURES.items():
        reached = [np.array(values[name]) for values in stages if values[name]]
        for before, after in pairwise(reached):
            steps = (after - before)[~np.isnan(after - before)]
            if measure.course == "settles":
                assert (np.abs(steps) < ROUNDING).all(), name
            else:
                assert ((steps if measure.course == "grows" else -steps) > -ROUNDING).all(), name


@pytest.fixture(scope="module")
def by_every_measure(case, recording, prepared):
    """The case, judged by lower and upper bounds on each measure: around its value and far from it."""
    values = _values(prepared(channels_of(recording)), case)
    criteria = tuple(
        _criterion(name, side, share, share * values[name][0])
        for name in MEASURES
        if values[name] and not math.isnan(values[name][0])
        for side in ("lower", "upper")
        for share in (0.1, 0.9, 1.1, 3.0)
    )
    profile = Criteria(name="every-measure", criteria=criteria)
    return replace(case, scenario=case.scenario.model_copy(update={"criteria": (profile,)}))


@pytest.fixture(scope="module")
def whole(by_every_measure, recording, prepared):
    """What the whole record decides."""
    return judge_stop(by_every_measure, prepared(channels_of(recording)))


def _criterion(name, side, share, bound):
    measure = MEASURES[name]
    unit = next(iter(KINDS[measure.kind].units.values()), None)
    fields = {"id": f"{name.replace('_', '-')}-{side}-{share}", "layer": "requirement"}
    fields[side] = bound if unit is None else f"{bound / float(unit.factor):.12f} {unit.symbol}"
    if measure.of_wheelsets:
        fields["wheelsets"] = {"at_least": "half"}
    definition = {word: _WORDS[word] for word in measure.definitions}
    return Criterion.model_validate({"measure": name, **fields, "definition": definition})


@pytest.mark.parametrize(
    "part",
    [
        *("until 0.01", "until 2", "until 6", "until 12", "until 17.5"),
        *("from 0.5", "from 1", "from 3", "from 9", "from 15"),
        *("without 0.2", "without 2", "without 7", "without 9", "without 15"),
    ],
)
def test_a_part_of_a_record_decides_nothing_else_than_the_whole(
    part, whole, by_every_measure, channels, prepared
):
    """What it shows for certain is decided, the rest open."""
    some = judge_stop(by_every_measure, prepared(_of_part(part, channels)))
    assert whole.outcome == "fail"
    assert len(whole.criteria) > 100
    assert some.outcome in ("fail", "inconclusive")
    wrong = [
        (early.id, early.status, early.reason)
        for early, late in zip(some.criteria, whole.criteria, strict=True)
        if early.status not in (late.status, "not_applicable" if early.is_check else "inconclusive")
    ]
    assert wrong == []
    verdicts = {each.id: each.status for each in some.criteria}
    assert "inconclusive" in verdicts.values()
    if part in ("until 12", "from 1", "without 9"):
        for name in ("sliding-duration", "valve-actuations", "maximum-clamping-force"):
            assert verdicts[f"{name}-lower-0.1"] == "pass"
            assert verdicts[f"{name}-upper-0.1"] == "fail"
            assert verdicts[f"{name}-upper-3.0"] == "inconclusive"


def test_neither_openings_nor_locks_on_either_side_of_a_gap_are_taken_for_others(case, channels, prepared):
    command = channels["valve_command_1"]
    vents = np.zeros_like(command.samples)
    vents[100:200] = 2.0
    vents[150:160] = np.nan
    channels["valve_command_1"] = replace(command, samples=vents)
    observed = observe(prepared(channels), case.scenario)
    assert observed.wheelset_measures[0].valve_actuations == 1.0
    time = channels["speed"].time
    wheel = channels["wheel_speed_1"]
    samples = np.where((time > 1.0) & (time < 2.6), 0.0, channels["speed"].samples)
    channels["wheel_speed_1"] = replace(wheel, samples=samples)
    broken = kept(channels, (time < 1.6) | (time > 2.0))
    observed = observe(prepared(broken), case.scenario)
    assert observed.wheelset_measures[0].longest_lock == pytest.approx(0.6, abs=0.03)


def test_a_record_that_begins_late_shows_no_offsets_and_knows_no_initial_speed(channels, prepared):
    for begin in (0.5, 1.0, 3.0):
        stop = prepared(_of_part(f"from {begin}", channels))
        assert [defect.kind for defect in stop.defects] == ["starts-late"]
    statements = ("rail.condition=dry", "brake.position=R", "rig.wsp=active")
    case = stated_case("late", 40.0 / 3.6, (*statements, "criteria=[uic-541-05-appendix-b]"))
    result = judge_stop(case, prepared(_of_part("from 2", channels)))
    verdicts = {each.id: (each.status, each.reason) for each in result.criteria}
    assert verdicts["braking-distance"] == (
        "inconclusive",
        "the record begins after the brake command: no initial speed",
    )
    assert result.outcome == "inconclusive"


@pytest.mark.parametrize("coarse", ["speed", "wheel_speed_3"])
def test_samples_far_apart_do_not_show_that_no_wheelset_locked(case, channels, prepared, coarse):
    dense = channels[coarse]
    # With the last one, so that a coarse speed shows the standstill.
    every = np.union1d(np.arange(0, dense.time.size, 50), dense.time.size - 1)
    sparse = replace(dense, time=dense.time[every], samples=dense.samples[every])
    stop = prepared({**channels, coarse: sparse})
    result = judge_stop(case, stop)
    verdicts = {each.id: each for each in result.criteria}
    assert [str(each) for each in stop.defects if each.kind == "coarse"] == [
        f"coarse: {coarse} is sampled every 0.5 s; at most 0.25 s shows all that happens"
    ]
    assert verdicts["locked-wheels"].status == "inconclusive"
    assert "samples are 0.5 s apart" in verdicts["locked-wheels"].reason
    assert verdicts["standstill"].status == "pass"
    assert result.outcome == "inconclusive"
