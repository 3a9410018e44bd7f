import pyarrow as pa
import pyarrow.parquet as pq
import pytest

from uictest.report import format_names, sweep_format_names
from uictest.report.sweep.formats import write_sweep_formats


@pytest.fixture
def content(make_sweep):
    """A sweep with two tables in its folder."""
    made = make_sweep()
    for name in ("rates.csv", "summary.csv"):
        (made.folder / name).write_text(f"{name}\n")
    pq.write_table(
        pa.table({"id": ["a"], "met": [True], "outcome": ["pass"]}), made.folder / "summary.parquet"
    )
    return made


def test_a_sweep_has_every_format_of_a_run_that_is_made_from_finished_results(content):
    assert set(format_names()) - set(sweep_format_names()) == {"junit"}
    paths = {name: write_sweep_formats(content.folder, content, [name]) for name in sweep_format_names()}
    assert {name: [path.name for path in own] for name, own in paths.items() if name != "csv"} == {
        "html": ["index.html"],
        "md": ["summary.md"],
        "xlsx": ["report.xlsx"],
    }
    assert all(path.stat().st_size for own in paths.values() for path in own)


def test_the_tables_of_a_sweep_are_there_already_and_copied_elsewhere(content, tmp_path):
    before = {path: path.stat().st_mtime_ns for path in content.folder.iterdir()}
    paths = write_sweep_formats(content.folder, content, ["csv"])
    assert [path.name for path in paths] == ["rates.csv", "summary.csv"]
    assert before == {path: path.stat().st_mtime_ns for path in content.folder.iterdir()}
    (tmp_path / "elsewhere").mkdir()
    paths = write_sweep_formats(tmp_path / "elsewhere", content, ["csv"])
    assert [path.read_text() for path in paths] == ["rates.csv\n", "summary.csv\n"]


def test_a_workbook_that_cannot_be_finished_leaves_nothing(content):
    (content.folder / "summary.parquet").unlink()
    with pytest.raises(FileNotFoundError):
        write_sweep_formats(content.folder, content, ["xlsx"])
    assert sorted(path.name for path in content.folder.iterdir()) == ["rates.csv", "summary.csv"]
