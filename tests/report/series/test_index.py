"""Series in the index of a folder of runs."""

from uictest import report, runs

from ..builders import make_result
from .made_up import make_series


def test_a_series_is_counted_apart_from_cases(tmp_path):
    content = report.RunContent("", [make_result(id="acceptance", outcome="fail")], series=[make_series()])
    runs.publish_run(content, {}, tmp_path, ("html",))
    index = (tmp_path / "index.html").read_text("utf-8")
    assert "1 case: 1 fail; 1 series: 1 pass" in index
