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


@pytest.mark.parametrize(
    ("expression", "said"), [("b", "no case of the run matches 'b'"), ("a and", "in 'a and'")]
)
def test_stops_to_draw_are_chosen_among_those_there_are(call, run, expression, said):
    answer = call("report", run, "--format", "html", "--draw", expression, code=4)
    assert said in " ".join(answer.err.split())
    assert call("report", run, "--format", "html", "--draw", "a").code == 0


def test_they_can_go_elsewhere(call, run):
    assert call("report", run, "--format", "csv", "-o", "elsewhere/deep").code == 0
    assert sorted(path.name for path in Path("elsewhere/deep").iterdir()) == [
        "criteria.csv",
        "summary.csv",
        "wheelsets.csv",
    ]


@pytest.mark.parametrize(
    "arguments",
    [["missing"], ["scenarios"], ["reports/latest", "--format", "pdf"], ["reports/latest", "-o", "a.txt"]],
)
def test_what_is_no_run_or_no_format_is_refused(call, run, arguments):
    Path("a.txt").touch()
    answer = call("report", *arguments)
    assert answer.code in (3, 4)
    assert answer.out == ""
    assert "Traceback" not in answer.err


@pytest.mark.parametrize(
    ("place", "said"),
    [
        (
            "scenarios",
            "scenarios holds no run: it has no results.json; report takes the folder of a finished",
        ),
        ("missing", "there is no missing; report takes the folder of a finished run or sweep"),
        ("study", "study holds a sweep that is not finished: run its command again"),
    ],
)
def test_a_folder_is_named_for_what_it_is(call, run, place, said):
    Path("study").mkdir()
    Path("study/manifest.json").write_text('{"schema": "uictest/manifest/2", "kind": "sweep"}')
    call("report", place, code=4, says=said)


@pytest.mark.parametrize(("file", "schema"), [("results.json", "result"), ("sweep.json", "sweep-result")])
def test_what_0_2_wrote_is_named_with_its_schema_and_that_which_is_read(call, run, file, schema):
    Path("old").mkdir()
    (Path("old") / file).write_text(f'{{"schema": "uictest/{schema}/1"}}')
    answer = call("report", "old", code=4)
    assert f"old/{file}: not the result" in answer.err
    found = f"found schema 'uictest/{schema}/1', written by uictest 0.2 or older: run it again"
    assert (
        f"expected schema 'uictest/result/2', kind '{'sweep' if 'sweep' in file else 'run'}', {found}"
        in answer.err
    )


def test_a_run_that_names_the_newest_in_a_file_is_found(call, run):
    target = run.resolve()
    run.unlink()
    run.write_text(f"{target.name}\n")
    assert call("report", run, "--format", "md").code == 0
    assert (target / "summary.md").exists()
