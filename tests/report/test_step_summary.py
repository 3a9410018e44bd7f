from __future__ import annotations

from pathlib import Path

import pytest

from uictest.report.step_summary import LIMIT, append_to_step_summary


def test_a_summary_is_told_how_much_room_is_left(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    place = tmp_path / "summary"
    monkeypatch.setenv("GITHUB_STEP_SUMMARY", str(place))
    texts = {LIMIT: "x" * 600_000, 400_000: "y" * 390_000, 10_000: "z" * 9_000, 2_000: ""}
    for _ in texts:
        append_to_step_summary(texts.__getitem__)
    assert place.stat().st_size == 999_000


@pytest.mark.parametrize("value", ["", None])
def test_without_github_no_summary_is_asked_for(value: str | None, monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.delenv("GITHUB_STEP_SUMMARY", raising=False)
    if value is not None:
        monkeypatch.setenv("GITHUB_STEP_SUMMARY", value)
    append_to_step_summary(lambda limit: pytest.fail(f"asked for {limit} bytes"))
