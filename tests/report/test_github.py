import pytest

from uictest.report.github import LIMIT, annotation, append_to_step_summary, case_annotations

from .builders import HOSTILE, make_result


def test_only_cases_that_are_not_met_are_annotated():
    assert list(case_annotations(make_result())) == []
    (line,) = case_annotations(make_result(outcome="fail", criteria=(), reason="locked"))
    properties, message = line.removeprefix("::error ").split("::")
    assert properties == "file=scenarios/dry/120.yaml,title=fail dry-120[command=90]"
    assert message == "fail. Expected: pass%0Alocked"


def test_an_annotation_carries_its_level_and_the_place_in_the_file():
    with_place = annotation("a.yaml", "key", "100 %", line=3, column=7)
    assert with_place == "::error file=a.yaml,line=3,col=7,title=key::100 %25"
    assert annotation("a.yaml", "sweep", "done", level="notice") == "::notice file=a.yaml,title=sweep::done"


def test_a_hostile_name_cannot_start_a_command_of_its_own():
    (line,) = case_annotations(make_result(id=HOSTILE, scenario=HOSTILE, outcome="error"))
    assert line.startswith("::error file=")
    assert "\n" not in line


def test_a_summary_is_told_how_much_room_is_left(tmp_path, monkeypatch):
    place = tmp_path / "summary"
    monkeypatch.setenv("GITHUB_STEP_SUMMARY", str(place))
    texts = {LIMIT: "x" * 600_000, 400_000: "y" * 390_000, 10_000: "z" * 9_000, 2_000: ""}
    for _ in texts:
        append_to_step_summary(texts.__getitem__)
    assert place.stat().st_size == 999_000


@pytest.mark.parametrize("value", ["", None])
def test_without_github_no_summary_is_asked_for(value, monkeypatch):
    monkeypatch.delenv("GITHUB_STEP_SUMMARY", raising=False)
    if value is not None:
        monkeypatch.setenv("GITHUB_STEP_SUMMARY", value)
    append_to_step_summary(lambda limit: pytest.fail(f"asked for {limit} bytes"))
