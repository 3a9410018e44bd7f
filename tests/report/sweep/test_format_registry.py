from __future__ import annotations

from pathlib import Path

import pyarrow as pa
import pyarrow.parquet as pq
import pytest

from uictest.report import format_names, sweep_format_names
from uictest.report.sweep.folder import SweepContent, write_sweep_formats

from ..builders import MakeSweep


@pytest.fixture
def content(make_sweep: MakeSweep) -> SweepContent:
    """A sweep with two tables in its folder."""
    made = make_sweep()
    for name in ("rates.csv", "summary.csv"):
        (made.folder / name).write_text(f"{name}\n")
    pq.write_table(
        pa.table({"id": ["a"], "met": [True], "outcome": ["pass"]}), made.folder / "summary.parquet"
    )
    return made


def test_a_sweep_has_every_format_of_a_run_that_is_made_from_finished_results(content: SweepContent) -> None:
    assert set(format_names()) - set(sweep_format_names()) == {"junit"}
    for name in sweep_format_names():
        assert write_sweep_formats(content.folder, content, [name])


def test_the_tables_of_a_sweep_are_there_already(content: SweepContent) -> None:
    before = {path: path.stat().st_mtime_ns for path in content.folder.iterdir()}
    paths = write_sweep_formats(content.folder, content, ["csv"])
    assert [path.name for path in paths] == ["rates.csv", "summary.csv"]
    assert before == {path: path.stat().st_mtime_ns for path in content.folder.iterdir()}


def test_elsewhere_the_tables_are_copied(content: SweepContent, tmp_path: Path) -> None:
    (tmp_path / "elsewhere").mkdir()
    paths = write_sweep_formats(tmp_path / "elsewhere", content, ["csv"])
    assert [path.read_text() for path in paths] == ["rates.csv\n", "summary.csv\n"]


def test_each_format_becomes_a_file(content: SweepContent) -> None:
    paths = write_sweep_formats(content.folder, content, ["md", "xlsx"])
    assert [path.name for path in paths] == ["summary.md", "report.xlsx"]
    assert all(path.stat().st_size for path in paths)


def test_a_workbook_that_cannot_be_finished_leaves_nothing(content: SweepContent) -> None:
    (content.folder / "summary.parquet").unlink()
    with pytest.raises(FileNotFoundError):
        write_sweep_formats(content.folder, content, ["xlsx"])
    assert sorted(path.name for path in content.folder.iterdir()) == ["rates.csv", "summary.csv"]
