"""A result in its formats: each is some files, and a summary for GitHub has the room that is left."""

import pytest

from uictest.core.document import Suite, Testcase
from uictest.report.formats import (
    DRAWING,
    FORMATS,
    IN_EVERY_RUN,
    LIMIT,
    Publication,
    append_step_summary,
    publish,
)

from .made_up import DOCUMENT, TABLE, table_of_texts


def publication(**changes):
    content = {
        "document": DOCUMENT,
        "tables": [TABLE, table_of_texts(["a"])],
        "page": lambda: "<p>",
        "suites": lambda named: [
            Suite("s", [Testcase("c", "n", "passed", properties={"id": "1"} if named else {})])
        ],
        "texts": {"results.json": '{"name": "a\udcff"}'},
    }
    return Publication(**content | changes)


FILES = {
    "csv": ["tables/cells.csv", "tables/texts.csv"],
    "html": ["index.html"],
    "junit": ["junit.xml"],
    "md": ["summary.md"],
    "xlsx": ["report.xlsx"],
}


@pytest.mark.parametrize("formats", [*([name] for name in FILES), ["csv", "junit", "csv"], []])
def test_every_format_becomes_files_once_and_documents_are_always_there(tmp_path, formats):
    paths = publish(publication(), formats, tmp_path)
    wanted = [file for name in dict.fromkeys(formats) for file in FILES[name]]
    assert [path.relative_to(tmp_path).as_posix() for path in paths] == wanted
    assert all(path.stat().st_size for path in paths)
    # A name that is no UTF-8 is an escape.
    assert (tmp_path / "results.json").read_text() == '{"name": "a\\udcff"}'


def test_the_formats_of_every_run_are_there_and_only_the_page_draws():
    assert set(FILES) == set(FORMATS)
    assert (("csv", "junit"), {"html"}) == (IN_EVERY_RUN, DRAWING)


def test_the_file_with_properties_of_testcases_is_there_only_where_an_importer_finds_something_in_it(
    tmp_path,
):
    assert len(publish(publication(), ["junit"], tmp_path)) == 1
    plain, named = publish(publication(named_in_tests=True), ["junit"], tmp_path)
    assert (plain.name, named.name) == ("junit.xml", "junit-properties.xml")
    assert ("<property " in plain.read_text(), "<property " in named.read_text()) == (False, True)


def test_what_cannot_be_finished_leaves_nothing(tmp_path):
    def page():
        raise OSError("no recording")

    with pytest.raises(OSError, match="no recording"):
        publish(publication(page=page, texts={}), ["html"], tmp_path)
    assert list(tmp_path.iterdir()) == []


@pytest.mark.parametrize(("there", "room"), [(0, LIMIT), (600_000, 400_000), (999_500, 2_000)])
def test_a_summary_has_the_room_that_others_left(tmp_path, monkeypatch, there, room):
    path = tmp_path / "summary"
    if there:
        path.write_bytes(b"x" * (there - 1) + b"\n")
    monkeypatch.setenv("GITHUB_STEP_SUMMARY", str(path))
    append_step_summary(
        publication(tables=[], document=DOCUMENT._replace(sections=[table_of_texts(["é" * 90] * 9999)]))
    )
    assert path.read_bytes()[there:].startswith(b"## A run\n")
    assert room - 2_000 < path.stat().st_size - there <= room


@pytest.mark.parametrize("value", ["", None])
def test_without_github_no_summary_is_made(value, monkeypatch):
    monkeypatch.delenv("GITHUB_STEP_SUMMARY", raising=False)
    if value is not None:
        monkeypatch.setenv("GITHUB_STEP_SUMMARY", value)
    append_step_summary(publication(document=None))
