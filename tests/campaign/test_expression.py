import pytest
from hypothesis import given, strategies as st

from uictest.running.campaign.selection import ExpressionError, parse

WORDS = frozenset({"slip", "wet", "slip-120[friction=0.10,command=90]"})


def _holds(text):
    return parse(text)(WORDS.__contains__)


@pytest.mark.parametrize(
    ("text", "holds"),
    [
        ("", True),
        ("  ", True),
        ("dry and dry or wet", True),
        ("not (dry or wet)", False),
        ("slip-120[friction=0.10,command=90]", True),
        ("1==1", False),  # nothing is evaluated
    ],
)
def test_an_expression_holds_of_the_words_that_it_names(text, holds):
    assert _holds(text) == holds


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
def test_a_malformed_expression_says_where(text, message):
    with pytest.raises(ExpressionError) as caught:
        parse(text)
    assert str(caught.value) == message


def test_an_absurd_nesting_is_rejected_before_the_stack_is_full():
    with pytest.raises(ExpressionError, match="inside each other"):
        parse("(" * 100_000)


@given(st.lists(st.sampled_from(["slip", "dry", "and", "or", "not", "(", ")"]), max_size=12))
def test_it_agrees_with_python_wherever_python_can_read_it(tokens):
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
