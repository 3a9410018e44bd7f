"""Series in the index of a folder of runs."""

import re
from urllib.parse import unquote

from uictest import report, runs

from ..builders import make_result
from .made_up import make_series


def test_a_series_stands_apart_from_a_case_of_its_id_and_leads_to_itself(tmp_path):
    content = report.RunContent("", [make_result(id="acceptance", outcome="fail")], series=[make_series()])
    folder = runs.publish_run(content, {}, tmp_path, ("html",)).place
    index = (tmp_path / "index.html").read_text("utf-8")
    links = re.findall(r'<th scope="row"><a href="([^"]+)">acceptance</a>', index)
    assert len(links) == 2
    page = (folder / "index.html").read_text("utf-8")
    for link in links:
        assert f'id="{unquote(link.partition("#")[2])}"' in page
