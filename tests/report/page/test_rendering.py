from __future__ import annotations

from markupsafe import Markup

from uictest.report.page import rendering


def test_what_cannot_be_seen_is_spelled_out_and_markup_of_ours_is_left_alone() -> None:
    assert rendering._visible("a\u202eb\x00") == "a\\u202eb\\x00"
    ours = Markup("<b>\n</b>")
    assert rendering._visible(ours) is ours
    assert rendering._visible(3) == 3
