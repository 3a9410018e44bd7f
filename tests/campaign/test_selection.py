"""Which cases an expression, a tag or an id selects."""

import pytest
from hypothesis import given, strategies as st

from uictest.running.campaign import ExpressionError, by_expression, by_id, by_tag, parse

from .conftest import make_case

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


@pytest.fixture
def cases():
    return [
        make_case("dry-120", "uic-541-05", "dry", file="stops.yaml"),
        make_case("slip-120[friction=0.10]", "uic-541-05", "slip", file="slip.yaml"),
        make_case("slide-80", "slip", "long", file="slide.yaml"),
    ]


def _ids(cases):
    return [case.id for case in cases]


@pytest.mark.parametrize(
    ("select", "expression", "ids"),
    [
        # A word is sought in id, file name and tags.
        (by_expression, "120", ["dry-120", "slip-120[friction=0.10]"]),
        (by_expression, "DRY", ["dry-120"]),
        (by_expression, "stops", ["dry-120"]),
        (by_expression, "long", ["slide-80"]),
        (by_expression, "slip and not long", ["slip-120[friction=0.10]"]),
        (by_expression, "friction=0.10]", ["slip-120[friction=0.10]"]),
        (by_expression, "snow", []),
        # A tag is matched whole.
        (by_tag, "slip", ["slip-120[friction=0.10]", "slide-80"]),
        (by_tag, "sli", []),
        (by_tag, "slip and not long", ["slip-120[friction=0.10]"]),
    ],
)
def test_a_word_is_sought_in_names_and_tags_and_a_tag_matched_whole(cases, select, expression, ids):
    assert _ids(select(cases, expression)) == ids


@pytest.mark.parametrize(
    ("expression", "numbers"),
    [
        ("car=1", [0]),
        ("CAR=10", [1]),
        ("car=1]", [0]),
        ("car=", [0, 1, 2]),
        ("car", [0, 1, 2]),
        ("train[speed=80", [0, 1]),
        ("speed=8", []),
        ("speed=80kmh,car=1", [0]),
        ("leak=1", []),
        ("leak=1e-8", [2]),
        ("controller=slip", []),
        ("slip", [2]),
    ],
)
def test_a_value_at_the_end_of_a_word_is_whole_but_for_its_unit(expression, numbers):
    trains = ["train[speed=80kmh,car=1]", "train[speed=80kmh,car=10]"]
    cases = [
        make_case(name, file="t.yaml") for name in (*trains, "x[leak=1e-8m3sPa,controller=slip-band,car=2]")
    ]
    assert by_expression(cases, expression) == [cases[number] for number in numbers]


def test_ids_keep_the_order_of_the_cases_and_a_malformed_expression_is_an_error_without_any(cases):
    assert _ids(by_id(cases, frozenset({"slide-80", "dry-120", "gone"}))) == ["dry-120", "slide-80"]
    with pytest.raises(ExpressionError):
        by_expression([], "and")
