from pathlib import Path

import pytest

pytestmark = pytest.mark.usefixtures("made_up")


@pytest.fixture
def run(call, scenario):
    scenario("a", "tags: [fail]\n")
    call("run", "--report", "csv")
    return Path("reports/latest")


def test_further_formats_are_written_into_the_run_and_named(call, run):
    answer = call("report", run, "--format", "xlsx,html,md", code=0)
    names = ["report.xlsx", "index.html", "summary.md"]
    assert [Path(line).name for line in answer.out.splitlines()] == names
    assert all((run / name).stat().st_size for name in names)


def test_they_can_go_elsewhere(call, run):
    assert call("report", run, "--format", "csv", "-o", "elsewhere/deep").code == 0
    assert sorted(path.name for path in Path("elsewhere/deep").iterdir()) == [
        "criteria.csv",
        "summary.csv",
        "wheelsets.csv",
    ]


def test_a_run_that_names_the_newest_in_a_file_is_found(call, run):
    target = run.resolve()
    run.unlink()
    run.write_text(f"{target.name}\n")
    assert call("report", run, "--format", "md").code == 0
    assert (target / "summary.md").exists()
