from __future__ import annotations

import pytest
from hypothesis import given, strategies as st

from uictest.running.campaign.selection import ExpressionError, parse

WORDS = frozenset({"slip", "wet", "slip-120[friction=0.10,command=90]"})


def _holds(text: str) -> bool:
    return parse(text)(WORDS.__contains__)


@pytest.mark.parametrize(
    "text",
    [
        "",
        "  ",
        "slip",
        "slip and wet",
        "slip and not dry",
        "dry or wet",
        "not dry",
        "not not slip",
        "dry and dry or wet",
        "wet or dry and dry",
        "not (dry or snow)",
        "((slip))",
        "slip-120[friction=0.10,command=90]",
    ],
)
def test_holds(text: str) -> None:
    assert _holds(text)


@pytest.mark.parametrize(
    "text", ["dry", "slip and dry", "not slip", "not (dry or wet)", "(dry or wet) and dry"]
)
def test_does_not_hold(text: str) -> None:
    assert not _holds(text)


@pytest.mark.parametrize(
    ("text", "message"),
    [
        ("slip wet", "at column 6: expected 'and', 'or' or the end, found 'wet'"),
        ("slip and", "at column 9: expected a word, 'not' or '(', found the end"),
        ("and slip", "at column 1: expected a word, 'not' or '(', found 'and'"),
        ("(slip", "at column 6: expected ')', found the end"),
        ("slip)", "at column 5: expected 'and', 'or' or the end, found ')'"),
        ("()", "at column 2: expected a word, 'not' or '(', found ')'"),
    ],
)
def test_a_malformed_expression_says_where(text: str, message: str) -> None:
    with pytest.raises(ExpressionError) as caught:
        parse(text)
    assert str(caught.value) == message


def test_an_absurd_nesting_is_rejected_before_the_stack_is_full() -> None:
    with pytest.raises(ExpressionError, match="inside each other"):
        parse("(" * 100_000)


def test_nothing_is_evaluated() -> None:
    assert not _holds("1==1")


@given(st.lists(st.sampled_from(["slip", "dry", "and", "or", "not", "(", ")"]), max_size=12))
def test_it_agrees_with_python_wherever_python_can_read_it(tokens: list[str]) -> None:
    text = " ".join(tokens)
    try:
        expected = eval(text, {"slip": True, "dry": False}) if text else True
    except (SyntaxError, TypeError):
        # `slip (dry)` is a call to Python and an error to both; `()` is an empty tuple to Python only.
        with pytest.raises(ExpressionError):
            parse(text)
        return
    if expected == () or "( )" in text:
        return
    assert _holds(text) == expected
