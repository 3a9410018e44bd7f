from __future__ import annotations

from hypothesis import given, strategies as st
from markdown_it import MarkdownIt

from uictest.report.markdown_text import code, figure, prose

_READER = MarkdownIt("commonmark", {"html": True}).enable("table")


@given(st.text())
def test_a_text_in_a_code_span_is_only_that(text: str) -> None:
    row = f"| a | b |\n|---|---|\n| {code(text)} | x |\n"
    tokens = [token for token in _READER.parse(row) if token.type == "inline"]
    assert len(tokens) == 4
    assert {child.type for child in tokens[2].children or []} <= {"code_inline"}


@given(st.text())
def test_prose_holds_no_markup(text: str) -> None:
    tokens = _READER.parse(f"x{prose(text)}x")
    kinds = {child.type for token in tokens for child in token.children or []}
    assert kinds <= {"text"}


def test_no_figure_is_a_dash() -> None:
    shown = [figure(value, ".1f") for value in (1.25, None, float("nan"))]
    assert shown == ["1.2", "–", "–"]  # noqa: RUF001 - a dash on paper
