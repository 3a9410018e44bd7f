"""The index of a folder of runs, and the pages of studies, in the browser."""

import pytest

from studies.quantity import OwnBand, SourceBand, StudyQuantity, StudyValue
from studies.study import Study, StudyFindings, StudyResult
from studies.writing import write_figures, write_pages
from uictest import report, runs

from .builders import make_result
from .test_accessibility import appearances, assert_fit_for_all, shown


@pytest.fixture
def index(tmp_path):
    """Three runs of which the second fails, a sweep that is not finished, and a folder of somebody."""
    for outcome in ("pass", "fail", "pass"):
        results = [make_result(id="slip-120", outcome=outcome), make_result(id="dry-120")]
        manifest = report.RunManifest(command=("uictest", "run", outcome), versions={"uictest": "0.1.0"})
        runs.publish_run(report.RunContent("", results, manifest), {}, tmp_path / "reports", ("html",))
    (tmp_path / "reports" / "mine").mkdir()
    runs.publish_run(report.RunContent("", [make_result(id="dry-120")]), {}, tmp_path / "reports", ())
    return tmp_path / "reports" / "index.html"


@pytest.fixture
def study_page(tmp_path):
    """A study with a value that holds, one that misses, one that is only shown, and a figure."""
    quantities = (
        StudyQuantity(
            "time",
            "braking time",
            "s",
            "17.6 s",
            status="calibrated",
            band=OwnBand(lower=16.5, upper=19.0, reason="ours"),
        ),
        StudyQuantity(
            "share",
            "share",
            "%",
            "below 2 %",
            status="predicted",
            band=SourceBand(upper=2.0, below=True, declared_miss="Heat."),
        ),
        StudyQuantity("count", "actuations", status="predicted", digits=0),
    )
    values = {"time": StudyValue(18.1, 17.9, 18.3), "share": StudyValue(2.5), "count": StudyValue(11.0)}

    def draw(figure):
        figure.subplots().plot([0.0, 1.0], [1.0, 0.0])

    findings = StudyFindings(values, {"data": {"time_s": [0.0]}}, {"figure": draw}, ("Made up.",))
    result = StudyResult(
        Study("made-up", "A made-up study", "17.6 s", quantities, lambda _: findings), findings
    )
    pytest.importorskip("matplotlib")
    write_figures(tmp_path, result)
    write_pages(tmp_path, [result], [], [])
    return tmp_path / "made-up" / "index.html"


@appearances
def test_the_index_breaks_no_rule_of_accessibility(browser, index, scheme, width):
    shown(browser, index, scheme, width)
    assert_fit_for_all(browser)


@appearances
def test_the_pages_of_studies_break_no_rule_of_accessibility(browser, study_page, scheme, width):
    for page in (study_page, study_page.parents[1] / "index.html"):
        shown(browser, page, scheme, width)
        assert_fit_for_all(browser)
