from uictest.report import format_names, formats, write_formats
from uictest.report.formats import IN_EVERY_RUN, format_named

from .builders import make_content, make_result


def test_every_format_becomes_files(tmp_path):
    paths = {name: write_formats(tmp_path, make_content(make_result()), [name]) for name in format_names()}
    assert {name: [path.name for path in own] for name, own in paths.items()} == {
        "csv": ["summary.csv", "wheelsets.csv", "criteria.csv"],
        "html": ["index.html"],
        "junit": ["junit.xml"],
        "md": ["summary.md"],
        "xlsx": ["report.xlsx"],
    }
    assert all(path.stat().st_size for own in paths.values() for path in own)


def test_the_formats_of_every_run_are_there_and_only_the_page_draws():
    assert set(IN_EVERY_RUN) <= set(format_names())
    assert [name for name in format_names() if format_named(name).draws_stops] == ["html"]


def test_a_new_format_is_one_module(tmp_path, monkeypatch):
    (tmp_path / "yaml.py").write_text(
        "from uictest.report.formats import ReportFormat\n"
        "FORMAT = ReportFormat(lambda content: {'run.yaml': content.name.encode()})\n"
    )
    monkeypatch.setattr(formats, "__path__", [*formats.__path__, str(tmp_path)])
    format_names.cache_clear()
    try:
        assert "yaml" in format_names()
        (path,) = write_formats(tmp_path, make_content(), ["yaml"])
    finally:
        format_names.cache_clear()
    assert path.read_text() == "a-run"
