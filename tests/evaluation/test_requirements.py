import pytest

from uictest.judging.evaluation import SimulatedRepeat, error_result, evaluate, evaluate_repeats
from uictest.plans.scenario import applies_to, load

TEXT = """\
schema: uictest/scenario/1
name: stop
initial_speed: 120 km/h
requirements: [BR-1]
test_case: WSP-TC-7
criteria:
  name: own
  criteria:
    - {id: short, layer: requirement, measure: braking_distance, upper: 900 m, requirements: [BR-2, BR-1]}
    - id: slow
      layer: requirement
      measure: braking_distance
      upper: 900 m
      applies: {initial_speed: {value: 80 km/h, tolerance: 4 km/h}}
      requirements: [BR-3]
"""


@pytest.fixture
def named(tmp_path):
    """A stop from 120 km/h that names requirements, and so do two criteria, one of them for 80 km/h."""
    (tmp_path / "stop.yaml").write_text(TEXT)
    (case,) = load([tmp_path])
    return case


def test_a_result_has_the_ids_of_the_case_and_each_verdict_those_of_its_criterion(named, stop, wheelsets):
    result = evaluate(named, stop(), wheelsets(0.0, 0.0, 0.0, 0.0))
    assert (result.requirements, result.test_case) == (("BR-1",), "WSP-TC-7")
    own = [verdict.requirements for verdict in result.criteria if verdict.layer != "rig"]
    assert own == [("BR-2", "BR-1"), ("BR-3",)]


def test_a_case_that_could_not_be_judged_hides_no_requirement_repeated_or_not(named, stop, wheelsets):
    assert error_result(named, "diverged").requirements == ("BR-1", "BR-2", "BR-3")
    records = stop(), wheelsets(0.0, 0.0, 0.0, 0.0)
    sound = SimulatedRepeat(0, evaluate(named, *records, detail="status"), *records)
    assert evaluate_repeats(named, [sound, sound]).requirements == ("BR-1",)
    failed = SimulatedRepeat(1, error_result(named, "diverged"))
    assert evaluate_repeats(named, [sound, failed]).requirements == ("BR-1", "BR-2", "BR-3")


def test_whether_a_criterion_applies_is_known_before_the_stop(named):
    (profile,) = named.scenario.criteria
    assert [applies_to(criterion, named.scenario) for criterion in profile.criteria] == [True, False]
