from __future__ import annotations

from pathlib import Path

import pytest
from markupsafe import Markup

from uictest.report.page import rendering


def test_compiled_templates_are_kept_if_there_is_a_place(
    tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    monkeypatch.setattr(rendering, "user_cache", lambda name: tmp_path)
    assert rendering._bytecode_cache() is not None
    monkeypatch.setattr(rendering, "user_cache", lambda name: None)
    assert rendering._bytecode_cache() is None


def test_what_cannot_be_seen_is_spelled_out_and_markup_of_ours_is_left_alone() -> None:
    assert rendering._visible("a\u202eb\x00") == "a\\u202eb\\x00"
    ours = Markup("<b>\n</b>")
    assert rendering._visible(ours) is ours
    assert rendering._visible(3) == 3
