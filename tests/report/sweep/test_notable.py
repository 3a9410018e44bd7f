from uictest.report.sweep.sweep_sentences import notable_cases

from ..builders import make_result


def test_each_case_stands_once_and_those_not_met_in_front(make_sweep):
    missed = [{"id": name, "outcome": "error", "reason": "no air"} for name in ("a", "b")]
    worst = (make_result(id="narrow"), make_result(id="a", outcome="error", criteria=(), reason="no air"))
    cases = notable_cases(make_sweep(worst, missed=missed).result)
    assert [case.id for case in cases] == ["a", "b", "narrow"]
    assert [case.word for case in cases] == ["error", "error", "pass"]
    assert [case.why for case in cases] == [
        "error. Expected: pass; no air",
        "got error: no air",
        "",
    ]
    assert [case.distance for case in cases] == [465.25, None, 465.25]


def test_without_a_reason_the_outcome_is_one(make_sweep):
    (case,) = notable_cases(make_sweep(missed=[{"id": "a", "outcome": "skipped", "reason": ""}]).result)
    assert case.why == "got skipped"
