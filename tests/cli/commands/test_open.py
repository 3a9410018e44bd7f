"""`uictest open` and `uictest report`: what is done with a run later."""

import os
import sys
from pathlib import Path

import pytest


@pytest.fixture
def runs(call, scenario, made_up, made_once):
    """The names of two runs below `reports`, oldest first."""

    def make():
        scenario("stop")
        call("run")
        call("run", "--seed", "3")

    made_once(make)
    return sorted(
        (path.name for path in Path("reports").iterdir() if path.is_dir() and not path.is_symlink()),
        key=lambda name: Path("reports", name, "index-entry.json").stat().st_mtime_ns,
    )


@pytest.fixture(autouse=True)
def no_display(monkeypatch):
    for variable in ("BROWSER", "DISPLAY", "WAYLAND_DISPLAY"):
        monkeypatch.delenv(variable, raising=False)


def opened(answer):
    assert answer.code == 0, answer.err
    return Path(answer.out.removesuffix("\n"))


@pytest.mark.skipif(sys.platform in ("win32", "darwin"), reason="there is always a display")
def test_without_a_display_the_path_of_the_index_is_printed(call, runs):
    answer = call("open")
    assert opened(answer) == Path("reports", "index.html").absolute()
    assert answer.err == "uictest: there is no display here; open the file yourself\n"


def test_the_newest_run_is_opened_with_last_and_others_by_name_or_folder_wherever_they_are(call, runs):
    assert opened(call("open", "--last")) == Path("reports", runs[-1], "index.html").absolute()
    page = Path("reports", runs[0], "index.html").absolute()
    assert opened(call("open", runs[0])) == page
    assert opened(call("open", Path("reports", runs[0]))) == page
    assert opened(call("open", "latest")).resolve() == Path("reports", runs[-1], "index.html").resolve()
    Path("reports").rename("nightly")
    for arguments in (["nightly"], ["-o", "nightly"]):
        assert opened(call("open", *arguments)) == Path("nightly", "index.html").absolute()


def test_an_index_is_written_anew_with_hints_on_names_but_not_over_that_of_somebody_else(call, runs):
    index = Path("reports", "index.html")
    index.unlink()
    assert opened(call("open")) == index.absolute()
    assert runs[0] in index.read_text("utf-8")
    answer = call("open", runs[0][:-1])
    assert (answer.code, answer.out) == (4, "")
    assert f"did you mean {runs[0]!r}?" in answer.err
    index = Path("reports", "index.html")
    index.write_text("mine")
    call("open", code=4, says="--last opens the newest run")
    assert index.read_text() == "mine"


def test_a_folder_of_runs_that_are_not_listed_says_why_the_first_is_not(call, runs):
    first = min(runs)
    for name in runs:
        Path("reports", name, "manifest.json").write_text('{"schema": "uictest/manifest/1"}')
    call("open", code=4, says=f"holds no finished run: {first}: not read: manifest.json has schema")
    call("open", code=4, says="written by uictest 0.2 or older: run it again")
    folder = Path("reports", first)
    (folder / "recordings").mkdir(exist_ok=True)
    call("open", folder, code=4, says=f"{folder} holds no finished run: not read: manifest.json has schema")


@pytest.mark.skipif(sys.platform == "win32", reason="a shell script stands for the browser")
@pytest.mark.parametrize(("exit_code", "complaint"), [(0, ""), (3, "no browser could be started")])
def test_the_browser_of_the_environment_gets_the_address(process, runs, tmp_path, exit_code, complaint):
    browser = tmp_path / "browser"
    browser.write_text(f'#!/bin/sh\necho "$@" > {tmp_path}/opened\nexit {exit_code}\n')
    browser.chmod(0o755)
    answer = process("open", "--last", env={**os.environ, "BROWSER": f"{browser} %s"})
    page = Path("reports", runs[-1], "index.html").absolute()
    assert (answer.code, Path(answer.out.strip())) == (0, page)
    assert (tmp_path / "opened").read_text() == f"{page.as_uri()}\n"
    assert complaint in answer.err
    assert bool(complaint) == bool(answer.err)


@pytest.fixture
def run(call, scenario, made_up):
    scenario("a", "tags: [fail]\n")
    call("run", "--report", "csv")
    return Path("reports/latest")


def test_further_formats_are_written_into_the_run_or_elsewhere_also_where_a_file_names_the_newest(call, run):
    answer = call("report", run, "--format", "xlsx,html,md", code=0)
    names = ["report.xlsx", "index.html", "summary.md"]
    assert [Path(line).name for line in answer.out.splitlines()] == names
    assert all((run / name).stat().st_size for name in names)
    assert call("report", run, "--format", "csv", "-o", "elsewhere/deep").code == 0
    assert sorted(path.name for path in Path("elsewhere/deep").iterdir()) == [
        "criteria.csv",
        "summary.csv",
        "wheelsets.csv",
    ]
    target = run.resolve()
    run.unlink()
    run.write_text(f"{target.name}\n")
    assert call("report", run, "--format", "md").code == 0
    assert (target / "summary.md").exists()
