from dataclasses import replace

from markdown_it import MarkdownIt

from uictest.report import CaseDescription, append_step_summary
from uictest.report.formats.md import markdown_summary
from uictest.report.github import LIMIT

from ..builders import HOSTILE, make_content, make_result

_READER = MarkdownIt("commonmark", {"html": True}).enable("table")


def _kinds(text):
    """The kinds of everything that a reader of Markdown finds in a text."""
    tokens = _READER.parse(text)
    return {child.type for token in tokens for child in (token.children or [])} - {"softbreak"}


def test_the_summary_is_one_table_with_cases_not_met_first():
    missed = make_result(id="b[x]", outcome="fail", criteria=(), reason="locked")
    lines = markdown_summary(make_content(make_result(), missed)).splitlines()
    assert lines[0] == "## uictest: 2 cases: 1 pass, 1 fail; 1 not as expected"
    first, second = [line for line in lines if line.startswith("| ")][1:]
    assert first.startswith("| **fail** | `b[x]` | fail | not judged | not judged | 465.2 |")
    assert "locked" in first
    statements = "pass | valid | not judged"
    assert second.startswith(f"| pass | `dry-120[command=90]` | {statements} | 465.2 | 27.5 | 1.195 | – |")  # noqa: RUF001


def test_a_recorded_stop_is_told_from_a_simulated_one():
    subjects = {"b": CaseDescription(recorded={"file": "b.csv"})}
    text = markdown_summary(make_content(make_result(id="a"), make_result(id="b"), subjects=subjects))
    simulated, recorded = text.splitlines()[-2:]
    assert "| pass (recorded stop) |" in recorded
    assert "recorded" not in simulated


def test_ten_thousand_cases_stay_within_the_limit_and_say_what_is_missing():
    failed = make_result(outcome="fail")
    results = [replace(failed, id=f"wet-80-friction[friction={n}]") for n in range(10_000)]
    text = markdown_summary(make_content(*results))
    assert len(text.encode()) <= LIMIT
    shown = text.count("\n| **fail**")
    assert f"{10_000 - shown} more cases are in" in text


def test_hostile_texts_are_shown_as_text():
    bad = f"{HOSTILE}`|\\`` <img src=x> [a](javascript:b) ![c](d) ~~e~~ @team #1 https://example.org"
    text = markdown_summary(make_content(make_result(id=bad, outcome="fail", criteria=(), reason=bad)))
    assert _kinds(text) <= {"text", "code_inline", "strong_open", "strong_close"}
    assert not set("\x00\x1b\u202e") & set(text)


def test_the_summary_is_appended_where_github_wants_it_and_what_is_there_already_counts(
    tmp_path, monkeypatch
):
    place = tmp_path / "summary"
    place.write_bytes(b"x" * 990_000 + b"\n")
    monkeypatch.setenv("GITHUB_STEP_SUMMARY", str(place))
    append_step_summary(make_content(*(make_result(id=f"case-{n}") for n in range(1000))))
    assert b"x\n## uictest: 1000 cases: 1000 pass" in place.read_bytes()
    assert place.stat().st_size <= LIMIT


def test_requirements_that_are_not_met_come_first_and_name_the_case():
    results = [
        make_result(id="a", requirements=("BR-1", "BR-2")),
        make_result(id="b", requirements=("BR-2",), outcome="fail"),
    ]
    lines = markdown_summary(make_content(*results)).splitlines()
    assert [line for line in lines if line.startswith("| `BR-")] == [
        "| `BR-2` | **not met** | 2 | b (fail) |",
        "| `BR-1` | met | 1 |  |",
    ]
    assert "| requirement |" in "\n".join(lines)
    assert "| requirement |" not in markdown_summary(make_content(make_result()))
