from uictest.report.sweep.wording import notable_cases

from ..builders import make_result


def test_each_case_stands_once_and_those_not_met_in_front(make_sweep):
    missed = [{"id": name, "outcome": "error", "reason": "no air"} for name in ("a", "b")]
    worst = (make_result(id="narrow"), make_result(id="a", outcome="error", criteria=(), reason="no air"))
    cases = notable_cases(make_sweep(worst, missed=missed).result)
    assert [(case.id, case.word, case.why, case.distance) for case in cases] == [
        ("a", "error", "error. Expected: pass; no air", 465.25),
        ("b", "error", "got error: no air", None),
        ("narrow", "pass", "", 465.25),
    ]
    (case,) = notable_cases(make_sweep(missed=[{"id": "a", "outcome": "skipped", "reason": ""}]).result)
    assert case.why == "got skipped"
