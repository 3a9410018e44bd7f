import os
import re
import subprocess
import sys
import threading
from dataclasses import replace
from urllib.parse import unquote, urlsplit

import pytest

from uictest.core import files
from uictest.core.files import FolderLock
from uictest.runs.history import page, refresh_index
from uictest.runs.history.listing import started_in

from .conftest import case

HOSTILE = "<script>alert(1)</script>'\"&\u202e"


def links(page):
    return re.findall(r'href="([^"]*)"', page.read_text("utf-8"))


def rows(reports):
    """Return the texts of every row of the table of runs."""
    page = (reports / "index.html").read_text("utf-8")
    found = re.findall(r"<tr>(.*?)</tr>", page, re.DOTALL)[1:]
    return [[re.sub(r"(<[^>]+>)+", " ", cell).strip() for cell in re.split(r"<t[hd]", row)] for row in found]


def test_every_run_stands_in_the_index_the_newest_first(publish, reports):
    assert refresh_index(reports.parent) == ""
    assert "There is no finished run here." in (reports.parent / "index.html").read_text("utf-8")
    runs = [publish(case("slip[friction=0.09]")), publish(case("b")), publish(case("c", "fail"))]
    assert links(reports / "index.html")[1:] == [f"./{run.name}/index.html" for run in reversed(runs)]
    # Nothing half written and no lock is left.
    assert {path.name for path in reports.iterdir()} == {run.name for run in runs} | {"latest", "index.html"}


def test_a_run_has_a_row_with_time_subject_verdict_and_distance(publish, reports):
    run = publish(case("a"), case("b", "fail", 480.0))
    publish(case("a", "error", float("nan")), formats=())
    without, [_, time, subject, verdict, distance] = rows(reports)
    assert time.endswith(f"{started_in(run.name):%Y-%m-%d %H:%M:%S}")
    assert "dry" in subject
    assert "threshold (built into uictest 0.1.0)" in subject
    assert f"run {run.name}" in " ".join(subject.split())
    assert "not met" in verdict
    assert "2 cases: 1 pass, 1 fail" in verdict
    assert distance.endswith("470.0 .. 480.0")
    assert "no page" in without[1]
    assert "error" in without[3]
    assert without[4].endswith("–")  # noqa: RUF001 - a dash on paper


def test_names_of_runs_and_cases_are_text_whatever_they_hold_and_the_index_runs_no_script(publish, reports):
    publish(replace(case("a"), scenario=f"{HOSTILE.replace('/', '|')}.yaml"))
    assert "&lt;script&gt;alert(1)&lt;|script&gt;" in (reports / "index.html").read_text("utf-8")
    (reports / HOSTILE.replace("/", "|")).mkdir()
    (reports / "javascript:alert(1)").mkdir()
    (reports / "notes").mkdir()
    (reports / "half").mkdir()
    (reports / "half" / "manifest.json").write_text("{")
    (reports / ".x.0123.partial").mkdir()
    assert refresh_index(reports) == ""
    page = (reports / "index.html").read_text("utf-8")
    assert "<script" not in page
    assert "\u202e" not in page
    assert all(link.startswith(("./", "#")) for link in links(reports / "index.html"))
    # What is no run is stated with its reason.
    assert "<code>notes</code>: not of uictest: there is no manifest.json" in page
    assert "<code>half</code>: manifest.json is damaged" in page
    assert "1 folder being filled, or left by a killed run." in page


@pytest.mark.parametrize("name", ["a b", "javascript:x", "per%cent", "q?a=b#c", "ü", "a%2f.."])
def test_a_renamed_run_is_still_found_by_its_link(publish, reports, name):
    publish().rename(reports / name)
    assert refresh_index(reports) == ""
    found = [link for link in links(reports / "index.html") if "/index.html" in link]
    assert found
    for link in found:
        parts = urlsplit(link)
        assert parts.scheme == parts.netloc == ""
        assert (reports / unquote(parts.path)).resolve() == reports / name / "index.html"


@pytest.mark.skipif(sys.platform in ("win32", "darwin"), reason="every name of a file is Unicode")
def test_names_that_are_no_unicode_are_spelled_out(publish, reports):
    publish().rename(reports / os.fsdecode(b"L\xe4ufe"))
    (reports / os.fsdecode(b"Entw\xfcrfe")).mkdir()
    assert refresh_index(reports) == ""
    page = (reports / "index.html").read_text("utf-8")
    assert "./L%E4ufe/index.html" in page
    assert "Entw\\udcfcrfe" in page


def test_a_page_of_somebody_else_is_left_alone(publish, reports):
    reports.mkdir()
    index = reports / "index.html"
    index.write_text("my own page")
    run = publish()
    assert index.read_text() == "my own page"
    assert "is no index of runs" in refresh_index(reports)
    assert "is no index of runs" in refresh_index(run)  # nor is the page of a run taken for one
    index.unlink()
    index.symlink_to(reports.parent / "elsewhere.html")
    publish()
    assert index.is_symlink()
    assert not (reports.parent / "elsewhere.html").exists()


def test_an_index_that_cannot_be_written_undoes_no_run(publish, reports, monkeypatch):
    def fail(*_):
        raise OSError(28, "No space left on device")

    monkeypatch.setattr(page, "list_runs", fail)
    run = publish()
    assert (run / "results.json").is_file()
    assert not (reports / "index.html").exists()
    assert "No space left on device" in refresh_index(reports)


def test_an_index_waits_for_the_one_that_is_being_written_and_not_forever(publish, reports, monkeypatch):
    """The second starts to read only when the first has written: neither can miss the other's run."""
    publish()
    order = []
    write = files.write

    def noted(path, name, text):
        order.append("written")
        write(path, name, text)

    monkeypatch.setattr(files, "write", noted)
    second = threading.Thread(target=refresh_index, args=(reports,))
    with FolderLock(reports):
        second.start()
        second.join(timeout=0.3)
        assert order == []
    second.join()
    assert order == ["written"]
    monkeypatch.setattr(page, "_PATIENCE", 0.0)
    with FolderLock(reports):
        assert "is in use by" in refresh_index(reports)


AT_ONCE = """
import sys
from pathlib import Path
from uictest import report, runs
from uictest.core import files
from uictest.judging import evaluation
from uictest.plans.scenario import PASS
for n in range(4):
    result = evaluation.CaseResult(f"case-{sys.argv[1]}-{n}", "s.yaml", {}, PASS, "pass")
    manifest = report.RunManifest(command=("uictest", "run", sys.argv[1], str(n)))
    published = runs.publish_run(report.RunContent("", [result], manifest), {}, Path("reports"), ())
    assert published.index_problem == "", published.index_problem
"""


def test_runs_that_end_at_once_all_stand_in_the_index(reports):
    processes = [
        subprocess.Popen([sys.executable, "-c", AT_ONCE, str(each)], cwd=reports.parent) for each in range(3)
    ]
    assert [process.wait() for process in processes] == [0, 0, 0]
    page = (reports / "index.html").read_text("utf-8")
    runs = [path.name for path in reports.glob("2*Z-*")]
    assert len(runs) == 12
    assert all(run in page for run in runs)
