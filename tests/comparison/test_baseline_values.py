"""The accepted values of criteria beside those of a run that is compared with them."""

from dataclasses import replace

from uictest.analysis.comparison import Baseline, Scope, Tolerances
from uictest.report import RunContent
from uictest.report.page import page_html
from uictest.report.run_folder import baseline_form, read_baseline_comparison
from uictest.report.traces.trace import trace_of

from ..report.builders import make_content, make_recording, make_result, make_verdict

NOW = make_result(id="dry", criteria=(make_verdict(value=465.25), make_verdict(id="slide", unit="%")))


def _compared(*accepted):
    """A drawn case, compared with what was accepted of it."""
    kept = {"dry": replace(NOW, criteria=accepted)}
    baseline = Baseline(
        "kept",
        "00",
        RunContent("kept", list(kept.values())),
        kept,
        {},
        Scope(frozenset()),
        Tolerances.read(()),
    )
    run = make_content(NOW, make_result(id="added"), traces={"dry": trace_of(make_recording())})
    return replace(run, baseline=baseline.compare(run))


def test_the_table_of_criteria_of_a_stop_has_the_accepted_values():
    content = _compared(make_verdict(value=460.5), make_verdict(id="slide", unit="%", value=None))
    assert content.baseline is not None
    assert content.baseline.values == {"dry": {"braking-distance": 460.5}}
    page = page_html(content)
    assert page.count("<small>baseline 460.5 m</small>") == page.count("<small>baseline ") == 1
    assert read_baseline_comparison({"baseline": baseline_form(content.baseline)}) == content.baseline


def test_a_value_in_another_unit_is_not_set_beside():
    content = _compared(make_verdict(value=0.4605, unit="km"), make_verdict(id="slide", unit="%", value=7.0))
    assert content.baseline is not None
    assert content.baseline.values == {"dry": {"slide": 7.0}}


def test_without_a_baseline_the_table_has_no_accepted_values():
    assert "<small>baseline " not in page_html(replace(_compared(make_verdict()), baseline=None))
